"""The package as a whole: its names, its examples, its errors, and what is printed of it."""

import doctest
import importlib
import inspect
import pickle
import pkgutil
import re
from pathlib import Path

import numpy as np
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


def test_an_argument_of_the_wrong_type_is_a_type_error_that_names_it():
    names = [(ds, one) for one in ds.__all__ if one != "generate"]
    names += [(ds.generate, one) for one in ds.generate.__all__]
    public = [(one, getattr(home, one)) for home, one in names]
    functions = [value for one, value in public if one[0].islower()]
    assert len(functions) > 18
    with pytest.raises(AttributeError, match="no attribute 'wonder'"):
        ds.wonder  # noqa: B018
    for called in functions:
        first, *rest = inspect.signature(called).parameters.values()
        more = [object() for one in rest if one.default is one.empty]
        with pytest.raises(TypeError, match=f"^{first.name} must be .*, not <object"):
            called(object(), *more)
        assert pickle.dumps(called)  # it is where it says that it is
    stones, bricks = rubble(), ds.generate.BrickSettings()
    for text, called in (
        ("stones must be StoneSet, not [<Stone 1:", lambda: ds.plan_wall(list(stones), 60, 20)),
        ("width must be a number, not '60'", lambda: ds.plan_wall(stones, "60", 20)),
        ("seed must be a whole number, not True", lambda: ds.plan_wall(stones, 6, 2, seed=True)),
        ("site must be Site, not (60, 20)", lambda: ds.Planner(stones, (60, 20))),
        ("each of stones must be Stone, not 1", lambda: ds.StoneSet([1])),
        ("width_px must be a whole number, not 60.5", lambda: ds.Site(60.5, 20)),
        ("label must be a list, not 'stone'", lambda: ds.ReadSettings(label="stone")),
        ("changes must be Mapping, not None", lambda: ds.PlannerSettings().updated(None)),
        ("rng must be Generator, not '7'", lambda: ds.generate.brick_stones(bricks, "7")),
        *((f"count must be a whole number, not {wrong!r}", lambda w=wrong, make=make: make(count=w))
          for wrong in (2.5, "3") for make, _ in ds.generate.GENERATORS.values()),
        ("two_sided must be true or false, not 'no'", lambda: ds.PlannerSettings(two_sided="no")),
        *(("must be ", lambda called=called: called([[1, 1], [2]]))
          for called in (ds.read_stones, ds.measure_labels, ds.model_from_labels)),
    ):  # fmt: skip
        with pytest.raises(TypeError, match=re.escape(text)):
            called()


def test_numbers_of_numpy_are_numbers():
    wall = {"seed": np.uint8(1), "budget": np.int64(1), "n_jobs": np.int8(1), "scale": 1.0}
    plan = ds.plan_wall(rubble(), np.int64(100), np.float32(36), **wall).plan
    assert plan == ds.plan_wall(rubble(), 100, 36, seed=1, budget=1, scale=1.0).plan
    made = ds.PlannerSettings(mu=np.float64(0.5), ban=[np.uint8(3)])
    told = {"mu": np.float32(0.5), "ban": np.array([3]), "stop": {"failures": np.int64(2)}}
    for one in (made, made.updated(told)):
        assert (one.mu, one.ban, type(one.mu), type(one.ban[0])) == (0.5, (3,), float, int)
    assert made.updated(told).stop.failures == 2


@pytest.mark.parametrize("package", [drystone, drystone_lab])
def test_the_examples_of_the_docstrings_run(package):
    for name in drystone._HOMES:
        vars(drystone).pop(name, None)  # what was asked for would count as the package's own
    modules = pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    names = sorted({package.__name__, *(one.name for one in modules)} - {"drystone.__main__"})
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
    row = re.compile(r"^\| ([EW]\d{3}) \| (.+) \| (.+) \|$", re.MULTILINE)
    sections = [row.findall(section) for section in text.split("\n## ")[1:]]
    assert all(rows == sorted(rows) for rows in sections)
    rows = [row for section in sections for row in section]
    assert all(meaning.strip() and cure.strip() for _, meaning, cure in rows)
    assert sorted(code for code, *_ in rows) == list(CODES), "docs/errors.md and CODES differ"
    sources = [path.read_text(encoding="utf-8") for path in (ROOT / "src").rglob("*.py")]
    raised = "".join(text.partition("\nCODES = {")[0] for text in sources)
    # Examples in docstrings stand in backticks.
    used = set(re.findall(r'(?<!`)"([EW]\d{3})"', raised))
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
    model = result.model
    sizes = f"{len(model.blocks)} blocks, {len(model.interfaces)} interfaces"
    assert repr(model) == f"<RigidBlockModel: {sizes}, mu 0.58>"
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
