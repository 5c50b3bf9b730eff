"""Train the value policy: ``python -m drystone_lab.rl.train -o weights.json``.

Monte-Carlo policy iteration: walls are built up to a random stone and finished from each of its
places by the policy so far, which at first takes the lowest; the value of a place is fitted to the
merits of all these walls; the place of the largest value is what the next policy takes.
"""

import argparse
import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from drystone.errors import DrystoneError, ExitCode, UsageError
from drystone.planner.workshop import Workshop
from drystone.selection.policies.choices import LOWEST
from drystone.selection.policies.learned import FEATURES, ValueModel, features, learned
from drystone.selection.policy import Offer
from drystone.whole_files import refuse_existing
from drystone_lab.commands import say
from drystone_lab.rl.episode import ARRIVING, DrawSettings, Episode, draw_wall

Floats = NDArray[np.float64]

Choose = Callable[[Sequence[Offer], Generator], int]
"""Chooses among offers."""


def at_random(offers: Sequence[Offer], rng: Generator) -> int:
    """Choose any of some offers, all with the same chance."""
    return int(rng.integers(len(offers)))


class Branching(NamedTuple):
    """The places of one stone, and the walls that were finished from each."""

    features: Floats
    merits: Floats

    @property
    def centred(self) -> tuple[Floats, Floats]:
        """Features and merits less their means: what the choice of the place makes of them."""
        return self.features - self.features.mean(axis=0), self.merits - self.merits.mean()


def finished(episode: Episode, choose: Choose, rng: Generator) -> float:
    """Build on by a policy until the wall is finished; return its merit."""
    while not episode.over:
        episode.take(choose(episode.offers, rng))
    return episode.merit


def branching(workshop: Workshop, choose: Choose, seed: Sequence[int]) -> Branching | None:
    """Build a wall up to a random stone, and finish it from each of the places of that stone.

    It is among the first two thirds that arrive: the last mostly find no place.  Of the stones
    before it three in ten are placed at random: later states than those of the policy itself are
    seen so.  The walls that are finished have the same random numbers for all places.  None when no
    stone has a choice of places.
    """
    rng = np.random.default_rng([*seed, 0])
    episode = Episode(workshop)
    step = int(rng.integers(max(1, int(2 / 3 * len(workshop.fitting)))))
    found: Episode | None = None
    while not episode.over and step >= 0:
        if len(episode.offers) > 1:
            found = episode.copy()
        explores = rng.random() < 0.3
        episode.take((at_random if explores else choose)(episode.offers, rng))
        step -= 1
    if found is None:
        return None
    merits = []
    for position in range(len(found.offers)):
        branch = found.copy()
        branch.take(position)
        merits.append(finished(branch, choose, np.random.default_rng([*seed, 1])))
    return Branching(features(found.offers), np.array(merits))


def fitted(branchings: Sequence[Branching], strength: float) -> Floats:
    """Return the weights that say best which places lead to better walls.

    Least squares on the differences within each branching, drawn towards 0 (ridge regression).
    Features count by how much they differ between the places of one stone: over the root of their
    mean variance within a branching, if they differ at all.
    """
    x, y = map(np.concatenate, zip(*(one.centred for one in branchings), strict=True))
    spread = np.sqrt((x**2).mean(axis=0))
    scale = np.where(spread > 1e-6, spread, 1.0)
    x = x / scale
    held = strength * np.eye(x.shape[1])
    return np.asarray(np.linalg.solve(x.T @ x + held, x.T @ y) / scale, np.float64)


TRAINED_ON = ("brick", "fourier", "polygon")
"""Kinds of stones; rubble is held out."""

HELD_OUT = 10**7
"""Seed of the walls that trained policies are compared on: nothing is trained with it."""


@dataclass(frozen=True, kw_only=True)
class TrainSettings:
    """A training run; equal settings give the same weights."""

    seed: int = 1
    rounds: int = 2  # How many times the value is fitted, and the policy with it
    # Of a round, of the kinds in turn; each is finished from all places of one stone
    walls: int = 100
    strength: float = 50.0  # Of the ridge of the fit (:func:`drystone_lab.rl.train.fitted`)
    validation: int = 24  # Walls on which start and result are compared
    draw: DrawSettings = field(default_factory=lambda: DrawSettings(kinds=TRAINED_ON))


