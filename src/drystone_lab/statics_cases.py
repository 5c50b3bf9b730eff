"""Walls and arches whose load factor is known from a formula, or from other people's programs."""

import math
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

import numpy as np

from drystone.contacts.given import model_from_json
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel

Rectangle = tuple[float, float, float, float]
"""x, y of the lower left corner, width, height."""

BLOCKS = ((1.0, 1.0, 0.3), (1.0, 2.0, 0.7), (1.0, 4.0, 0.65), (2.0, 1.0, 0.65), (0.2, 1.0, 0.7))
"""Width, height and mu of single blocks; the last is that of Portioli's examples."""

PAIRS = ((1.0, 1.0, 0.65), (2.0, 1.0, 0.65), (3.0, 0.5, 0.9))
"""Width, height and mu of two equal blocks, one on the other."""

SHIFTS = (0.0, 0.1, 0.2, 0.4, 0.5)
"""How far the upper of two unit blocks is shifted towards +x."""


@dataclass(frozen=True)
class ClosedForm:
    """Rectangles on the ground and the load factors they must have."""

    name: str
    rectangles: tuple[Rectangle, ...]  # Blocks 1, 2, ...
    mu: float  # Coefficient of friction
    # left, right: Load factors towards -x and +x on the tilting table, the same for both flow
    # rules: a stack with one bed a course is statically determinate
    left: float
    right: float

    @property
    def model(self) -> RigidBlockModel:
        """The case as a model.

        >>> len(running_bond().model.blocks)
        10
        """
        return model_from_json({"blocks_xywh": self.rectangles, "mu": self.mu})


def single_block(width: float, height: float, mu: float) -> ClosedForm:
    """Return a block that slides at mu or overturns about its toe at b/h."""
    alpha = min(mu, width / height)
    name = f"block {width:g} x {height:g}: min(mu, b/h)"
    return ClosedForm(name, ((0.0, 0.0, width, height),), mu, alpha, alpha)


def two_equal_blocks(width: float, height: float, mu: float) -> ClosedForm:
    """Return two aligned blocks, which overturn as one at b/(2h)."""
    alpha = min(mu, width / (2.0 * height))
    rows = ((0.0, 0.0, width, height), (0.0, height, width, height))
    return ClosedForm(f"two blocks {width:g} x {height:g}: min(mu, b/(2h))", rows, mu, alpha, alpha)


def offset_stack(shift: float, mu: float) -> ClosedForm:
    """Return a unit block on a unit block, shifted by 0 to .5 towards +x.

    Towards +x the upper block overturns about the lower one's edge at (.5 - s) / .5, both about
    the ground at (.5 + .5 - s) / (.5 + 1.5); towards -x the upper block at 1, both at
    (.5 + .5 + s) / (.5 + 1.5).

    >>> case = offset_stack(0.25, mu=0.9)
    >>> case.left, case.right
    (0.625, 0.375)
    """
    right = min(mu, (0.5 - shift) / 0.5, (1.0 - shift) / 2.0)
    left = min(mu, 1.0, (1.0 + shift) / 2.0)
    rows = ((0.0, 0.0, 1.0, 1.0), (shift, 1.0, 1.0, 1.0))
    return ClosedForm(f"unit block on unit block, shifted by {shift:g}", rows, mu, left, right)


def running_bond() -> ClosedForm:
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
    return ClosedForm("running bond of four courses, bricks 2 x 1: mu", rows, 0.58, 0.58, 0.58)


def closed_forms() -> tuple[ClosedForm, ...]:
    """Return all cases of this page."""
    return (
        *(single_block(*block) for block in BLOCKS),
        *(two_equal_blocks(*pair) for pair in PAIRS),
        *(offset_stack(shift, mu) for mu in (0.9, 0.3) for shift in SHIFTS),
        running_bond(),
    )


NO_SLIDING = 50.0
"""A coefficient of friction at which nothing slides in an arch."""

THINNEST, THICKEST = 0.01, 0.4
"""Range of t/R in which the least thickness is sought."""


@dataclass(frozen=True)
class ArchCase:
    """An arch and the least thickness it must have."""

    count: int  # Voussoirs
    mu: float  # Coefficient of friction
    least: float | None  # Least t/R, to five digits; None when no thickness up to `THICKEST` stands


WITHOUT_SLIDING = tuple(
    ArchCase(count, NO_SLIDING, least)
    for count, least in {
        9: 0.10213, 11: 0.10491, 16: 0.10724, 20: 0.10746, 27: 0.10678, 40: 0.10746, 100: 0.10746,
    }.items()
)  # fmt: skip
WITH_FRICTION = tuple(
    ArchCase(40, mu, least)
    for mu, least in {0.5: 0.10746, 0.4: 0.10746, 0.35: 0.15182, 0.32: 0.18544, 0.3: None}.items()
)


