"""Suite "statics": walls and arches whose load factor is known, by the limit analysis.

They are known from a formula, or from other people's programs.
"""

import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from drystone.contacts.given import model_from_json
from drystone.statics.flow.nonassociative import NonassociativeResult, nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult
from drystone_lab.table import BENCH, BenchSettings, Cell, Table, worded

Rectangle = tuple[float, float, float, float]
"""x, y of the lower left corner, width, height."""


@dataclass(frozen=True)
class KnownWall:
    """Rectangles on the ground, and what the answers of the limit analysis must be."""

    name: str
    rectangles: tuple[Rectangle, ...]  # Blocks 1, 2, ...
    mu: float  # Coefficient of friction
    left: float  # left, right: Load factors towards -x and +x on the tilting table
    right: float
    tolerance: float = 1e-6  # Of the load factors
    # Range of accepted load factors without dilatancy, never above the others; None for the same: a
    # stack with one bed a course is statically determinate
    nonassociative: tuple[float, float] | None = None
    may_not_converge: bool = False  # An answer without such a factor is accepted too

    @property
    def model(self) -> RigidBlockModel:
        """The case as a model.

        >>> len(running_bond().model.blocks)
        10
        """
        return model_from_json({"blocks_xywh": self.rectangles, "mu": self.mu})

    @property
    def accepted(self) -> str:
        """Range without dilatancy for people."""
        if self.nonassociative is None:
            return "the same"
        low, high = self.nonassociative
        return f"{low:g} to {high:g}" if low else f"at most {high:g}, or none"

    def fits_without_dilatancy(self, found: NonassociativeResult, associative: float) -> bool:
        """Tell whether a factor is checked, in its range, and not above the associative one."""
        if found.alpha is None:
            return self.may_not_converge
        checked = found.check is not None and found.check.holds
        below = found.alpha <= associative + 1e-7  # for rounding
        known = self.left if found.direction == "left" else self.right
        low, high = self.nonassociative or (known - self.tolerance, known + self.tolerance)
        return checked and below and low <= found.alpha <= high


def aligned_blocks(count: int, width: float, height: float, mu: float) -> KnownWall:
    """Return a block, or two that lie on each other, which slide at mu or overturn as one."""
    alpha = min(mu, width / (count * height))
    rows = tuple((0.0, k * height, width, height) for k in range(count))
    blocks, toe = ("block", "b/h") if count == 1 else ("two blocks", "b/(2h)")
    return KnownWall(f"{blocks} {width:g} x {height:g}: min(mu, {toe})", rows, mu, alpha, alpha)


def offset_stack(shift: float, mu: float) -> KnownWall:
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
    return KnownWall(f"unit block on unit block, shifted by {shift:g}", rows, mu, left, right)


def laid(courses: Sequence[str], *, full: float, height: float) -> tuple[Rectangle, ...]:
    """Return bricks in courses from the bottom up: f is a full one, h a half one, - a gap."""
    widths = {"f": full, "h": full / 2, "-": full}
    found: list[Rectangle] = []
    for row, course in enumerate(courses):
        lefts = accumulate((widths[brick] for brick in course), initial=0.0)
        for brick, left in zip(course, lefts, strict=False):
            if brick != "-":
                found.append((left, height * row, widths[brick], height))
    return tuple(found)


def running_bond() -> KnownWall:
    """Return bricks 2 x 1 in four courses of running bond, 4 wide; they slide at mu = .58.

    No closed form; the value that a public program for block assemblies prints for this wall.
    """
    rows = laid(("ff", "hfh", "ff", "hfh"), full=2.0, height=1.0)
    return KnownWall("running bond of four courses, bricks 2 x 1: mu", rows, 0.58, 0.58, 0.58)


