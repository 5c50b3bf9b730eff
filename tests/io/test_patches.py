"""Cutting out, filling, holes and necks by slow twins, and the numbers of split pieces."""

from collections import Counter

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from scipy import ndimage

from drystone.errors import LabelImageError
from drystone.io.images import Picture
from drystone.io.labels import Census, to_ids
from drystone.io.outlines_in.model import Area, OutlinedStone, PlacedMask, filled_area, pixels_of
from drystone.io.patches import StonePatch, cut, enclosed, neck_width_px
from drystone.io.read_stones import ReadSettings, read_stones
from drystone.kernels.ids import numbered
from tests.io.pictures import areas, codes, discs, said
from tests.naive import io as naive

shapes = array_shapes(min_dims=2, max_dims=2, max_side=12)


@given(arrays(np.uint8, shapes, elements=st.integers(0, 4)))
def test_cut_puts_every_pixel_where_it_was(labels):
    census = Census(*numbered(labels))
    patches = cut(census.index, census.values)
    assert {patch.id: patch.area_px for patch in patches} == Counter(labels[labels > 0].tolist())
    for patch in patches:
        rows = slice(patch.row, patch.row + patch.mask.shape[0])
        cols = slice(patch.col, patch.col + patch.mask.shape[1])
        np.testing.assert_array_equal(labels[rows, cols] == patch.id, patch.mask)
        others = (labels[rows, cols] != patch.id) & (labels[rows, cols] > 0)
        np.testing.assert_array_equal(others, patch.others)
        assert patch.mask[0].any()
        assert patch.mask[:, -1].any()
        if len(patch.piece_areas_px) == 1:
            stone = patch.to_stone()
            assert stone.left_px == patch.col
            assert stone.bottom_px == labels.shape[0] - rows.stop


def test_a_stone_of_two_parts_that_meet_has_the_outline_of_its_pixels():
    """Of a line that crosses itself the larger part was drawn, and the pixels are of both."""
    y, x = np.mgrid[-9.5:10, -19.5:20]
    parts = np.abs(y) < np.abs(x) / 2 + 0.3
    drawn = np.array([[0, 0], [0, 20], [20, 10]])  # one of both, clockwise as y is down
    assert StonePatch(parts, 0, 0, 1, 20, drawn=drawn).to_stone().drawn is None
    alone = StonePatch(parts[:, :20], 0, 0, 1, 20, drawn=drawn)
    assert alone.to_stone().drawn.tolist() == [[0, 20], [0, 0], [20, 10]]


@given(arrays(bool, shapes))
def test_holes(mask):
    np.testing.assert_array_equal(enclosed(mask), naive.holes(mask))


@given(st.integers(0, 10**6), st.integers(3, 36), st.integers(3, 36), st.sampled_from([1, 2, 3]))
def test_necks_of_any_mask(seed, height, width, smooth):
    noise = ndimage.gaussian_filter(np.random.default_rng(seed).random((height, width)), smooth)
    mask = noise > np.quantile(noise, 0.35)
    assert neck_width_px(mask) == naive.neck_width(mask)


