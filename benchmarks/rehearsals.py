"""What is left of planned walls under a builder's errors: `python -m benchmarks.rehearsals`.

Plans walls of the masons' stones, of polygons and of generated irregular stones by the default
method, and builds each with the errors of a robot and of a hand (docs/theory.md), without looking
(open loop) and planned again after every stone (closed loop).  Plans and rows stay in a folder:
what was stopped goes on, more seeds or runs are added.  `--plans-of CHECKOUT` lets another source
tree plan, in a folder of its own; the judge is always this one.  Several folders are compared.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from statistics import mean, median
from typing import Any

import numpy as np

from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.io.walls import read_wall
from drystone.model.builder import HAND, ROBOT, BuilderErrors
from drystone.model.steps import grouped, piece_id
from drystone.search.closed_loop import rehearse_closed
from drystone.search.rehearsal import (
    Groups,
    mean_size,
    rehearse,
    rehearse_in_engine,
    tilt_as_built,
)
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone_lab.walls import IR, NOISY, PR_560, PR_600, UNSEEN, R, chosen

WALLS = (R, PR_600, PR_560, IR, NOISY[4], UNSEEN[3], UNSEEN[2], UNSEEN[0])
"""R, PR in two sizes, IR, noise 50, and rubble, polygons and Fourier stones of named seeds."""

LEVELS = {"none": 0.0, "robot": ROBOT, "hand": HAND}
LOOPS = {"open": rehearse, "closed": rehearse_closed, "engine": rehearse_in_engine}

PLAN = """
import sys, time
from pathlib import Path
from drystone import plan_wall
from drystone.io.plan_folder import write_plan_folder
from drystone_lab import walls
name, seed, folder, data, budget = sys.argv[1:]
known = [one for of in vars(walls).values() for one in (of if isinstance(of, tuple) else (of,))]
target = next(one for one in known if isinstance(one, walls.Target) and one.name == name)
stones = target.stones(Path(data) if data else None)
if stones is not None:
    start = time.process_time()
    size = target.size(stones)
    budget = int(budget) if budget else None
    found = plan_wall(stones, *size, seed=int(seed), scale=target.scale, budget=budget)
    seconds = time.process_time() - start
    write_plan_folder(found, folder)
    Path(folder, "seconds").write_text(f"{seconds:.2f}")
