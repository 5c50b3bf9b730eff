"""What `drystone analyse -o` writes as tables: every contact point, every block."""

import csv
from collections.abc import Iterable, Sequence
from io import StringIO
from pathlib import Path

from drystone.drawing.words.analysis import BLOCKS, CONTACTS
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult
from drystone.whole_files import write_whole

Cell = str | int | float


def write_tables(
    folder: Path, model: RigidBlockModel, ends: Sequence[LimitResult], per_unit_m: float | None
) -> None:
    """Write both tables into a folder that exists, of both directions.

    `per_unit_m` is metres in a unit of the model; None leaves lengths in its own unit.  Forces are
    in weights of the whole wall.  The normal points into `block`; `other` is 0 for the ground.
    """
    unit, factor = ("", 1.0) if per_unit_m is None else ("_m", per_unit_m)
    weight = sum(block.weight for block in model.blocks if not block.fixed) or 1.0
    head: list[Cell] = ["block", "other", f"x{unit}", f"y{unit}", "normal_x", "normal_y", "mu"]
    rows: list[list[Cell]] = [
        [face.block, face.other, x * factor, y * factor, *face.normal, model.friction(face)]
        for face in model.interfaces
        for x, y in face.points.tolist()
    ]
    for end in ends:
        if end.forces is not None:
            head += [f"{name}_force_{end.direction}" for name in ("normal", "tangential")]
            rows = [row + f for row, f in zip(rows, (end.forces / weight).tolist(), strict=True)]
    _write(folder / CONTACTS, [head, *rows])
    head = ["block", f"x{unit}", f"y{unit}", f"area{unit and '_m2'}", "share_of_weight"]
    rows = []
    for block in model.blocks:
        x, y = block.centroid
        share = 0.0 if block.fixed else block.weight / weight
        rows.append([block.id, x * factor, y * factor, block.area * factor**2, share])
    for end in ends:
        if end.mechanism is not None:
            head += [f"{name}_{end.direction}" for name in ("velocity_x", "velocity_y", "turning")]
            found = end.mechanism
            moves = dict(zip(found.block_ids, found.velocity.tolist(), strict=True))
            for row in rows:
                across, up, turning = moves.get(int(row[0]), (0.0, 0.0, 0.0))
                # Centroids move in units of the largest displacement; turns are per such a unit.
                row += [across, up, turning / factor]
    _write(folder / BLOCKS, [head, *rows])


def _write(path: Path, rows: Iterable[list[Cell]]) -> None:
    text = StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    write_whole(path, text.getvalue().encode())
