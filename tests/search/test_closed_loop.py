"""Walls that are looked at after every stone."""

import numpy as np
import pytest
import shapely

from drystone.model.builder import HAND
from drystone.search.closed_loop import rehearse_closed, tilt_as_built
from drystone.search.rehearsal import rehearse
from tests.polygons import box_of as box
from tests.search.test_rehearsal import BOND, NONE, TOWER, runs
from tests.settle.test_as_built import PLANK, POST


def fallen(run):
    return [end.stone for end in run.stones if end.fallen]


@pytest.mark.parametrize("groups", [BOND, TOWER])
def test_without_errors_it_is_the_wall_of_open_loop(groups):
    run = rehearse_closed(groups, NONE, np.random.default_rng(0))
    plain = rehearse(groups, NONE, np.random.default_rng(0))
    assert (run.again, fallen(run)) == (0, [])
    assert [end.stone for end in run.stones] == [group[0][0] for group in groups]
    for (one, corners), (other, expected) in zip(run.blocks, plain.blocks, strict=True):
        assert one == other
        np.testing.assert_allclose(corners, expected, atol=1e-9)


def test_fewer_walls_lose_a_stone_than_in_open_loop():
    closed, plain = (runs(TOWER, HAND, 16, once) for once in (rehearse_closed, rehearse))
    assert sum(map(bool, map(fallen, plain))) >= 3
    assert sum(map(bool, map(fallen, closed))) == 0
    assert any(run.again for run in closed)


def test_a_stone_whose_place_is_gone_comes_to_lie_on_the_wall():
    """It was planned in the air beside a wall of one course, which has no other room."""
    row = [[(k + 1, box(41.0 * k, 0.0))] for k in range(3)]
    run = rehearse_closed([*row, [(9, box(100.0, 70.0))]], NONE, np.random.default_rng(0))
    assert fallen(run) == []
    lies = dict(run.blocks)[9]
    assert lies[:, 1].min() == pytest.approx(20.0, abs=0.5)
    # What lies in the wall overlaps nothing.
    shapes = [shapely.Polygon(corners) for _, corners in run.blocks]
    assert sum(one.area for one in shapes) == pytest.approx(shapely.union_all(shapes).area)


def test_what_another_throws_down_or_pushes_away_is_taken_up_and_laid_again():
    """A brick comes onto the end of a plank, or in between two bricks that leave no room."""
    tipped = [POST, PLANK, [(3, box(24.0, 30.0, 20.0, 30.0))]]
    pushed = [[(k, box(x, 0.0))] for k, x in [(1, 0.0), (2, 64.0), (3, 32.0)]]
    assert rehearse(tipped, NONE, np.random.default_rng(0)).first_fall is not None
    for groups, again in ((tipped, 0), (pushed, 2)):
        run = rehearse_closed(groups, NONE, np.random.default_rng(0))
        assert (sorted(i for i, _ in run.blocks), run.again) == ([1, 2, 3], again)


def test_what_lies_in_the_way_of_a_stone_is_taken_up_for_it():
    """A tall stone was planned in the air; then another comes where alone it can stand."""
    tall, later = box(42.0, 17.0, 40.0, 110.0), box(42.0, 0.0, 60.0, 40.0)
    groups = [[(1, box(0.0, 0.0, 40.0, 36.0))], [(2, tall)], [(3, later)]]
    run = rehearse_closed(groups, NONE, np.random.default_rng(0))
    assert fallen(run) == []
    assert run.again > 0
    assert dict(run.blocks)[2][:, 1].min() == pytest.approx(0.0, abs=0.1)


def test_a_stone_without_any_place_is_not_in_the_wall():
    """A needle rests on no point, and lying it would be longer than the wall."""
    needle = [(2, np.array([[-2.0, 220.0], [0.0, 20.0], [2.0, 220.0], [0.0, 420.0]]))]
    run = rehearse_closed([[(1, box(-20.0, 0.0))], needle], NONE, np.random.default_rng(0))
    assert fallen(run) == [2]
    assert [i for i, _ in run.blocks] == [1]


def test_a_wall_as_it_was_built_is_tilted():
    pytest.importorskip("pymunk")
    low = [[(k + 1, box(41.0 * k, 0.0))] for k in range(2)]
    (run,) = runs(low, HAND, 1, rehearse_closed)
    assert tilt_as_built(run) == pytest.approx(1.0, abs=0.1)  # it slides
    # A column that is thrice as high as wide topples at a third; one on an edge falls at once.
    high = rehearse([[(1, box(0.0, 0.0, 20.0, 60.0))]], NONE, np.random.default_rng(0))
    assert tilt_as_built(high) == pytest.approx(0.333 / 0.58, abs=0.05)
