"""What is no stone in a label image: nothing by its value, nets of edges, few blended pixels."""

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from drystone.errors import InputError, LabelImageError
from drystone.io.read_stones import ReadSettings, read_stones
from drystone.io.walls import read_wall
from tests.io.pictures import areas, codes, discs, many_stones, said, two_stones

IDS = ReadSettings(mask=False)


# -- NaN, -1 and other grounds -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("dtype", "ground"),
    [("f2", np.nan), ("f8", np.nan), ("f4", -1), ("i1", -1), ("i4", -1), ("i8", -1)],
)
@pytest.mark.parametrize("background", [0, -1])
def test_what_is_no_number_of_a_stone_is_ground(tmp_path, dtype, ground, background):
    labels = np.where(two_stones() == 0, ground, two_stones(7, 9, float)).astype(dtype)
    np.save(tmp_path / "a.npy", labels)
    stones = read_stones(tmp_path / "a.npy", settings=ReadSettings(background=background))
    assert areas(stones) == {7: 375, 9: 600}
    assert codes(stones) == ([] if ground == background else ["W135"])
    wall = read_wall(tmp_path / "a.npy", ReadSettings(background=background))
    np.testing.assert_array_equal(wall.labels, two_stones(7, 9))
    assert [notice.code for notice in wall.notices] == codes(stones)


@pytest.mark.parametrize("ground", [np.nan, -1])
def test_a_stone_of_0_on_such_a_ground_is_refused(ground):
    labels = np.where(two_stones() == 0, ground, two_stones(0, 1).astype(float))
    for background in (0, -1):
        with pytest.raises(InputError, match=r"E108 .*375 px are 0.*add 1"):
            read_stones(labels, settings=ReadSettings(background=background))
    assert areas(read_stones(labels + 1 if ground != -1 else np.where(labels < 0, -1, labels + 1)))


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


# -- nets of edges -----------------------------------------------------------------------------


def netted(labels, width=3, value=255):
    """Labels with edges of a value around all stones, as data sets mark what is no class."""
    near = ndimage.maximum_filter(labels, 2 * width + 1) > 0
    return np.where((labels == 0) & near, value, labels)


@pytest.mark.parametrize(("value", "gap"), [(2, 8), (255, 3), (65535, 8), (2**32 - 1, 3)])
def test_a_net_of_edges_is_no_stone(tmp_path, value, gap):
    labels = np.pad(many_stones(4, 5, first=10, gap=gap), 4)
    np.save(tmp_path / "a.npy", netted(labels, value=value))
    stones = read_stones(tmp_path / "a.npy")
    assert areas(stones) == dict.fromkeys(range(10, 70, 3), 576)
    assert codes(stones) == ["W135"]
    assert f"the value {value} (" in said(stones)
    assert "--no-mask" in said(stones)
    skipped = read_stones(tmp_path / "a.npy", settings=ReadSettings(skip=(value, 10)))
    assert areas(skipped) == dict.fromkeys(range(13, 70, 3), 576)
    assert codes(skipped) == ["W135"]
    np.testing.assert_array_equal(read_wall(tmp_path / "a.npy").labels, labels)
    kept = read_stones(
        tmp_path / "a.npy", settings=ReadSettings(mask=False, pieces="keep-largest", holes="keep")
    )
    assert value in areas(kept)


def test_a_class_of_grains_with_a_class_of_edges_is_a_mask():
    centres = [(22 + 38 * i, 22 + 38 * j) for i in range(3) for j in range(4)]
    grains = (discs((120, 160), centres, 15) > 0.5).astype(np.uint8)
    stones = read_stones(netted(grains, 4, 2))
    assert len(stones) == 12
    assert stones.total_area_px == grains.sum()
    assert codes(stones) == ["W135", "W114"]


def test_one_stone_with_a_ring_of_no_class():
    labels = two_stones(3, 0)
    assert areas(read_stones(netted(labels, 2))) == {3: 375}
    assert 4 in areas(read_stones(netted(labels, 2, 4)))  # may be a stone, with its hole filled


