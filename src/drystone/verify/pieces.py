"""What each stone and wedge must be where it lies.

The outline of a stone is that of its pixels, whatever made it (DESIGN 4.9); stones are lowered
from straight above (DESIGN 4.4); wedges touch what they hold and what holds them, and are what a
mason would cut (§3.7).
"""

from collections.abc import Iterator

import numpy as np
import shapely
from scipy import ndimage

from drystone.kernels.polygons import Points, Polygons, area_and_centroid, turn
from drystone.kernels.raster import Mask
from drystone.model.landscape import Landscape
from drystone.model.outline import farthest_px, reach_px
from drystone.model.outlines import Outlines
from drystone.model.overlap import common_parts, shape_of
from drystone.model.placement import Wedge
from drystone.model.plan import StoneStep, WedgeStep
from drystone.model.site import Site
from drystone.model.steps import Problem
from drystone.model.stone import Stone
from drystone.model.wall import Labels
from drystone.model.wedge_shape import WedgeShape
from drystone.placement.feasible import can_be_lowered
from drystone.settle.wedge import WedgeLimits, squeezed_out
from drystone.stabilise.settings import StabiliseSettings
from drystone.statics.model import RigidBlockModel
from drystone.verify.lengths import working_points
from drystone.verify.replay import PENETRATION_PX, Stage

SLIVER_CELLS = 1.0
"""What stands in the way is moved aside, or slid under, when it is not wider; working px.

Pixels cannot tell less either."""


def check_outline(
    step: StoneStep, stone: Stone, centroid_px: Points, corners: Points, tolerance_px: float
) -> list[Problem]:
    """Compare the outline of a stone where it lies, source px, with its pixels there (E240).

    The contour goes through the middles of pixel edges; holes count as stone.  Each middle of an
    edge between the stone and what is around it must be within
    :func:`drystone.model.outline.reach_px` of the outline, on either side, and the outline must
    have the area of the pixels.  The corner of a pixel may be √2/4 px further out than the middles
    of its edges.  Of a stone that its file draws, corners and area are those of the drawing.
    """
    if stone.drawn is None:
        pixels = ndimage.binary_fill_holes(stone.mask)
        rim, area = rim_px(pixels), float(pixels.sum())
    else:
        rim, area = stone.drawn, area_and_centroid(stone.drawn)[0]
    rim = turn(rim - np.array(stone.local_centroid), step.angle_deg) + centroid_px
    off, allowed = farthest_px(rim, corners), reach_px(tolerance_px)
    share = area_and_centroid(corners)[0] / area
    said = []
    if off > allowed:
        said.append(f"is {off:.3g} source px from the rim that was read; {allowed:.3g} are allowed")
    if abs(share - 1.0) > 1e-6:  # more than rounding
        said.append(f"has {share:.6g} times the area that was read")
    return [Problem("E240", step.step, f"the outline of stone {stone.id} {why}.") for why in said]


def rim_px(mask: Mask) -> Points:
    """Return the middles of the pixel edges around a mask, from its bottom-left corner, y up."""
    padded = np.pad(mask, 1)
    row, left = np.nonzero(padded[1:-1, 1:] != padded[1:-1, :-1])
    top, col = np.nonzero(padded[1:, 1:-1] != padded[:-1, 1:-1])
    upright = np.column_stack([left, len(mask) - row - 0.5])
    level = np.column_stack([col + 0.5, len(mask) - top])
    return np.vstack([upright, level])


def is_buried(stage: Stage) -> bool:
    """Say whether a stone cannot be lowered to its place from straight above."""
    placement, before = stage.group.placement, stage.before
    if before.outlines is not None and placement.settled is not None:
        sliver = SLIVER_CELLS / before.site.scale
        return lies_under(placement.settled.corners, before.outlines, sliver)
    landscape = Landscape.of(before)
    return not can_be_lowered(landscape, placement.posed, placement.row, placement.col)


def lies_under(corners: Points, outlines: Outlines, sliver: float) -> bool:
    """Say whether an earlier outline reaches into the way of a stone that comes from above.

    What one of them takes of the way counts where it is wider than `sliver`; all are source px.
    """
    boxes = outlines.polygons.boxes
    (left, bottom), right = corners.min(axis=0), corners[:, 0].max()
    beside = (boxes[:, 0] < right - sliver) & (boxes[:, 2] > left + sliver)
    met = np.flatnonzero(beside & (boxes[:, 3] > bottom))
    if not met.size:
        return False
    way = swept_upwards(corners, float(boxes[met, 3].max()))
    earlier = [shape_of(outlines.polygons.polygon(i)) for i in met.tolist()]
    parts = [part for shape in earlier for part in common_parts(way, shape)]
    # What is no thicker than a stone may lie deep in its bed does not stand in its way.
    bounds = shapely.bounds(shapely.buffer(parts, -PENETRATION_PX / 2.0))
    widths = bounds[:, 2] - bounds[:, 0] + PENETRATION_PX  # NaN of what vanishes
    return bool((widths > sliver).any())


