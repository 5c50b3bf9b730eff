from dataclasses import fields, replace

import pytest

from drystone.planner.settings import method_settings
from drystone_lab.runs import spec as spec_module
from drystone_lab.runs.spec import RunSpec, StoneSource
from tests.lab.runs.bricks import SOURCE

SPEC = RunSpec(source=SOURCE, width=60, height=20)
OTHERS = {
    "source": replace(SOURCE, seed=2),
    "width": 61.0,
    "height": 21.0,
    "scale": 0.5,
    "method": "best",
    "changes": (("placement.beta", 0.5),),
    "seed": 1,
}
OTHER_SOURCES = {
    "kind": "rubble",
    "name": "a.png",
    "seed": 2,
    "settings": (("count", 7),),
}


def test_every_field_is_tried() -> None:
    assert set(OTHERS) == {field.name for field in fields(RunSpec)}
    assert set(OTHER_SOURCES) == {field.name for field in fields(StoneSource)}


@pytest.mark.parametrize("name", OTHERS)
def test_the_key_changes_with_a_field(name: str) -> None:
    assert replace(SPEC, **{name: OTHERS[name]}).key != SPEC.key


@pytest.mark.parametrize("name", OTHER_SOURCES)
def test_the_key_changes_with_a_field_of_the_source(name: str) -> None:
    source = replace(SOURCE, **{name: OTHER_SOURCES[name]})
    assert replace(SPEC, source=source).key != SPEC.key


def test_the_key_changes_with_the_version(monkeypatch: pytest.MonkeyPatch) -> None:
    before = SPEC.key
    monkeypatch.setattr(spec_module, "version", lambda _: "0.0.0")
    assert SPEC.key != before


def test_equal_runs_have_equal_keys() -> None:
    as_floats = RunSpec(source=SOURCE, width=60.0, height=20.0, scale=1)
    assert as_floats == SPEC
    assert as_floats.key == SPEC.key
    one, other = ("mu", 0.5), ("placement.beta", 0.5)
    assert replace(SPEC, changes=(one, other)).key == replace(SPEC, changes=(other, one)).key
    # What the method has anyway: walls of several items of the paper are planned once.
    usual = (("orientations", "quarter"), ("placement.beta", 0.7))
    assert replace(SPEC, changes=usual).key == SPEC.key


def test_changes_replace_settings_and_leave_the_others() -> None:
    changed = replace(SPEC, changes=(("placement.beta", 0.5), ("mu", 0.4))).settings()
    default = method_settings("paper")
    assert (changed.placement.beta, changed.mu) == (0.5, 0.4)
    assert replace(changed, mu=default.mu, placement=default.placement) == default
    assert SPEC.settings() == default


@pytest.mark.parametrize(
    ("spec", "line"),
    [
        (SPEC, "brick 1, 60 x 20 px at 1, paper, seed 0"),
        (
            RunSpec(source=StoneSource(kind="published", name="a/R.png"), changes=(("mu", 0.4),)),
            "a/R.png, own size at 1, paper, mu = 0.4, seed 0",
        ),
    ],
)
def test_in_a_line(spec: RunSpec, line: str) -> None:
    assert str(spec) == line
