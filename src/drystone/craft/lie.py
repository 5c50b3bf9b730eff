"""How stones lie: on their beds, big ones low, level, and in line at the ends and the top."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import shapely
from scipy import ndimage

from drystone.craft.finding import Case, Evidence, worst_first
from drystone.craft.masonry import Masonry
from drystone.kernels.polygons import Points
from drystone.kernels.profiles import Floats
from drystone.model.overlap import common_parts

MIDDLE = 0.8
"""Share of the width of a stone whose edges are looked at: its corners are rounded."""

OFF_LEVEL = 0.5
"""From which deviation of a stone's top it is named, mean stone heights."""

SHORT = 0.25
"""From which gap beside a stone at an end it is named, mean stone widths."""


def on_end(masonry: Masonry) -> Evidence:
    """Find stones that stand on end: the longer side of the face upright.

    Length and breadth are those of the smallest rectangle around the face.  A stone that is laid
    with its length along the face instead of into the wall (a traced stone), or with the bedding
    of its rock upright (face-bedded), cannot be told from the face.
    """
    if not masonry.stones:
        return Evidence(None, note="There are no stones.")
    cases = []
    longer = 0
    for stone, loop in masonry.stones.items():
        middle, one, other = _smallest_rectangle(loop)
        sides = float(np.hypot(*one)), float(np.hypot(*other))
        elongation = max(sides) / min(sides)
        if elongation < masonry.settings.elongation - 1e-9:
            continue
        longer += 1
        along = one if sides[0] >= sides[1] else other
        axis = np.array([middle - 0.4 * along, middle + 0.4 * along])
        dx, dy = np.abs(axis[1] - axis[0]).tolist()
        if dy > dx * (1.0 + 1e-9):
            words = f"{elongation:.1f} times as high as long"
            cases.append(Case((stone,), round(elongation, 6), words, (axis,)))
    number = len(cases) / len(masonry.stones)
    return Evidence(number, worst_first(cases), {"stones with a longer side": float(longer)})


def _smallest_rectangle(loop: Points) -> tuple[Points, Points, Points]:
    """Return the middle of the smallest rectangle around corners, (n, 2), and two of its sides.

    Of equally small ones, as a triangle has, it is the least elongated; that of GEOS goes by
    rounding, and is wrong far from the origin.
    """
    corners = shapely.get_coordinates(shapely.convex_hull(shapely.MultiPoint(loop - loop[0])))
    along = np.diff(corners, axis=0) / np.hypot(*np.diff(corners, axis=0).T)[:, None]
    axes = np.stack((along, along[:, ::-1] * (-1.0, 1.0)))
    at = axes @ corners.T  # (2, edges, corners)
    sides, area = np.ptp(at, axis=2), np.ptp(at, axis=2).prod(axis=0)
    elongation = sides.max(axis=0) / sides.min(axis=0)
    best = np.where(area <= (1.0 + 1e-9) * area.min(), elongation, np.inf).argmin()
    middle = (at.min(axis=2) + sides / 2.0)[:, best] @ axes[:, best]
    one, other = axes[:, best] * sides[:, best, None]
    return loop[0] + middle, one, other


