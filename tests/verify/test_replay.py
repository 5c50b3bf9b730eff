"""The wall of a plan is built again from its settings and poses."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import PlanError
from drystone.model.placement import Placement
from drystone.model.plan import StoneStep
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.planner.settings import METHODS, PlannerSettings
from drystone.poses import PoseBook
from drystone.verify.check import check_plan
from drystone.verify.lengths import plan_settings
from drystone.verify.replay import place_stone, rebuild_wall, replay_plan
from tests.planner.scenes import read_again
from tests.strategies import repeatable, stones
from tests.verify.exact_examples import exact_example
from tests.verify.examples import SLAB, WEDGE, example
from tests.verify.tampering import changed, moved, reshaped


@repeatable(80)
@given(
    stones(stone_id=6, max_px=12),
    st.sampled_from([0.0, 90.0, -37.0, 12.3, 179.0]),
    st.sampled_from([1.0, 0.7, 0.3]),
    st.sampled_from([None, 437.0, 1e-3]),
)
def test_pose_of_a_plan_is_the_pose_of_the_planner(stone, angle_deg, scale, px_per_m):
    site = Site(40, 30, scale, px_per_m)
    placed = Placement(PoseBook(scale).pose(stone, angle_deg), 7, 11, "right", 2)
    x, y = placed.centroid(site.height_px)
    unit = site.units_per_px
    step = StoneStep(1, 6, placed.posed.angle_deg, stone.centroid, (x * unit, y * unit), "right",
                     1, 2, {}, None, None, None)  # fmt: skip
    found = place_stone(step, StoneSet((stone,)), site)
    np.testing.assert_array_equal(found.posed.mask, placed.posed.mask)
    assert (found.row, found.col, found.side, found.rotation_moves) == (7, 11, "right", 2)
    assert found.posed.anchor == placed.posed.anchor


def test_wall_size_in_metres_does_not_depend_on_rounding():
    made = example()
    for width in range(1, 400, 2):
        plan = replace(made.plan, width=width / 437.0, length_unit="m", px_per_m=437.0,
                       height=30 / 437.0, working_scale=0.5, steps=())  # fmt: skip
        assert replay_plan(plan, made.stones).site.width_px == (width + 1) // 2


@pytest.mark.parametrize(
    ("make", "said"), [(example, "80 working px"), (exact_example, "source px deep in stone 3")]
)
def test_pieces_that_overlap_stay_in_the_replay_and_the_wall_ends_before(make, said):
    made = make()
    replay = replay_plan(moved(made.plan, 5, -25, 0), made.stones)
    assert replay.broken_at == 2
    assert [p.code for p in replay.problems if p.step == 2] == ["E221"]
    assert said in replay.problems[0].message
    assert [p.stone_id for p in replay.wall.placements] == [3]
    assert len(replay.pieces) == 6
    assert 5 in replay.labels
    # One that is hidden in another has no pixel.
    made = exact_example()
    hidden = replay_plan(moved(made.plan, 300, 4 - 74, 4), made.stones)
    assert [p.code for p in hidden.problems] == ["E221"]
    assert hidden.pieces[-1].item is None


def test_wall_that_cannot_be_built_is_refused_with_the_step():
    made = exact_example()
    others = StoneSet(tuple(stone for stone in made.stones if stone.id != SLAB))
    unknown = replace(made.plan, settings={**made.plan.settings, "wings": 2})
    for said, plan, given_stones in (
        ("E212 step 3: ", made.plan, others),
        ("E217 settings: ", unknown, made.stones),
        ("E221 step 2: ", moved(made.plan, 5, -25, 0), made.stones),
    ):
        with pytest.raises(PlanError, match=f"{said}.* Correct the plan, or give its own stones"):
            rebuild_wall(plan, given_stones)


def test_the_outline_decides_whether_a_stone_is_in_the_wall():
    made = exact_example()
    plans = [
        # A wall of 84.49 px has 84 columns; a stone may fill half of the next one, and .3 px more.
        (moved(replace(made.plan, width=84.49), 300, right - 84, 0), codes)
        for right, codes in ((84.48, []), (84.52, []), (84.78, []), (84.8, ["E220"]))
    ]
    # What is huge is refused before it is drawn.
    huge = reshaped(made.plan, lambda w: w * 1e12), changed(made.plan, 3, centroid=(1e300, 10.0))
    for plan, codes in (*plans, *((plan, ["E220"]) for plan in huge)):
        assert [p.code for p in replay_plan(plan, made.stones).problems] == codes


def test_wedge_may_fill_no_pixel_and_is_a_block_nevertheless():
    made = exact_example(scale=0.1, count=3)
    assert WEDGE not in made.wall.labels
    replay = replay_plan(read_again(made.plan), made.stones)
    assert replay.problems == ()
    np.testing.assert_array_equal(replay.labels, made.wall.labels)
    assert [wedge.mask.size for wedge in replay.wall.wedges] == [0]
    # What a wedge may be does not depend on the working px.
    assert check_plan(made.plan, made.stones, wall_labels=made.wall.labels).ok


def found(settings, method="best"):
    whole = METHODS.get(method, PlannerSettings()).as_dict() | settings
    return plan_settings(replace(example().plan, method=method, settings=whole))


@pytest.mark.parametrize("method", ["paper", "best"])
def test_a_setting_out_of_range_is_the_one_of_the_plans_method(method):
    settings, (problem,) = found({"mu": -3.0, "vary": 0.1}, method)
    assert settings == replace(METHODS[method], vary=0.1)
    assert problem.code == "E217"
    assert "mu must be in (0, 1e+06], not -3.0" in problem.message
    assert f"Used instead, of the method {method!r}: mu = 0.58." in problem.message
    assert problem.message.endswith("The others are those of the plan.")
    assert found({"mu": 0.6}, method) == (replace(METHODS[method], mu=0.6), [])
    # Of a method that is not known the default is used.
    settings, (problem,) = found({"orientations": "north"}, "custom")
    assert settings == PlannerSettings()
    assert "Used instead, the package's own: orientations = 'quarter'." in problem.message


def test_unknown_ones_are_left_out_and_wrong_groups_named():
    stop = {"filling": 0.9, "wonder": 1}
    settings, (problem,) = found({"wings": 2, "stop": stop, "score": 3})
    assert settings == METHODS["best"].updated({"stop": {"filling": 0.9}})
    assert "Used instead, of the method 'best': score. " in problem.message
    assert "Left out: stop.wonder, wings." in problem.message


def test_those_that_need_each_other_are_kept_and_what_is_not_said_is_the_default():
    policy = {"selection_rule": "towers", "search": {"budget": 1}}
    assert found(policy | {"mu": -1.0})[0] == METHODS["best"].updated(policy)
    plan = replace(example().plan, method="best", settings={"search": {"budget": 1}, "mu": -1.0})
    settings, _ = plan_settings(plan)
    assert settings == PlannerSettings().updated({"search": {"budget": 1}})
    assert settings.geometry != METHODS["best"].geometry
