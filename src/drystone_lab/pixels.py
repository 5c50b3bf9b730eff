"""Suite "pixels": cases from pictures, and how errors fall as the resolution grows."""

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.random import Generator
from numpy.typing import ArrayLike, NDArray
from shapely.geometry.polygon import orient
from shapely.ops import split

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.contacts.outlines import model_of_traced, outlines_of_labels
from drystone.kernels.outline import rasterise_polygon
from drystone.model.wall import Labels
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus
from drystone_lab.statics_cases import HEIGHT, WALLS, Rectangle, closed_forms
from drystone_lab.table import BENCH, BenchSettings, Cell, Table, worded
from drystone_lab.timed_walls import exponents

Points = NDArray[np.float64]

STONE_LENGTH = 1.5
"""Mean length of a stone over the height of its course."""

ATTEMPTS = 200
"""How often a joint is drawn anew before the whole wall is, and how often the wall."""

LENGTH, TILTED_MU = 0.9, 0.58
"""Of a wall of tilted joints; it is 1 high."""

SHORTEST = 0.04
"""Bends and ends of joints are at least this far apart along a bed; the wall is 1 high."""

TiltedWall = tuple[Points, ...]
"""A wall of height 1 on flat ground whose joints follow no grid: corners of stone 1, 2, ...

Counter-clockwise, not closed, x to the right and y up; without gaps between them.
"""


def exact_model(wall: TiltedWall) -> RigidBlockModel:
    """Return the exact rigid block model of a wall."""
    blocks = [{"id": number, "polygon": stone.tolist()} for number, stone in enumerate(wall, 1)]
    return model_from_json({"blocks": blocks, "mu": TILTED_MU})


def picture_of(wall: TiltedWall, height_px: int, offset_px: ArrayLike = (0.0, 0.0)) -> Labels:
    """Return the label image of a wall: a pixel belongs to the stone that its centre lies in.

    `offset_px` is where the lower left corner lies right of and above a pixel corner, 0 to 1.
    """
    scaled = [stone * height_px + np.asarray(offset_px) for stone in wall]
    width, height = np.ceil(np.max([p.max(axis=0) for p in scaled], axis=0)).astype(int)
    labels = np.zeros((int(height), int(width)), np.uint32)
    for number, polygon in enumerate(scaled, start=1):
        mask, left, bottom = rasterise_polygon(polygon)
        last, right = int(height) - bottom, left + mask.shape[1]
        labels[last - mask.shape[0] : last, left:right][mask] = number
    filled = np.flatnonzero(labels.any(axis=1))
    return labels[: filled[-1] + 1]


def tilted_wall(rng: Generator, courses: int) -> TiltedWall:
    """Draw a wall whose bed joints zigzag, whose head joints lean and whose ends have a batter.

    Bends and ends of joints are at least `SHORTEST` apart along a bed.  A facet smaller than a
    pixel cannot be seen in a picture, but may carry a good part of the load.

    >>> wall = tilted_wall(np.random.default_rng(1), courses=3)
    >>> len(wall), picture_of(wall, 40).shape
    (7, (40, 36))
    """
    for _ in range(ATTEMPTS):
        if wall := _attempt(rng, courses):
            return wall
    raise ValueError(f"no wall of {courses} courses, {LENGTH} long, has joints far enough apart")


def _attempt(rng: Generator, courses: int) -> TiltedWall:
    """Draw course after course; give up, without stones, where joints come too close."""
    # The ends of the wall lean inwards by as many degrees.
    left, right = np.tan(np.radians(rng.permutation((3.0, 5.0))))
    outline = shapely.Polygon([(0, 0), (LENGTH, 0), (LENGTH - right, 1), (left, 1)])
    lower = np.array([[-1.0, 0.0], [LENGTH + 1.0, 0.0]])
    polygons: list[Points] = []
    below: list[Points] = []
    for course in range(courses):
        draws = (_heads(rng, course, courses) for _ in range(ATTEMPTS))
        heads = next((h for h in draws if _are_apart(lower, [*below, *h], outline)), None)
        if heads is None:
            return ()
        beds = (_bed(rng, course + 1, courses) for _ in range(ATTEMPTS))
        upper = next((bed for bed in beds if _are_apart(bed, heads, outline)), None)
        if upper is None:
            return ()
        pieces = [shapely.Polygon([*lower, *upper[::-1]]) & outline]
        for head in heads:
            line = shapely.LineString(head)
            pieces = [part for piece in pieces for part in split(piece, line).geoms]
        pieces.sort(key=lambda piece: float(piece.centroid.x))
        polygons += [shapely.get_coordinates(orient(piece))[:-1] for piece in pieces]
        lower, below = upper, heads
    return tuple(polygons)


