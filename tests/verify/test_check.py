import json
from dataclasses import fields, replace

import numpy as np
import pytest

from drystone.errors import PlanError
from drystone.io.plan_json import plan_from_json, plan_to_json
from drystone.model.plan import PlanMetrics
from drystone.model.stone import Source, StoneSet
from drystone.search import plan_result
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from drystone.verify import check, claims
from drystone.verify.check import PrefixAlpha, check_plan
from drystone.verify.replay import PENETRATION_PX, rebuild_wall
from tests.planner.scenes import read_again
from tests.verify.exact_examples import GAP_PX, block_model, exact_example, hanging_example
from tests.verify.examples import L_STONE, SLAB, WEDGE, example
from tests.verify.tampering import changed, codes, moved, reshaped, step_of, swapped, without

WHOLE = {"raster": example(), "exact": exact_example()}
# Plans may leave out what they claim without dilatancy.
NOTHING = dict.fromkeys(("F_LR_coulomb", "alpha_left_coulomb", "alpha_right_coulomb"))
MADE = {
    name: replace(made, plan=replace(made.plan, metrics=replace(made.plan.metrics, **NOTHING)))
    for name, made in WHOLE.items()
}
TRUE, EXACT = MADE.values()


@pytest.fixture(autouse=True)
def _flow_rules(request, monkeypatch):
    """Look for answers without dilatancy, which takes most of the time, in two tests only."""
    if request.function not in (test_true_plan_passes, test_every_metric_is_verified):
        monkeypatch.setattr(plan_result, "MOST_WITHOUT_DILATANCY", 0)


@pytest.fixture(params=MADE.values(), ids=MADE)
def either(request):
    return request.param


@pytest.mark.parametrize("make", [example, exact_example])
@pytest.mark.parametrize(("scale", "px_per_m"), [(1.0, None), (1.0, 137.0), (0.5, 211.3)])
def test_true_plan_passes(make, scale, px_per_m):
    """In any unit and at any scale."""
    made = make(scale, px_per_m)
    plan, labels = read_again(made.plan), made.wall.labels
    blocks = block_model(made) if make is exact_example else None
    report = check_plan(plan, made.stones, wall_labels=labels, blocks=blocks)
    assert (report.ok, report.problems, report.notes) == (True, (), ())
    assert report.overlap_depth < 1e-9
    assert report.area_error == 0
    assert report.prefixes[0].alpha_left == pytest.approx(0.58)  # a square block slides
    assert [prefix.step for prefix in report.prefixes] == [1, 2, 4, 5, 6]
    found = rebuild_wall(plan, made.stones)
    np.testing.assert_array_equal(found.labels, labels)
    assert found.site == made.wall.site
    assert [p.side for p in found.placements] == [p.side for p in made.wall.placements]
    (mine,), (its,) = found.wedges, made.wall.wedges
    assert (mine.id, mine.under, mine.row, mine.col) == (WEDGE, SLAB, its.row, its.col)
    np.testing.assert_array_equal(mine.mask, its.mask)
    assert (mine.corners is None) == (make is example)
    if make is exact_example:
        # Lengths that were in metres are rounded.
        assert np.abs(mine.corners - its.corners).max() < 1e-9
        for one, other in zip(found.placements, made.wall.placements, strict=True):
            assert np.abs(one.settled.corners - other.settled.corners).max() < 1e-9
        assert report.geometry == report.as_dict()["geometry"] == "exact"
        assert (report.overlap_depth, report.overlap_depth_at, report.buried) == (0.0, None, ())
        assert report.metrics.F_LR_half == pytest.approx(1.0)  # blocks slide before they tip


def setting(plan, **values):
    return replace(plan, settings={**plan.settings, **values})


def top(polygon, x, y):
    """A shift of its rightmost corners by x, and of its uppermost by y."""
    return (polygon == polygon.max(axis=0)) * (x, y)


