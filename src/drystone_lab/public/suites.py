"""The walls and the methods of the public benchmark.

Walls are fixed (``suites.toml``): they may not change without a new :data:`SUITE_VERSION`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

from drystone.errors import UsageError
from drystone.planner.settings import method_settings
from drystone.selection.policies.registry import BUILT_IN, GROUP, PAPER, RULES, no_policy, rule_of
from drystone_lab import walls as made
from drystone_lab.runs.spec import STRIPS, Changes, Scalar, changes_of, settings_of
from drystone_lab.table import BENCH
from drystone_lab.walls import Target, chosen

SUITE_VERSION = 1

ALL = "all"

_WALLS: Mapping[str, tuple[Target, ...]] = {
    suite: tuple(
        replace(wall, name=wall.name.removesuffix(" framed"), suite=suite) for wall in walls
    )
    for suite, walls in {
        "masons": (made.PR_560, made.PR_600, made.R_FRAMED, made.IR_FRAMED),
        **made.made_walls(Path(__file__).with_name("suites.toml")),
        "noise": made.NOISY,
    }.items()
}

PUBLIC_SUITES: Mapping[str, str] = BENCH["public"]["suites"]
"""What each is about.  Of generated stones there are .85 of the wall, within .01."""


def walls_of(suite: str, only: Sequence[str] = (), *, quick: bool = False) -> tuple[Target, ...]:
    """Return the walls of a suite, in order.

    >>> [wall.name for wall in walls_of("masons", ["PR"])]
    ['PR 560x160', 'PR 600x160']
    """
    walls = sum(_WALLS.values(), ()) if suite == ALL else _WALLS[suite]
    found = chosen(walls, only, suite)
    return found[:1] if quick else found


BEST = "best"

STRIP_SECONDS = 3
"""For each strip of the yardstick."""

ABOUT = {
    PAPER: "the paper's method as it is (Algorithm 2)",
    **dict.fromkeys(BUILT_IN, "the paper's method, but this policy chooses the stones"),
    BEST: "one pass of the default method, on outlines: no search",
    STRIPS: "no policy but a yardstick, F_SF alone: strips packed without gravity (extra `bench`)",
}
"""What each does; docs/for-researchers.md explains the policies."""


def known_methods() -> dict[str, str]:
    """Return what each method does by name, those of other packages last."""
    others = {entry.name for entry in entry_points(group=GROUP)} - {*ABOUT, *RULES}
    return ABOUT | dict.fromkeys(sorted(others), "a policy of another package that is installed")


def method_named(name: str, changes: Changes = ()) -> tuple[str, Changes]:
    """Return the method of runs, and the settings that replace its own.

    >>> method_named("lowest", (("sampling", "full"),))
    ('paper', (('selection_rule', 'lowest'), ('sampling', 'full')))
    """
    if name == STRIPS:
        # No setting of a planner means anything to it.
        return STRIPS, (("seconds", STRIP_SECONDS),)
    if name == BEST:
        method, own = "best", dict[str, Scalar]({"search.budget": 1})
    else:
        if name not in (known := known_methods()):
            raise no_policy(name, tuple(known))
        method, own = "paper", {} if name == PAPER else {"selection_rule": rule_of(name)}
    merged = tuple((own | dict(changes)).items())
    method_settings(method).updated(settings_of(merged))  # E123 for what there is not
    return method, merged


def flat_changes(settings: Mapping[str, Any], where: str) -> Changes:
    """Return settings from a TOML file as changes of every method.

    >>> flat_changes({"sampling": "full", "placement": {"beta": 0.5}}, "full.toml")
    (('placement.beta', 0.5), ('sampling', 'full'))
    """
    for name in ("selection_rule", "ban", "pin"):
        if name in settings:
            what = f"{name} cannot be the same for all methods and walls."
            cure = "Leave it out; --policy names who chooses the stones."
            raise UsageError("E138", what, where=where, cure=cure)
    return changes_of(settings)
