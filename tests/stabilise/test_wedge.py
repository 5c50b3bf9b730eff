"""Wedging (§3.7, Fig. 9c)."""

import numpy as np
import pytest
from scipy import ndimage

from drystone.model.stone import Stone
from drystone.poses import PoseBook
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.stabilise import wedge_under
from tests.naive import support as naive
from tests.stabilise.scenes import bar_on_the_ledge, ledge, mirrored

ID = 70_000


def check_wedge(occupied, pose, wedge, largest_px, settings):
    """What DESIGN 4.6 asks of a wedge."""
    posed, row, col = pose
    stone = np.zeros_like(occupied)
    stone[row : row + posed.height_px, col : col + posed.width_px] = posed.mask
    cut = np.zeros_like(occupied)
    cut[wedge.window] = wedge.mask
    assert not (cut & (stone | occupied)).any()
    assert ndimage.label(wedge.mask)[1] == 1
    assert wedge.under == posed.stone.id
    for column in range(wedge.mask.shape[1]):
        rows = np.flatnonzero(cut[:, wedge.col + column])
        assert settings.min_wedge_px <= rows.size <= largest_px
        assert rows.size == rows[-1] - rows[0] + 1
        assert stone[rows[0] - 1, wedge.col + column]  # touches the stone all along
        under = rows[-1] + 1
        assert under == len(occupied) or occupied[under, wedge.col + column]  # and what is below
    assert wedge.mask.shape[1] >= settings.min_wedge_px


def holds(occupied, pose, wedges, margin=0.0):
    posed, row, col = pose
    scene = occupied.copy()
    for wedge in wedges:
        scene[wedge.window] |= wedge.mask
    margin_px = margin * posed.width_px
    x_c = col + posed.anchor[0]
    return naive.rests_stably(scene, posed.mask, row, col, x_c, margin_px)


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize("margin", [0.0, 0.1])
def test_a_wedge_holds_an_overhanging_bar(side, margin):
    occupied = ledge()
    trial = bar_on_the_ledge(occupied, PoseBook())
    if side == "left":
        occupied, trial = mirrored(occupied, trial, PoseBook())
    settings = StabiliseSettings(margin=margin)
    wedge = wedge_under(occupied, trial, ID, 12.0, settings)
    assert wedge.id == ID
    check_wedge(occupied, trial, wedge, 6.0, settings)
    assert not holds(occupied, trial, (), margin)
    assert holds(occupied, trial, (wedge,), margin)


def test_the_wedge_is_where_the_free_side_touches_first():
    occupied = ledge()
    occupied[-2:, 24:28] = True
    wedge = wedge_under(
        occupied, bar_on_the_ledge(occupied, PoseBook()), ID, 12.0, StabiliseSettings()
    )
    assert (wedge.col, wedge.mask.shape) == (24, (2, 4))


@pytest.mark.parametrize(
    ("height", "mean", "smallest", "found"),
    [
        (4, 8.0, 2, True),
        (2, 8.0, 2, True),
        (2, 8.0, 3, False),
        (5, 9.0, 2, False),
        (5, 10.0, 2, True),
    ],
)
def test_smallest_and_largest_size(height, mean, smallest, found):
    occupied = ledge(height=height)
    settings = StabiliseSettings(min_wedge_px=smallest)
    wedge = wedge_under(occupied, bar_on_the_ledge(occupied, PoseBook()), ID, mean, settings)
    assert (wedge is not None) is found


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize(("shelf", "taken"), [((16, 18), (16, 18)), ((15, 18), (16, 18))])
def test_the_column_at_the_centre_of_mass_is_the_first_that_helps(side, shelf, taken):
    occupied = ledge()
    occupied[-2:, slice(*shelf)] = True
    trial = bar_on_the_ledge(occupied, PoseBook())
    if side == "left":
        occupied, trial = mirrored(occupied, trial, PoseBook())
        taken = (50 - taken[1], 50 - taken[0])
    wedge = wedge_under(occupied, trial, ID, 12.0, StabiliseSettings())
    assert (wedge.col, wedge.col + wedge.mask.shape[1]) == taken
    assert holds(occupied, trial, (wedge,))


@pytest.mark.parametrize(("mean", "found"), [(12.0, False), (16.0, True)])
def test_between_sloping_faces_the_whole_wedge_counts(mean, found):
    """Three pixels of gap, in a wedge of six columns that is eight pixels high."""
    bottoms = [12] * 4 + [2] * 10 + [4, 5, 6, 7, 8, 9]
    mask = np.arange(12)[:, None] < bottoms
    occupied = np.ones((24, 30), bool)
    for column, bottom in enumerate(bottoms):
        occupied[: 6 + bottom + (3 if column >= 14 else 0 if column < 4 else 9), column] = False
    posed = PoseBook().pose(Stone(5, mask), 0.0)
    assert posed.mask.tolist() == mask.tolist()
    occupied[:18, 20:] = False
    settings = StabiliseSettings(margin=0.2)
    wedge = wedge_under(occupied, (posed, 6, 0), ID, mean, settings)
    assert (wedge is not None) is found
    assert wedge is None or wedge.mask.shape == (8, 6)