def foot(polygon, x, y):
    """A shift of its leftmost corners by x, and of its lowest by y."""
    return (polygon == polygon.min(axis=0)) * (x, y)


# What is changed in plans of either geometry, and the codes that name it: exactly these.
ONLY_BOTH = {
    "unused stone missing": (lambda p: replace(p, unused=()), {"E216"}),
    "settings": (lambda p: setting(p, wings=2), {"E217"}),
    "source centroid": (lambda p: changed(p, 3, source_centroid=(12.0, 13.5)), {"E225"}),
    "alpha of a stone": (lambda p: changed(p, 3, alpha_left=0.580001), {"E231"}),
    "cluster": (lambda p: changed(p, 3, cluster=77), {"E233"}),
}  # fmt: skip

# Changes with more than one consequence: these codes are among those found.
AMONG_BOTH = {
    "stone lifted by 1 px": (lambda p: moved(p, L_STONE, 0, 1), {"E230", "E236"}),
    "stone turned by 180 degrees": (lambda p: changed(p, L_STONE, angle_deg=-90.0), {"E236"}),
    "ids of equal boxes swapped": (lambda p: swapped(p, L_STONE, 300), {"E225", "E236"}),
    "stone that is not there": (lambda p: changed(p, 3, stone=4), {"E212", "E216"}),
    "stone used twice": (lambda p: changed(p, 300, stone=3), {"E213", "E216"}),
    "side": (lambda p: changed(p, 300, side="left"), {"E232"}),
    "wedge left out": (lambda p: without(p, WEDGE), {"E230", "E234", "E236"}),
    "wedge with a stone's id": (lambda p: changed(p, WEDGE, id=9), {"E213", "E236"}),
    "friction": (lambda p: setting(p, mu=0.3), {"E231", "E234"}),
    "one-sided": (lambda p: setting(p, two_sided=False), {"E235"}),
    "wall wider": (lambda p: replace(p, width=90.0), {"E234", "E236"}),
}  # fmt: skip


ONLY_RASTER = {
    "another digest": (lambda p: replace(p, source={**p.source, "sha256": "0" * 64}), {"E210"}),
    "number of stones": (lambda p: replace(p, source={**p.source, "stones": 7}), {"E211"}),
    "image height": (lambda p: replace(p, source={**p.source, "height_px": 7}), {"E211"}),
    "image width": (lambda p: replace(p, source={**p.source, "width_px": 7}), {"E211"}),
    "file names": (lambda p: replace(p, source={**p.source, "files": ["a.png"]}), {"E211"}),
    "step number": (lambda p: changed(p, SLAB, step=9), {"E214"}),
    "alpha before the wedge": (lambda p: changed(p, SLAB, alpha_left=0.5), {"E214"}),
    "used stone listed": (lambda p: replace(p, unused=(9, 3)), {"E216"}),
    "stone 1 px left of the wall": (lambda p: moved(p, 3, -1, 0), {"E220"}),
    "stone 1 px below the ground": (lambda p: moved(p, 5, 0, -1), {"E220"}),
    "stone above the top": (lambda p: moved(p, SLAB, 0, 5), {"E220"}),
    "stone 1 px into another": (lambda p: moved(p, SLAB, 0, -1), {"E221"}),
    "wedge clockwise": (lambda p: reshaped(p, lambda points: points[::-1]), {"E222"}),
    "wedge without pixels": (lambda p: reshaped(p, lambda w: w[0] + (w - w[0]) / 99), {"E222"}),
    "wedge far outside": (lambda p: reshaped(p, lambda points: points + 1e9), {"E220"}),
    "rotation moves": (lambda p: changed(p, 3, rotation_moves=1), {"E235"}),
    "too many rotation moves": (lambda p: changed(p, 3, rotation_moves=99), {"E235"}),
    "course height of an inner stone": (lambda p: changed(p, L_STONE, course_height=9.0), {"E232"}),
    "course height left out": (lambda p: changed(p, 3, course_height=None), {"E232"}),
}  # fmt: skip


