"""All rules at once."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from types import MappingProxyType
from typing import Any, Protocol

from drystone.craft import (
    big_low,
    cross_joints,
    flush_ends,
    inward_edges,
    laps,
    level_beds,
    level_top,
    on_end,
    one_over_two,
    pins,
    running_joints,
)
from drystone.craft.finding import Finding, Limit, Rule
from drystone.craft.masonry import Masonry
from drystone.errors import UsageError

UNSEEN = (
    "What a flat picture does not show: traced stones (length along the face instead of into the "
    "wall), through stones, hearting, batter, and the bedding of the rock."
)


class Check(Protocol):
    """What a file of a rule has."""

    RULE: Rule

    def find(self, masonry: Masonry, limit: Limit) -> Finding:
        """Look at a wall."""
        ...


_CHECKS: tuple[Check, ...] = (
    running_joints, cross_joints, one_over_two, laps, on_end, big_low, level_beds, inward_edges,
    pins, level_top, flush_ends,
)  # fmt: skip

RULES: Mapping[str, Rule] = MappingProxyType({check.RULE.name: check.RULE for check in _CHECKS})
"""All rules by name."""


@dataclass(frozen=True, eq=False)
class CraftReport:
    """What the rules find in a wall.

    Parameters
    ----------
    masonry : Masonry
        The wall.
    findings : mapping of str to Finding
        By name of the rule, in the order of :data:`RULES`.
    """

    masonry: Masonry
    findings: Mapping[str, Finding]

    @property
    def broken(self) -> tuple[str, ...]:
        """Names of the rules that are broken."""
        return tuple(name for name, one in self.findings.items() if one.verdict == "broken")

    def report(self) -> dict[str, Any]:
        """Return everything for JSON."""
        masonry = self.masonry
        return {
            "stones": len(masonry.stones),
            "wedges": len(set(masonry.wedge_ids)),
            "mean_stone_height": masonry.mean_height,
            "mean_stone_width": masonry.mean_width,
            "settings": asdict(masonry.settings),
            "rules": {name: one.report(masonry.steps) for name, one in self.findings.items()},
            "unseen": UNSEEN,
        }


def look(masonry: Masonry, limits: Mapping[str, Limit] | None = None) -> CraftReport:
    """Judge a wall by the masons' rules.

    Parameters
    ----------
    masonry : Masonry
        Any wall; also an empty one, of which nothing is judged.
    limits : mapping of str to Limit, optional
        By name of a rule, limits that replace its own.

    Raises
    ------
    UsageError
        E190 for limits of no rule, or the wrong way round.

    Examples
    --------
    >>> import numpy as np
    >>> brick = np.array([[0, 0], [2, 0], [2, 1], [0, 1]])
    >>> places = [(0, 0), (2, 0), (0, 1), (2, 1)]
    >>> report = look(Masonry({i: brick + place for i, place in enumerate(places, 1)}))
    >>> report.findings["running_joints"].verdict, report.broken
    ('fair', ('cross_joints',))
    """
    given = dict(limits or {})
    strangers = sorted(set(given) - set(RULES))
    if strangers:
        raise UsageError(
            "E190",
            f"there is no rule {', '.join(map(repr, strangers))}.",
            where="limits of craft",
            cure=f"The rules are {', '.join(RULES)}.",
        )
    findings = {}
    for check in _CHECKS:
        rule = check.RULE
        findings[rule.name] = check.find(masonry, rule.checked(given.get(rule.name, rule.limit)))
    return CraftReport(masonry, findings)
