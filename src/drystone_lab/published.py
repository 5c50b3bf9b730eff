"""Suite "statics": published and closed-form cases of the limit analysis, both flow rules."""

from dataclasses import dataclass
from typing import NamedTuple

from drystone.statics.flow.nonassociative import NonassociativeResult, nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult
from drystone_lab import statics_cases
from drystone_lab.statics_cases import WALLS, WITH_FRICTION, WITHOUT_SLIDING, closed_forms
from drystone_lab.table import BENCH, BenchSettings, Cell, Table, worded

FERRIS_TOLERANCE = 5e-6
"""Half a unit of the fifth digit, to which they are published."""

QUICK_ARCHES = (*WITHOUT_SLIDING[:2], *WITH_FRICTION[2::2])


@dataclass(frozen=True)
class Expected:
    """What the answers for one direction must be."""

    alpha: float  # alpha, tolerance: Associative load factor
    tolerance: float
    low: float  # low, high: Range of the factor without dilatancy
    high: float
    words: str  # That range for people
    may_not_converge: bool = False  # No factor without dilatancy is accepted too

    def fits_without_dilatancy(self, found: NonassociativeResult, upper: float | None) -> bool:
        """Tell whether a factor is checked, in its range, and not above the associative one."""
        if found.alpha is None:
            return self.may_not_converge
        checked = found.check is not None and found.check.holds
        below = upper is not None and found.alpha <= upper + 1e-7  # for rounding
        return checked and below and self.low <= found.alpha <= self.high


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
    quick = settings.quick
    forms: list[CaseRow] = []
    for number, case in enumerate(closed_forms()):
        expected = [
            Expected(alpha, 1e-6, alpha - 1e-6, alpha + 1e-6, "the same")
            for alpha in (case.left, case.right)
        ]
        # The quick version asks for few factors without dilatancy.
        both_rules = not quick or number % 3 == 0
        forms += _rows(case.name, case.model, expected, both_rules=both_rules)
    walls: list[CaseRow] = []
    for wall in WALLS:
        low, high = wall.nonassociative
        words = f"{low:g} to {high:g}" if low else f"at most {high:g}, or none"
        one = Expected(wall.associative, FERRIS_TOLERANCE, low, high, words, wall.may_not_converge)
        both_rules = not quick or wall.number == 3
        name = f"example {wall.number}, {wall.blocks} blocks"
        walls += _rows(name, wall.model, [one, one], both_rules=both_rules)
    arches = QUICK_ARCHES if quick else (*WITHOUT_SLIDING, *WITH_FRICTION)
    of = BENCH["statics"]
    return (
        worded(of["closed_forms"], forms),
        worded(of["ferris"], walls),
        worded(of["arches"], map(_arch_row, arches)),
    )


def _rows(
    case: str, model: RigidBlockModel, expected: list[Expected], *, both_rules: bool
) -> list[CaseRow]:
    """Return a row for each direction, or one when both say the same."""
    both = lateral_resistance(model)
    found: list[LimitResult] = [both.left, both.right]
    others: list[NonassociativeResult | None] = [None, None]
    if both_rules:
        without = nonassociative_resistance(model)
        others = [without.left, without.right]
    rows = (_row(case, model.mu, *things) for things in zip(expected, found, others, strict=True))
    return _together(*rows)


def _row(
    case: str, mu: float, expected: Expected, found: LimitResult, other: NonassociativeResult | None
) -> CaseRow:
    difference = None if found.alpha is None else abs(found.alpha - expected.alpha)
    fits = found.certificate is not None and found.certificate.holds
    fits = fits and difference is not None and difference <= expected.tolerance
    if other is not None:
        fits = fits and expected.fits_without_dilatancy(other, found.alpha)
    return CaseRow(
        case, mu, "-x" if found.direction == "left" else "+x", expected.alpha, found.alpha,
        difference, None if found.certificate is None else found.certificate.gap, expected.words,
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


def _arch_row(case: statics_cases.ArchCase) -> tuple[Cell, ...]:
    mu: Cell = "no sliding" if case.mu == statics_cases.NO_SLIDING else case.mu
    # To a tenth of the tolerance.
    least = statics_cases.least_thickness(case.count, case.mu, 1e-6)
    if least is None or case.least is None:
        words = [
            f"none up to {statics_cases.THICKEST:g}" if t is None else t
            for t in (case.least, least)
        ]
        return case.count, mu, *words, None, None, "pass" if least is case.least else "miss"
    certificate = lateral_resistance(
        statics_cases.arch(case.count, least, case.mu)
    ).right.certificate
    gap = None if certificate is None else certificate.gap
    difference = abs(least - case.least)
    verdict = "pass" if difference <= 1e-5 else "miss"
    return case.count, mu, case.least, least, difference, gap, verdict