def closed_forms() -> tuple[KnownWall, ...]:
    """Return all cases of this page."""
    # The last is that of Portioli's examples.
    blocks = (1.0, 1.0, 0.3), (1.0, 2.0, 0.7), (1.0, 4.0, 0.65), (2.0, 1.0, 0.65), (0.2, 1.0, 0.7)
    pairs = (1.0, 1.0, 0.65), (2.0, 1.0, 0.65), (3.0, 0.5, 0.9)
    shifts = 0.0, 0.1, 0.2, 0.4, 0.5
    return (
        *(aligned_blocks(1, *block) for block in blocks),
        *(aligned_blocks(2, *pair) for pair in pairs),
        *(offset_stack(shift, mu) for mu in (0.9, 0.3) for shift in shifts),
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


def ferris_wall(
    number: int,
    courses: Sequence[str],
    alpha: float,
    nonassociative: Sequence[float],
    *,
    may_not_converge: bool = False,
) -> KnownWall:
    """Return a wall of Ferris and Tin-Loi, with its courses from the bottom up.

    >>> model = WALLS[0].model
    >>> len(model.blocks), len(model.interfaces)
    (33, 83)
    """
    found = laid(courses, full=4.0, height=HEIGHT)
    low, high = nonassociative
    # They are published to five digits: half a unit of the last one.
    return KnownWall(
        f"example {number}, {len(found)} blocks", found, MU, alpha, alpha, 5e-6,
        (low, high), may_not_converge,
    )  # fmt: skip


_FILE = tomllib.loads(Path(__file__).with_name("statics_cases.toml").read_text("utf-8"))

WALLS = tuple(ferris_wall(number, **wall) for number, wall in enumerate(_FILE["walls"], 1))
"""Ferris and Tin-Loi (2001)."""

QUICK_ARCHES = (*WITHOUT_SLIDING[:2], *WITH_FRICTION[2::2])


class CaseRow(NamedTuple):
    """A row of a table."""

    case: str
    mu: float
    towards: str
    expected: float
    alpha: float | None
    difference: float | None
    gap: float | None
    accepted: str
    without_dilatancy: float | None
    verdict: str


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Compare the limit analysis with all published cases."""
    quick, of = settings.quick, BENCH["statics"]
    # The quick version asks for few factors without dilatancy.
    forms = [
        row
        for number, case in enumerate(closed_forms())
        for row in _rows(case, both_rules=not quick or number % 3 == 0)
    ]
    walls = [
        row
        for number, wall in enumerate(WALLS, 1)
        for row in _rows(wall, both_rules=not quick or number == 3)
    ]
    arches = QUICK_ARCHES if quick else (*WITHOUT_SLIDING, *WITH_FRICTION)
    return (
        worded(of["closed_forms"], forms),
        worded(of["ferris"], walls),
        worded(of["arches"], map(_arch_row, arches)),
    )


def _rows(case: KnownWall, *, both_rules: bool) -> list[CaseRow]:
    """Return a row for each direction, or one when both say the same."""
    both = lateral_resistance(case.model)
    if not both_rules:
        return _together(_row(case, both.left), _row(case, both.right))
    without = nonassociative_resistance(case.model)
    return _together(_row(case, both.left, without.left), _row(case, both.right, without.right))


def _row(case: KnownWall, found: LimitResult, other: NonassociativeResult | None = None) -> CaseRow:
    left = found.direction == "left"
    known = case.left if left else case.right
    difference = None if found.alpha is None else abs(found.alpha - known)
    fits = found.certificate is not None and found.certificate.holds
    fits = fits and difference is not None and difference <= case.tolerance
    if other is not None and found.alpha is not None:
        fits = fits and case.fits_without_dilatancy(other, found.alpha)
    return CaseRow(
        case.name, case.mu, "-x" if left else "+x", known, found.alpha, difference,
        None if found.certificate is None else found.certificate.gap, case.accepted,
        None if other is None else other.alpha, "pass" if fits else "miss",
    )  # fmt: skip


def _together(left: CaseRow, right: CaseRow) -> list[CaseRow]:
    """Make one row of two that agree: the larger difference, and the larger gap."""
    alike = all(
        one is other if one is None or other is None else abs(one - other) <= 1e-6
        for one, other in (
            (left.alpha, right.alpha),
            (left.without_dilatancy, right.without_dilatancy),
        )
    )
    if not alike or (left.expected, left.verdict) != (right.expected, right.verdict):
        return [left, right]
    worse = max((left, right), key=lambda row: row.difference or 0.0)
    gap = max((row.gap for row in (left, right) if row.gap is not None), default=None)
    return [worse._replace(towards="both", gap=gap)]


def _arch_row(case: ArchCase) -> tuple[Cell, ...]:
    mu: Cell = "no sliding" if case.mu == NO_SLIDING else case.mu
    # To a tenth of the tolerance.
    least = least_thickness(case.count, case.mu, 1e-6)
    if least is None or case.least is None:
        words = [f"none up to {THICKEST:g}" if t is None else t for t in (case.least, least)]
        return case.count, mu, *words, None, None, "pass" if least is case.least else "miss"
    certificate = lateral_resistance(arch(case.count, least, case.mu)).right.certificate
    gap = None if certificate is None else certificate.gap
    difference = abs(least - case.least)
    verdict = "pass" if difference <= 1e-5 else "miss"
    return case.count, mu, case.least, least, difference, gap, verdict
