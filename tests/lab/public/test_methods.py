"""Methods of the public benchmark."""

import pytest

from drystone.errors import UsageError
from drystone_lab.public.suites import flat_changes, method_named, walls_of

WALL = walls_of("bricks")[0]


def test_only_the_choice_differs():
    paper = method_named("paper").run(WALL, 3).settings()
    for name in ("random", "lowest", "scalarised", "filter", "towers"):
        own = method_named(name).run(WALL, 3).settings()
        assert own.selection_rule == name
        assert own.updated({"selection_rule": "algorithm2"}) == paper


def test_best_is_one_pass_on_outlines():
    best = method_named("best").run(WALL, 3).settings()
    assert (best.geometry, best.search.budget, best.selection_rule) == ("exact", 1, "score")


def test_settings_are_replaced_for_all_alike():
    changes = flat_changes({"sampling": "full", "placement": {"beta": 0.5}}, "x.toml")
    for name in ("paper", "random", "best"):
        settings = method_named(name, changes).run(WALL, 0).settings()
        assert (settings.sampling, settings.placement.beta) == ("full", 0.5)


@pytest.mark.parametrize("nested", [{"selection_rule": "random"}, {"ban": [3]}, {"pin": [1]}])
def test_settings_that_cannot_be_the_same(nested):
    with pytest.raises(UsageError) as caught:
        flat_changes(nested, "x.toml")
    assert caught.value.code == "E138"


def test_what_does_not_exist():
    with pytest.raises(UsageError) as caught:
        method_named("nobody")
    assert caught.value.code == "E146"
    with pytest.raises(UsageError) as caught:
        method_named("paper", (("placement.gamma", 1.0),))
    assert caught.value.code == "E123"