def test_a_neck_in_a_coarser_picture():
    mask = discs((200, 360), [(100, 88), (100, 272)], 80.3) >= 0.5
    mask[80:120, 120:240] = True
    assert neck_width_px(mask) == 40
    assert neck_width_px(mask, 2 * 90 * 180) == 40  # half of its rows and columns are enough
    assert neck_width_px(np.ones((200, 360), bool), 100) is None
    mask[80:120, 150:210] = False
    mask[99:100, 150:210] = True  # hit or missed, it is not thicker than a pixel of 4 px
    assert neck_width_px(mask, 72_000 // 16) == 4


def test_noise_is_no_picture_of_stones():
    mask = np.zeros((900, 900), np.uint8)
    mask[3:-3:2, 3:-3:2] = 255  # 200,000 pixels apart from each other
    with pytest.raises(LabelImageError, match="E110 array: there are more than 100000 pieces"):
        read_stones(mask)
    ids = np.where(mask > 0, 7, 0).astype(np.uint16)
    ids[10:40, 10:60] = 300
    with pytest.raises(LabelImageError, match="E110 7: there are more than 100000 pieces"):
        read_stones(ids)


@given(
    arrays(np.uint32, shapes, elements=st.integers(0, 5))
    | arrays(np.uint32, shapes, elements=st.integers(2**32 - 4, 2**32 - 1))
    | arrays(np.uint32, shapes)
)
def test_census(labels):
    census = Census(*numbered(labels))
    assert dict(zip(census.values.tolist(), census.counts.tolist(), strict=True)) == Counter(
        labels.ravel().tolist()
    )
    solid = ndimage.minimum_filter(labels, 3) == ndimage.maximum_filter(labels, 3)
    solid[[0, -1]] = solid[:, [0, -1]] = False
    np.testing.assert_array_equal(census.solid, solid)


@given(arrays(np.uint8, st.tuples(st.integers(1, 6), st.integers(1, 6), st.just(3))))
def test_ids_of_colours(picture):
    """The id of DESIGN 4.1, unless two colours would share it; never two colours, one id."""
    ids = to_ids(Picture(picture), 0).ids
    colours = {tuple(pixel) for row in picture.tolist() for pixel in row}
    assert len(np.unique(ids)) == len(colours)
    expected = [
        [r if r == g == b else r + 256 * g + 65536 * b for r, g, b in row]
        for row in picture.tolist()
    ]
    if len(set(np.ravel(expected).tolist())) == len(colours):
        np.testing.assert_array_equal(ids, expected)


@pytest.mark.parametrize(("grey", "value", "said"), [(5, 5 * 0x010101, 0), (7, 7, 1)])
def test_greys_among_colours_keep_their_value_unless_a_colour_has_that_id(grey, value, said):
    picture = np.array([[[0, 0, 0], [grey] * 3, [5, 0, 0], [1, 2, 3]]], np.uint8)
    image = to_ids(Picture(picture), 0)
    assert image.ids.tolist() == [[0, value, 5, 1 + 256 * 2 + 65536 * 3]]
    message = image.notices[0].message
    assert message.count("greys") == message.count("(greys: their value)") == said


def in_pieces():
    """Stones 1 of three pieces, 2 of one, and 3 of two; the pieces are 4, 5 and 6."""
    labels = np.zeros((50, 90), np.uint8)
    for row, stones, sides in ((2, (1, 1, 1), (20, 15, 12)), (26, (2, 3, 3), (18, 16, 11))):
        for stone, col, side in zip(stones, (2, 30, 60), sides, strict=True):
            labels[row : row + side, col : col + side] = stone
    return labels


ALL = {1: 400, 2: 324, 3: 256, 4: 225, 5: 144, 6: 121}


def split(labels, skip, **more):
    return read_stones(labels, settings=ReadSettings(pieces="split", skip=tuple(skip), **more))


def test_pieces_are_left_out_under_the_numbers_that_were_announced():
    for skip in ((), (1,), (4,), (2, 6), (1, 2, 3, 4, 6)):
        stones = split(in_pieces(), skip)
        assert areas(stones) == {i: area for i, area in ALL.items() if i not in skip}
        assert "W116" not in codes(stones)
        for piece in (4, 5, 6):
            assert (f"{piece} ({ALL[piece]} px)" in said(stones)) == (piece not in skip)
    # A number that neither a stone nor a piece has.
    (notice,) = [n for n in split(in_pieces(), (4, 7)).notices if n.code == "W116"]
    assert notice.message == "no stone 7 to skip."
    whole = read_stones(in_pieces() % 3, settings=ReadSettings(pieces="keep-largest", skip=(4,)))
    assert "no stone 4 to skip." in [n.message for n in whole.notices]


def test_what_is_a_speck_beside_skipped_giants_is_not_numbered():
    labels = np.pad(in_pieces(), ((0, 400), (0, 400)))
    labels[60:440, 2:242], labels[60:440, 246:486], labels[4:50, 100:480] = 7, 8, 9
    labels[2, 480::2] = 10
    everything = areas(split(labels, (), min_area_px=None))
    for skip in ((7, 8), (7, 8, 9), (1, 9)):
        left = {i: area for i, area in everything.items() if i not in skip}
        assert areas(split(labels, skip)) == left


@given(
    arrays(np.uint8, array_shapes(min_dims=2, max_dims=2, min_side=3, max_side=9)),
    st.sets(st.integers(1, 12)),
)
def test_skipping_is_leaving_out(values, skip):
    labels = np.pad(values % 4 * 100, 1)
    if not labels.any():
        return
    more = {"min_area_px": 2, "mask": False}
    try:
        everything = areas(split(labels, (), **more))
    except LabelImageError:
        return
    skip = {sorted(everything)[i % len(everything)] for i in skip}
    left = {i: area for i, area in everything.items() if i not in skip}
    if left:
        assert areas(split(labels, skip, **more)) == left


NUMBERS = st.integers(-24, 72).map(lambda n: n / 3 + 0.1)
RINGS = st.lists(st.tuples(NUMBERS, NUMBERS), min_size=3, max_size=9, unique=True)
LOW, SIZE = -10, 40


CENTRES = np.stack(np.meshgrid(*2 * [np.arange(LOW, LOW + SIZE) + 0.5]), axis=-1)


def filled(*rings, **rule):
    image = np.zeros((SIZE, SIZE), bool)
    placed = filled_area(Area(tuple(map(np.array, rings)), **rule))
    if placed is not None:
        rows, cols = placed.mask.shape
        row, col = placed.row - LOW, placed.col - LOW
        image[row : row + rows, col : col + cols] = placed.mask
    return image


def winding(points):
    """How often a ring runs around each centre: by the sum of the angles at which it is seen."""
    to_corners = np.array(points) - CENTRES[:, :, None]
    angles = np.arctan2(to_corners[..., 1], to_corners[..., 0])
    turns = np.roll(angles, -1, axis=-1) - angles
    return np.rint(((turns + np.pi) % (2 * np.pi) - np.pi).sum(axis=-1) / (2 * np.pi))


@given(RINGS, RINGS)
def test_pixels_are_in_an_area_by_how_often_its_rings_run_around_them(one, other):
    total = winding(one) + winding(other)
    # Centres farther than 1e-6 from edges, for which rules differ.
    edges = shapely.MultiLineString([[*ring, ring[0]] for ring in (one, other)])
    where = shapely.distance(shapely.points(CENTRES), edges) > 1e-6
    np.testing.assert_array_equal(filled(one, other)[where], (total % 2 == 1)[where])
    nonzero = filled(one, other, rule="nonzero")
    np.testing.assert_array_equal(nonzero[where], (total != 0)[where])


@given(st.lists(st.integers(0, 35), min_size=4, max_size=9, unique=True), st.data())
def test_halves_of_a_polygon_share_no_pixel_and_leave_none(tens, data):
    """Corners of an ellipse through centres of pixels, split along any of its diagonals."""
    angles = np.radians(sorted(tens)) * 10
    ring = np.column_stack([5.5 + 9 * np.cos(angles), 4.5 + 7 * np.sin(angles)])
    first = data.draw(st.integers(0, len(ring) - 3))
    last = data.draw(st.integers(first + 2, len(ring) - 1))
    halves = (ring[first : last + 1], np.vstack([ring[last:], ring[: first + 1]]))
    both = [filled(part) for part in halves if len(part) > 2]
    assert sum(mask.astype(int) for mask in both).max() <= 1
    np.testing.assert_array_equal(np.any(both, axis=0), filled(ring))


def test_what_holds_no_centre_is_nothing_and_masks_are_united():
    for ring in ([[0.6, 0.6], [0.9, 0.6], [0.9, 0.9]], [[0.0, 0.0], [9.0, 0.0], [4.0, 0.0]]):
        assert filled_area(Area((np.array(ring),))) is None
    assert pixels_of(OutlinedStone(1)) is None
    one, other = (PlacedMask(np.ones((2, 3), bool), row, col) for row, col in ((5, 5), (6, 7)))
    union = pixels_of(OutlinedStone(1, masks=(one, other)))
    assert (union.row, union.col, union.mask.shape) == (5, 5, (3, 5))
    assert union.mask.sum() == 6 + 6 - 1
