"""What a rule is, and what it finds in a wall."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from drystone.craft.masonry import Masonry
from drystone.errors import UsageError
from drystone.kernels.polygons import Points

Verdict = Literal["good", "fair", "broken", "not judged"]

ROUNDING = 1e-9
"""Numbers this near to a limit are at the limit: a mirrored wall gets the same verdict."""


@dataclass(frozen=True)
class Limit:
    """Where a rule's number stops being good, and where it is broken."""

    good: float  # last values that are good, and fair; beyond `fair` the rule is broken
    fair: float


@dataclass(frozen=True, eq=False)
class Case:
    """One place where a rule is not kept."""

    stones: tuple[int, ...]
    value: float  # how bad it is, in the unit of `words`
    words: str  # what is wrong, after the names of the stones
    lines: tuple[Points, ...] = ()  # (n, 2), joints, edges or slopes to draw
    # How many of the stones, the first ones, do not keep the rule; 0 when it is a joint between
    # them that does not.
    at_fault: int = 1


def worst_first(cases: Iterable[Case]) -> tuple[Case, ...]:
    """Sort cases by their values, the greatest first."""
    return tuple(sorted(cases, key=lambda case: (-case.value, case.stones)))


@dataclass(frozen=True, eq=False)
class Evidence:
    """What there is in a wall, before a limit judges it."""

    number: float | None  # see `Rule.meaning`; None when there is nothing to judge
    cases: tuple[Case, ...] = ()  # worst first.  A good wall may have some.
    # Other numbers that go with it.
    figures: Mapping[str, float | None] = field(default_factory=dict)
    note: str = ""  # why nothing was judged, or what the number does not say
    broken: bool = False  # the rule is broken whatever the number is


@dataclass(frozen=True)
class Rule:
    """A mason's rule as a check."""

    name: str  # for options and JSON
    title: str  # for tables and pictures
    sentence: str  # the rule as a mason says it
    source: str  # who says it; "Own definition" for what is ours
    meaning: str  # what the number is
    limit: Limit  # usual limits; ours, unless the source says otherwise
    # Gives the number of a wall, a Masonry, and its cases; with `by_limit` it is told the limit.
    measure: Callable[..., Evidence]
    unit: str = ""  # empty for shares and counts
    higher_is_better: bool = False
    by_limit: bool = False

    def find(self, masonry: Masonry, limit: Limit | None = None) -> "Finding":
        """Judge a wall, by limits of its own unless others are given."""
        limit = limit or self.limit
        sign = 1.0 if self.higher_is_better else -1.0
        if not (
            np.isfinite([limit.good, limit.fair]).all() and sign * (limit.good - limit.fair) >= 0
        ):
            better = "higher" if self.higher_is_better else "lower"
            raise UsageError(
                "E190",
                f"{limit.good:g}:{limit.fair:g} are not limits of {self.name!r}, "
                f"whose number is better the {better} it is.",
                where="limits of craft",
                cure=f"Give the last good and the last fair value, such as {self.limit.good:g}:"
                f"{self.limit.fair:g}.",
            )
        found = self.measure(masonry, limit) if self.by_limit else self.measure(masonry)
        verdict: Verdict
        if found.broken:
            verdict = "broken"
        elif found.number is None:
            verdict = "not judged"
        elif sign * (found.number - limit.good) >= -ROUNDING:
            verdict = "good"
        else:
            verdict = "fair" if sign * (found.number - limit.fair) >= -ROUNDING else "broken"
        return Finding(**vars(found), rule=self, limit=limit, verdict=verdict)


@dataclass(frozen=True, eq=False, kw_only=True)
class Finding(Evidence):
    """What a rule finds: what there is, judged."""

    rule: Rule
    limit: Limit
    verdict: Verdict

    @property
    def amount(self) -> str:
        """The number with its unit; empty when nothing was judged."""
        if self.number is None:
            return ""
        unit = self.rule.unit
        if unit.endswith("s") and self.number == 1.0:
            unit = unit[:-1]
        return f"{self.number:.3g}{unit if unit in ('', '°') else f' {unit}'}"

    def report(self, steps: Mapping[int, int]) -> dict[str, Any]:
        """Return it for JSON."""
        return {
            "title": self.rule.title,
            "rule": self.rule.sentence,
            "source": self.rule.source,
            "meaning": self.rule.meaning,
            "number": self.number,
            "unit": self.rule.unit,
            "better": "higher" if self.rule.higher_is_better else "lower",
            "limits": {"good": self.limit.good, "fair": self.limit.fair},
            "verdict": self.verdict,
            "figures": dict(self.figures),
            "note": self.note,
            "cases": [
                {
                    "stones": list(case.stones),
                    **({"steps": [steps[stone] for stone in case.stones]} if steps else {}),
                    "value": case.value,
                    "words": case.words,
                    "lines": [np.round(line, 9).tolist() for line in case.lines],
                }
                for case in self.cases
            ],
        }
