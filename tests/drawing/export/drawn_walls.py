"""A wall of any number of stones, made by hand for the tests of drawings, films and sheets.

Stones are bricks with bevelled corners that lie in a grid in the source image, each turned by an
angle of its own; the first one slants below, and a wedge is under its right end.
"""

import math

import numpy as np
import shapely
from PIL import Image, ImageDraw

from drystone.contacts.given import model_from_json
from drystone.drawing.assembly import Assembly, Part
from drystone.indices import INDEX_NAMES
from drystone.model.plan import Plan, PlanMetrics, StoneStep, WedgeStep
from drystone.statics.limit import lateral_resistance

WIDTH_PX, HEIGHT_PX = 60.0, 30.0
CELL_PX = 80
ANGLES_DEG = (0.0, 97.0, -45.0, 180.0, 12.5, -90.0, 1.0, 178.5)
WEDGE_PX = np.array([(30.0, 0.0), (60.0, 0.0), (60.0, 6.0)])


def assembly(columns=3, rows=2, px_per_m=200.0):
    """Build a wall course by course from the left, the wedge after the first stone."""
    factor = 1.0 if px_per_m is None else 1.0 / px_per_m
    across = math.ceil(math.sqrt(columns * rows))
    parts = []
    for place in range(columns * rows):
        row, column = divmod(place, columns)
        corners = (outline_px(place) + np.array([column * WIDTH_PX, row * HEIGHT_PX])) * factor
        row, column = divmod(place, across)
        # Rows of the image from the top, so that the first stones are fetched first.
        source = (column + 0.5) * CELL_PX, (across - row - 0.5) * CELL_PX
        step = StoneStep(
            len(parts) + 1, 11 + 3 * place, ANGLES_DEG[place % len(ANGLES_DEG)], source,
            centroid_of(corners), "left", 1 + place % 3, 0, dict.fromkeys(INDEX_NAMES, 0.5),
            None, None, None,
        )  # fmt: skip
        parts.append(Part(step, corners, step.centroid))
        if place == 0:
            wedge = WEDGE_PX * factor
            step = WedgeStep(2, 1000, step.stone, tuple(map(tuple, wedge.tolist())), None, None)
            parts.append(Part(step, wedge, centroid_of(wedge)))
    blocks = [{"id": part.id, "polygon": part.corners.tolist()} for part in parts]
    model = model_from_json({"blocks": blocks, "mu": 0.58})
    source = {
        "path": "stones.png", "sha256": "0" * 64, "stones": columns * rows + 2,
        "width_px": across * CELL_PX, "height_px": across * CELL_PX,
    }  # fmt: skip
    unit = "px" if px_per_m is None else "m"
    plan = Plan(
        "0.1.0", "best", 7, {"mu": 0.58}, unit, px_per_m, 1.0, source,
        columns * WIDTH_PX * factor, rows * HEIGHT_PX * factor,
        tuple(part.plan_step for part in parts), (901, 902), "the wall is full",
        PlanMetrics(0.9, None, None, 0.5, None, None, None, None, 0.0),
    )  # fmt: skip
    resistance = lateral_resistance(model, mechanism=True)
    return Assembly(plan, tuple(parts), model, resistance, unit, px_per_m, HEIGHT_PX * factor)


def outline_px(place):
    """Return a brick from its lower left corner; the first slants below from its middle."""
    w, h = WIDTH_PX, HEIGHT_PX
    below = [(30.0, 0.0), (w, WEDGE_PX[2, 1])] if place == 0 else [(w, 0.0)]
    bevel = 1.0 + place % 3
    return np.array([(0.0, 0.0), *below, (w, h), (bevel, h), (0.0, h - bevel)])


def centroid_of(corners):
    """By shapely: not how the package does it."""
    x, y = shapely.Polygon(corners).centroid.coords[0]
    return x, y


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