def _heads(rng: Generator, course: int, courses: int) -> list[Points]:
    """Draw the lines of the head joints, half a stone further on in every other course."""
    count = max(2, round(LENGTH * courses / STONE_LENGTH))
    steps = np.cumsum(rng.uniform(0.85, 1.15, count + 1))
    places = (steps - 0.5 * (course % 2) * steps[0]) / steps[-2] * LENGTH
    middle = (course + 0.5) / courses
    lines = []
    for place in places[: count - 1 + course % 2].tolist():
        lean_deg = float(rng.choice((7.0, 11.0, 17.0)) * rng.choice([-1, 1]))
        lean = math.tan(math.radians(lean_deg))
        lines.append(np.array([[place + lean * t, middle + t] for t in (-1.0, 1.0)]))
    return lines


def _bed(rng: Generator, course: int, courses: int) -> Points:
    """Draw the bed below a course, a zigzag with pieces about as long as a stone; flat at the top.

    It reaches beyond the wall on both sides.
    """
    if course == courses:
        return np.array([[-1.0, 1.0], [LENGTH + 1.0, 1.0]])
    x, y = [float(rng.uniform(-1.0, -0.5))], [0.0]
    sign = float(rng.choice([-1.0, 1.0]))
    while x[-1] < LENGTH + 0.5:
        slope_deg = float(rng.choice((4.0, 7.0, 11.0)))
        slope = sign * math.tan(math.radians(slope_deg))
        run = float(rng.uniform(0.7, 1.3)) * STONE_LENGTH / courses
        x.append(x[-1] + run)
        y.append(y[-1] + slope * run)
        sign = -sign
    points = np.column_stack([x, y])
    points[:, 1] += course / courses - points[:, 1].mean()
    return points


def _are_apart(bed: Points, heads: list[Points], outline: shapely.Polygon) -> bool:
    """Tell whether the ends and bends of a bed and its joints are at least SHORTEST apart."""
    line = shapely.LineString(bed)
    inside = shapely.get_coordinates(line & outline)[:, 0]
    joints = shapely.get_coordinates([line & shapely.LineString(head) for head in heads])[:, 0]
    places = np.sort(np.concatenate([inside, joints]))
    return all(after - before >= SHORTEST for before, after in pairwise(places.tolist()))


COURSES = (3, 4, 5)
"""The walls have these numbers of courses in turn."""


def refinement_errors(
    heights_px: Sequence[int], *, walls: int = 9, offsets: int = 3, seed: int = 0
) -> NDArray[np.float64]:
    """Compare pictures of walls of tilted joints with their polygons.

    Each wall is drawn at several heights, and at several sub-pixel positions (`offsets`).  Returns
    |alpha - exact alpha|, (heights, 2, cases): with contacts from pixel edges, then from outlines;
    cases are walls times offsets times two directions, nan where there is no number.  A picture of
    blocks that do not stand counts with alpha = 0.

    >>> refinement_errors((40, 80), walls=1, offsets=1).shape
    (2, 2, 2)
    """
    seeds = np.random.default_rng(seed).integers(0, 2**32, walls).tolist()
    drawn = [
        tilted_wall(np.random.default_rng(wall_seed), COURSES[i % len(COURSES)])
        for i, wall_seed in enumerate(seeds)
    ]
    exact = [_alphas(exact_model(wall)) for wall in drawn]
    # An even sequence of sub-pixel positions (Roberts's R2)
    numbers = np.arange(offsets)[:, None]
    places = (0.5 + numbers * (0.7548776662466927, 0.5698402909980532)) % 1.0
    errors = [
        np.abs(_alphas(model_of(picture_of(wall, height_px, place), TILTED_MU)) - true)
        for height_px in heights_px
        for model_of in (from_pixels, from_outlines)
        for wall, true in zip(drawn, exact, strict=True)
        for place in places
    ]
    return np.reshape(errors, (len(heights_px), 2, -1))


