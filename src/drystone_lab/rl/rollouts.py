"""What each place of a stone is worth: the wall is finished from each of them, by one policy."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from drystone.planner.workshop import Workshop
from drystone.selection.policies.learned import features
from drystone.selection.policy import Offer
from drystone_lab.rl.episode import Episode

Floats = NDArray[np.float64]

Choose = Callable[[Sequence[Offer], Generator], int]
"""Chooses among offers."""

EXPLORED = 0.3
"""Share of the stones before a branching that are placed at random: later states than those of
the policy itself are seen so."""

BRANCHED = 2 / 3
"""Branchings are among this share of the stones that arrive first; the last of them mostly find no
place."""


def at_random(offers: Sequence[Offer], rng: Generator) -> int:
    """Choose any of some offers, all with the same chance."""
    return int(rng.integers(len(offers)))


@dataclass(frozen=True, eq=False)
class Branching:
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

    The walls that are finished have the same random numbers for all places.  None when no stone has
    a choice of places.
    """
    rng = np.random.default_rng([*seed, 0])
    episode = Episode(workshop)
    step = int(rng.integers(max(1, int(BRANCHED * len(workshop.fitting)))))
    found: Episode | None = None
    while not episode.over and step >= 0:
        if len(episode.offers) > 1:
            found = episode.copy()
        explores = rng.random() < EXPLORED
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


def fitted(branchings: Sequence[Branching], scale: Floats, strength: float) -> Floats:
    """Return the weights that say best which places lead to better walls.

    Least squares on the differences within each branching, drawn towards 0 (ridge regression).
    """
    pairs = [one.centred for one in branchings]
    x = np.concatenate([rows for rows, _ in pairs]) / scale
    y = np.concatenate([merits for _, merits in pairs])
    held = strength * np.eye(x.shape[1])
    return np.asarray(np.linalg.solve(x.T @ x + held, x.T @ y), np.float64)


def spread_of(branchings: Sequence[Branching]) -> Floats:
    """Return by how much each feature differs between the places of one stone, (f,).

    The root of its mean variance within a branching; 1 for one that never differs.
    """
    squares = np.concatenate([one.centred[0] for one in branchings]) ** 2
    scale = np.sqrt(squares.mean(axis=0))
    return np.where(scale > 1e-6, scale, 1.0)
