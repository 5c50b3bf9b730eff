"""Stacks of rectangles whose load factor is known from a formula, or from another program."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from drystone.contacts.given import model_from_json
from drystone.statics.model import RigidBlockModel

Rectangle = tuple[float, float, float, float]
"""x, y of the lower left corner, width, height."""

BLOCKS = (
    (1.0, 1.0, 0.3),
    (1.0, 2.0, 0.7),
    (1.0, 4.0, 0.65),
    (2.0, 1.0, 0.65),
    (0.2, 1.0, 0.7),
)
"""Width, height and mu of single blocks; the last is that of Portioli's examples."""

PAIRS = ((1.0, 1.0, 0.65), (2.0, 1.0, 0.65), (3.0, 0.5, 0.9))
"""Width, height and mu of two equal blocks, one on the other."""

SHIFTS = (0.0, 0.1, 0.2, 0.4, 0.5)
"""How far the upper of two unit blocks is shifted towards +x."""


@dataclass(frozen=True)
class Case:
    """Rectangles on the ground and the load factors they must have.

    Parameters
    ----------
    name : str
        For people.
    rectangles : tuple of (x, y, width, height)
        Blocks 1, 2, ...
    mu : float
        Coefficient of friction.
    left, right : float
        Load factors towards -x and +x on the tilting table, the same for both flow rules: a
        stack with one bed a course is statically determinate.
    """

    name: str
    rectangles: tuple[Rectangle, ...]
    mu: float
    left: float
    right: float

    @property
    def data(self) -> Mapping[str, Any]:
        """The case as a block model file."""
        return {"blocks_xywh": self.rectangles, "mu": self.mu}

    @property
    def model(self) -> RigidBlockModel:
        """The case as a model.

        Examples
        --------
        >>> len(running_bond().model.blocks)
        10
        """
        return model_from_json(self.data)


def single_block(width: float, height: float, mu: float) -> Case:
    """Return a block that slides at mu or overturns about its toe at b/h."""
    alpha = min(mu, width / height)
    name = f"block {width:g} x {height:g}: min(mu, b/h)"
    return Case(name, ((0.0, 0.0, width, height),), mu, alpha, alpha)


def two_equal_blocks(width: float, height: float, mu: float) -> Case:
    """Return two aligned blocks, which overturn as one at b/(2h)."""
    alpha = min(mu, width / (2.0 * height))
    rows = ((0.0, 0.0, width, height), (0.0, height, width, height))
    return Case(f"two blocks {width:g} x {height:g}: min(mu, b/(2h))", rows, mu, alpha, alpha)


def offset_stack(shift: float, mu: float) -> Case:
    """Return a unit block on a unit block, shifted by 0 to .5 towards +x.

    Towards +x the upper block overturns about the lower one's edge at (.5 - s) / .5, both about
    the ground at (.5 + .5 - s) / (.5 + 1.5); towards -x the upper block at 1, both at
    (.5 + .5 + s) / (.5 + 1.5).

    Examples
    --------
    >>> case = offset_stack(0.25, mu=0.9)
    >>> case.left, case.right
    (0.625, 0.375)
    """
    right = min(mu, (0.5 - shift) / 0.5, (1.0 - shift) / 2.0)
    left = min(mu, 1.0, (1.0 + shift) / 2.0)
    rows = ((0.0, 0.0, 1.0, 1.0), (shift, 1.0, 1.0, 1.0))
    return Case(f"unit block on unit block, shifted by {shift:g}", rows, mu, left, right)


def running_bond() -> Case:
    """Return bricks 2 x 1 in four courses of running bond, 4 wide; they slide at mu = .58.

    No closed form; the value that a public program for block assemblies prints for this wall.
    """
    whole = ((0.0, 2.0), (2.0, 2.0))
    halves = ((0.0, 1.0), (1.0, 2.0), (3.0, 1.0))
    rows = tuple(
        (x, float(course), width, 1.0)
        for course in range(4)
        for x, width in (whole, halves)[course % 2]
    )
    return Case("running bond of four courses, bricks 2 x 1: mu", rows, 0.58, 0.58, 0.58)


def closed_forms() -> tuple[Case, ...]:
    """Return all cases of this page."""
    return (
        *(single_block(*block) for block in BLOCKS),
        *(two_equal_blocks(*pair) for pair in PAIRS),
        *(offset_stack(shift, mu) for mu in (0.9, 0.3) for shift in SHIFTS),
        running_bond(),
    )