def arch(count: int, thickness: float, mu: float) -> RigidBlockModel:
    """Make an arch with the joints of its corners, and area and centroid of annular sectors.

    >>> model = arch(9, 0.2, mu=0.6)
    >>> len(model.blocks), len(model.interfaces)
    (9, 10)
    """
    inner, outer = 1.0 - thickness / 2.0, 1.0 + thickness / 2.0
    angles = np.linspace(0.0, math.pi, count + 1)
    blocks = []
    for number, (first, last) in enumerate(pairwise(angles.tolist()), start=1):
        polar = ((inner, first), (outer, first), (outer, last), (inner, last))
        corners = [[r * math.cos(t), max(0.0, r * math.sin(t))] for r, t in polar]
        blocks.append({"id": number, "polygon": corners})
    model = model_from_json({"blocks": blocks, "mu": mu})
    half = math.pi / count / 2.0
    area = half * (outer**2 - inner**2)
    radius = 2.0 / 3.0 * math.sin(half) / half * (outer**3 - inner**3) / (outer**2 - inner**2)
    sectors = tuple(
        replace(block, area=area, centroid=(radius * math.cos(middle), radius * math.sin(middle)))
        for block, middle in zip(model.blocks, (angles[:-1] + half).tolist(), strict=True)
    )
    return RigidBlockModel(sectors, model.interfaces, mu)


def stands(count: int, thickness: float, mu: float) -> bool:
    """Tell whether an arch stands under its own weight."""
    return lateral_resistance(arch(count, thickness, mu)).stable


def least_thickness(count: int, mu: float, tolerance: float) -> float | None:
    """Find the thickness over the mean radius at which an arch first stands, by bisection."""
    falls, carries = THINNEST, THICKEST
    if not stands(count, carries, mu):
        return None
    while carries - falls > tolerance:
        middle = (falls + carries) / 2.0
        if stands(count, middle, mu):
            carries = middle
        else:
            falls = middle
    return carries


HEIGHT, MU = 1.75, 0.65

BRICKS = {"f": 4, "h": 2, "-": 4}
"""Widths of a full brick, a half one and a gap."""

A, B, A_OPEN, B_OPEN = "hffffh", "fffff", "f-f-f", "hh-hh-hh"
P, Q, P_OPEN, Q_OPEN = "ffff", "hfffh", "fh-hf", "hf-fh"
C, D, C_OPEN, D_OPEN = "hffh", "fff", "f-f", "hh-hh"
E, F, E_OPEN, F_OPEN = "hffffffh", "fffffff", "hf-ff-fh", "fh-hfh-hf"
"""Courses, and the same with openings."""


@dataclass(frozen=True)
class FerrisWall:
    """One of the examples."""

    number: int  # 1 to 6, as published
    courses: tuple[str, ...]  # Bottom first
    blocks: int
    contacts: int
    associative: float  # Load factor, the same in both directions
    # Range of accepted load factors without dilatancy; never above the associative one
    nonassociative: tuple[float, float]
    may_not_converge: bool = False  # An answer without a factor is accepted too

    @property
    def rectangles(self) -> tuple[Rectangle, ...]:
        """Blocks as x, y, width, height, course by course and from left to right."""
        found = []
        for row, course in enumerate(self.courses):
            lefts = accumulate((BRICKS[brick] for brick in course), initial=0)
            for brick, left in zip(course, lefts, strict=False):
                if brick != "-":
                    found.append((float(left), HEIGHT * row, float(BRICKS[brick]), HEIGHT))
        return tuple(found)

    @property
    def model(self) -> RigidBlockModel:
        """The wall as a model.

        >>> model = WALLS[0].model
        >>> len(model.blocks), len(model.interfaces)
        (33, 83)
        """
        return model_from_json({"blocks_xywh": self.rectangles, "mu": MU})


WALLS = (
    FerrisWall(1, (A, B) * 3, 33, 83, 0.64286, (0.638, 0.650)),
    FerrisWall(2, (A, B) * 5, 55, 141, 0.58000, (0.550, 0.564)),
    FerrisWall(
        3, (P, Q, P, *(Q_OPEN, P_OPEN) * 2, Q_OPEN, P, Q, P), 46, 102, 0.40369, (0.350, 0.361)
    ),
    FerrisWall(
        4, (A, B, A, *(A_OPEN, B_OPEN) * 2, A_OPEN, A, B, A), 55, 116, 0.33195, (0.262, 0.267)
    ),
    FerrisWall(
        5, (*(C, D, C, *(C_OPEN, D_OPEN) * 2, C_OPEN) * 2, C, D, C), 61, 120, 0.23964,
        (0.205, 0.217),
    ),
    FerrisWall(
        6, (E, F, *(E, F, *(E_OPEN, F_OPEN) * 2, E_OPEN, F) * 2, E, F, E), 146, 345, 0.34782,
        (0.0, 0.34783), may_not_converge=True,
    ),
)  # fmt: skip
