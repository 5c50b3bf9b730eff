"""The construction step by step, as SVG shapes for the report."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from drystone.model.plan import Plan, StoneStep, WedgeStep
from drystone.plotting.palette import WEDGE_COLOUR, cluster_colour, text_colour
from drystone.report.content import length_digits, number

WIDTH = 1000.0
"""Width of the wall in the drawing; SVG units are then fine enough with one digit."""

LARGEST_FONT, SMALLEST_FONT = 22.0, 7.0


@dataclass(frozen=True)
class Shape:
    """One stone or wedge of the drawing; x right, y down.

    Parameters
    ----------
    step : int
        Number of the step that places it.
    kind : {"stone", "wedge"}
        Wedges carry no number.
    points : str
        Corners as SVG wants them.
    fill, text_fill : str
        Colours.
    x, y, font : float
        Place and size of the number.
    says : str
        What the step does.
    """

    step: int
    kind: Literal["stone", "wedge"]
    points: str
    fill: str
    text_fill: str
    x: float
    y: float
    font: float
    says: str


@dataclass(frozen=True)
class Drawing:
    """The whole construction.

    Parameters
    ----------
    height : float
        Of the wall, where its width is 1000.
    shapes : tuple of Shape
        In order of construction.
    """

    height: float
    shapes: tuple[Shape, ...]


def drawing(plan: Plan, outlines: Mapping[int, NDArray[np.float64]]) -> Drawing:
    """Turn a plan and its outlines into shapes.

    Parameters
    ----------
    plan : Plan
        The steps.
    outlines : mapping of int to (n, 2) float array
        Polygon of every placed stone by id, wall frame, plan's units.  Wedges without one are
        drawn as their step says.

    Raises
    ------
    ValueError
        When a placed stone has no outline.
    """
    missing = [step.stone for step in plan.stone_steps if step.stone not in outlines]
    if missing:
        raise ValueError(f"there is no outline for the placed stones {missing}")
    factor = WIDTH / plan.width
    frame = _Frame(factor, plan.height * factor)
    shapes = (
        _stone(plan, step, outlines[step.stone], frame)
        if isinstance(step, StoneStep)
        else _wedge(step, outlines.get(step.id, np.array(step.polygon, float)), frame)
        for step in plan.steps
    )
    return Drawing(round(frame.height, 1), tuple(shapes))


@dataclass(frozen=True)
class _Frame:
    """From the wall frame to the drawing."""

    factor: float
    height: float

    def points(self, outline: NDArray[np.float64]) -> NDArray[np.float64]:
        x, y = np.asarray(outline, float).T * self.factor
        return np.column_stack([x, self.height - y])


def _stone(plan: Plan, step: StoneStep, outline: NDArray[np.float64], frame: _Frame) -> Shape:
    points = frame.points(outline)
    ((x, y),) = frame.points(np.array([step.centroid]))
    width, height = np.ptp(points, axis=0)
    room = min(height, width / (0.62 * len(str(step.step))))
    fill = cluster_colour(step.cluster)
    digits = length_digits(plan)
    at_x, at_y = (number(value, digits) for value in step.centroid)
    turned = number(step.angle_deg, 1)
    return Shape(
        step=step.step,
        kind="stone",
        points=_svg_points(points),
        fill=fill,
        text_fill=text_colour(fill),
        x=round(float(x), 1),
        y=round(float(y), 1),
        font=round(min(max(0.6 * float(room), SMALLEST_FONT), LARGEST_FONT), 1),
        says=f"place stone {step.stone}, turned by {turned}°, with its centroid at "
        f"({at_x}, {at_y}) {plan.length_unit}, from the {step.side}.{_strength(step)}",
    )


def _wedge(step: WedgeStep, outline: NDArray[np.float64], frame: _Frame) -> Shape:
    points = frame.points(outline)
    x, y = points.mean(axis=0)
    return Shape(
        step=step.step,
        kind="wedge",
        points=_svg_points(points),
        fill=WEDGE_COLOUR,
        text_fill=text_colour(WEDGE_COLOUR),
        x=round(float(x), 1),
        y=round(float(y), 1),
        font=SMALLEST_FONT,
        says=f"push wedge {step.id} in under stone {step.under}.{_strength(step)}",
    )


def _strength(step: StoneStep | WedgeStep) -> str:
    if step.alpha_left is None and step.alpha_right is None:
        return ""
    left, right = number(step.alpha_left), number(step.alpha_right)
    return f" Load multipliers then: left {left}, right {right}."


def _svg_points(points: NDArray[np.float64]) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
