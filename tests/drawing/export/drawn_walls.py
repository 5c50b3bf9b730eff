"""A wall of any number of stones, made by hand for the tests of drawings, films and sheets.

Stones are bricks with bevelled corners that lie in a grid in the source image, each turned by an
angle of its own; the first one slants below, and a wedge is under its right end.
"""

import math

import numpy as np
import shapely
from PIL import Image, ImageDraw

from drystone.contacts.given import model_from_json
from drystone.drawing.assembly.parts import Assembly, Part
from drystone.model.plan import Plan, PlanMetrics, StoneStep, WedgeStep
from drystone.statics.limit import lateral_resistance

STONE_PX = (60.0, 30.0)
CELL_PX = 80
ANGLES_DEG = (0.0, 97.0, -45.0, 180.0, 12.5, -90.0, 1.0, 178.5)
WEDGE_PX = ((30.0, 0.0), (60.0, 0.0), (60.0, 6.0))
INDICES = ("SF", "LFR", "GDS", "NHR", "IWR", "IS", "LLC")
UNUSED = (901, 902)


def wall_px(columns, rows):
    return columns * STONE_PX[0], rows * STONE_PX[1]


def assembly(columns=3, rows=2, px_per_m=200.0, photo=None):
    """Build a wall course by course from the left, the wedge after the first stone."""
    factor = 1.0 if px_per_m is None else 1.0 / px_per_m
    across = math.ceil(math.sqrt(columns * rows))
    size = across * CELL_PX, across * CELL_PX
    steps = []
    parts = []
    corners_px = {}
    wedge_id = 1000
    for place in range(columns * rows):
        row, column = divmod(place, columns)
        corners = outline_px(place) + np.array([column * STONE_PX[0], row * STONE_PX[1]])
        stone_id = 11 + 3 * place
        centroid = centroid_of(corners)
        steps.append(stone_step(len(steps) + 1, stone_id, place, centroid, across, factor))
        parts.append(Part(steps[-1], corners * factor, steps[-1].centroid))
        corners_px[stone_id] = corners
        if place == 0:
            polygon = tuple((x * factor, y * factor) for x, y in WEDGE_PX)
            steps.append(WedgeStep(2, wedge_id, stone_id, polygon, None, None))
            wedge = np.array(WEDGE_PX) * factor
            parts.append(Part(steps[-1], wedge, centroid_of(wedge)))
            corners_px[wedge_id] = np.array(WEDGE_PX)
    blocks = [{"id": i, "polygon": (c * factor).tolist()} for i, c in corners_px.items()]
    model = model_from_json({"blocks": blocks, "mu": 0.58})
    width, height = (side * factor for side in wall_px(columns, rows))
    plan = plan_of(tuple(steps), (width, height), size, px_per_m)
    return Assembly(
        plan, tuple(parts), model, lateral_resistance(model, mechanism=True),
        "px" if px_per_m is None else "m", px_per_m, 30.0 * factor, photo=photo,
    )  # fmt: skip


def outline_px(place):
    """Return a brick from its lower left corner; the first slants below from its middle."""
    w, h = STONE_PX
    rise = WEDGE_PX[2][1] if place == 0 else 0.0
    middle = [(30.0, 0.0)] if place == 0 else []
    bevel = 1.0 + place % 3
    return np.array([(0.0, 0.0), *middle, (w, rise), (w, h), (bevel, h), (0.0, h - bevel)], float)


def centroid_of(corners):
    """By shapely: not how the package does it."""
    x, y = shapely.Polygon(corners).centroid.coords[0]
    return x, y


def stone_step(step, stone, place, centroid_px, across, factor):
    row, column = divmod(place, across)
    # Rows of the image from the top, so that the first stones are fetched first.
    source = (column + 0.5) * CELL_PX, (across - row - 0.5) * CELL_PX
    x, y = centroid_px
    return StoneStep(
        step, stone, ANGLES_DEG[place % len(ANGLES_DEG)], source, (x * factor, y * factor),
        "left", 1 + place % 3, 0, dict.fromkeys(INDICES, 0.5), None, None, None,
    )  # fmt: skip


def plan_of(steps, size, source_px, px_per_m):
    stones = [step.stone for step in steps if isinstance(step, StoneStep)]
    source = {
        "path": "stones.png", "sha256": "0" * 64, "stones": len(stones) + len(UNUSED),
        "width_px": source_px[0], "height_px": source_px[1],
    }  # fmt: skip
    none = PlanMetrics(0.9, None, None, 0.5, None, None, None, None, 0.0)
    return Plan(
        "0.1.0", "best", 7, {"mu": 0.58}, "px" if px_per_m is None else "m", px_per_m, 1.0, source,
        *size, steps, UNUSED, "the wall is full", none,
    )  # fmt: skip


def photograph(wall, path, zoom=3.0):
    """Draw the stones as they lie, every one in a colour that tells its step."""
    width, height = wall.plan.source["width_px"], wall.plan.source["height_px"]
    image = Image.new("RGB", (round(width * zoom), round(height * zoom)), (235, 232, 225))
    draw = ImageDraw.Draw(image)
    for part in wall.stones:
        corners = wall.source_corners(part)
        points = [(x * zoom, (height - y) * zoom) for x, y in corners.tolist()]
        draw.polygon(points, fill=photo_colour(part.step))
    image.save(path)
    return path


def photo_colour(step):
    return 90 + (step * 37) % 120, 80 + (step * 59) % 110, 70 + (step * 83) % 100


def runs(lit):
    """Return the lengths of what is lit in a row."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], lit.astype(int), [0]])))
    return edges[1::2] - edges[::2]
