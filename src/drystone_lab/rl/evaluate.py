"""Compare policies on stones that arrive: ``python -m drystone_lab.rl.evaluate``.

All policies build with the same stones in the same order, from the same places offered, by the
planner itself (``order = "given"``); none of the walls was trained on.  With ``--free`` they choose
the order too.
"""

import argparse
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.stats import sem
from scipy.stats import t as student

from drystone.errors import DrystoneError, ExitCode
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.goal import FoundWall
from drystone.search.yard import Yard
from drystone.selection.policies.registry import rule_of
from drystone_lab.cells import COVERED
from drystone_lab.rl.episode import ARRIVING, KINDS, DrawSettings, draw_wall
from drystone_lab.rl.train import HELD_OUT
from drystone_lab.table import markdown_rows

FIGURES = ("merit", "F_SF", "F_AV", "F_AH", "F_LR")

POLICIES = ("learned", "random", "lowest", "scalarised", "filter", "towers", "paper")
"""Policies that are compared, by their names; the first with each other."""

FREE = replace(ARRIVING, order="free", sampling="variant")
"""The same places, offered for one stone of each cluster that is left."""


def difference(values: Sequence[float]) -> tuple[float, float]:
    """Return the mean of some differences, and half the width of its interval by Student's t.

    The half is infinite for a single difference.

    >>> difference([1.0, 1.0, 1.0])
    (1.0, 0.0)
    """
    mean = float(np.mean(values))
    if len(values) < 2:
        return mean, float("inf")
    return mean, float(sem(values) * student.ppf(0.5 + COVERED / 2, len(values) - 1))


def held_out_wall(kind: str, number: int, draw: DrawSettings) -> Workshop:
    """Return a wall that no training with these seeds has had."""
    rng = np.random.default_rng([HELD_OUT, KINDS.index(kind), number])
    return Workshop.prepare(*draw_wall(replace(draw, kinds=(kind,)), rng), ARRIVING)


def figures_by(
    policy: str, workshops: Sequence[Workshop], settings: PlannerSettings = ARRIVING
) -> dict[str, list[float]]:
    """Return the figures of the walls that a policy builds."""
    found: dict[str, list[float]] = {name: [] for name in FIGURES}
    rule = replace(settings, selection_rule=rule_of(policy))
    for number, workshop in enumerate(workshops):
        planner = Yard(workshop, rule).planner(number)
        for _ in planner.steps():
            pass
        wall = FoundWall.of(planner)
        if wall.figures is None:
            raise ValueError(f"{policy} built nothing with wall {number}")
        found["merit"].append(wall.merit)
        for name in FIGURES[1:]:
            found[name].append(getattr(wall.figures, name))
    return found


def report(found: Mapping[str, Mapping[str, Sequence[float]]], title: str) -> str:
    """Return the means of each policy, and what the first has more than each of the others."""
    first, *others = found
    means = [
        [name, *(f"{np.mean(walls[figure]):.3f}" for figure in FIGURES)]
        for name, walls in found.items()
    ]

    def less(other: str, name: str) -> str:
        mean, half = difference(np.subtract(found[first][name], found[other][name]).tolist())
        return f"{mean:+.3f} ± {half:.3f}{'*' if abs(mean) > half else ''}"

    paired = [[other, *(less(other, name) for name in FIGURES)] for other in others]
    return "\n\n".join(
        [
            f"{title}: means",
            markdown_rows(("policy", *FIGURES), means),
            f"{title}: `{first}` less each other, with 95 % intervals (* without 0)",
            markdown_rows((f"{first} less", *FIGURES), paired),
        ]
    )


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m drystone_lab.rl.evaluate", description=__doc__)
    parser.add_argument("--walls", type=int, default=12, help="of each kind of stones")
    parser.add_argument("--first", type=int, default=0, help="number of the first of each kind")
    parser.add_argument("--stones", type=int, default=DrawSettings.stones, help="of a wall")
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--policies", nargs="+", default=list(POLICIES))
    parser.add_argument(
        "--free", action="store_true", help="any stone may be next, of the paper's samples"
    )
    arguments = parser.parse_args(argv)
    if min(arguments.walls, arguments.first + 1) < 1 or len(set(arguments.policies)) < 2:
        parser.error("there must be a wall or more, from number 0 on, and two policies or more")
    every = {name: {figure: list[float]() for figure in FIGURES} for name in arguments.policies}
    try:
        draw = DrawSettings(stones=arguments.stones)
        settings = FREE if arguments.free else ARRIVING
        for kind in arguments.kinds:
            numbers = range(arguments.first, arguments.first + arguments.walls)
            walls = [held_out_wall(kind, number, draw) for number in numbers]
            found = {name: figures_by(name, walls, settings) for name in arguments.policies}
            _print(report(found, f"{len(walls)} walls of {kind} stones"))
            for name, figures in found.items():
                for figure in FIGURES:
                    every[name][figure] += figures[figure]
    except DrystoneError as error:
        sys.stderr.write(f"drystone: {error}\n")
        return int(error.exit_code)
    if len(arguments.kinds) > 1:
        _print(report(every, f"All {arguments.walls * len(arguments.kinds)} walls"))
    return int(ExitCode.DONE)


def _print(text: str) -> None:
    sys.stdout.write(f"{text}\n\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
