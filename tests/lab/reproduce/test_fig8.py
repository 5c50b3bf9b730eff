import numpy as np
import pytest
from matplotlib.figure import Figure

from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone_lab.reproduce import fig8
from drystone_lab.reproduce.construction import amid_course
from tests.lab.reproduce.small_walls import RUBBLE, built, gids, of, rows
from tests.naive import indices as naive
from tests.naive.rays import local_filling_ratio

MADE = of("fig8", RUBBLE)


@pytest.fixture(scope="module")
def trial(folder):
    moment, place = amid_course(built(folder, RUBBLE))
    return moment, moment.trial(place.posed.stone.id)


def naive_maps(occupied, mask):
    """Position by position: overlap with the landscape, and with what is beside it."""
    bounds = np.pad(occupied, 1, constant_values=True)
    grown = bounds.copy()
    for r, c in np.argwhere(bounds[1:-1, 1:-1]) + 1:
        grown[[r - 1, r + 1, r, r], [c, c, c - 1, c + 1]] = True
    grown[[1, -2]] = grown[:, [1, -2]] = True
    shape = np.array(occupied.shape) - mask.shape + 1
    free, floating = np.zeros(shape, bool), np.zeros(shape, bool)
    for row, col in np.ndindex(*shape):
        window = np.s_[row : row + mask.shape[0], col : col + mask.shape[1]]
        free[row, col] = not np.any(occupied[window] & mask)
        floating[row, col] = not np.any(grown[1:-1, 1:-1][window] & mask)
    return free, floating


def test_maps_are_those_of_every_position_and_so_are_counts(output, trial):
    moment, (posed, *_) = trial
    maps = fig8.PositionMaps.of(moment.wall.occupied, posed.mask)
    free, floating = naive_maps(moment.wall.occupied, posed.mask)
    np.testing.assert_array_equal(maps.free, free)
    np.testing.assert_array_equal(maps.floating, floating)
    assert not np.any(maps.touching & maps.floating)
    below = np.vstack([free[1:], np.zeros_like(free[:1])])
    resting = np.count_nonzero(free & ~below)
    counts = [row["count"] for row in rows(output, "positions")]
    assert counts == [
        free.size, free.sum(), floating.sum(), free.sum() - floating.sum(), resting, 1,
    ]  # fmt: skip
    drawn = set(gids(output, "fig8"))
    assert len([gid for gid in drawn if gid.startswith("layer-")]) == 4
    assert {"values", "chosen", "best"} <= drawn


def test_the_chosen_position_is_worth_most(output, trial):
    moment, (posed, row, col) = trial
    occupied = moment.wall.occupied

    def value(at):
        stone = naive.painted(occupied.shape, posed.mask, *at)
        dice = naive.dice_score(occupied, stone)
        x_c = at[1] + posed.anchor[0]
        filled = local_filling_ratio(occupied, posed.mask, *at)
        return filled + (dice if dice > 0.7 else 0.0) - x_c / occupied.shape[1]

    *_, touching, best, chosen = rows(output, "positions")
    assert chosen["best: left px"] == col
    assert chosen["best: Eq. 12"] == pytest.approx(value((row, col)), abs=1e-4)
    assert best["best: Eq. 12"] == chosen["best: Eq. 12"] <= touching["best: Eq. 12"]
    others = moment.positions(posed)[::9].tolist()
    assert max(map(value, map(tuple, others))) <= value((row, col)) + 1e-12


SITE = np.zeros((6, 10), np.uint32)
SITE[4:, :5] = 1
MASK = np.ones((2, 4), bool)
POSED = PosedStone(Stone(9, MASK), 0.0, 1.0, MASK, (2.0, 1.0))


def test_a_position_is_drawn_where_the_centroid_is():
    at = np.zeros((5, 7), bool)
    at[2, 3] = True
    ax = Figure().add_subplot()
    fig8.plot_position_layers(ax, SITE, POSED, [("here", "#d55e00", at)])
    (image,) = ax.images
    rgba, (left, right, bottom, top) = image.get_array(), image.get_extent()
    ((row, col),) = np.argwhere(rgba[..., 3] > 0).tolist()
    x = left + (col + 0.5) * (right - left) / rgba.shape[1]
    y = top - (row + 0.5) * (top - bottom) / rgba.shape[0]
    # Columns 3 to 7, rows 2 and 3 from the top.
    assert (x, y) == (5.0, 3.0)


def test_values_are_at_the_centroids_and_the_stone_at_the_chosen_one():
    positions = np.array([[2, 0], [2, 1], [4, 5]])
    ax = Figure().add_subplot()
    fig8.plot_position_values(ax, SITE, POSED, positions, np.array([1.0, 0.9, 0.5]), (2, 0))
    (dots,) = [one for one in ax.collections if one.get_gid() == "values"]
    np.testing.assert_allclose(dots.get_offsets(), [[2, 3], [3, 3], [7, 1]])
    np.testing.assert_allclose(dots.get_array(), [1.0, 0.9, 0.5])
    (stone,) = [patch for patch in ax.patches if patch.get_gid() == "chosen"]
    box = stone.get_path().get_extents()
    assert (box.x0, box.y0, box.x1, box.y1) == (0, 2, 4, 4)
    (best,) = [line for line in ax.lines if line.get_gid() == "best"]
    assert best.get_xydata().tolist() == [[2, 3]]
