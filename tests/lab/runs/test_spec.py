"""Tests."""

from dataclasses import fields, replace

import numpy as np
import pytest
from PIL import Image

from drystone.errors import InputError
from drystone.planner.settings import method_settings
from drystone_lab.runs import spec as spec_module
from drystone_lab.runs.spec import RunSpec, StoneSource, published
from tests.lab.runs.bricks import SOURCE, picture

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
OTHER_SOURCES = {"kind": "rubble", "name": "a.png", "seed": 2, "settings": (("count", 7),)}


def test_the_key_changes_with_every_field_and_with_the_version(monkeypatch):
    assert set(OTHERS) == {field.name for field in fields(RunSpec)}
    assert set(OTHER_SOURCES) == {field.name for field in fields(StoneSource)}
    others = [replace(SPEC, **{name: value}) for name, value in OTHERS.items()]
    for name, value in OTHER_SOURCES.items():
        others.append(replace(SPEC, source=replace(SOURCE, **{name: value})))
    keys = {SPEC.key, *(other.key for other in others)}
    # Another seed of the source is among both.
    assert len(keys) == len(OTHERS) + len(OTHER_SOURCES)
    monkeypatch.setattr(spec_module, "version", lambda _: "0.0.0")
    assert SPEC.key not in keys


def test_equal_runs_have_equal_keys():
    as_floats = RunSpec(source=SOURCE, width=60.0, height=20.0, scale=1)
    assert as_floats == SPEC
    one, other = ("mu", 0.5), ("placement.beta", 0.5)
    assert replace(SPEC, changes=(one, other)).key == replace(SPEC, changes=(other, one)).key
    # What the method has anyway: walls of several items of the paper are planned once.
    usual = (("orientations", "quarter"), ("placement.beta", 0.7))
    assert replace(SPEC, changes=usual).key == SPEC.key == as_floats.key


def test_changes_replace_settings_and_leave_the_others():
    changed = replace(SPEC, changes=(("placement.beta", 0.5), ("mu", 0.4))).settings()
    default = method_settings("paper")
    assert (changed.placement.beta, changed.mu) == (0.5, 0.4)
    assert replace(changed, mu=default.mu, placement=default.placement) == default
    assert SPEC.settings() == default


def test_in_a_line():
    assert str(SPEC) == "brick 1, 60 x 20 px at 1, paper, seed 0"
    own = RunSpec(source=published("a/R.png"), changes=(("mu", 0.4),))
    assert str(own) == "a/R.png, own size at 1, paper, mu = 0.4, seed 0"


def test_published_stones_are_read_from_their_folder(tmp_path):
    source = published("set/bricks.png")
    assert not source.is_there(None)
    assert not source.is_there(tmp_path)
    picture(tmp_path / "set" / "bricks.png")
    assert source.is_there(tmp_path)
    assert len(source.stones(tmp_path)) == 6


def test_other_stones_in_the_place_of_published_ones(tmp_path):
    source = published("almeida/PR.png")
    source.check(None)
    source.check(tmp_path)  # a file that is missing is another matter
    picture(tmp_path / "almeida" / "PR.png")
    for refused in (source.check, source.stones):
        with pytest.raises(InputError, match="E160"):
            refused(tmp_path)


def test_published_pictures_may_be_read_otherwise(tmp_path):
    path = tmp_path / "one.png"
    Image.fromarray(np.full((12, 24, 4), 255, np.uint8)).save(path)
    bricks = published("one.png", copies=3).stones(tmp_path)
    assert [(stone.id, stone.mask.shape) for stone in bricks] == [(n, (12, 24)) for n in (1, 2, 3)]
    grey = np.zeros((30, 40), np.uint8)
    grey[5:15, 5:15], grey[20:28, 20:38], grey[2, 2] = 7, 9, 8
    Image.fromarray(np.dstack([grey] * 3)).save(path)
    source = published("one.png", least_px=10)
    assert [stone.id for stone in source.stones(tmp_path)] == [7, 9]
    np.testing.assert_array_equal(source.labels(tmp_path), np.where(grey == 8, 0, grey))
