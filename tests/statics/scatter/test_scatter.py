from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.errors import InputError
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from drystone.statics.scatter import scatter as scatter_module
from drystone.statics.scatter.scatter import ScatterSettings, scatter, shaken
from tests.statics.walls import boxes, brick_model, coursed, irregular
from tests.strategies import label_images, repeatable

FLAT = boxes([0, 0, 40, 10])
PAIR = boxes([0, 0, 20, 8], [0, 8, 20, 8])
NOISY = ScatterSettings(samples=24, mu=(0.4, 0.8), outline_noise=0.3, placement_noise=0.4)


def rng(seed=0):
    return np.random.default_rng(seed)


def outlines_shaken(model, count, noise=0.5):
    """The wall, shaken so often."""
    settings = ScatterSettings(outline_noise=noise)
    return [shaken(model, settings, rng(seed)) for seed in range(count)]


def test_workers_do_not_change_the_result_and_progress_is_told_after_every_sample():
    model, told = model_from_labels(coursed(3, 3, 60)).model, []

    def figures(seed, executor=None):
        found = scatter(model, NOISY, seed=seed, executor=executor, on_sample=told.append)
        arrays = (found.mu, found.alpha_left, found.alpha_right)
        return [*found.status], [array.tolist() for array in arrays]

    with ProcessPoolExecutor(2) as executor:
        assert figures(5, executor) == figures(5) != figures(6)
    assert told == [*range(1, 25)] * 3


def test_friction_is_uniform_in_its_range_and_alpha_follows_where_blocks_slide():
    found = scatter(FLAT, ScatterSettings(samples=100, mu=(0.4, 0.8)))
    assert found.alpha_left == pytest.approx(found.mu)
    assert found.value == pytest.approx(np.ones(100))
    assert found.mu.min() >= 0.4
    assert found.mu.max() <= 0.8
    assert found.mu.mean() == pytest.approx(0.6, abs=0.02)
    assert found.mu.std() == pytest.approx(0.4 / np.sqrt(12), abs=0.01)
    assert found.alpha_quantiles == pytest.approx((0.42, 0.6, 0.78), abs=0.04)
    assert found.value_quantiles == pytest.approx((1, 1, 1))


def test_nothing_shaken_is_the_wall_itself():
    model = model_from_labels(irregular(3, 12, 60, 40), 0.47).model
    found = scatter(model, ScatterSettings(samples=3))
    both = found.unshaken
    assert found.mu.tolist() == [0.47] * 3
    assert found.alpha_left == pytest.approx([both.left.alpha] * 3)
    assert found.alpha_right == pytest.approx([both.right.alpha] * 3)
    assert found.alpha.tolist() == np.minimum(found.alpha_left, found.alpha_right).tolist()


def test_every_interface_may_have_a_friction_of_its_own():
    model = brick_model(3, 3, 1.0, 0.58)
    smooth = replace(model.interfaces[0], mu=0.0)
    model = replace(model, interfaces=(smooth, *model.interfaces[1:]))
    settings = ScatterSettings(mu=(0.4, 0.8), mu_per_interface=True)
    wall = shaken(model, settings, rng())
    first, *others = (interface.mu for interface in wall.interfaces)
    assert first == 0.0
    assert len(set(others)) == len(others)
    assert 0.4 <= min(others) < max(others) <= 0.8
    assert wall.mu == pytest.approx(np.mean(others))
    whole = shaken(model, replace(settings, mu_per_interface=False), rng())
    assert [interface.mu for interface in whole.interfaces] == [0.0] + [None] * len(others)
    assert 0.4 < whole.mu < 0.8