AMONG_RASTER = {
    "stone moved by 1 px": (lambda p: moved(p, SLAB, 1, 0), {"E232", "E236"}),
    "stone turned by 3 degrees": (lambda p: changed(p, 3, angle_deg=3.0), {"E235", "E236"}),
    "wedge under another stone": (lambda p: changed(p, WEDGE, under=3), {"E214"}),
    "wedge too thin": (lambda p: reshaped(p, lambda w: w - top(w, 0, 3)), {"E223", "E224"}),
    "wedge hanging": (lambda p: reshaped(p, lambda w: w + foot(w, 0, 1)), {"E223"}),
    "wedge a pixel narrower": (lambda p: reshaped(p, lambda w: w - top(w, 1, 0)), {"E234", "E236"}),
    "wedge polygon off the grid": (lambda p: reshaped(p, lambda w: w - top(w, 0.3, 0)), {"E222"}),
    "largest wedge": (lambda p: setting(p, stabilise={"max_wedge_height": 0.1}), {"E224"}),
    "working scale": (lambda p: replace(p, working_scale=0.5), {"E236"}),
}  # fmt: skip


ONLY_EXACT = {
    "stone left of the wall": (lambda p: moved(p, 3, -0.31, 0), {"E220"}),
    "stone in the ground": (lambda p: moved(p, 5, 0, -0.07), {"E220"}),
    "stone right of the wall": (lambda p: moved(p, 300, 0.31, 0), {"E220"}),
    "stone above the top": (lambda p: moved(p, SLAB, 0, 4.3), {"E220"}),
    "stone turned into another": (
        lambda p: changed(p, SLAB, angle_deg=181.0, rotation_moves=1), {"E221"}),
    "wedge .2 px into its stone": (lambda p: reshaped(p, lambda w: w - (0, -0.2)), {"E221"}),
    "wedge clockwise": (lambda p: reshaped(p, lambda w: w[::-1]), {"E222"}),
    "wedge that crosses itself": (lambda p: reshaped(p, lambda w: w[[0, 2, 1, 3]]), {"E222"}),
    "wedge without area": (lambda p: reshaped(p, lambda w: w * (1, 0)), {"E222"}),
    "wedge too small": (lambda p: setting(p, wedge={"height": 0.4, "thickness": 0.5}), {"E224"}),
    "wedge too high": (lambda p: setting(p, wedge={"height": 0.1}), {"E224"}),
    "two rotation moves": (lambda p: changed(p, 3, rotation_moves=2), {"E235"}),
    "a turn that is none": (
        lambda p: changed(setting(p, stabilise={"method": "wedge"}), 3, rotation_moves=1),
        {"E235"}),
}  # fmt: skip


AMONG_EXACT = {
    "stone lifted beyond the tolerance": (lambda p: moved(p, 300, 0, 0.11), {"E230"}),
    "stone lifted within the tolerance": (lambda p: moved(p, 300, 0, 0.06), {"E234"}),
    "stone turned by 1 degree": (lambda p: changed(p, 3, angle_deg=1.0), {"E235"}),
    "stone turned further than it may": (
        lambda p: changed(p, 3, angle_deg=12.1, rotation_moves=1), {"E235"}),
    "wedge too low": (lambda p: reshaped(p, lambda w: w - top(w, 0, 0.2)), {"E223", "E230"}),
    "wedge hanging": (lambda p: reshaped(p, lambda w: w + foot(w, 0, 0.2)), {"E223"}),
    "wedge elsewhere": (lambda p: reshaped(p, lambda w: w - (12, 0)), {"E223", "E230", "E236"}),
    "contact tolerance": (
        lambda p: setting(p, settle={"contact_px": GAP_PX / 2, "clearance_px": GAP_PX / 8}),
        {"E223", "E230"}),
    "raster": (lambda p: setting(p, geometry="raster"), {"E234"}),
    "unit of length": (lambda p: replace(p, px_per_m=2.0, length_unit="m"), {"E230"}),
}  # fmt: skip


