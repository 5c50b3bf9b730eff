import hashlib

import pytest

from drystone.errors import UsageError
from drystone_lab.public import suites
from drystone_lab.public.suites import flat_changes, method_named, walls_of

FIXED = {1: "04f156b565ce5721"}
"""By version: of everything that makes the walls of all suites, and of the area of the stones that
the generators make of it.  A new version is a new line.
"""


def test_nothing_changes_without_a_new_version():
    made = ("kind", "name", "seed", "settings")
    text = repr([
        (wall.suite, wall.name, *(getattr(wall.source, name) for name in made),
         float(wall.width), float(wall.height), wall.scale,
         wall.source.kind != "published" and wall.source.stones(None).total_area_px)
        for wall in walls_of("all")
    ])  # fmt: skip
    assert hashlib.sha256(text.encode()).hexdigest()[:16] == FIXED[suites.SUITE_VERSION]


def test_all_walls_and_some_alone():
    names = {suite: [wall.name for wall in walls_of(suite)] for suite in suites.PUBLIC_SUITES}
    some = [wall.name for wall in walls_of("fourier", ["fourier 60"])]
    assert some == ["fourier 60 round", "fourier 60 long"]
    assert [wall.name for wall in walls_of("sizes", quick=True)] == ["sizes 20"]
    with pytest.raises(UsageError, match=r"E138.*rubble"):
        walls_of("sizes", ["sizes 20", "rubble"])
    every = names.pop("all")
    assert len(set(every)) == len(every)
    assert [name for part in names.values() for name in part] == every
    assert all(wall.suite in suites.PUBLIC_SUITES for wall in walls_of("all"))


def settings_of(name, changes=()):
    method, merged = method_named(name, changes)
    return walls_of("bricks")[0].run(3, *merged, method=method).settings()


def test_only_the_choice_differs_and_settings_are_replaced_for_all_alike():
    paper = settings_of("paper")
    for name in ("random", "lowest", "scalarised", "filter", "towers"):
        own = settings_of(name)
        assert own.selection_rule == name
        assert own.updated({"selection_rule": "algorithm2"}) == paper
    best = settings_of("best")
    assert (best.geometry, best.search.budget, best.selection_rule) == ("exact", 1, "score")
    changes = flat_changes({"sampling": "full", "placement": {"beta": 0.5}}, "x.toml")
    for name in ("paper", "random", "best"):
        settings = settings_of(name, changes)
        assert (settings.sampling, settings.placement.beta) == ("full", 0.5)


@pytest.mark.parametrize(
    ("ask", "code"),
    [
        (lambda: flat_changes({"selection_rule": "random"}, "x.toml"), "E138"),
        (lambda: flat_changes({"ban": [3]}, "x.toml"), "E138"),
        (lambda: flat_changes({"pin": [1]}, "x.toml"), "E138"),
        (lambda: method_named("nobody"), "E146"),
        (lambda: method_named("paper", (("placement.gamma", 1.0),)), "E123"),
    ],
)
def test_settings_and_methods_that_are_refused(ask, code):
    with pytest.raises(UsageError, match=code):
        ask()
