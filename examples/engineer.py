"""Walk-through of an engineer: the load multiplier of a wall that stands already.

python examples/engineer.py            # a wall of 12 stones
python examples/engineer.py --full     # one of 60
"""

import argparse
import csv
import tempfile
from pathlib import Path

import numpy as np
from walk import Walk

from drystone.io.wall_image import read_wall_image, write_labels


def drawn_as_from_a_photograph(wall: Path, path: Path) -> None:
    """Write a wall as somebody draws it from a photograph: joints are 2 px wide."""
    labels = read_wall_image(wall)
    padded = np.pad(labels, 1, mode="edge")
    inside = np.ones(labels.shape, bool)
    for down, right in ((0, 1), (1, 0), (1, 2), (2, 1)):
        there = padded[down : down + labels.shape[0], right : right + labels.shape[1]]
        inside &= (there == labels) | (there == 0)
    write_labels(np.where(inside, labels, 0).astype(labels.dtype), path)


def walk(folder: Path, *, full: bool) -> Walk:
    """Do all steps in a folder."""
    stones, wall = (60, "700x300") if full else (12, "240x110")
    one = Walk(folder)
    one.drystone(
        "generate", "rubble", "-o", "stones.png", "--count", stones, "--seed", 2,
        "--set", f"width_px={wall.split('x')[0]}", "--set", f"height_px={wall.split('x')[1]}",
        "--set", f"courses={5 if full else 3}",
    )  # fmt: skip
    one.drystone(
        "plan", "stones.png", "--wall", wall, "--method", "paper", "--two-sided", "--sampling",
        "full", "--scale", 1, "--seed", 1, "-o", "built", codes=(0, 4), lines=3,
    )  # fmt: skip
    drawn_as_from_a_photograph(folder / "built" / "wall.png", folder / "wall_photo_labels.png")
    print("# wall_photo_labels.png: every stone with its own grey, joints drawn 2 px wide\n")
    asked = ("analyse", "wall_photo_labels.png", "--px-per-m", 250, "--mu", 0.6, "--load", "tilt")
    one.drystone(*asked, lines=4, codes=(5,))  # with its joints open it does not stand
    one.drystone(*asked, "--close-gaps", "3px", "-o", "analysis", lines=30)
    with (folder / "analysis" / "contacts.csv").open(encoding="utf-8") as file:
        contacts = list(csv.DictReader(file))
    largest = max(contacts, key=lambda row: float(row["normal_force_right"]))
    print(
        f"   analysis/report.html to look around in, contacts.csv with {len(contacts)} points; "
        f"pushed to the right block {largest['block']} presses hardest, on {largest['other']}\n"
    )
    one.drystone("analyse", "wall_photo_labels.png", "--close-gaps", 3, "--mu", ".5:.7",
                 "--scatter", 40, "--associative-only", lines=12)  # fmt: skip
    top = max(contacts, key=lambda row: float(row["y_m"]))
    x, y = float(top["x_m"]) * 250, float(top["y_m"]) * 250
    one.drystone(
        "analyse", "wall_photo_labels.png", "--close-gaps", 3, "--load", "points",
        "--live", f"{top['block']}@{x:.0f},{y:.0f}:0,-100", "--associative-only", lines=7,
    )  # fmt: skip
    one.summary()
    return one


def main() -> None:
    """Read the options."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--full", action="store_true", help="60 stones")
    parser.add_argument("-o", "--output", metavar="DIR", help="keep the files there")
    options = parser.parse_args()
    if options.output:
        Path(options.output).mkdir(parents=True)
        walk(Path(options.output), full=options.full)
        return
    with tempfile.TemporaryDirectory() as folder:
        walk(Path(folder), full=options.full)


if __name__ == "__main__":
    main()
