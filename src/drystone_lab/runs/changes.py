"""Settings that an experiment replaces, as flat pairs that can be kept, compared and printed."""

from collections.abc import Mapping
from typing import Any

from drystone_lab.runs.source import Scalar

Changes = tuple[tuple[str, Scalar], ...]


def flat(settings: Mapping[str, Any]) -> Changes:
    """Return nested settings with their names in full, in order.

    Examples
    --------
    >>> flat({"sampling": "full", "placement": {"beta": 0.5}})
    (('placement.beta', 0.5), ('sampling', 'full'))
    """
    return tuple(sorted(_pairs(settings, "")))


def _pairs(settings: Mapping[str, Any], prefix: str) -> list[tuple[str, Scalar]]:
    found: list[tuple[str, Scalar]] = []
    for name, value in settings.items():
        if isinstance(value, Mapping):
            found.extend(_pairs(value, f"{prefix}{name}."))
        else:
            found.append((prefix + name, value))
    return found


def nested(changes: Changes) -> dict[str, Any]:
    """Return what :meth:`drystone.planner.settings.PlannerSettings.updated` takes.

    Examples
    --------
    >>> nested((("placement.beta", 0.5), ("sampling", "full")))
    {'placement': {'beta': 0.5}, 'sampling': 'full'}
    """
    tables: dict[str, Any] = {}
    for name, value in changes:
        *above, last = name.split(".")
        table = tables
        for part in above:
            table = table.setdefault(part, {})
        table[last] = value
    return tables


def told(changes: Changes) -> str:
    """Return them for people.

    Examples
    --------
    >>> told((("goal.F_AH", 3.6), ("goal.F_AV", 24.0)))
    'goal.F_AH = 3.6, goal.F_AV = 24.0'
    """
    return ", ".join(f"{name} = {value}" for name, value in changes)
