"""What `drystone analyse -o` writes as tables: every contact point, every block."""

import csv
from collections.abc import Iterator, Sequence
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

    `per_unit_m` is metres in a unit of the model; None leaves lengths in its own unit.
    """
    unit, factor = ("", 1.0) if per_unit_m is None else ("_m", per_unit_m)
    _write(folder / CONTACTS, contact_rows(model, ends, unit, factor))
    _write(folder / BLOCKS, block_rows(model, ends, unit, factor))


def contact_rows(
    model: RigidBlockModel, ends: Sequence[LimitResult], unit: str, factor: float
) -> Iterator[list[Cell]]:
    """Yield a head, then a row for every contact point; forces in weights of the whole wall.

    The normal points into `block`; `other` is 0 for the ground.
    """
    forced = [end for end in ends if end.forces is not None]
    head: list[Cell] = ["block", "other", f"x{unit}", f"y{unit}", "normal_x", "normal_y", "mu"]
    for end in forced:
        head += [f"normal_force_{end.direction}", f"tangential_force_{end.direction}"]
    yield head
    weight = sum(block.weight for block in model.blocks if not block.fixed) or 1.0
    number = 0
    for face in model.interfaces:
        for x, y in face.points.tolist():
            row: list[Cell] = [face.block, face.other, x * factor, y * factor, *face.normal]
            row.append(model.friction(face))
            for end in forced:
                assert end.forces is not None  # noqa: S101 - only those have come here
                row += (end.forces[number] / weight).tolist()
            yield row
            number += 1


def block_rows(
    model: RigidBlockModel, ends: Sequence[LimitResult], unit: str, factor: float
) -> Iterator[list[Cell]]:
    """Yield a head, then a row for every block: where it is, how it moves in each mechanism."""
    moving = [end for end in ends if end.mechanism is not None]
    head: list[Cell] = ["block", f"x{unit}", f"y{unit}", f"area{unit and '_m2'}", "share_of_weight"]
    for end in moving:
        head += [f"{name}_{end.direction}" for name in ("velocity_x", "velocity_y", "turning")]
    yield head
    weight = sum(block.weight for block in model.blocks if not block.fixed) or 1.0
    velocities = [
        dict(zip(one.block_ids, one.velocity.tolist(), strict=True))
        for one in (end.mechanism for end in ends) if one is not None
    ]  # fmt: skip
    for block in model.blocks:
        x, y = block.centroid
        share = 0.0 if block.fixed else block.weight / weight
        row: list[Cell] = [block.id, x * factor, y * factor, block.area * factor**2, share]
        for found in velocities:
            across, up, turning = found.get(block.id, (0.0, 0.0, 0.0))
            # Centroids move in units of the largest displacement; turns are per such a unit.
            row += [across, up, turning / factor]
        yield row


def _write(path: Path, rows: Iterator[list[Cell]]) -> None:
    text = StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    write_whole(path, text.getvalue().encode())