def swept_upwards(corners: Points, top: float) -> shapely.Geometry:
    """Return the area, up to `top`, that a counter-clockwise polygon passes when it is lifted."""
    ends = np.roll(corners, -1, axis=0)
    ceiling = max(top, float(corners[:, 1].max()))
    # Above every point of the polygon is what is above the edges at its underside.
    columns = [
        shapely.Polygon([start, end, (end[0], ceiling), (start[0], ceiling)])
        for start, end in zip(corners.tolist(), ends.tolist(), strict=True)
        if start[0] < end[0]
    ]
    return shapely.union_all(columns)


def check_wedge(
    step: WedgeStep,
    wedge: Wedge,
    labels: Labels,
    settings: StabiliseSettings,
    mean_height_px: float,
) -> Iterator[Problem]:
    """Verify the rules of wedging on the wall with the stone: contact (E223) and size (E224)."""
    # With what is right above and right below its pixels; the ground is 2^32-1.
    framed = np.pad(labels, ((1, 0), (0, 0)))
    framed = np.pad(framed, ((0, 1), (0, 0)), constant_values=np.iinfo(np.uint32).max)
    rows, cols = np.nonzero(wedge.mask)
    rows, cols = rows + wedge.row + 1, cols + wedge.col
    holds = bool((framed[rows - 1, cols] == wedge.under).any())
    below = framed[rows + 1, cols]
    stands = bool(np.isin(below, (0, wedge.id, wedge.under), invert=True).any())
    yield from _touching(step, holds=holds, stands=stands)
    heights = wedge.mask.sum(axis=0)
    smallest = settings.min_wedge_px
    largest = max(smallest, settings.max_wedge_height * mean_height_px)
    low, high, width = int(heights.min()), int(heights.max()), heights.size
    if min(low, width) < smallest or high > largest:
        message = (
            f"wedge {wedge.id} is {width} px wide and {low} to {high} px high; the settings allow "
            f"{smallest} px to a height of {largest:.6g} px."
        )
        yield Problem("E224", step.step, message)


def check_settled_wedge(
    step: WedgeStep,
    corners: Points,
    model: RigidBlockModel,
    stone: Points,
    wall: Polygons,
    width: float,
    limits: WedgeLimits,
) -> Iterator[Problem]:
    """Verify the rules of wedging for a wedge that is an outline, source px: E223 and E224.

    The model, of the wall with the stone and its wedges, says what touches what.  `stone` lies on
    the wedge, `wall` are all outlines, and `width` is that of the site.
    """
    # What touches it, with how far each normal into it points up.
    touching = [(f.other, f.normal[1]) for f in model.interfaces if f.block == step.id]
    touching += [(f.block, -f.normal[1]) for f in model.interfaces if f.other == step.id]
    holds = any(other == step.under and up < 0.0 for other, up in touching)
    stands = any(other != step.under and up > 0.0 for other, up in touching)
    yield from _touching(step, holds=holds, stands=stands)
    faults = list(limits.faults(WedgeShape.of(corners)))
    if squeezed_out(corners, stone, wall, width, limits):
        faults.append("nothing beside it at the end of the wall")
    if faults:
        message = f"no mason would cut wedge {step.id} (source px): {'; '.join(faults)}."
        yield Problem("E224", step.step, message)


def check_polygon(step: WedgeStep, wedge: Wedge, site: Site) -> Iterator[Problem]:
    """Verify that a wedge's polygon is that of its pixels, counter-clockwise (E222)."""
    area, *_ = area_and_centroid(working_points(step.polygon, site))
    if not abs(area - wedge.area_px) <= 1e-6 * max(1.0, wedge.area_px):
        message = (
            f"the polygon of wedge {wedge.id} has an area of {area:.9g} working px (negative: "
            f"clockwise), its pixels {wedge.area_px}."
        )
        yield Problem("E222", step.step, message)


def _touching(step: WedgeStep, *, holds: bool, stands: bool) -> Iterator[Problem]:
    """Say what a wedge does not touch (E223)."""
    if not holds:
        message = f"wedge {step.id} does not touch stone {step.under} from below."
        yield Problem("E223", step.step, message)
    if not stands:
        yield Problem("E223", step.step, f"wedge {step.id} stands on nothing.")
