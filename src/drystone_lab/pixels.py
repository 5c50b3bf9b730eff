"""`drystone bench pixels`: published cases from pictures, and tilted joints as pixels shrink."""

from collections.abc import Callable, Iterable

import numpy as np

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.outlines import model_from_outlines, outlines_of_labels
from drystone.model.wall import Labels
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone_lab.cases import Rectangle, closed_forms
from drystone_lab.refinement import RefinementStudy, refinement_study
from drystone_lab.table import BenchSettings, Cell, Table
from drystone_lab.walls_of_ferris import HEIGHT, MU, WALLS

BRICK_PX = 20
"""Height of a brick."""

TOLERANCE = 0.01
"""Of a load factor from pixels, relative."""

SEEDS = 4
"""The study of tilted joints is done for this many sets of walls."""


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Return the published cases from pixels, and the study of tilted joints."""
    return _published(quick=settings.quick), _refinement(settings)


def rasterised(rectangles: Iterable[Rectangle], px: float) -> Labels:
    """Draw rectangles, numbered from 1, at `px` pixels per unit; edges at the nearest pixel edge.

    Examples
    --------
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
    return model_from_outlines(outlines_of_labels(labels), mu)


def _published(*, quick: bool) -> Table:
    cases = [
        (f"Ferris and Tin-Loi, example {wall.number}", wall.rectangles, BRICK_PX / HEIGHT, MU,
         (wall.associative, wall.associative))
        for wall in (WALLS[:1] if quick else WALLS)
    ]  # fmt: skip
    cases += [
        (case.name, case.rectangles, float(BRICK_PX), case.mu, (case.left, case.right))
        for case in closed_forms()
    ]
    rows = []
    for name, rectangles, px, mu, expected in cases:
        labels = rasterised(rectangles, px)
        pixels, pixel_error = _compared(from_pixels, labels, mu, expected)
        outlines, outline_error = _compared(from_outlines, labels, mu, expected)
        known = (pixel_error, outline_error)
        hits = all(error is not None and error <= TOLERANCE for error in known)
        told = _both(*expected)
        verdict = "pass" if hits else "miss"
        rows.append((name, mu, told, pixels, pixel_error, outlines, outline_error, verdict))
    return Table(
        f"Published cases from pictures, {BRICK_PX} px a brick height",
        ("case", "mu", "expected", "pixels", "error, pixels", "outlines", "error, outlines",
         "verdict"),
        tuple(rows),
        (f"Errors are relative to the expected factor, the larger of both directions (absolute"
         f" where that is 0); tolerance {TOLERANCE:g}. Where left and right differ both are given.",
         "Edges lie on the nearest pixel edge: a brick 4 x 1.75 is 45 or 46 px wide."),
    )  # fmt: skip


def _compared(
    model_of: Callable[[Labels, float], RigidBlockModel],
    labels: Labels,
    mu: float,
    expected: tuple[float, float],
) -> tuple[str, float | None]:
    """Return what was found, and its error; None when there is no number."""
    both = lateral_resistance(model_of(labels, mu))
    if both.left.alpha is None or both.right.alpha is None:
        return f"{both.left.status} / {both.right.status}", None
    found = (both.left.alpha, both.right.alpha)
    errors = [abs(a - b) / (b or 1.0) for a, b in zip(found, expected, strict=True)]
    return _both(*found), max(errors)


def _both(left: float, right: float) -> str:
    if abs(left - right) < 1e-4:
        return f"{left:.4f}"
    return f"{left:.4f} / {right:.4f}"


def _refinement(settings: BenchSettings) -> Table:
    count = 1 if settings.quick else SEEDS
    rows: list[tuple[Cell, ...]] = []
    for seed in range(settings.seed, settings.seed + count):
        study = (
            refinement_study((40, 80, 160), walls=3, offsets=1, seed=seed)
            if settings.quick
            else refinement_study(seed=seed)
        )
        rows += _study_rows(seed, study)
    return Table(
        "Walls of tilted joints: |alpha - alpha of the polygons|",
        ("walls of seed", "height px", "cases", "pixels, mean", "pixels, worst",
         "outlines, mean", "outlines, worst", "order, pixels", "order, outlines"),
        tuple(rows),
        ("Nine walls of 3 to 5 courses, bed and head joints tilted, each at three sub-pixel"
         " positions, both directions. The order p is that of error ~ height^-p.",
         "No bend and no piece of a joint of these walls is shorter than .04 wall heights, 1.6 px"
         " at 40 px: what a picture cannot show does not converge with it (with pieces down to"
         " .003 wall heights the order was .88)."),
    )  # fmt: skip


def _study_rows(seed: int, study: RefinementStudy) -> list[tuple[Cell, ...]]:
    last = len(study.rows) - 1
    return [
        (
            seed, row.height_px, row.cases, row.pixel_error, row.pixel_worst, row.outline_error,
            row.outline_worst,
            study.pixel_order if place == last else None,
            study.outline_order if place == last else None,
        )
        for place, row in enumerate(study.rows)
    ]  # fmt: skip
