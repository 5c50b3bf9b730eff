"""Wedges touch what they hold and what holds them, and are what a mason would cut (§3.7)."""

import numpy as np

from drystone.kernels.polygons import Points, Polygons
from drystone.model.placement import Wedge
from drystone.model.plan import WedgeStep
from drystone.model.site import Site
from drystone.model.wall import Labels
from drystone.model.wedge_shape import WedgeShape
from drystone.settle.wedge import WedgeLimits, squeezed_out
from drystone.stabilise.settings import StabiliseSettings
from drystone.statics.model import RigidBlockModel
from drystone.verify.lengths import working_points
from drystone.verify.report import Problem

AREA_TOLERANCE_PX = 1e-6
"""Between the area of a wedge's polygon and of its pixels, working px."""


def check_wedge(
    step: WedgeStep,
    wedge: Wedge,
    labels: Labels,
    settings: StabiliseSettings,
    mean_height_px: float,
) -> list[Problem]:
    """Verify the rules of wedging on the wall with the stone: contact (E223) and size (E224)."""
    above, below = _neighbours(wedge, labels)
    holds = bool((above == wedge.under).any())
    stands = bool(np.isin(below, (0, wedge.id, wedge.under), invert=True).any())
    problems = _touching(step, holds=holds, stands=stands)
    heights = wedge.mask.sum(axis=0)
    smallest = settings.min_wedge_px
    largest = max(smallest, settings.max_wedge_height * mean_height_px)
    low, high, width = int(heights.min()), int(heights.max()), heights.size
    if min(low, width) < smallest or high > largest:
        message = (
            f"wedge {wedge.id} is {width} px wide and {low} to {high} px high; the settings allow "
            f"{smallest} px to a height of {largest:.6g} px."
        )
        problems.append(Problem("E224", step.step, message))
    return problems


def check_settled_wedge(
    step: WedgeStep,
    corners: Points,
    model: RigidBlockModel,
    stone: Points,
    wall: Polygons,
    width: float,
    limits: WedgeLimits,
) -> list[Problem]:
    """Verify the rules of wedging for a wedge that is an outline, source px: E223 and E224.

    The model, of the wall with the stone and its wedges, says what touches what.  `stone` lies on
    the wedge, `wall` are all outlines, and `width` is that of the site.
    """
    above, below = _supports(step.id, model)
    stands = bool(below - {step.under})
    problems = _touching(step, holds=step.under in above, stands=stands)
    faults = list(limits.faults(WedgeShape.of(corners)))
    if squeezed_out(corners, stone, wall, width, limits):
        faults.append("nothing beside it at the end of the wall")
    if faults:
        message = f"no mason would cut wedge {step.id} (source px): {'; '.join(faults)}."
        problems.append(Problem("E224", step.step, message))
    return problems


def check_polygon(step: WedgeStep, wedge: Wedge, site: Site) -> list[Problem]:
    """Verify that a wedge's polygon is that of its pixels, counter-clockwise (E222)."""
    x, y = working_points(step.polygon, site).T
    area = float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
    if abs(area - wedge.area_px) <= AREA_TOLERANCE_PX * max(1.0, wedge.area_px):
        return []
    message = (
        f"the polygon of wedge {wedge.id} has an area of {area:.9g} working px (negative: "
        f"clockwise), its pixels {wedge.area_px}."
    )
    return [Problem("E222", step.step, message)]


def _touching(step: WedgeStep, *, holds: bool, stands: bool) -> list[Problem]:
    """Say what a wedge does not touch (E223)."""
    missing = {
        f"wedge {step.id} does not touch stone {step.under} from below.": holds,
        f"wedge {step.id} stands on nothing.": stands,
    }
    return [Problem("E223", step.step, said) for said, touches in missing.items() if not touches]


def _supports(block: int, model: RigidBlockModel) -> tuple[set[int], set[int]]:
    """Return the ids of what touches a block from above and from below."""
    above, below = set(), set()
    for interface in model.interfaces:
        if block not in (interface.block, interface.other):
            continue
        mine = interface.block == block
        up = interface.normal[1] if mine else -interface.normal[1]
        other = interface.other if mine else interface.block
        if up > 0.0:
            below.add(other)
        elif up < 0.0:
            above.add(other)
    return above, below


def _neighbours(wedge: Wedge, labels: Labels) -> tuple[Labels, Labels]:
    """Return the labels right above and right below the wedge's pixels; the ground is 2^32-1."""
    ground = np.iinfo(np.uint32).max
    framed = np.pad(labels, ((1, 0), (0, 0)))
    framed = np.pad(framed, ((0, 1), (0, 0)), constant_values=ground)
    rows, cols = np.nonzero(wedge.mask)
    rows, cols = rows + wedge.row + 1, cols + wedge.col
    return framed[rows - 1, cols], framed[rows + 1, cols]
