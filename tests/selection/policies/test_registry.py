"""Policies by name, also those of other packages."""

from importlib.metadata import EntryPoint, EntryPoints

import pytest

from drystone.errors import UsageError
from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.policies import registry
from drystone.selection.policies.registry import BUILT_IN, GROUP, policy_named, rule_of
from drystone.selection.policies.settings import PolicySettings


class First:
    """A policy of another package."""

    def choose(self, candidates, rng): ...


class NeedsMore(First):
    def __init__(self, more): ...


@pytest.fixture
def installed(monkeypatch):
    """Pretend that packages with some entry points are installed."""

    def install(*given):
        points = EntryPoints(EntryPoint(name, value, GROUP) for name, value in given)
        monkeypatch.setattr(registry, "entry_points", points.select)

    return install


def named(name):
    return policy_named(name, PolicySettings(), SelectionSettings())


HERE = __name__


def test_those_built_in_and_those_of_other_packages_are_there(installed):
    ours = f"{HERE}:First"
    installed(("first", ours), ("other", "nowhere:Other"), ("random", ours))
    assert [rule_of(name) for name in (*BUILT_IN, "first")] == [*BUILT_IN, "first"]
    assert rule_of("paper") == "algorithm2"
    policy = named("first")
    assert type(policy).__name__ == "First"
    assert named("first") is not policy  # it is made anew
    # Names of ours cannot be taken.
    assert type(named("random")).__module__.startswith("drystone.")
    with pytest.raises(UsageError, match="E146"):
        named("paper")  # it is the planner's own rule


@pytest.mark.parametrize("name", ["fist", "algorithm2", "score", "First", " "])
def test_unknown_ones_are_refused_with_the_known_ones(name, installed):
    installed(("first", f"{HERE}:First"), ("score", f"{HERE}:First"), ("paper", f"{HERE}:First"))
    for find in (rule_of, named):
        with pytest.raises(UsageError, match="E146") as caught:
            find(name)
        assert repr(name) in caught.value.what
        known = f"paper, {', '.join(BUILT_IN)}, first."
        asked = "Did you mean `first`? " if name in ("fist", "First") else ""
        assert caught.value.cure == f"{asked}Choose one of {known}"


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("no_such_module:First", "cannot be loaded: ModuleNotFoundError"),
        (f"{HERE}:Second", "cannot be loaded: AttributeError"),
        (f"{HERE}:NeedsMore", "cannot be loaded: TypeError"),
        (f"{HERE}:HERE", "cannot be loaded: TypeError"),
        ("builtins:dict", "has no method `choose`"),
    ],
)
def test_broken_ones_are_named(value, said, installed):
    installed(("mine", value))
    with pytest.raises(UsageError, match="E147 --policy: the policy 'mine' ") as caught:
        named("mine")
    assert said in caught.value.what


def test_a_name_in_two_packages_is_refused(installed):
    installed(("mine", f"{HERE}:First"), ("mine", "other:First"))
    with pytest.raises(UsageError, match=r"E147 .*several packages.*other:First"):
        named("mine")
    installed(("mine", f"{HERE}:First"), ("mine", f"{HERE}:First"))
    assert named("mine")
