"""What a rule is, and what it finds in a wall."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from drystone.errors import UsageError

Line = NDArray[np.float64]
"""(n, 2) points of the wall frame."""

Verdict = Literal["good", "fair", "broken", "not judged"]
VERDICTS: tuple[Verdict, ...] = ("good", "fair", "broken")
"""From the best to the worst."""

ROUNDING = 1e-9
"""Numbers this near to a limit are at the limit: a mirrored wall gets the same verdict."""


@dataclass(frozen=True)
class Limit:
    """Where a rule's number stops being good, and where it is broken.

    Parameters
    ----------
    good, fair : float
        Last values that are good, and fair; beyond `fair` the rule is broken.
    """

    good: float
    fair: float


@dataclass(frozen=True)
class Rule:
    """A mason's rule as a check.

    Parameters
    ----------
    name : str
        For options and JSON.
    title : str
        For tables and pictures.
    sentence : str
        The rule as a mason says it.
    source : str
        Who says it; "Own definition" for what is ours.
    meaning : str
        What the number is.
    higher_is_better : bool
        Direction of the number.
    limit : Limit
        Usual limits; ours, unless the source says otherwise.
    unit : str
        Of the number, empty for shares and counts.
    """

    name: str
    title: str
    sentence: str
    source: str
    meaning: str
    higher_is_better: bool
    limit: Limit
    unit: str = ""

    def verdict(self, number: float | None, limit: Limit) -> Verdict:
        """Say what a number is worth.

        Examples
        --------
        >>> rule = Rule("joints", "", "", "", "", False, Limit(1, 2))
        >>> [rule.verdict(number, rule.limit) for number in (1, 2, 3, None)]
        ['good', 'fair', 'broken', 'not judged']
        """
        if number is None:
            return "not judged"
        sign = 1.0 if self.higher_is_better else -1.0
        if sign * (number - limit.good) >= -ROUNDING:
            return "good"
        return "fair" if sign * (number - limit.fair) >= -ROUNDING else "broken"

    def checked(self, limit: Limit) -> Limit:
        """Return limits that make sense; UsageError (E190) for those that are the wrong way round.

        Raises
        ------
        UsageError
            E190.
        """
        sign = 1.0 if self.higher_is_better else -1.0
        if np.isfinite([limit.good, limit.fair]).all() and sign * (limit.good - limit.fair) >= 0:
            return limit
        better = "higher" if self.higher_is_better else "lower"
        raise UsageError(
            "E190",
            f"{limit.good:g}:{limit.fair:g} are no limits of {self.name!r}, "
            f"whose number is better the {better} it is.",
            where="limits of craft",
            cure=f"Give the last good and the last fair value, such as {self.limit.good:g}:"
            f"{self.limit.fair:g}.",
        )


@dataclass(frozen=True, eq=False)
class Case:
    """One place where a rule is not kept.

    Parameters
    ----------
    stones : tuple of int
        Ids concerned.
    value : float
        How bad it is, in the unit of `words`.
    words : str
        What is wrong, after the names of the stones.
    lines : tuple of (n, 2) float arrays
        Joints, edges or slopes to draw.
    at_fault : int
        How many of the stones, the first ones, do not keep the rule; 0 when it is a joint
        between them that does not.
    """

    stones: tuple[int, ...]
    value: float
    words: str
    lines: tuple[Line, ...] = ()
    at_fault: int = 1


@dataclass(frozen=True, eq=False)
class Finding:
    """What a rule finds.

    Parameters
    ----------
    rule : Rule
        Which one.
    limit : Limit
        Limits that were used.
    number : float or None
        See ``rule.meaning``; None when there is nothing to judge.
    verdict : {"good", "fair", "broken", "not judged"}
        By the limits.
    cases : tuple of Case
        Worst first.  A good wall may have some.
    figures : mapping of str to float or None
        Other numbers that go with it.
    note : str
        Why nothing was judged, or what the number does not say.
    """

    rule: Rule
    limit: Limit
    number: float | None
    verdict: Verdict
    cases: tuple[Case, ...] = ()
    figures: Mapping[str, float | None] = field(default_factory=dict)
    note: str = ""

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
        """Return it for JSON.

        Parameters
        ----------
        steps : mapping of int to int
            Step of the plan by id; empty for what is no plan.
        """
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
            "cases": [_case_report(case, steps) for case in self.cases],
        }


def _case_report(case: Case, steps: Mapping[int, int]) -> dict[str, Any]:
    told: dict[str, Any] = {"stones": list(case.stones)}
    if steps:
        told["steps"] = [steps[stone] for stone in case.stones]
    return {
        **told,
        "value": case.value,
        "words": case.words,
        "lines": [np.round(line, 9).tolist() for line in case.lines],
    }
