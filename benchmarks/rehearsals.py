"""What is left of planned walls under a builder's errors: `python -m benchmarks.rehearsals`.

Plans walls of the masons' stones, of polygons and of generated irregular stones by the default
method, and rehearses each with the errors of a robot and of a hand (docs/theory.md).
"""

import argparse
import os
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import mean, median

import numpy as np

from drystone import plan_wall
from drystone.model.builder import HAND, ROBOT, BuilderErrors
from drystone.search.rehearsal import Groups, mean_size, rehearse, rehearse_in_engine
from drystone.verify.outlines import plan_polygons
from drystone_lab.walls import IR, NOISY, PR_600, UNSEEN, R, Target, chosen

WALLS = (R, PR_600, IR, NOISY[3], UNSEEN[3], UNSEEN[2], UNSEEN[0])


@dataclass(frozen=True)
class Outcome:
    """A planned wall: its figures, and shares of whole runs and of fallen stones by precision."""

    placed: int
    F_AV: float
    F_AH: float
    F_LR: float  # the smaller of both flow rules
    seconds: float  # of CPU time
    whole: dict[float, float]
    fallen: dict[float, float]


def outcome(target: Target, seed: int, asked: argparse.Namespace) -> Outcome | None:
    """Plan a wall and rehearse it; None when its stones are not there."""
    stones = target.stones(asked.data)
    if stones is None:
        return None
    start = time.process_time()
    width, height = target.size(stones)
    found = plan_wall(stones, width, height, seed=seed, scale=target.scale, budget=asked.budget)
    seconds, groups = time.process_time() - start, plan_polygons(found.plan, stones)
    whole, fallen = {}, {}
    for precision in (ROBOT, HAND):
        counts = list(falls(groups, precision, asked))
        whole[precision] = mean(count == 0 for count in counts)
        fallen[precision] = mean(counts) / len(groups)
    now = found.plan.metrics
    carried = min(now.F_LR or 0.0, now.F_LR_coulomb or 0.0)
    return Outcome(len(groups), now.F_AV or 0, now.F_AH or 0, carried, seconds, whole, fallen)


def falls(groups: Groups, precision: float, asked: argparse.Namespace) -> Iterator[int]:
    """Count the stones that fall in each run."""
    once = rehearse_in_engine if asked.physics else rehearse
    errors = BuilderErrors.of_precision(precision, mean_size(groups))
    for run in range(asked.runs):
        found = once(groups, errors, np.random.default_rng([99, run]))
        yield sum(end.fallen for end in found.stones)


def main() -> None:
    """Print a row for each wall: means of whole walls and falls, medians of the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    option = parser.add_argument
    data = os.environ.get("DRYSTONE_DATA")
    option("--data", type=Path, default=data and Path(data), help="default: $DRYSTONE_DATA")
    option("--only", nargs="*", default=[], metavar="WALL")
    option("--seeds", type=int, default=4)
    option("--budget", type=int, default=16, help="walls of a search")
    option("--runs", type=int, default=20)
    option("--physics", action="store_true", help="rehearse in the rigid-body engine")
    asked = parser.parse_args()
    columns = "wall | whole robot, hand | fallen robot, hand | placed | F_AV | F_AH | F_LR | CPU s"
    sys.stdout.write(f"{columns}\n")
    for target in chosen(WALLS, asked.only):
        found = [one for k in range(asked.seeds) if (one := outcome(target, k, asked)) is not None]
        if found:
            whole = ", ".join(f"{mean(o.whole[p] for o in found):.0%}" for p in (ROBOT, HAND))
            fallen = ", ".join(f"{mean(o.fallen[p] for o in found):.1%}" for p in (ROBOT, HAND))
            figures = " | ".join(
                f"{median(getattr(one, name) for one in found):.{digits}f}"
                for name, digits in
                (("placed", 0), ("F_AV", 1), ("F_AH", 1), ("F_LR", 2), ("seconds", 0))
            )  # fmt: skip
            sys.stdout.write(f"{target.name} | {whole} | {fallen} | {figures}\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