WAYS = {
    ("raster", "only"): ONLY_RASTER,
    ("exact", "only"): ONLY_BOTH | ONLY_EXACT,
    ("raster", "among"): AMONG_BOTH | AMONG_RASTER,
    ("exact", "among"): AMONG_BOTH | AMONG_EXACT,
}


@pytest.mark.parametrize(("way", "name"), [(way, name) for way in WAYS for name in WAYS[way]])
def test_tampering_is_caught_by_its_code(way, name):
    made, (change, expected), only = MADE[way[0]], WAYS[way][name], way[1] == "only"
    labels = None if only else made.wall.labels
    report = check_plan(change(made.plan), made.stones, wall_labels=labels)
    assert codes(report) == expected if only else codes(report) >= expected


def test_stones_that_the_settings_do_not_allow_are_named():
    def found(steps=TRUE.plan.steps, **choice):
        plan = replace(TRUE.plan, settings={**TRUE.plan.settings, **choice}, steps=steps)
        return [str(problem) for problem in check_plan(plan, TRUE.stones).problems]

    assert found(order="given", ban=[9]) == found(pin=[9]) == []  # it may be missing
    assert found(ban=[9, SLAB]) == [f"E239 step 3: stone {SLAB} is banned."]
    first, second, *others = TRUE.plan.steps
    said = "E239 step 1: stone 3 comes after stone 5 in an order that is given."
    problems = found((second, first, *others), order="given")
    assert [one for one in problems if "E239" in one] == [said]


def test_what_is_claimed_and_cannot_be_is_said_in_words():
    plan = changed(TRUE.plan, WEDGE, alpha_right=None)
    plan = replace(plan, metrics=replace(plan.metrics, F_LR_half=0.5))
    metric, load = check_plan(plan, TRUE.stones).problems
    assert (load.code, load.message[:37]) == ("E231", "alpha_right is null by the plan, 0.58")
    said = "F_LR_half is 0.5 by the plan, but there is no such value."
    assert (metric.code, metric.message) == ("E234", said)
    # Metrics beyond the contract may be left out.
    data = plan_to_json(TRUE.plan)
    del data["metrics"]["T_LEVEL"], data["metrics"]["E_FLUSH"]
    assert check_plan(plan_from_json(data), TRUE.stones).ok


def test_every_index_is_verified(either):
    step, names = step_of(either.plan, SLAB), ["SF", "LFR", "GDS", "NHR", "IWR", "IS", "LLC"]
    for by, said in ((1e-8, names), (1e-11, [])):
        # LLC by what two solvers may not differ.
        claims = {n: v + by * (100 if n == "LLC" else 1) for n, v in step.indices.items()}
        report = check_plan(changed(either.plan, SLAB, indices=claims), either.stones)
        assert [problem.message.split()[0] for problem in report.problems] == said
        assert all((p.code, p.step) == ("E232", step.step) for p in report.problems)


@pytest.mark.parametrize("either", WHOLE.values(), ids=WHOLE)
def test_every_metric_is_verified(either):
    exact = either.plan.settings["geometry"] == "exact"
    claims = {}
    for field in fields(PlanMetrics):
        value = getattr(either.plan.metrics, field.name)
        # A wall of pixels has no contact tolerance: its plan may not claim what comes of others.
        claims[field.name] = 0.5 if value is None else value + 1e-6 * max(1.0, value)
        if field.name.endswith("_coulomb") and not exact:
            # The least that is found: a plan may know of less, not claim more.
            claims[field.name] = 9.0
    assert check_plan(either.plan, either.stones).ok
    plan = replace(either.plan, metrics=replace(either.plan.metrics, **claims))
    problems = check_plan(plan, either.stones).problems
    assert {problem.code for problem in problems} == {"E234"}
    assert [problem.message.split()[0] for problem in problems] == list(claims)


