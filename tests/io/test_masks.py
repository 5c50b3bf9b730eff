"""Which pictures and arrays are masks, and what in a label image is no stone."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from PIL import Image
from scipy import ndimage
from skimage.measure import label

from drystone.errors import InputError, LabelImageError, UsageError
from drystone.io.labels import components
from drystone.io.read_stones import ReadSettings, read_stones
from drystone.io.walls import read_wall
from tests.io.known_stones import PIECES, compare, label_image, masks
from tests.io.pictures import areas, codes, discs, many_stones, said, two_stones


@given(arrays(bool, array_shapes(min_dims=2, max_dims=2, max_side=12)))
def test_components_are_numbered_in_row_order(mask):
    np.testing.assert_equal(components(mask), label(mask, connectivity=2, return_num=True))


def test_two_values_are_a_mask(tmp_path):
    for value, dtype in ((1, bool), (1, np.uint8), (255, np.uint8), (1, float), (300, np.uint16)):
        mask = two_stones(value, value, dtype)
        stones = read_stones(mask)
        assert areas(stones) == {1: 375, 2: 600}
        assert codes(stones) == ["W114"]
        assert "2 components, numbered in row order" in stones.notices[0].message
        if mask.dtype in (bool, np.uint8):
            Image.fromarray(mask).save(tmp_path / "m.png")
            assert areas(read_stones(tmp_path / "m.png")) == {1: 375, 2: 600}


def test_stones_that_meet_at_a_corner_are_one_component():
    mask = np.kron([[1, 0], [0, 1]], np.ones((15, 15), bool)) > 0
    stones = read_stones(np.pad(mask, 5))
    assert areas(stones) == {1: 450}
    assert codes(stones) == ["W114", "W110"]
    assert "meet at a corner only" in stones.notices[1].message


def test_a_single_stone_and_two_that_fill_the_picture_keep_their_ids():
    labels = two_stones(300, 0)
    assert areas(read_stones(labels)) == {300: 375}
    labels[labels == 300] = 255
    assert areas(read_stones(labels)) == {1: 375}
    assert areas(read_stones(labels, settings=ReadSettings(mask=False))) == {255: 375}
    labels = np.where(np.indices((20, 40))[1] < 22, 5, 9)
    assert areas(read_stones(labels)) == {5: 440, 9: 360}


def test_antialiased_mask(tmp_path):
    cover = (discs((70, 70), [(15, 15), (15, 50), (50, 16), (50, 52)], 10.3) * 255).astype(np.uint8)
    edge = (cover > 0) & (cover < 255)
    # Sub-pixel smoothing leaves a little colour in the edges.
    coloured = np.dstack([cover, cover, cover - np.uint8(20) * (edge & (cover > 40))])
    few = np.dstack([cover] * 3)
    few[15, 15], few[50, 16] = (30, 200, 90), (200, 60, 70)
    for values, more in ((cover, 0), (coloured, 0), (few, 2)):
        Image.fromarray(values).save(tmp_path / "m.png")
        stones = read_stones(tmp_path / "m.png")
        assert len(stones) == 4
        assert stones.total_area_px == int((cover >= 127.5).sum())
        assert codes(stones) == ["W114"]
        assert f"{edge.sum() + more} px of values between them" in stones.notices[0].message


def test_grey_stones_are_not_taken_for_edges_nor_colours_for_a_mask():
    centres = [(15 + 30 * i, 15 + 30 * j) for i in range(4) for j in range(4)]
    values = (discs((150, 130), centres, 10.3) * 255).astype(np.uint8)
    values[130:140, 10:20] = 90
    with pytest.raises(LabelImageError, match=r"E10[13]"):
        read_stones(values)
    # 0 and the large stone's 200 hold nearly all pixels; the others are stones all the same.
    labels = np.zeros((200, 200), np.uint8)
    labels[10:150, 10:190] = 200
    for i in range(5):
        labels[160:170, 10 + 30 * i : 20 + 30 * i] = 20 + i
    labels[180:182, 10:30] = 30  # a sliver with no 3 x 3 px of its own
    assert len(read_stones(labels)) == 7
    # Equally bright colours.
    picture = np.zeros((40, 80, 3), np.uint8)
    for i in range(3):
        picture[5:35, 5 + 25 * i : 25 + 25 * i, i] = 255
    assert areas(read_stones(picture)) == {255: 600, 65280: 600, 255 * 65536: 600}


@pytest.mark.parametrize(("value", "quality"), [(128, 10), (200, 50), (255, 95)])
def test_mask_is_forced(tmp_path, value, quality):
    forced = ReadSettings(mask=True)
    cover = discs((70, 70), [(15, 15), (50, 50)], 10.3)
    blurred = np.round(ndimage.gaussian_filter(cover, 2.0) * 200).astype(np.uint8)
    assert len(read_stones(blurred, settings=forced)) == 2
    labels = many_stones(2, 3, first=200, step=10)
    assert areas(read_stones(labels, settings=forced)) == dict.fromkeys(range(1, 7), 576)
    labels[0, 0] = 1
    assert read_stones(labels, settings=forced).total_area_px == 6 * 576
    # Edges overshoot: the brightest pixel of a lossy file is brighter than the stones.
    labels = np.minimum(many_stones(3, 4), 1) * value
    Image.fromarray(labels.astype(np.uint8)).save(tmp_path / "mask.jpg", quality=quality)
    assert len(read_stones(tmp_path / "mask.jpg", settings=forced)) == 12


@pytest.mark.parametrize(("count", "lossy"), [(3, False), (30, False), (4, True)])
def test_ids_are_not_forced_into_a_mask(tmp_path, count, lossy):
    labels = many_stones(1, count, first=1, step=1)
    path = tmp_path / ("ids.jpg" if lossy else "ids.png")
    scale = 240 // count if lossy else 1
    Image.fromarray((labels * scale).astype(np.uint8)).save(path)
    with pytest.raises(UsageError, match=r"E118 ids.*plain areas are neither.*leave --mask"):
        read_stones(path, settings=ReadSettings(mask=True))
    labels[labels == count] = 255
    with pytest.raises(UsageError, match=r"E118 array: \d\d%"):
        read_stones(labels, settings=ReadSettings(mask=True))


@given(arrays(np.uint8, array_shapes(min_dims=2, max_dims=2, min_side=3)), st.booleans())
def test_forced_reading_never_crashes_and_loses_nothing(values, mask):
    """Every pixel is a stone's, a listed speck's, or background."""
    labels = values.astype(int) % 3 * 100
    settings = ReadSettings(mask=mask, min_area_px=1, pieces="split", holes="keep")
    if len(np.unique(labels)) < 2 or not (labels == 0).any():
        return
    stones = read_stones(np.pad(labels, 1), settings=settings)
    expected = (labels > 0).sum() if not mask else (2 * labels >= labels.max()).sum()
    assert stones.total_area_px == expected


def saved(tmp_path, **arrays):
    np.savez_compressed(tmp_path / "stones.npz", **arrays)
    return tmp_path / "stones.npz"


def test_an_array_of_labels_or_a_mask_a_stone(tmp_path):
    path = saved(tmp_path, image=np.zeros((40, 60, 3)), labels=label_image(), x=np.arange(3))
    assert compare(read_stones(path, settings=PIECES)) == 1.0
    given = {f"stone_{i}": mask.astype(np.uint8) * 255 for i, mask in masks().items()}
    stones = read_stones(saved(tmp_path, **given), settings=PIECES)
    assert compare(stones) == 1.0
    assert stones.by_id(300).name == "stone_300"
    by_name = read_stones(saved(tmp_path, **{f"m{i}": m for i, m in masks().items()}),
                          settings=PIECES)  # fmt: skip
    assert {stone.id for stone in by_name} == set(range(1, 8))


def test_arrays_that_are_no_masks_and_damaged_archives(tmp_path):
    for wrong, text in (
        ({"a": np.zeros((4, 4)), "b": np.zeros((5, 4))}, "E114.*not masks of one picture"),
        ({"a": np.zeros(4), "b": np.zeros(4)}, "E114.*not masks of one picture"),
        ({"a": np.eye(4), "b": np.arange(16).reshape(4, 4)}, "E114.*'b' is not a mask"),
        ({"a": np.array([{}], dtype=object), "b": np.zeros(3)}, "E107.*pickle"),
    ):
        with pytest.raises(InputError, match=text):
            read_stones(saved(tmp_path, **wrong))
    path = saved(tmp_path, a=label_image())
    path.write_bytes(path.read_bytes()[:-40])
    with pytest.raises(InputError, match=r"E106"):
        read_stones(path)


def test_what_is_no_number_of_a_stone_is_ground(tmp_path):
    for dtype in ("f2", "f8", "f4", "i1", "i4", "i8"):
        ground = np.nan if dtype in ("f2", "f8") else -1
        none, zero = two_stones() == 0, two_stones(0, 1, float)
        labels = np.where(none, ground, two_stones(7, 9, float)).astype(dtype)
        np.save(tmp_path / "a.npy", labels)
        for background in (0, -1):
            settings = ReadSettings(background=background)
            stones = read_stones(tmp_path / "a.npy", settings=settings)
            assert areas(stones) == {7: 375, 9: 600}
            assert codes(stones) == ([] if ground == background else ["W135"])
            wall = read_wall(tmp_path / "a.npy", settings)
            np.testing.assert_array_equal(wall.labels, two_stones(7, 9))
            assert codes(wall) == codes(stones)
            with pytest.raises(InputError, match=r"E108 .*375 px are 0.*add 1"):
                read_stones(np.where(none, ground, zero), settings=settings)
        assert areas(read_stones(np.where(none, ground, zero + 1)))


def watershed(ground=1):
    """Markers as OpenCV leaves them: -1 around every region and at the rim, the ground a region."""
    found = np.where(many_stones(2, 3) == 0, ground, many_stones(2, 3, first=5)).astype(np.int32)
    edge = (ndimage.maximum_filter(found, 3) != found) & (found == ground)
    edge[[0, -1]] = edge[:, [0, -1]] = True
    return np.where(edge, -1, found)


def test_edges_of_a_watershed():
    assert len(read_stones(watershed(0))) == 6
    for background in (0, -1):
        with pytest.raises(LabelImageError, match=r"E105 .*the value 1 fills.*--background 1 "):
            read_stones(watershed(), settings=ReadSettings(background=background))
    stones = read_stones(watershed(), settings=ReadSettings(background=1))
    assert areas(stones) == dict.fromkeys(range(5, 23, 3), 576)
    assert "px are -1 (edges, as a watershed leaves them)" in said(stones)
    with pytest.raises(LabelImageError, match=r"E104.*2400 px are -1 .*edges"):
        read_stones(np.full((40, 60), -1))
    # Pockets of ground among edges are no stones of 0.
    pocket = watershed(0)
    pocket[32:36, 10:20] = -1
    assert len(read_stones(pocket)) == 6


def netted(labels, width=3, value=255):
    """Labels with edges of a value around all stones, as data sets mark what is no class."""
    near = ndimage.maximum_filter(labels, 2 * width + 1) > 0
    return np.where((labels == 0) & near, value, labels)


@pytest.mark.parametrize(("value", "gap"), [(2, 8), (255, 3), (65535, 8), (2**32 - 1, 3)])
def test_a_net_of_edges_is_no_stone(tmp_path, value, gap):
    labels = np.pad(many_stones(4, 5, first=10, gap=gap), 4)
    path = tmp_path / "a.npy"
    np.save(path, netted(labels, value=value))
    stones = read_stones(path)
    assert areas(stones) == dict.fromkeys(range(10, 70, 3), 576)
    assert codes(stones) == ["W135"]
    assert f"the value {value} (" in said(stones)
    assert "--no-mask" in said(stones)
    skipped = read_stones(path, settings=ReadSettings(skip=(value, 10)))
    assert areas(skipped) == dict.fromkeys(range(13, 70, 3), 576)
    assert codes(skipped) == ["W135"]
    np.testing.assert_array_equal(read_wall(path).labels, labels)
    kept = ReadSettings(mask=False, pieces="keep-largest", holes="keep")
    assert value in areas(read_stones(path, settings=kept))


def test_a_class_of_grains_with_a_class_of_edges_is_a_mask_but_one_stone_with_a_ring_is_none():
    centres = [(22 + 38 * i, 22 + 38 * j) for i in range(3) for j in range(4)]
    grains = (discs((120, 160), centres, 15) > 0.5).astype(np.uint8)
    stones = read_stones(netted(grains, 4, 2))
    assert len(stones) == 12
    assert stones.total_area_px == grains.sum()
    assert codes(stones) == ["W135", "W114"]
    labels = two_stones(3, 0)
    assert areas(read_stones(netted(labels, 2))) == {3: 375}
    assert 4 in areas(read_stones(netted(labels, 2, 4)))  # may be a stone, with its hole filled


def test_neither_stones_that_touch_nor_a_thick_stone_around_others_are_nets():
    courses = np.kron(np.arange(1, 13).reshape(3, 4), np.ones((10, 30), int))
    on_base = np.pad(np.kron([[1, 2, 3]], np.ones((54, 30), int)), ((6, 0), (0, 0)),
                     constant_values=9)  # fmt: skip
    for labels in (many_stones(3, 4, size=8, gap=0), courses, on_base):
        stones = read_stones(np.pad(labels, 4), settings=ReadSettings(mask=False))
        assert [stone.id for stone in stones] == [i for i in np.unique(labels) if i]
    labels = np.pad(np.kron([[1, 0, 2, 0, 3]], np.ones((20, 20), int)), 20, constant_values=0)
    labels[12:48, 12:128] = np.where(labels[12:48, 12:128], labels[12:48, 12:128], 9)
    stones = read_stones(labels)
    assert sorted(areas(stones)) == [1, 2, 3, 9]
    assert codes(stones) == ["W112"]


@pytest.mark.parametrize(("step", "share"), [(1, 0.03), (4, 0.01)])
def test_few_blended_pixels_are_given_to_what_they_touch_most(tmp_path, step, share):
    labels = many_stones(4, 5, first=4, step=step).astype(np.int64)
    rng = np.random.default_rng(1)
    edge = (labels > 0) & (ndimage.minimum_filter(labels, 3) == 0)
    chosen = edge & (rng.random(labels.shape) < share)
    values = np.where(chosen, (labels * rng.random(labels.shape)).astype(int) | 1, labels)
    stones = read_stones(values)
    changed = int((labels != values).sum())
    assert changed > 0
    assert [stone.id for stone in stones] == [int(i) for i in np.unique(labels) if i]
    assert abs(stones.total_area_px - int((labels > 0).sum())) <= changed
    for stone in stones:
        assert abs(stone.area_px - 576) <= 4
    assert "W136" in codes(stones)
    np.save(tmp_path / "a.npy", values)
    wall = read_wall(tmp_path / "a.npy")
    assert set(np.unique(wall.labels)) <= set(np.unique(values))
    assert "W136" in [notice.code for notice in wall.notices]


def test_each_blended_pixel_is_counted_but_no_speck_or_sliver():
    known = dict.fromkeys(range(100, 220, 20), 576)
    labels = many_stones(2, 3, first=100, step=20).astype(int)
    values = labels.copy()
    values[6, 10], values[6, 20], values[5, 12] = 50, 51, 49  # two in the edge, one outside
    stones = read_stones(values)
    assert areas(stones) == known
    assert "3 px at edges have values that were blended" in said(stones)
    assert "background: 1, stone 100: 2" in said(stones)
    kept = read_stones(values, settings=ReadSettings(min_area_px=1))
    assert {49, 50, 51} <= set(areas(kept))
    assert "W136" not in codes(kept)
    labels[2, 2:4] = 50  # on the ground
    labels[30:32, 8:28] = 60  # thin, and against a stone
    stones = read_stones(labels)
    assert codes(stones) == ["W113"]
    assert areas(stones) == known | {60: 40}


@pytest.mark.parametrize("mask", [False, True])
def test_rough_stones_on_ten_million_pixels(tmp_path, mask):
    """In two seconds, or in hours where a stone is looked at in all of the picture."""
    rng = np.random.default_rng(7)
    rough = ndimage.gaussian_filter(rng.random((700, 600)), 3)
    rows, cols = np.indices(rough.shape)
    pieces, _ = ndimage.label(np.hypot((rows - 350) / 300, (cols - 300) / 255) + rough < 1.5)
    stone = pieces == pieces[350, 300]
    labels = np.zeros((3500, 3000), np.uint8)
    for i in range(25):
        part = labels[i // 5 * 700 :, i % 5 * 600 :][:700, :600]
        part[stone] = 1 if mask else i + 1
    Image.fromarray(labels).save(tmp_path / "a.png", compress_level=1)
    assert len(read_stones(tmp_path / "a.png")) == 25
