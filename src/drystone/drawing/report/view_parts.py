"""Stones and wedges as the viewer wants them."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.outlines import Region
from drystone.drawing.palette import PLAIN_COLOUR, WEDGE_COLOUR, cluster_colour, text_colour
from drystone.drawing.report.view_statics import rounded
from drystone.drawing.words.content import number
from drystone.kernels.polygons import Points
from drystone.model.plan import StoneStep
from drystone.statics.model import RigidBlockModel

PATTERNS = ("none", "rising", "falling", "dots", "level", "upright", "crossed", "grid")
"""Clusters that are apart in their colour only by a little are apart in their pattern."""


def part_digits(size: tuple[float, float]) -> int:
    """Return the digits of lengths at which a hundred-thousandth of a wall is left out.

    Examples
    --------
    >>> part_digits((280.0, 80.0)), part_digits((1.4, 0.4))
    (2, 4)
    """
    longest = max(*size, 1e-9)
    return max(0, 4 - int(np.floor(np.log10(longest))))


def planned_parts(assembly: Assembly, crops: Mapping[int, Any], digits: int) -> list[Any]:
    """Return the parts of a plan in the order of its steps."""
    under: dict[int, list[int]] = {}
    for wedge in assembly.wedges:
        under.setdefault(wedge.under or 0, []).append(wedge.id)
    return [
        {
            **_common(part.id, part.kind, [part.corners], part.centroid, digits),
            **_look(part.kind, part.cluster),
            "name": part.name,
            "step": part.step,
            "number": part.step if part.kind == "stone" else None,
            "angle_deg": round(part.angle_deg, 3) + 0.0,
            "size": rounded(part.size, digits),
            "neighbours": list(assembly.neighbours(part.id)),
            "under": part.under,
            "wedges": under.get(part.id, []),
            "words": words(assembly, part),
            "crop": crops.get(part.id),
            **_of_step(assembly, part),
        }
        for part in assembly.parts
    ]


def _of_step(assembly: Assembly, part: Part) -> dict[str, Any]:
    """Return what only the step of a part knows."""
    step = part.plan_step
    alphas = {
        "alpha_left": _short(step.alpha_left),
        "alpha_right": _short(step.alpha_right),
    }
    if not isinstance(step, StoneStep):
        return {"side": None, "indices": {}, "source": None, **alphas}
    return {
        "side": step.side,
        "indices": {name: _short(value) for name, value in step.indices.items()},
        "source": rounded(assembly.source_corners(part), 2),
        **alphas,
    }


def given_parts(
    regions: Iterable[Region], model: RigidBlockModel, wedges: Iterable[int], digits: int
) -> list[Any]:
    """Return the blocks of a wall that was not planned: they have no step and no source."""
    touching: dict[int, set[int]] = {}
    for face in model.interfaces:
        touching.setdefault(face.block, set()).add(face.other)
        touching.setdefault(face.other, set()).add(face.block)
    known = frozenset(wedges)
    made = []
    for region in regions:
        kind = "wedge" if region.id in known else "stone"
        corners = np.concatenate(region.loops)
        made.append(
            {
                **_common(region.id, kind, region.loops, region.centroid, digits),
                **_look(kind, None),
                "name": f"{kind}_{region.id:03d}",
                "step": None,
                "number": region.id,
                "angle_deg": None,
                "size": rounded(np.ptp(corners, axis=0), digits),
                "neighbours": sorted(touching.get(region.id, ())),
                "under": None,
                "wedges": [],
                "words": "",
                "crop": None,
                "side": None,
                "indices": {},
                "source": None,
                "alpha_left": None,
                "alpha_right": None,
            }
        )
    return made


def _common(
    part_id: int, kind: str, loops: Iterable[Points], centroid: tuple[float, float], digits: int
) -> dict[str, Any]:
    return {
        "id": part_id,
        "kind": kind,
        "points": [rounded(loop, digits) for loop in loops],
        "centroid": rounded(centroid, digits + 1),
    }


def _look(kind: str, cluster: int | None) -> dict[str, Any]:
    colour = WEDGE_COLOUR if kind == "wedge" else PLAIN_COLOUR
    pattern = PATTERNS[0]
    if cluster is not None:
        colour, pattern = cluster_colour(cluster), PATTERNS[(cluster - 1) % len(PATTERNS)]
    return {
        "cluster": cluster,
        "colour": colour,
        "text_colour": text_colour(colour),
        "pattern": pattern,
    }


def words(assembly: Assembly, part: Part) -> str:
    """Say what the step of a part asks for."""
    digits = 3 if assembly.unit == "m" else 1
    x, y = (number(value, digits) for value in part.centroid)
    step = part.plan_step
    if not isinstance(step, StoneStep):
        wide, high = (number(value, digits) for value in part.size)
        return (
            f"Push wedge {part.id} in under stone {step.under}: {wide} wide, {high} high, "
            f"around ({x}, {y}) {assembly.unit}."
        )
    return (
        f"Place stone {part.id}, {turned(part.angle_deg)}, with its centroid at ({x}, {y}) "
        f"{assembly.unit}, from the {step.side}."
    )


def turned(angle_deg: float) -> str:
    """Say how far something is turned, the shorter way round.

    Examples
    --------
    >>> turned(-90.04), turned(270.0), turned(0.01)
    ('turned 90.0° clockwise', 'turned 90.0° clockwise', 'not turned')
    """
    angle = (angle_deg + 180.0) % 360.0 - 180.0
    if abs(angle) < 0.05:
        return "not turned"
    return f"turned {abs(angle):.1f}° {'counter-clockwise' if angle > 0 else 'clockwise'}"


def _short(value: float | None) -> float | None:
    return None if value is None or not np.isfinite(value) else round(float(value), 4) + 0.0