def big_low(masonry: Masonry) -> Evidence:
    """Compare the sizes of stones below and above mid-height and name big ones above."""
    if len(masonry.stones) < 2:
        return Evidence(None, note="There are no two stones to compare.")
    x0, y0, x1, y1 = masonry.box
    lower = shapely.box(x0, y0, x1, 0.5 * (y0 + y1))
    areas = np.array([masonry.areas[i] for i in masonry.stones])
    lying = [
        sum(part.area for part in common_parts(shape, lower)) for shape in masonry.shapes.values()
    ]
    below = np.clip(np.array(lying) / areas, 0.0, 1.0)
    above = 1.0 - below
    if min(below.sum(), above.sum()) < 1e-9:
        return Evidence(None, note="One half of the wall has no stone.")
    low, high = float(areas @ below / below.sum()), float(areas @ above / above.sum())
    mean = float(areas.mean())
    big = [
        (area / mean, stone)
        for stone, area, share in zip(masonry.stones, areas.tolist(), above.tolist(), strict=True)
        if share > 0.5 + 1e-9 and area >= (masonry.settings.big - 1e-9) * mean
    ]
    cases = tuple(
        Case((stone,), round(times, 6), f"{times:.1f} times the mean area, above mid-height")
        for times, stone in sorted(big, key=lambda one: (-one[0], one[1]))
    )
    figures = {"mean area below over mean": low / mean, "mean area above over mean": high / mean}
    return Evidence(high / low, cases, figures)


@dataclass(frozen=True, eq=False)
class Edge:
    """The upper or lower edge of a stone, as a straight line fitted to it."""

    stone: int
    side: Literal["lower", "upper"]
    slope: float  # rise to the right over run
    width: float  # of the part that was fitted
    line: Points  # (2, 2), its ends

    @property
    def angle_deg(self) -> float:
        """Of the slope, in (-90, 90)."""
        return float(np.degrees(np.arctan(self.slope)))


def edges(masonry: Masonry) -> list[Edge]:
    """Fit a straight line to the lower and the upper edge of every stone.

    They come by id, the lower one first; stones that are too narrow to have edges are left out.
    """
    found = []
    for stone, profile in masonry.profiles.items():
        x0, _, x1, _ = masonry.boxes[stone]
        inner = np.abs(profile.x - 0.5 * (x0 + x1)) <= 0.5 * MIDDLE * (x1 - x0)
        if inner.sum() > 2:
            found.append(_fitted(stone, "lower", profile.x[inner], profile.low[inner]))
            found.append(_fitted(stone, "upper", profile.x[inner], profile.high[inner]))
    return found


def _fitted(stone: int, side: Literal["lower", "upper"], x: Floats, y: Floats) -> Edge:
    about = x - x.mean()
    slope = float(about @ (y - y.mean()) / (about @ about))
    ends = x[[0, -1]]
    line = np.column_stack([ends, y.mean() + slope * (ends - x.mean())])
    return Edge(stone, side, slope, float(np.ptp(x)), line)


def level_beds(masonry: Masonry) -> Evidence:
    """Find beds that slope."""
    found = edges(masonry)
    if not found:
        return Evidence(None, note="No stone is wide enough.")
    slopes = np.array([abs(edge.angle_deg) for edge in found])
    widths = np.array([edge.width for edge in found])
    cases = []
    for edge, angle in zip(found, slopes.tolist(), strict=True):
        if angle > masonry.settings.steep_deg + 1e-9:
            falls = "right" if edge.slope < 0 else "left"
            words = f"{edge.side} edge falls to the {falls} by {angle:.0f}°"
            cases.append(Case((edge.stone,), round(angle, 6), words, (edge.line,)))
    figures = {
        "steepest": float(slopes.max()),
        "share of the edges that are too steep": len(cases) / len(found),
    }
    return Evidence(round(float(slopes @ widths / widths.sum()), 9), worst_first(cases), figures)


def inward_edges(masonry: Masonry) -> Evidence:
    """Find end stones whose upper edge falls outwards."""
    left, right = masonry.ends
    # A stone from end to end has no inward side.
    sides = dict.fromkeys(right - left, "right") | dict.fromkeys(left - right, "left")
    slopes, cases = [], []
    for edge in edges(masonry):
        if edge.side == "upper" and edge.stone in sides:
            end = sides[edge.stone]
            inward = edge.slope if end == "right" else -edge.slope
            slopes.append(inward)
            if inward < -masonry.settings.outward - 1e-9:
                angle = f"{abs(edge.angle_deg):.0f}°"
                words = f"upper edge at the {end} end falls outwards by {angle}"
                cases.append(Case((edge.stone,), round(-inward, 6), words, (edge.line,)))
    if not slopes:
        return Evidence(None, note="The wall has no two ends.")
    figures = {"mean inward slope": sum(slopes) / len(slopes), "end stones": float(len(slopes))}
    return Evidence(round(min(slopes), 9) + 0.0, worst_first(cases), figures)  # never -0