def train(
    settings: TrainSettings,
    say: Callable[[str], None] = lambda _: None,
    seconds: float = math.inf,
) -> ValueModel:
    """Return the model that a training run finds.

    No round is begun after `seconds`; a run that it cut short is repeated by the number of rounds
    that the model says.
    """
    start = time.monotonic()
    found: list[Branching] = []
    model = ValueModel((0.0,) * len(FEATURES), {})
    done = walls = 0
    while done < settings.rounds and time.monotonic() - start <= seconds:
        choose = learned(model).choose if done else LOWEST.choose
        branched = (
            branching(_workshop(settings, k), choose, (settings.seed, 3, k))
            for k in range(done * settings.walls, (done + 1) * settings.walls)
        )
        new = [one for one in branched if one is not None]
        found += new
        if not found:
            what = "no stone of these walls has a choice of places."
            cure = "Train on more walls, or of more stones."
            raise UsageError("E123", what, where="TrainSettings", cure=cure)
        model = ValueModel(tuple(fitted(found, settings.strength).tolist()), {})
        done += 1
        walls += sum(len(one.merits) for one in new)
        merit = np.mean([one.merits.mean() for one in new])
        say(
            f"round {done} of {settings.rounds}: {walls} walls finished, the last "
            f"of merit {merit:.3f}; {time.monotonic() - start:.0f} s"
        )
    # Training has fewer walls than that.
    others = [_workshop(settings, 10**6 + k) for k in range(settings.validation)]
    by_random, by_lowest, by_value = (
        mean_merit(choose, others) for choose in (at_random, LOWEST.choose, learned(model).choose)
    )
    say(
        f"on {settings.validation} other walls: merit {by_random:.3f} at random, "
        f"{by_lowest:.3f} by the lowest, {by_value:.3f} by value"
    )
    trained = {
        "seed": settings.seed, "rounds": done, "walls": settings.walls,
        "finished": walls, "strength": settings.strength,
        "kinds": list(settings.draw.kinds), "stones": settings.draw.stones,
        "merit_random": round(by_random, 6), "merit_lowest": round(by_lowest, 6),
        "merit_learned": round(by_value, 6),
    }  # fmt: skip
    return replace(model, trained=trained)


def mean_merit(choose: Choose, workshops: Sequence[Workshop]) -> float:
    """Return the mean merit of the walls that a policy builds."""
    merits = (
        finished(Episode(one), choose, np.random.default_rng(number))
        for number, one in enumerate(workshops)
    )
    return math.fsum(merits) / len(workshops)


def _workshop(settings: TrainSettings, number: int) -> Workshop:
    kinds = settings.draw.kinds
    draw = replace(settings.draw, kinds=(kinds[number % len(kinds)],))
    rng = np.random.default_rng([settings.seed, 2, number])
    return Workshop.prepare(*draw_wall(draw, rng), ARRIVING)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m drystone_lab.rl.train", description=__doc__)
    parser.add_argument("-o", "--output", type=Path, required=True, help="file to write")
    parser.add_argument("--overwrite", action="store_true", help="replace a file that is there")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=TrainSettings.rounds)
    parser.add_argument("--walls", type=int, default=TrainSettings.walls, help="of a round")
    parser.add_argument(
        "--validation", type=int, default=TrainSettings.validation, help="walls that compare"
    )
    parser.add_argument("--stones", type=int, default=DrawSettings.stones, help="of a wall")
    parser.add_argument("--minutes", type=float, default=math.inf, help="begin none after these")
    arguments = parser.parse_args(argv)
    if min(arguments.rounds, arguments.walls, arguments.validation) < 1:
        parser.error("rounds and numbers of walls must be positive")
    if not 0 <= arguments.seed < HELD_OUT:
        parser.error(f"the seed must be 0 to {HELD_OUT - 1}: from there on they are held out")

    try:
        # Before a minute of training.
        refuse_existing(arguments.output, overwrite=arguments.overwrite)
        settings = TrainSettings(
            seed=arguments.seed, rounds=arguments.rounds, walls=arguments.walls,
            validation=arguments.validation,
            draw=DrawSettings(kinds=TRAINED_ON, stones=arguments.stones),
        )  # fmt: skip
        model = train(settings, say, 60.0 * arguments.minutes)
        arguments.output.write_text(model.to_json(), encoding="utf-8")
    except (DrystoneError, OSError) as error:
        sys.stderr.write(f"drystone: {error}\n")
        return int(getattr(error, "exit_code", ExitCode.BAD_INPUT))
    sys.stdout.write(f"{arguments.output}\n")
    return int(ExitCode.DONE)


if __name__ == "__main__":
    sys.exit(main())