@given(seed=st.integers(0, 10**6), noise=st.sampled_from([0.5, 2.0, 30.0]))
@repeatable(30)
def test_flush_blocks_laid_out_of_place_touch_where_they_overlap(seed, noise):
    wall = shaken(PAIR, ScatterSettings(placement_noise=noise), rng(seed))
    (x1, y1), (x2, y2) = (block.centroid for block in wall.blocks)
    assert (x1, y1) != (10, 4)
    ground, joint = wall.interfaces
    assert np.sort(ground.points, axis=0).ravel() == pytest.approx([x1 - 10, 0, x1 + 10, 0])
    left, right = max(x1, x2) - 10, min(x1, x2) + 10
    if left > right:  # they still touch, at a point
        left = right = (left + right) / 2
    between = 8 + ((y1 - 4) + (y2 - 12)) / 2
    assert np.sort(joint.points, axis=0).ravel() == pytest.approx([left, between, right, between])
    assert joint.normal == PAIR.interfaces[1].normal


def test_outlines_move_the_toe_and_turn_the_joint():
    tall = boxes([0, 0, 10, 40])
    walls = outlines_shaken(tall, 600)
    ends = np.array([wall.interfaces[0].points for wall in walls])
    spans = ends[:, 1] - ends[:, 0]
    turned = np.arctan2(spans[:, 1], spans[:, 0])
    assert turned.std() == pytest.approx(0.5 / 10, rel=0.1)  # the noise over its length
    along = np.hypot(*spans.T)
    assert along.mean() == pytest.approx(10, abs=0.1)  # the ground has no ends
    assert along.std() == pytest.approx(0.5 * np.sqrt(2), rel=0.1)
    normals = np.array([wall.interfaces[0].normal for wall in walls])
    assert np.abs((normals * spans).sum(axis=1)).max() < 1e-9
    assert {wall.blocks[0].centroid for wall in walls} == {tall.blocks[0].centroid}


def test_between_two_stones_the_nearer_end_counts():
    lengths = [wall.interfaces[1].length for wall in outlines_shaken(PAIR, 600)]
    # The lesser of two normal deviates lies 1 / sqrt(pi) below the mean.
    assert np.mean(lengths) == pytest.approx(20 - 2 * 0.5 / np.sqrt(np.pi), abs=0.1)


def test_no_direction_is_lost_in_noise():
    """A joint of one pixel, known to a pixel, turns no more than one of three."""
    model = model_from_labels(np.ones((9, 1), np.uint32)).model
    normals = [wall.interfaces[0].normal for wall in outlines_shaken(model, 400, 1.0)]
    assert np.arctan2(*np.transpose(normals)).std() == pytest.approx(1 / 3, rel=0.15)


def test_a_contact_at_a_point_moves_to_both_sides_alike():
    model = model_from_labels(np.array([[0, 2], [1, 0]])).model
    (corner,) = (i for i in model.interfaces if len(i.points) == 1)
    number = model.interfaces.index(corner)
    walls = outlines_shaken(model, 1500, 1.0)
    moved = np.array([wall.interfaces[number].points[0] - corner.points[0] for wall in walls])
    along = moved @ (corner.normal[1], -corner.normal[0])
    assert along.mean() == pytest.approx(0, abs=0.035)
    assert along.std() > 0.3


def test_what_is_fixed_stays_and_so_does_the_joint_across():
    pair = boxes([0, 0, 4, 1], [0, 1, 4, 1], fixed=(1,))
    wall = shaken(pair, ScatterSettings(placement_noise=0.3), rng())
    assert wall.blocks[0].centroid == (2.0, 0.5)
    joint = next(i for i in wall.interfaces if {i.block, i.other} == {1, 2})
    assert joint.points[:, 1] == pytest.approx([1, 1])
    shift = wall.blocks[1].centroid[0] - 2.0
    assert shift != 0
    assert sorted(joint.points[:, 0]) == pytest.approx(sorted([max(0, shift), 4 + min(0, shift)]))


