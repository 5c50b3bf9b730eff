"""Policies by their names: those built in, and those of other packages."""

from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import entry_points

from drystone.errors import UsageError, meant
from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.policies.choices import LOWEST, Random, scalarised, thresholds, towers
from drystone.selection.policies.learned import learned
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.policies.table1 import filtered, learned_parts, parts, summed
from drystone.selection.policy import Policy, broken

GROUP = "drystone.policies"
"""Entry points of other packages: each names a class, or a function, that is called without
arguments and returns a :class:`drystone.selection.policy.Policy`."""

PAPER = "paper"
"""Name of the policy that is the planner's own Algorithm 2, with Eq. 29 between the sides."""

RULES = ("algorithm2", "score")
"""Values of `selection_rule` that are no policies."""

BUILT_IN: Mapping[str, Callable[[PolicySettings, SelectionSettings], Policy]] = {
    "random": lambda *_: Random(),
    "lowest": lambda *_: LOWEST,
    "scalarised": lambda settings, weights: scalarised(weights, settings.w_sf),
    "filter": lambda settings, _: thresholds(settings),
    "towers": lambda settings, _: towers(settings),
    "learned": lambda *_: learned(),
    "johns": lambda settings, _: summed(parts("johns", settings)),
    "lambert": lambda settings, _: summed(parts("lambert", settings)),
    "liu2021": lambda settings, _: filtered(parts("liu2021", settings)),
    "thangavelu": lambda settings, _: filtered(parts("thangavelu", settings), contacts=True),
    "menezes": lambda settings, _: learned(learned_parts(parts("menezes", settings))),
    "liu2018": lambda settings, _: learned(learned_parts(parts("liu2018", settings))),
}
"""Policies of this package beside the paper's, and what makes them."""


def rule_of(name: str) -> str:
    """Return the `selection_rule` that chooses by a policy; UsageError (E146): there is none."""
    if name == PAPER:
        return "algorithm2"
    if name not in BUILT_IN and (name in RULES or not entry_points(group=GROUP, name=name)):
        raise _unknown(name)
    return name


def policy_named(name: str, settings: PolicySettings, weights: SelectionSettings) -> Policy:
    """Return a new policy, one of :data:`BUILT_IN` or of an entry point.

    `weights` are those of the weighted sum.  UsageError: E146: there is none of this name; E147:
    that of another package cannot be loaded.
    """
    make = BUILT_IN.get(name)
    if make is not None:
        return make(settings, weights)
    found = () if name in (PAPER, *RULES) else tuple(entry_points(group=GROUP, name=name))
    if not found:
        raise _unknown(name)
    if len({entry.value for entry in found}) > 1:
        raise broken(name, f"is in several packages: {', '.join(sorted(e.value for e in found))}")
    try:
        policy = found[0].load()()
    except (Exception, SystemExit) as error:
        raise broken(name, f"cannot be loaded: {type(error).__name__}: {error}") from error
    if not callable(getattr(policy, "choose", None)):
        raise broken(name, f"is {policy!r}, which has no method `choose`")
    return policy  # type: ignore[no-any-return]


def _unknown(name: str) -> UsageError:
    others = {entry.name for entry in entry_points(group=GROUP)} - {PAPER, *RULES, *BUILT_IN}
    return no_policy(name, (PAPER, *BUILT_IN, *sorted(others)))


def no_policy(name: str, known: Sequence[str]) -> UsageError:
    """Return the error (E146) of a name that none of the known policies has."""
    cure = f"{meant(name, known)}Choose one of {', '.join(known)}."
    return UsageError("E146", f"there is no policy {name!r}.", where="--policy", cure=cure)