def test_wall_image_of_another_wall_is_caught(either):
    mirrored, painted = either.wall.labels.copy(), either.wall.labels.copy()
    window = next(p.window for p in either.wall.placements if p.stone_id == L_STONE)
    mirrored[window] = mirrored[window][:, ::-1]
    painted[0, 0] = 555
    step = step_of(either.plan, L_STONE).step
    for labels, where in ((mirrored, step), (painted, None), (painted[:-1], None)):
        report = check_plan(either.plan, either.stones, wall_labels=labels)
        assert [(p.code, p.step) for p in report.problems] == [("E236", where)]


def test_steps_after_a_broken_one_are_said_to_be_unchecked():
    report = check_plan(moved(TRUE.plan, SLAB, 0, -1), TRUE.stones)
    assert (report.metrics, [prefix.step for prefix in report.prefixes]) == (None, [1, 2])
    assert any("From step 3 on" in note for note in report.notes)
    data = json.loads(json.dumps(report.as_dict()))
    assert list(data)[:3] == ["ok", "problems", "overlap_depth"]
    assert data["ok"] is False
    assert data["problems"][0].keys() == {"code", "step", "message"}


def test_overlap_and_area_of_real_outlines_are_reported_and_no_problem_is_made_of_them():
    for deep, at in ((1 / 256, None), (0.25, (3, SLAB))):  # the same pixels
        report = check_plan(moved(TRUE.plan, SLAB, 0, -deep), TRUE.stones)
        assert (report.ok, report.overlap_depth_at) == (True, at)
    assert report.overlap_depth == pytest.approx(0.25)
    reduced = example(0.5)  # the depth is in source px
    report = check_plan(moved(reduced.plan, SLAB, 0, -0.25), reduced.stones)
    assert report.overlap_depth == pytest.approx(0.25)
    # A square of 20 px on its tip, its centre on a pixel corner: 2 (2 + 4 + ... + 28) px.
    turned = check_plan(changed(TRUE.plan, 3, angle_deg=45.0), TRUE.stones)
    assert (turned.area_error_at, turned.area_error) == (3, pytest.approx(420 / 400 - 1))


def test_stone_that_cannot_be_lowered_in_is_listed(either):
    below_the_slab = moved(either.plan, 300, 22 - 74, 0)
    for plan, buried in ((either.plan, ()), (below_the_slab, (300,))):
        assert check_plan(plan, either.stones).buried == buried


def test_wall_in_the_air_does_not_stand(either):
    alone = moved(replace(either.plan, steps=either.plan.steps[:1]), 3, 0, 1)
    report = check_plan(alone, either.stones)
    (problem,) = (p for p in report.problems if p.code == "E230")
    assert problem.message == "nothing of the wall stands on the ground."
    assert report.prefixes == (PrefixAlpha(1, None, None),)


def test_empty_plan_is_checked_and_one_of_no_image_is_refused(either):
    ids = tuple(stone.id for stone in either.stones)
    for level, found in ((None, []), (0.0, []), (0.1, ["E234"])):  # earlier plans said 0
        empty = PlanMetrics(0.0, None, None, None, level, level and 0.0, None, None, 0.0)
        plan = replace(either.plan, steps=(), unused=ids, metrics=empty)
        report = check_plan(plan, either.stones)
        assert ([*codes(report)], report.area_error_at) == (found, None)
    for size in (1e12, 0.1):
        with pytest.raises(PlanError, match="E215"):
            check_plan(replace(plan, width=size), either.stones)


def test_other_stones_are_reported_and_those_without_digest_are_not_compared():
    report = check_plan(TRUE.plan, StoneSet((), Source("none.png", "00" * 32, 1, 1)))
    assert codes(report) >= {"E210", "E211", "E212", "E216"}
    stones = replace(TRUE.stones, source=replace(TRUE.stones.source, sha256=""))
    report = check_plan(TRUE.plan, stones, wall_labels=TRUE.wall.labels)
    (note,) = report.notes
    assert report.ok
    assert "digest" in note