@given(label_images(), st.integers(0, 99), st.sampled_from([0.2, 1.0, 5.0]))
@repeatable(60)
def test_any_wall_can_be_shaken(labels, seed, noise):
    model = model_from_labels(labels).model
    settings = ScatterSettings(mu=(0.3, 0.9), outline_noise=noise, placement_noise=noise)
    wall = shaken(model, settings, rng(seed))
    assert [len(i.points) for i in wall.interfaces] == [len(i.points) for i in model.interfaces]
    for interface in wall.interfaces:
        assert np.hypot(*interface.normal) == pytest.approx(1)
        assert np.isfinite(interface.points).all()
    both = lateral_resistance(wall)
    assert not both.failed
    assert both.left.status is both.right.status


def test_walls_that_do_not_stand_are_counted_and_have_no_numbers():
    model = boxes([0, 0, 20, 10], [9, 10, 20, 10])
    found = scatter(model, ScatterSettings(samples=60, placement_noise=1.0, mu=(0.4, 0.8)))
    counts = found.counts
    assert counts[LimitStatus.OPTIMAL] + counts[LimitStatus.UNSTABLE] == 60 == len(found.mu)
    assert 0 < counts[LimitStatus.UNSTABLE] < 60
    assert found.falling_share == counts[LimitStatus.UNSTABLE] / 60
    assert len(found.alpha) == len(found.value) == counts[LimitStatus.OPTIMAL]
    standing = [mu for mu, s in zip(found.mu, found.status, strict=True) if s == "optimal"]
    assert found.standing_mu.tolist() == standing


def test_walls_that_carry_any_load_stand_and_failed_solves_count_neither_way(monkeypatch):
    model = boxes([0, 0, 1, 2], [1, 1, 1, 1], [2, 0, 1, 2], fixed=(1, 3))
    settings = ScatterSettings(samples=60, mu=(0.0, 0.05), outline_noise=0.05)
    found = scatter(model, settings)
    fallen = found.counts[LimitStatus.UNSTABLE]
    assert fallen > 0
    assert found.counts[LimitStatus.UNBOUNDED] > 0
    assert found.falling_share == fallen / 60

    def gives_up(wall):
        both = lateral_resistance(wall)
        failed = replace(both.left, status=LimitStatus.FAILED, alpha=None)
        return replace(both, left=failed) if wall.mu < 0.6 else both

    monkeypatch.setattr(scatter_module, "lateral_resistance", gives_up)
    found = scatter(FLAT, ScatterSettings(samples=40, mu=(0.4, 0.8)))
    assert found.counts[LimitStatus.FAILED] == np.count_nonzero(found.mu < 0.6) > 0
    assert found.falling_share == 0.0
    assert found.alpha.min() >= 0.6


def test_what_has_no_number_has_no_quantiles():
    """A wall that never stands, and a ratio to no friction, or to one that no joint has."""
    model = boxes([0, 0, 20, 10], [19, 10, 20, 10])
    found = scatter(model, ScatterSettings(samples=4, mu=(0.4, 0.8)))
    assert (found.falling_share, len(found.alpha), found.unshaken.stable) == (1.0, 0, False)
    assert (found.alpha_quantiles, found.value_quantiles) == (None, None)
    found = scatter(FLAT, ScatterSettings(samples=3, mu=(0.0, 0.0)))
    assert found.alpha == pytest.approx(np.zeros(3), abs=1e-9)
    assert (found.value, found.value_quantiles) == (None, None)
    own = replace(FLAT, interfaces=tuple(replace(face, mu=0.3) for face in FLAT.interfaces))
    found = scatter(own, ScatterSettings(samples=3, mu=(0.4, 0.8)))
    assert found.alpha == pytest.approx(np.full(3, 0.3))
    assert (found.value, found.unshaken.value) == (None, None)


@pytest.mark.parametrize(
    ("code", "settings"),
    [
        *(("E302", {"mu": mu}) for mu in ((0.8, 0.4), (-0.1, 0.4), (0.1, np.inf), (np.nan, 0.4))),
        ("E318", {"samples": 0}),
        ("E318", {"outline_noise": -1.0}),
        ("E318", {"placement_noise": np.nan}),
    ],
)
def test_settings_that_make_no_sense(code, settings):
    with pytest.raises(InputError, match=code):
        ScatterSettings(**settings)