@pytest.mark.parametrize(
    "labels",
    [
        many_stones(3, 4, size=8, gap=0),  # touching
        np.kron(np.arange(1, 13).reshape(3, 4), np.ones((10, 30), int)),  # courses
        np.pad(np.kron([[1, 2, 3]], np.ones((54, 30), int)), ((6, 0), (0, 0)), constant_values=9),
    ],
)  # fmt: skip
def test_stones_that_touch_are_no_net(labels):
    stones = read_stones(np.pad(labels, 4), settings=IDS)
    assert [stone.id for stone in stones] == [i for i in np.unique(labels) if i]


def test_a_thick_stone_around_others_is_no_net():
    labels = np.pad(np.kron([[1, 0, 2, 0, 3]], np.ones((20, 20), int)), 20, constant_values=0)
    labels[12:48, 12:128] = np.where(labels[12:48, 12:128], labels[12:48, 12:128], 9)
    stones = read_stones(labels)
    assert sorted(areas(stones)) == [1, 2, 3, 9]
    assert codes(stones) == ["W112"]


# -- blended pixels ----------------------------------------------------------------------------


def blended(share, first=20, step=4, seed=1):
    """Stones of which a share of the outline took a value between those of its two sides."""
    labels = many_stones(4, 5, first=first, step=step).astype(np.int64)
    rng = np.random.default_rng(seed)
    edge = (labels > 0) & (ndimage.minimum_filter(labels, 3) == 0)
    chosen = edge & (rng.random(labels.shape) < share)
    return labels, np.where(chosen, (labels * rng.random(labels.shape)).astype(int) | 1, labels)


@pytest.mark.parametrize(("step", "share"), [(1, 0.03), (4, 0.01)])
def test_few_blended_pixels_are_given_to_what_they_touch_most(tmp_path, step, share):
    labels, values = blended(share, first=4, step=step)
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


def test_each_blended_pixel_is_counted():
    labels = many_stones(2, 3, first=100, step=20).astype(int)
    values = labels.copy()
    values[6, 10], values[6, 20], values[5, 12] = 50, 51, 49  # two in the edge, one outside
    stones = read_stones(values)
    assert areas(stones) == dict.fromkeys(range(100, 220, 20), 576)
    assert "3 px at edges have values that were blended" in said(stones)
    assert "background: 1, stone 100: 2" in said(stones)
    kept = read_stones(values, settings=ReadSettings(min_area_px=1))
    assert {49, 50, 51} <= set(areas(kept))
    assert "W136" not in codes(kept)


def test_specks_and_slivers_are_not_blended():
    labels = many_stones(2, 3, first=100, step=20).astype(int)
    labels[2, 2:4] = 50  # on the ground
    labels[30:32, 8:28] = 60  # thin, and against a stone
    stones = read_stones(labels)
    assert codes(stones) == ["W113"]
    assert areas(stones) == dict.fromkeys(range(100, 220, 20), 576) | {60: 40}


def test_a_mask_with_a_few_coloured_pixels(tmp_path):
    centres = [(30 + 60 * i, 30 + 60 * j) for i in range(3) for j in range(4)]
    cover = (discs((180, 240), centres, 22) * 255).astype(np.uint8)
    values = np.dstack([cover] * 3)
    values[52, 30] = (30, 200, 90)
    values[150, 129] = (200, 60, 70)
    values[2, 2:5] = 255
    values[2, 100:104] = values[3, 100:104] = values[4, 100:104] = 255  # 12 px, under 1 %
    Image.fromarray(values).save(tmp_path / "a.png")
    stones = read_stones(tmp_path / "a.png")
    assert len(stones) == 12
    assert codes(stones)[:2] == ["W114", "W113"]
    assert "2 specks < 16 px" in said(stones)
    assert len(read_stones(tmp_path / "a.png", settings=ReadSettings(min_area_px=10))) == 13


# -- large pictures: two seconds, or hours where a stone is looked at in all of the picture --------


@pytest.mark.parametrize("mask", [False, True])
def test_rough_stones_on_ten_million_pixels(tmp_path, mask):
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