def test_what_the_solver_finds_is_said(monkeypatch):
    gave_up = "the solver gave up, and it is not known whether the wall stands"
    for status, side, from_call, said in (
        (LimitStatus.FAILED, "left", 0, gave_up),
        (LimitStatus.FAILED, "right", 3, gave_up),  # of the sturdy models
        (LimitStatus.UNBOUNDED, "left", 0, None),
        (LimitStatus.UNSTABLE, "left", 0, "the wall does not stand: left unstable."),
        (LimitStatus.UNSTABLE, "right", 0, "the wall does not stand: right unstable."),
    ):
        models = []

        def analyse(model, end=(status, side), after=from_call, seen=models):
            seen.append(model)
            status, side = end
            both = lateral_resistance(model)
            other = replace(getattr(both, side), status=status, alpha=None)
            return both if len(seen) <= after else replace(both, **{side: other})

        for place in (check, claims):
            monkeypatch.setattr(place, "lateral_resistance", analyse)
        problems = check_plan(EXACT.plan, EXACT.stones).problems
        told = [(p.code, p.message) for p in problems if p.code in ("E230", "E237")]
        assert bool(told) == (said is not None)
        assert all(code == "E230" and said in message for code, message in told)


def test_penetration_is_allowed_up_to_a_limit():
    for into, allowed in ((0.04, True), (0.06, False)):
        report = check_plan(moved(EXACT.plan, SLAB, 0, -GAP_PX - into), EXACT.stones)
        assert ("E221" not in codes(report), into <= PENETRATION_PX) == (allowed, allowed)
        assert report.overlap_depth == pytest.approx(into, abs=1e-6)
        assert report.overlap_depth_at in {(3, SLAB), (SLAB, WEDGE)}
    # What lies in a stone that lies in another is named too.
    lowered = moved(EXACT.plan, SLAB, 0, -0.2)
    x, y = step_of(lowered, SLAB).centroid
    plan = changed(lowered, 300, centroid=(x + 24.0, y))
    said = [p for p in check_plan(plan, EXACT.stones).problems if p.code == "E221"]
    for stone, other in ((SLAB, 3), (300, SLAB)):
        mine = [p.message for p in said if p.step == step_of(plan, stone).step]
        assert any(f"source px deep in stone {other}." in message for message in mine)


def test_depth_and_edges_are_said_in_source_px_and_of_wedges_too():
    made = exact_example(0.5, 200.0)
    report = check_plan(reshaped(made.plan, lambda w: w - (0, 1.2 / 200)), made.stones)
    assert report.overlap_depth == pytest.approx(1.2 - GAP_PX, abs=1e-6)
    assert report.overlap_depth_at == (5, WEDGE)
    (problem,) = (p for p in report.problems if p.code == "E221")
    assert "1.19 source px deep in stone 5" in problem.message
    assert problem.step == step_of(made.plan, WEDGE).step
    made = exact_example(0.5)
    (problem,) = check_plan(moved(made.plan, 300, 0.75, -0.25), made.stones).problems
    assert problem.code == "E220"
    assert "0.24 px below the ground, 0.75 px right of the right" in problem.message


def test_stone_that_hangs_between_others_does_not_stand():
    # As near to its neighbours as contacts are, with nothing below it.
    report = check_plan(moved(EXACT.plan, L_STONE, 2.0 - GAP_PX, 3.0), EXACT.stones)
    step = step_of(EXACT.plan, L_STONE).step
    assert "E230" in {p.code for p in report.problems if p.step == step}
    assert PrefixAlpha(step, None, None) in report.prefixes
    # One that only friction on upright faces holds is named too.
    hanging = hanging_example()
    problems = check_plan(hanging.plan, hanging.stones).problems
    assert [(problem.code, problem.step) for problem in problems] == [("E237", 3)]
