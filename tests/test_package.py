"""The package as a whole: its names, its examples, its errors, and what is printed of it."""

import doctest
import importlib
import pkgutil
import re
from pathlib import Path

import pytest

import drystone
import drystone as ds
import drystone_lab
from drystone.errors import CODES, InputError, Notice
from drystone.model.plan import PlanMetrics
from drystone.model.stone import Source
from tests.planner.scenes import RUBBLE_SITE, rubble
from tests.statics.walls import brick_model

ROOT = Path(__file__).resolve().parents[1]
CODE = re.compile(r'(?<!`)"([EW]\d{3})"')
"""As it is written where it is raised; examples in docstrings stand in backticks."""

ROW = re.compile(r"^\| ([EW]\d{3}) \| (.+) \| (.+) \|$", re.MULTILINE)
MODULES = sorted(
    module.name
    for package in (drystone, drystone_lab)
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    if module.name != "drystone.__main__"
)


def test_every_public_name_is_there():
    for name in drystone.__all__:
        assert getattr(drystone, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'wonder'"):
        drystone.wonder  # noqa: B018


@pytest.mark.parametrize("package", ["drystone", "drystone_lab"])
def test_the_examples_of_the_docstrings_run(package):
    names = [package, *(name for name in MODULES if name.startswith(f"{package}."))]
    found = {name: doctest.testmod(importlib.import_module(name)) for name in names}
    assert [name for name, one in found.items() if one.failed] == []
    assert sum(one.attempted for one in found.values()) > 9


def test_no_two_classes_have_one_name():
    places = {}
    for path in sorted((ROOT / "src").rglob("*.py")):
        for name in re.findall(r"^ *class (\w+)[:(]", path.read_text("utf-8"), re.MULTILINE):
            places.setdefault(name, []).append(str(path.relative_to(ROOT)))
    assert len(places) > 99
    assert {name: found for name, found in places.items() if len(found) > 1} == {}


def test_every_error_code_is_explained():
    text = (ROOT / "docs" / "errors.md").read_text(encoding="utf-8")
    sections = [ROW.findall(section) for section in text.split("\n## ")[1:]]
    assert all(rows == sorted(rows) for rows in sections)
    rows = [row for section in sections for row in section]
    assert all(meaning.strip() and cure.strip() for _, meaning, cure in rows)
    assert sorted(code for code, *_ in rows) == list(CODES), "docs/errors.md and CODES differ"
    sources = [path.read_text(encoding="utf-8") for path in (ROOT / "src").rglob("*.py")]
    raised = [text.partition("\nCODES = {")[0] for text in sources]
    used = {code for text in raised for code in CODE.findall(text)}
    assert sorted(used) == list(CODES), "raised without a meaning, or with one and not raised"


def test_stones_say_how_many_and_how_large():
    one, two = (ds.Stone(i, [[True] * 4] * i, name="a.png" * (i - 1)) for i in (1, 2))
    assert repr(one) == "<Stone 1: 4 x 1 px, area 4 px²>"
    assert repr(two) == "<Stone 2 (a.png): 4 x 2 px, area 8 px²>"
    assert repr(ds.StoneSet((one, two))) == "<StoneSet: 2 stones, area 12 px²>"
    read = ds.StoneSet((one,), Source("pile.png"), (Notice("W110", "odd."),))
    assert repr(read) == "<StoneSet of pile.png: 1 stones, area 4 px², 1 notices>"


def test_a_result_says_how_it_ended_and_its_figures():
    result = ds.plan_wall(rubble(), 100, 36, scale=1.0, seed=1, budget=1)
    stones, wedges = len(result.plan.stone_steps), len(result.wall.wedges)
    figures = str(result.metrics)
    assert figures.startswith(f"F_SF {result.metrics.F_SF:.3g}, F_AV {result.metrics.F_AV:.3g}, ")
    assert figures.endswith(f"E_FLUSH {result.metrics.E_FLUSH:.3g}")
    of = len(rubble())
    assert repr(result) == f"<PlanResult {result.status}: {stones} of {of} stones, {figures}>"
    assert repr(result.wall) == f"<Wall of 100 x 36 px: {stones} stones, {wedges} wedges>"
    assert repr(result.plan) == (
        "<Plan of a wall of 100 x 36 px, best, seed 1: "
        f"{stones} stones, {wedges} wedges, {figures}>"
    )
    blocks, faces = len(result.model.blocks), len(result.model.interfaces)
    assert repr(result.model) == (
        f"<RigidBlockModel: {blocks} blocks, {faces} interfaces, mu 0.58>"
    )
    unknown = str(PlanMetrics(0.5, None, None, None, None, None, None, None, 0.0))
    assert unknown.startswith("F_SF 0.5, F_AV -, F_AH -, F_LR -, ")
    wall = brick_model(3, 3, 1.0, 0.6)
    for both in (ds.lateral_resistance(wall, mechanism=True), ds.nonassociative_resistance(wall)):
        assert both.left.forces is not None
        assert f"alpha={both.left.alpha}" in repr(both)
        assert "array" not in repr(both)


def test_a_step_says_which_stone_goes_where():
    step = next(ds.Planner(rubble(), RUBBLE_SITE, seed=1).steps())
    placement = step.action.stabilised.placement
    x_px, y_px = placement.centroid(RUBBLE_SITE.height_px)
    said = (
        f"stone {step.stone_id} turned by {placement.posed.angle_deg:.1f} deg, "
        f"{len(step.action.stabilised.wedges)} wedges"
    )
    assert repr(step) == f"<Step 1: {said}, centroid at ({x_px:.1f}, {y_px:.1f}) px>"
    assert repr(step.action) == f"<Candidate: {said}>"


def test_names_of_files_do_not_move_the_cursor():
    name = "a\nb\x1b[2J\u2028c\x85é"
    for text in (Notice("W119", name, name), InputError("E100", name, where=name, cure=name)):
        assert str(text).isprintable()
        assert "é" in str(text)