def level_top(masonry: Masonry) -> Evidence:
    """Measure how level the top is, and name stones that stand out or lie low."""
    if not masonry.stones:
        return Evidence(None, note="There are no stones.")
    columns, height = masonry.columns, masonry.mean_height
    tops = np.full(len(columns.places), masonry.box[1])
    owner = np.zeros(len(tops), np.int64)
    for place, runs in enumerate(columns.runs):
        for run in runs:
            if run.id in masonry.stones and run.end > tops[place]:
                tops[place], owner[place] = run.end, run.id
    tops = without_slots(tops, masonry.settings.joint * height / columns.spacing)
    cases = []
    for stone in np.unique(owner[owner > 0]).tolist():
        mine = np.flatnonzero(owner == stone)
        x0, _, x1, _ = masonry.boxes[stone]
        if 2 * len(mine) * columns.spacing < x1 - x0:
            continue  # most of it is covered
        off = float(tops[mine].mean() - tops.mean()) / height
        if abs(off) >= OFF_LEVEL - 1e-9:
            words = f"its top is {abs(off):.1f} mean stone heights {'high' if off > 0 else 'low'}"
            line = np.column_stack([columns.places[mine], tops[mine]])[[0, -1]]
            cases.append(Case((stone,), round(abs(off), 6), words, (line,)))
    return Evidence(round(float(np.abs(tops - tops.mean()).mean()) / height, 9), worst_first(cases))


def without_slots(profile: Points, widest: float) -> Points:
    """Fill the slots of a profile, (n,), that are no wider than a joint to their lower brink.

    The width is in steps of the profile.
    """
    size = int(widest) + 1
    if size < 2 or profile.size < 2:
        return profile
    # Beyond both ends nothing is: what is low there is no slot.
    around = np.pad(profile, size, constant_values=float(profile.min()))
    return np.asarray(ndimage.grey_closing(around, size)[size:-size])


def flush_ends(masonry: Masonry) -> Evidence:
    """Measure how far the ends keep from upright lines through the outermost stones."""
    if not masonry.stones:
        return Evidence(None, note="There are no stones.")
    x0, _, x1, _ = masonry.box
    beside: dict[tuple[int, int], list[tuple[float, float]]] = {}
    for y, runs in zip(masonry.rows.places.tolist(), masonry.rows.runs, strict=True):
        stones = [run for run in runs if run.id in masonry.stones]
        if stones:
            pair = (stones[0].begin - x0, x1 - stones[-1].end)
            for side, (gap, run) in enumerate(zip(pair, (stones[0], stones[-1]), strict=True)):
                # Else the row runs through an open bed, or above the stones of the end.
                if run.id in masonry.ends[side]:
                    beside.setdefault((run.id, side), []).append((y, gap))
    if not beside:
        return Evidence(None, note="The wall has no ends.")
    width = masonry.mean_width
    cases = []
    for (stone, side), rows in beside.items():
        mean = float(np.mean([gap for _, gap in rows])) / width
        if mean >= SHORT - 1e-9:
            end = "left" if side == 0 else "right"
            words = f"{mean:.2f} mean stone widths short of the {end} end"
            line = np.array([[(x0, x1)[side], rows[0][0]], [(x0, x1)[side], rows[-1][0]]])
            cases.append(Case((stone,), round(mean, 6), words, (line,)))
    gaps = [gap for rows in beside.values() for _, gap in rows]
    return Evidence(round(float(np.mean(gaps)) / width, 9), worst_first(cases))