def _alphas(model: RigidBlockModel) -> Points:
    """Return both load factors: 0 where blocks do not stand, nan where there is no number."""
    both = lateral_resistance(model)
    found = [0.0 if x.status is LimitStatus.UNSTABLE else x.alpha for x in (both.left, both.right)]
    return np.array(found, float)  # nan for None


BRICK_PX = 20
"""Height of a brick."""


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Return the published cases from pixels, and the study of tilted joints."""
    # How high pictures are, and how many sets of walls there are.
    heights, count = ((40, 80, 160), 1) if settings.quick else ((40, 80, 160, 320), 4)
    few = {"walls": 3, "offsets": 1} if settings.quick else {}
    rows: list[tuple[Cell, ...]] = []
    for seed in range(settings.seed, settings.seed + count):
        errors = refinement_errors(heights, seed=seed, **few)
        means, worst = np.nanmean(errors, axis=2), np.nanmax(errors, axis=2)
        # Of error ~ height^-p
        orders = [None if p is None else -p for p in exponents(heights, means.tolist())]
        for height, mean, most in zip(heights, means.tolist(), worst.tolist(), strict=True):
            known = orders if height == heights[-1] else [None, None]
            rows.append((seed, height, errors.shape[2], mean[0], most[0], mean[1], most[1], *known))
    return _published(quick=settings.quick), worded(BENCH["pixels"]["refinement"], rows)


def rasterised(rectangles: Iterable[Rectangle], px: float) -> Labels:
    """Draw rectangles, numbered from 1, at `px` pixels per unit; edges at the nearest pixel edge.

    >>> rasterised([(0, 0, 1, 1), (0.4, 1, 1, 1)], 2).tolist()
    [[0, 2, 2], [0, 2, 2], [1, 1, 0], [1, 1, 0]]
    """
    boxes = np.array(list(rectangles), float)
    corners = np.rint(np.column_stack([boxes[:, :2], boxes[:, :2] + boxes[:, 2:]]) * px)
    whole = corners.astype(int)
    width, height = whole[:, 2:].max(axis=0).tolist()
    labels = np.zeros((height, width), np.uint32)
    for number, (x0, y0, x1, y1) in enumerate(whole.tolist(), start=1):
        labels[height - y1 : height - y0, x0:x1] = number
    return labels


def from_pixels(labels: Labels, mu: float) -> RigidBlockModel:
    """Return the model with contacts from the edges of pixels."""
    return model_from_labels(labels, mu).model


def from_outlines(labels: Labels, mu: float) -> RigidBlockModel:
    """Return the model with contacts from sub-pixel outlines."""
    return model_of_traced(outlines_of_labels(labels), mu)


def _published(*, quick: bool) -> Table:
    walls = enumerate(WALLS[:1] if quick else WALLS, 1)
    cases = [(f"Ferris and Tin-Loi, example {k}", wall, BRICK_PX / HEIGHT) for k, wall in walls]
    cases += [(case.name, case, float(BRICK_PX)) for case in closed_forms()]
    rows = []
    for name, case, px in cases:
        labels, expected = rasterised(case.rectangles, px), (case.left, case.right)
        pixels, outlines = (
            _compared(model_of(labels, case.mu), expected)
            for model_of in (from_pixels, from_outlines)
        )
        hits = all(error is not None and error <= 0.01 for _, error in (pixels, outlines))
        verdict = "pass" if hits else "miss"
        rows.append((name, case.mu, _both(*expected), *pixels, *outlines, verdict))
    return worded(BENCH["pixels"]["published"], rows)


def _compared(model: RigidBlockModel, expected: tuple[float, float]) -> tuple[str, float | None]:
    """Return what was found, and its error; None when there is no number."""
    both = lateral_resistance(model)
    if both.left.alpha is None or both.right.alpha is None:
        return f"{both.left.status} / {both.right.status}", None
    found = (both.left.alpha, both.right.alpha)
    errors = [abs(a - b) / (b or 1.0) for a, b in zip(found, expected, strict=True)]
    return _both(*found), max(errors)


def _both(left: float, right: float) -> str:
    if abs(left - right) < 1e-4:
        return f"{left:.4f}"
    return f"{left:.4f} / {right:.4f}"
