"""Blocks that are put down not quite as planned."""

import numpy as np
import pytest

from drystone.kernels import putting
from drystone.kernels.polygons import no_polygons
from drystone.model.builder import Built
from drystone.settle.putting import fallen_share, put_down
from drystone.settle.settings import SettleSettings
from tests.naive import putting as naive
from tests.polygons import box_of as box

SETTLE = SettleSettings()


def brick(x, y, angle_deg=0.0, width=40.0):
    """A brick with its centroid at a place."""
    return Built(box(-width / 2, -10.0, width), x, y, angle_deg, (20.0 * width) ** 0.5)


def put(built, *around, mu=0.58):
    return put_down(built, no_polygons().added(around), mu, SETTLE)


def test_a_brick_on_the_ground_comes_to_lie_flat():
    rest, _ = put(brick(0.0, 10.0, -6.0))
    assert (rest.y, rest.angle_deg) == pytest.approx((10.0, 0.0), abs=0.4)


def test_neighbours_on_both_sides_are_pushed_apart_and_push_on():
    walls = box(-58.0, 0.0), box(18.0, 0.0), box(58.5, 0.0), box(110.0, 0.0)
    rest, pushed = put(brick(0.0, 10.0), *walls)
    assert rest.y == pytest.approx(10.0, abs=0.3)
    assert pushed == {i: pytest.approx(x, abs=0.3) for i, x in enumerate((-2.0, 2.0, 1.5))}


@pytest.mark.parametrize(
    ("y", "around", "ends"),
    [(10.0, box(-58.0, 0.0), (2.0, 10.0)), (29.0, box(-30.0, 0.0, 60.0), (0.0, 30.0))],
)
def test_a_brick_moves_aside_where_there_is_room_and_is_lifted_from_what_is_below(y, around, ends):
    rest, pushed = put(brick(0.0, y), around)
    assert (rest.x, rest.y) == pytest.approx(ends, abs=0.3)
    assert pushed == {}


def test_how_near_to_a_fall_a_stone_is():
    assert fallen_share(0.3, 0.4, 0.0, 4.0) == pytest.approx(0.5)
    assert fallen_share(0.0, 0.0, 348.0, 4.0) == pytest.approx(1.0)


def test_neighbours_that_lean_over_are_pushed_apart_where_a_lifted_brick_is():
    left = np.array([[-60.0, 3.0], [-20.0, 3.0], [-15.0, 33.0], [-60.0, 33.0]])
    right = left[::-1] * (-1.0, 1.0)
    rest, pushed = put(brick(0.0, 10.0), box(-60.0, -17.0, 120.0), left, right)
    assert 12.9 < rest.y < 13.8  # the bed is higher than planned; they hold it where they can
    room = 5.0 * 20.0 / 30.0  # that is missing at the top of the brick where it lies
    assert pushed == {1: pytest.approx(-room, abs=0.7), 2: pytest.approx(room, abs=0.7)}


@pytest.mark.parametrize(
    ("below", "mu"),
    [
        (box(5.0, 0.0), 0.58),  # its centroid is beyond the edge
        (np.array([[-30.0, 0.0], [30.0, 0.0], [30.0, 20.0], [-30.0, -1.0]]), 0.1),  # it slides
    ],
)
def test_what_finds_no_rest_falls(below, mu):
    assert put(brick(0.0, 30.0), below, mu=mu) == (None, {})


def test_blocks_come_to_rest_and_push_as_by_the_twin(monkeypatch):
    """All that is asked of the kernel is asked of the twin, lift by lift."""
    rng, rests = np.random.default_rng(3), [0, 0, 0]

    def both(*block, **how):
        (found, pushed), (told, moved) = kernel(*block, **how), naive.put_down(*block, **how)
        assert (found and found[1:4]) == (told and pytest.approx(told[1:4], abs=1e-3))
        assert pushed == pytest.approx(moved, abs=1e-3)
        rests[0 if found is None else 2 if pushed else 1] += 1
        return found, pushed

    kernel = putting.put_down
    monkeypatch.setattr(putting, "put_down", both)
    for _ in range(20):
        left, right, aside = rng.normal(0.0, 2.0, 3).tolist()
        tilts = rng.normal(0.0, 3.0, 3).tolist()
        around = [brick(left - 41.0, 14.0, tilts[0]), brick(right + 41.0, 14.0, tilts[1])]
        bed = box(-90.0, rng.uniform(-20.0, -16.0), 180.0)
        put(brick(4.0 * aside, 13.0, tilts[2]), bed, *(one.corners for one in around))
    assert min(rests) > 2, rests
