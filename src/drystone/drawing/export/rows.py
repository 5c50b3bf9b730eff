"""The build list: one row a step, with the unit in the names."""

from dataclasses import dataclass
from typing import Any

from drystone.drawing.assembly import handling
from drystone.drawing.assembly.parts import Assembly, Part
from drystone.model.plan import StoneStep


@dataclass(frozen=True)
class Column:
    """One column.

    Parameters
    ----------
    name : str
        With the unit of the assembly.
    type : type
        Of its values, apart from None; `list` is one of ids.
    values : tuple
        One a step.
    """

    name: str
    type: type
    values: tuple[Any, ...]


def columns(assembly: Assembly) -> tuple[Column, ...]:
    """Return the build list by columns.

    x and y are the plan's: x along the wall, y up. Width and height are those of the bounding
    box as a stone lies in the source image.
    """
    unit, parts = assembly.unit, assembly.parts
    stones = [part.plan_step if isinstance(part.plan_step, StoneStep) else None for part in parts]
    metric = unit == "m"

    def column(name: str, kind: type, values: list[Any]) -> Column:
        return Column(name, kind, tuple(values))

    return (
        column("step", int, [part.step for part in parts]),
        column("kind", str, [part.kind for part in parts]),
        column("id", int, [part.id for part in parts]),
        column("name", str, [part.name for part in parts]),
        column("under", int, [part.under for part in parts]),
        column("side", str, [stone and stone.side for stone in stones]),
        column("cluster", int, [part.cluster for part in parts]),
        column("angle_deg", float, [part.angle_deg for part in parts]),
        column(f"x_{unit}", float, [part.centroid[0] for part in parts]),
        column(f"y_{unit}", float, [part.centroid[1] for part in parts]),
        column("source_x_px", float, [stone and stone.source_centroid[0] for stone in stones]),
        column("source_y_px", float, [stone and stone.source_centroid[1] for stone in stones]),
        column(f"width_{unit}", float, [part.size[0] for part in parts]),
        column(f"height_{unit}", float, [part.size[1] for part in parts]),
        column(f"area_{unit}2", float, [part.area for part in parts]),
        column("mass_kg", float, [assembly.mass_kg(part) if metric else None for part in parts]),
        column("neighbours", list, [handling.touched_when_placed(assembly, p) for p in parts]),
        column("alpha_left", float, [part.plan_step.alpha_left for part in parts]),
        column("alpha_right", float, [part.plan_step.alpha_right for part in parts]),
        column("instruction", str, [instruction(assembly, part) for part in parts]),
    )


def instruction(assembly: Assembly, part: Part) -> str:
    """Return what to do in a step, in words."""
    x, y = (_length(value, assembly.unit) for value in part.centroid)
    if part.kind == "wedge":
        return f"Push wedge {part.id} in under stone {part.under}, {x} from the left, {y} up."
    angle = round(part.angle_deg)
    way = "clockwise" if angle < 0 else "counter-clockwise"
    turned = f"turned {abs(angle)} degrees {way}" if angle else "not turned"
    return f"Stone {part.id}, {turned}, middle {x} from the left, {y} up."


def _length(value: float, unit: str) -> str:
    return f"{value:.3f} m" if unit == "m" else f"{value:.1f} px"