"""
"""Run by the checkout that plans."""


def planned(name: str, seed: int, asked: argparse.Namespace) -> Path | None:
    """Return the folder of a plan, which is made unless it is there; None without its stones."""
    folder = Path(asked.folder) / f"{name.replace(' ', '_').replace('%', 'percent')}-{seed}"
    if not (folder / "seconds").exists():
        tree = Path(asked.plans_of).resolve()
        argv = [name, seed, folder, asked.data or "", asked.budget or ""]
        subprocess.run(  # noqa: S603 - our own program
            [sys.executable, "-c", PLAN, *map(str, argv)],
            env={**os.environ, "PYTHONPATH": f"{tree / 'src'}:{tree}"},
            check=True,
        )
    return folder if (folder / "seconds").exists() else None


def groups_in(folder: Path) -> tuple[Groups, Any]:
    """Read the stones of a plan with their wedges, source px, and its figures."""
    wall = read_wall(folder)
    assert wall.plan is not None and wall.blocks is not None  # noqa: S101, PT018 - our own plan
    outlines = polygons_from_json(wall.blocks)
    groups = [[piece_id(step) for step in steps] for steps in grouped(wall.plan.steps)[0]]
    return [[(i, outlines[i][:-1]) for i in ids] for ids in groups], wall.plan.metrics


def rows_of(
    name: str, seed: int, folder: Path, asked: argparse.Namespace
) -> Iterator[dict[str, Any]]:
    """Return what became of a wall in every run; what is on disk is not done again."""
    path = folder / "rows.jsonl"
    known = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    have = {(row["level"], row["loop"], row["run"]): row for row in known}
    groups, _ = groups_in(folder)
    for level, precision in LEVELS.items():
        errors = BuilderErrors.of_precision(precision, mean_size(groups))
        for loop in ["open"] if level == "none" else asked.loops:
            for run in range(1 if level == "none" else asked.runs):
                there = have.get((level, loop, run))
                if there is None or (run < asked.tilts and there["tilt"] is None):
                    start = time.process_time()
                    found = LOOPS[loop](groups, errors, np.random.default_rng([99, run]))
                    if run < asked.tilts and found.tilt is None:
                        found = replace(found, tilt=tilt_as_built(groups, found))
                    row = {
                        "level": level, "loop": loop, "run": run,
                        "fallen": sum(end.fallen for end in found.stones),
                        "again": getattr(found, "again", 0),
                        "tilt": found.tilt,
                        "seconds": round(time.process_time() - start, 3),
                    }  # fmt: skip
                    with path.open("a") as file:
                        file.write(json.dumps(row) + "\n")
                    have[level, loop, run] = row
                yield {**have[level, loop, run], "wall": name, "seed": seed}


def figures(folder: Path) -> dict[str, float]:
    """Return the figures of a plan; F_LR is the smaller of both flow rules, by this judge.

    Where nothing is found without dilatancy it is the other one, above which none can be.
    """
    groups, now = groups_in(folder)
    blocks = read_wall(folder).blocks
    assert blocks is not None and now.F_LR is not None  # noqa: S101, PT018 - our own plan
    found = nonassociative_resistance(model_from_json(blocks)).carried
    carried = min(now.F_LR, math.inf if found is None else found)
    return {
        "placed": len(groups), "F_AV": now.F_AV or 0.0, "F_AH": now.F_AH or 0.0, "F_LR": carried,
        "seconds": float((folder / "seconds").read_text()),
    }  # fmt: skip


def line(
    name: str, rows: list[dict[str, Any]], plans: list[dict[str, float]], loops: list[str]
) -> str:
    """Write a row: shares of whole runs, means of fallen stones, medians of the rest."""
    cells = [name]
    for loop in loops:
        for level in ("robot", "hand"):
            mine = [row for row in rows if (row["level"], row["loop"]) == (level, loop)]
            whole = mean(row["fallen"] == 0 for row in mine)
            again = f" ({mean(row['again'] for row in mine):.1f})" if loop == "closed" else ""
            cells.append(f"{whole:.0%}, {mean(row['fallen'] for row in mine):.1f}{again}")
    for loop in loops:
        weakest = []
        for level in LEVELS:
            mine = [row for row in rows if level == "none" or row["loop"] == loop]
            by_seed: dict[int, list[float]] = {}
            for row in mine:
                if row["level"] == level and row["tilt"] is not None:
                    by_seed.setdefault(row["seed"], []).append(row["tilt"])
            weakest.append(f"{median(map(min, by_seed.values())):.2f}" if by_seed else "-")
        cells.append(", ".join(weakest))
    for key, digits in (("placed", 1), ("F_AV", 1), ("F_AH", 1), ("F_LR", 2), ("seconds", 0)):
        cells.append(f"{median(plan[key] for plan in plans):.{digits}f}")
    return " | ".join(cells)


def main(argv: list[str] | None = None) -> None:
    """Print a row for each wall and folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    option = parser.add_argument
    option("folder", help="where plans and rows are kept")
    option("--data", default=os.environ.get("DRYSTONE_DATA"), help="default: $DRYSTONE_DATA")
    option("--only", nargs="*", default=[], metavar="WALL")
    option("--seeds", type=int, default=4)
    option("--runs", type=int, default=20)
    option("--loops", nargs="+", choices=LOOPS, default=["open", "closed"])
    option("--tilts", type=int, default=2, help="runs of which the wall is tilted in the engine")
    option("--budget", type=int, help="walls of a search (default: that of the settings)")
    option("--plans-of", default=".", metavar="CHECKOUT", help="source tree that plans")
    option("--against", nargs="*", default=[], metavar="FOLDER", help="compare with these")
    asked = parser.parse_args(argv)
    heads = ["wall"]
    heads += [f"{x}, {y}: whole, fallen" for x in asked.loops for y in ("robot", "hand")]
    heads += [f"tilt/mu none, robot, hand, {loop}" for loop in asked.loops]
    heads += ["placed", "F_AV", "F_AH", "F_LR", "CPU s"]
    sys.stdout.write(f"{' | '.join(heads)}\n")
    for target in chosen(WALLS, asked.only):
        for folder in [asked.folder, *asked.against]:
            rows: list[dict[str, Any]] = []
            plans: list[dict[str, float]] = []
            for seed in range(asked.seeds):
                mine = argparse.Namespace(**{**vars(asked), "folder": folder})
                place = planned(target.name, seed, mine)
                if place is not None:
                    rows += rows_of(target.name, seed, place, mine)
                    plans.append(figures(place))
            if plans:
                of = f" ({Path(folder).name})" if asked.against else ""
                sys.stdout.write(line(target.name + of, rows, plans, asked.loops) + "\n")
                sys.stdout.flush()


if __name__ == "__main__":
    main()
