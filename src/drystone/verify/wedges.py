"""Wedges touch what they hold and what holds them, and have the size of wedges (§3.7)."""

import numpy as np

from drystone.model.placement import Wedge
from drystone.model.plan import WedgeStep
from drystone.model.site import Site
from drystone.model.wall import Labels
from drystone.stabilise.settings import StabiliseSettings
from drystone.verify.replay import working_points
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
    """Verify the rules of wedging: contact (E223) and size (E224).

    Parameters
    ----------
    step : WedgeStep
        Names the wedge.
    wedge : Wedge
        Its pixels.
    labels : (h, w) array
        The wall with the stone and its wedges.
    settings : StabiliseSettings
        Smallest and largest size.
    mean_height_px : float
        Mean height of the stones, which limits the wedge's.
    """
    problems = []
    above, below = _neighbours(wedge, labels)
    if not (above == wedge.under).any():
        message = f"wedge {wedge.id} does not touch stone {wedge.under} from below."
        problems.append(Problem("E223", step.step, message))
    if not np.isin(below, (0, wedge.id, wedge.under), invert=True).any():
        message = f"wedge {wedge.id} stands on nothing."
        problems.append(Problem("E223", step.step, message))
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


def _neighbours(wedge: Wedge, labels: Labels) -> tuple[Labels, Labels]:
    """Return the labels right above and right below the wedge's pixels; the ground is 2^32-1."""
    ground = np.iinfo(np.uint32).max
    framed = np.pad(labels, ((1, 0), (0, 0)))
    framed = np.pad(framed, ((0, 1), (0, 0)), constant_values=ground)
    rows, cols = np.nonzero(wedge.mask)
    rows, cols = rows + wedge.row + 1, cols + wedge.col
    return framed[rows - 1, cols], framed[rows + 1, cols]
