"""The methods of the public benchmark by name."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import entry_points
from typing import Any

from drystone.errors import UsageError
from drystone.selection.policies.registry import BUILT_IN, GROUP, PAPER, RULES, rule_of
from drystone_lab.runs.changes import Changes, flat
from drystone_lab.runs.source import generated
from drystone_lab.runs.spec import STRIPS, RunSpec
from drystone_lab.walls import Target

BEST = "best"

STRIP_SECONDS = 3
"""For each strip of the yardstick."""

ABOUT = {
    PAPER: "the paper's method as it is (Algorithm 2)",
    **dict.fromkeys(BUILT_IN, "the paper's method, with this policy choosing the stones"),
    BEST: "one pass of the default method, on outlines: no search",
    STRIPS: "no policy but a yardstick, F_SF alone: strips packed without gravity (extra `bench`)",
}
"""What each does; docs/policies.md explains the policies."""


@dataclass(frozen=True)
class BenchMethod:
    """Somebody who builds walls.

    Parameters
    ----------
    name : str
        In tables.
    method : str
        Of the planner.
    changes : tuple of (str, value)
        Settings that replace the method's.
    """

    name: str
    method: str
    changes: Changes = ()

    def run(self, wall: Target, seed: int) -> RunSpec:
        """Return the run that builds a wall."""
        return wall.run(seed, *self.changes, method=self.method)


def known_methods() -> dict[str, str]:
    """Return what each method does by name, those of other packages last."""
    others = {entry.name for entry in entry_points(group=GROUP)} - {*ABOUT, *RULES}
    return ABOUT | dict.fromkeys(sorted(others), "a policy of another package that is installed")


def method_named(name: str, changes: Changes = ()) -> BenchMethod:
    """Return a method.

    Raises
    ------
    UsageError
        E146: there is none of this name; E123: `changes` name no setting, or one is out of range.

    Examples
    --------
    >>> method_named("lowest", (("sampling", "full"),)).changes
    (('selection_rule', 'lowest'), ('sampling', 'full'))
    """
    if name == STRIPS:
        # No setting of a planner means anything to it.
        return BenchMethod(STRIPS, STRIPS, (("seconds", STRIP_SECONDS),))
    if name == BEST:
        own: Changes = (("search.budget", 1),)
        found = BenchMethod(name, "best", _merged(own, changes))
    else:
        if name not in (known := known_methods()):
            raise UsageError(
                "E146",
                f"there is no policy {name!r}.",
                where="--policy",
                cure=f"Choose one of {', '.join(known)}.",
            )
        rule = rule_of(name)
        own = () if name == PAPER else (("selection_rule", rule),)
        found = BenchMethod(name, "paper", _merged(own, changes))
    RunSpec(source=generated("brick", 0), method=found.method, changes=found.changes).settings()
    return found


def flat_changes(nested: Mapping[str, Any], where: str) -> Changes:
    """Return settings from a TOML file as changes of every method.

    Raises
    ------
    UsageError
        E138: it says who chooses the stones, or names stones: methods and walls differ in these.

    Examples
    --------
    >>> flat_changes({"sampling": "full", "placement": {"beta": 0.5}}, "full.toml")
    (('placement.beta', 0.5), ('sampling', 'full'))
    """
    for name in ("selection_rule", "ban", "pin"):
        if name in nested:
            raise UsageError(
                "E138",
                f"{name} cannot be the same for all methods and walls.",
                where=where,
                cure="Leave it out; --policy names who chooses the stones.",
            )
    return flat(nested)


def _merged(own: Changes, changes: Changes) -> Changes:
    return tuple((dict(own) | dict(changes)).items())
