"""The table of bad input (docs/users.md): each row has its coded error or warning."""

import io

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from drystone.errors import ExitCode, InputError, LabelImageError, UsageError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.pictures import areas, codes, many_stones, two_stones


def message(stones, code):
    return next(str(notice) for notice in stones.notices if notice.code == code)


def jpeg(path, values, quality=75):
    Image.fromarray(values).save(path, "JPEG", quality=quality)
    return path


def photo(shape=(200, 300)):
    rng = np.random.default_rng(3)
    base = ndimage.gaussian_filter(rng.random(shape), 6)
    base = 40 + 160 * (base - base.min()) / np.ptp(base)
    colours = base[..., None] * [1, 0.9, 0.8] + rng.normal(0, 8, (*shape, 3))
    return np.clip(colours, 0, 255).astype(np.uint8)


# -- lossy and blended labels (E101), photos (E102) --------------------------------------------


@pytest.mark.parametrize("quality", [50, 75, 95])
def test_jpeg_labels(tmp_path, quality):
    labels = many_stones(first=20, step=4).astype(np.uint8)
    path = jpeg(tmp_path / "stones.jpg", labels, quality)
    values, counts = np.unique(np.asarray(Image.open(path)), return_counts=True)
    with pytest.raises(LabelImageError) as caught:
        read_stones(path)
    error = caught.value
    assert (error.code, error.where, error.exit_code) == ("E101", "stones.jpg", ExitCode.BAD_INPUT)
    assert f"{len(values)} values, {(counts < 10).sum()} of them on less than 10 px" in error.what
    assert "plain areas look like 48 stones" in error.what
    assert "PNG" in error.cure


def test_jpeg_inside_tiff_and_under_another_name(tmp_path):
    labels = many_stones(first=20, step=4).astype(np.uint8)
    Image.fromarray(labels).save(tmp_path / "a.tif", compression="jpeg")
    jpeg(tmp_path / "a.png", labels)
    for name in ("a.tif", "a.png"):
        with pytest.raises(LabelImageError, match=r"E101"):
            read_stones(tmp_path / name)


def test_jpeg_of_a_mask_can_be_read_as_a_mask(tmp_path):
    mask = (many_stones() > 0).astype(np.uint8) * 255
    path = jpeg(tmp_path / "mask.jpg", mask)
    with pytest.raises(LabelImageError, match=r"E101.*mask=True.*drystone segment PHOTO"):
        read_stones(path)
    stones = read_stones(path, settings=ReadSettings(mask=True))
    assert len(stones) == 48
    assert all(abs(stone.area_px - 576) < 12 for stone in stones)


@pytest.mark.parametrize("method", ["BILINEAR", "BICUBIC", "LANCZOS", "HAMMING"])
def test_labels_scaled_by_interpolation(tmp_path, method):
    labels = many_stones(first=20, step=4).astype(np.uint8)
    image = Image.fromarray(labels)
    image.resize((333, 261), Image.Resampling[method]).save(tmp_path / "a.png")
    with pytest.raises(LabelImageError, match=r"E101.*blended at the edges.*about 48 are stones"):
        read_stones(tmp_path / "a.png")


@pytest.mark.parametrize("method", ["BILINEAR", "BICUBIC", "LANCZOS", "HAMMING"])
@pytest.mark.parametrize("many", [(3, 3), (5, 6)])
def test_blended_edges_in_ids_of_other_stones(method, many):
    # Of ids 1 ... n every value between two is an id that is there.
    labels = many_stones(*many, first=1, step=1).astype(np.uint8)
    size = (labels.shape[1] * 2, labels.shape[0] * 2)
    blurred = np.asarray(Image.fromarray(labels).resize(size, Image.Resampling[method]))
    with pytest.raises(LabelImageError, match=r"E101.*blended at the edges.*id of another") as told:
        read_stones(blurred)
    assert len(str(told.value)) < 400


def test_joints_of_a_value_between_ids_are_background():
    ids = np.random.default_rng(3).permutation([i for i in range(1, 50) if i != 30])
    bricks = np.full((6 * 22 + 12, 8 * 42 + 12), 30, np.uint8)
    for number, stone in enumerate(ids):
        row, col = 6 + 22 * (number // 8), 6 + 42 * (number % 8)
        bricks[row : row + 20, col : col + 40] = stone
    assert len(read_stones(bricks, settings=ReadSettings(background=30))) == 48


def test_stones_that_touch_everywhere_are_not_blended():
    # Stones of about 4.5 px, each between a lower and a higher id at its corners.
    points = np.random.default_rng(1).random((500, 2)) * 100
    rows, cols = np.indices((100, 100))
    far = (rows[..., None] - points[:, 0]) ** 2 + (cols[..., None] - points[:, 1]) ** 2
    labels = np.pad(far.argmin(axis=2) + 1, 3)
    settings = ReadSettings(min_area_px=1, pieces="keep-largest")
    assert len(read_stones(labels, settings=settings)) == len(np.unique(labels)) - 1


def test_many_slivers_are_no_blending():
    labels = np.zeros((120, 120), np.uint8)
    labels[5:50, 5:115] = 250
    for i in range(30):
        labels[55 + i // 6 * 4 : 57 + i // 6 * 4, 2 + i % 6 * 19 : 18 + i % 6 * 19] = 10 + i
    assert len(read_stones(labels)) == 31


@pytest.mark.parametrize("grey", [False, True])
@pytest.mark.parametrize("suffix", ["png", "jpg"])
def test_photos(tmp_path, grey, suffix):
    image = Image.fromarray(photo())
    path = tmp_path / f"pile.{suffix}"
    (image.convert("L") if grey else image).save(path)
    with pytest.raises(LabelImageError, match=r"E102 pile.*looks like a photo.*label image"):
        read_stones(path)


def test_many_colours_in_plain_areas_are_ids():
    labels = many_stones(70, 70, size=5, gap=1, first=1, step=977)
    assert len(read_stones(labels)) == 4900


# -- touching stones ---------------------------------------------------------------------------


def test_two_stones_under_one_id_are_suspected():
    labels = many_stones(3, 4, size=20, gap=8)
    labels[8:28, 8:28] = labels[8:28, 36:56] = 500
    labels[15:21, 28:36] = 500  # a neck of 6 px
    stones = read_stones(labels)
    assert codes(stones) == ["W110"]
    text = message(stones, "W110")
    assert "stone 500 has 2.1 times the median area and a neck of about 6 px" in text


# -- pieces and holes --------------------------------------------------------------------------


def pieces(second=375):
    labels = two_stones(5, 9)
    labels[2, 40 : 40 + second % 20] = 5
    if second == 375:
        labels[5:20, 32:57] = 5
    return labels


def test_a_small_piece_is_left_out_and_listed():
    stones = read_stones(pieces(7))
    assert areas(stones) == {5: 375, 9: 600}
    assert codes(stones) == ["W111"]
    assert "stone 5: 7 px at column 40, row 2" in message(stones, "W111")


def test_pieces_of_two_percent_are_refused_by_default():
    labels = pieces(7)
    labels[2, 47] = 5  # 8 of 383 px
    with pytest.raises(LabelImageError, match=r"E103.*stone 5: 375 px .* row 5, 8 px .* row 2"):
        read_stones(labels)
    for settings in (ReadSettings(pieces="keep-largest"), ReadSettings(skip=(5,))):
        assert 600 in areas(read_stones(labels, settings=settings)).values()
    assert areas(read_stones(labels, settings=ReadSettings(pieces="keep-largest")))[5] == 375


def test_pieces_error_refuses_any():
    with pytest.raises(LabelImageError, match=r"E103"):
        read_stones(pieces(7), settings=ReadSettings(pieces="error"))


def test_split_lists_bits_too_small_to_be_stones():
    stones = read_stones(pieces(7), settings=ReadSettings(pieces="split"))
    assert areas(stones) == {5: 375, 9: 600}
    assert codes(stones) == ["W111", "W113"]
    assert "10 of 7 px at column 40, row 2" in message(stones, "W113")


def test_split_ids_after_the_last_possible_id():
    labels = pieces()
    labels[labels == 9] = 2**32 - 1
    labels[labels == 5] = 1
    stones = read_stones(labels, settings=ReadSettings(pieces="split"))
    assert sorted(areas(stones)) == [1, 2, 3, 2**32 - 1]


def test_holes_are_filled_before_area_and_centroid():
    labels = two_stones(5, 9)
    labels[6:10, 6:11] = 0
    filled = read_stones(labels)
    assert areas(filled) == {5: 375, 9: 600}
    assert filled.by_id(5).centroid == (17.5, 27.5)
    assert "holes filled: stone 5: 20 px." in message(filled, "W112")
    kept = read_stones(labels, settings=ReadSettings(holes="keep"))
    assert areas(kept) == {5: 355, 9: 600}
    assert "holes kept open" in message(kept, "W112")


def test_a_stone_in_a_hole_of_another_stays_and_is_said():
    labels = two_stones(5, 9)
    labels[8:14, 8:14] = 77
    stones = read_stones(labels)
    assert areas(stones) == {5: 375, 9: 600, 77: 36}
    assert "stone 5: 36 px, 36 px of them other stones'" in message(stones, "W112")


# -- specks ------------------------------------------------------------------------------------


def test_specks_are_left_out_and_all_listed():
    labels = two_stones(5, 9)
    labels[1:4, 50:53], labels[38, 0] = 11, 12
    stones = read_stones(labels)
    assert areas(stones) == {5: 375, 9: 600}
    text = message(stones, "W113")
    assert "2 specks < 10 px left out (10 px in all)" in text
    assert "11 of 9 px at column 50, row 1, 12 of 1 px at column 0, row 38" in text
    kept = read_stones(labels, settings=ReadSettings(min_area_px=1))
    assert areas(kept) == {5: 375, 9: 600, 11: 9, 12: 1}


def test_an_id_scattered_as_noise_is_a_speck_not_a_broken_stone():
    labels = two_stones(5, 9)
    labels[0, ::2] = 11
    assert "11 of 30 px" in message(read_stones(labels), "W113")


def test_speck_limit_grows_with_the_stones():
    labels = many_stones(2, 2, size=150)
    labels[0, :21] = 99  # 0.1 % of the median 22,500 px are 22.5 px
    assert len(read_stones(labels)) == 4
    labels[1, :2] = 99
    assert len(read_stones(labels)) == 5


# -- nothing there, wrong background -----------------------------------------------------------


@pytest.mark.parametrize("value", [0, 1, 255])
def test_one_value(value):
    with pytest.raises(LabelImageError, match=rf"E104.*all 64 x 48 px are {value}"):
        read_stones(np.full((48, 64), value, np.uint8))


def test_nothing_left():
    labels = np.zeros((20, 20), np.uint8)
    labels[3, 3], labels[9, 9] = 4, 5
    with pytest.raises(LabelImageError, match=r"E104.*2 specks"):
        read_stones(labels)
    with pytest.raises(LabelImageError, match=r"E104.*skipped"):
        read_stones(two_stones(), settings=ReadSettings(skip=(300, 70000)))


@pytest.mark.parametrize("empty", [np.zeros((0, 5), int), np.zeros((5, 0, 3), np.uint8)])
def test_no_pixels(empty):
    with pytest.raises(LabelImageError, match=r"E104.*no pixels"):
        read_stones(empty)


@pytest.mark.parametrize("mask", [False, True])
def test_white_background(mask):
    labels = two_stones(5, 5 if mask else 9, np.uint8)
    labels[labels == 0] = 255
    with pytest.raises(LabelImageError, match=r"E105.*value 255 fills.*Use --background 255 "):
        read_stones(labels)
    stones = read_stones(labels, settings=ReadSettings(background=255))
    assert sorted(areas(stones).values()) == [375, 600]


def test_a_stone_cropped_to_its_box_is_no_background():
    labels = np.full((30, 40), 7, np.uint8)
    labels[:6, :6] = 0  # one corner is missing
    assert areas(read_stones(labels)) == {7: 1164}
    labels[:4, -4:] = labels[-4:, :4] = labels[-4:, -4:] = 0
    labels[12:18, 12:18] = 9  # a stone lies on it, and it has no corners
    assert areas(read_stones(labels)) == {7: 1116, 9: 36}


def test_zero_beside_another_background():
    labels = two_stones(0, 9, np.uint8)
    labels[0:5] = 255
    with pytest.raises(LabelImageError, match=r"E108.*value 0 is there beside the background 255"):
        read_stones(labels, settings=ReadSettings(background=255))


# -- values that are no ids --------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (np.nan, "1 px are not finite"),
        (np.inf, "1 px are not finite"),
        (2.5, "1 px are no whole numbers"),
        (-3.0, "1 px are -3 ... 70000 outside"),
        (2.0**32, "1 px are not from 0 to"),
    ],
)
def test_floats_that_are_no_ids(value, said):
    labels = two_stones().astype(float)
    labels[7, 9] = value
    with pytest.raises(LabelImageError, match=rf"E108.*{said}.*column 9, row 7"):
        read_stones(labels)


@pytest.mark.parametrize("value", [-1, 2**32])
def test_integers_out_of_range_never_wrap(value):
    labels = two_stones().astype(np.int64)
    labels[7, 9] = value
    with pytest.raises(LabelImageError, match=r"E108.*outside 0 ... 2\^32-1.*column 9, row 7"):
        read_stones(labels)


@pytest.mark.parametrize("dtype", [complex, "U3", object])
def test_types_that_are_no_numbers(dtype):
    with pytest.raises(LabelImageError, match=r"E108.*are no ids"):
        read_stones(two_stones().astype(dtype))


def test_negative_background():
    labels = two_stones().astype(np.int64)
    labels[labels == 0] = -1
    assert areas(read_stones(labels, settings=ReadSettings(background=-1))) == {
        300: 375,
        70000: 600,
    }
    labels[0, 0] = 0
    with pytest.raises(LabelImageError, match=r"E108"):
        read_stones(labels, settings=ReadSettings(background=-1))


def test_masked_pixels_of_an_array_are_background():
    labels = np.ma.masked_equal(two_stones(), 300)
    assert areas(read_stones(labels)) == {70000: 600}


# -- folder of masks ---------------------------------------------------------------------------


def save_mask(path, mask):
    Image.fromarray(mask.astype(np.uint8) * 255).save(path)


def test_folder_is_numbered_in_natural_order(tmp_path):
    folder = tmp_path / "set"
    folder.mkdir()
    for name, side in (("s10.png", 10), ("s9.png", 9), ("s1.png", 4), ("S2.png", 5)):
        mask = np.zeros((20, 10 + side), bool)
        mask[2 : 2 + side, 3 : 3 + side] = True
        save_mask(folder / name, mask)
    (folder / "notes.txt").write_text("by hand")
    (folder / ".hidden").write_text("")
    stones = read_stones(folder)
    assert stones.source.files == ("s1.png", "S2.png", "s9.png", "s10.png")
    assert [stone.name for stone in stones] == list(stones.source.files)
    assert areas(stones) == {1: 16, 2: 25, 3: 81, 4: 100}
    assert stones.by_id(4).bottom_px == 8
    assert (stones.source.path, stones.source.width_px, stones.source.height_px) == ("set", 20, 20)
    assert codes(stones) == ["W117"]
    assert "notes.txt" in message(stones, "W117")
    before = stones.source.sha256
    save_mask(folder / "s9.png", np.pad(np.ones((9, 8), bool), 2))
    assert read_stones(folder).source.sha256 != before


def test_folder_with_an_empty_a_full_and_a_broken_mask(tmp_path):
    save_mask(tmp_path / "a.png", np.zeros((9, 9), bool))
    save_mask(tmp_path / "b.png", np.ones((8, 9), bool))
    two = two_stones() == 300
    two[30:35, 30:32] = True
    save_mask(tmp_path / "c.png", two)
    with pytest.raises(LabelImageError, match=r"E103.*stone 3 \(c.png\)"):
        read_stones(tmp_path)
    stones = read_stones(tmp_path, settings=ReadSettings(pieces="keep-largest"))
    assert areas(stones) == {2: 72, 3: 375}
    assert "1 (a.png) of 0 px" in message(stones, "W113")
    assert "b.png is stone to all its edges" in message(stones, "W118")
    split = read_stones(tmp_path, settings=ReadSettings(pieces="split"))
    assert areas(split) == {2: 72, 3: 375, 4: 10}
    assert split.by_id(4).name == "c.png"


def test_folder_of_other_things(tmp_path):
    with pytest.raises(InputError, match=r"E111.*no pictures"):
        read_stones(tmp_path)
    Image.fromarray(two_stones(7, 9, np.uint8)).save(tmp_path / "labels.png")
    with pytest.raises(LabelImageError, match=r"E111.*labels.png: 3 values in a mask of one stone"):
        read_stones(tmp_path)


def test_folder_masks_of_any_stone_value(tmp_path):
    for name, value in (("a", 1), ("b", 255), ("c", 128)):
        mask = (two_stones() == 300).astype(np.uint8) * np.uint8(value)
        Image.fromarray(mask).save(tmp_path / f"{name}.png")
    np.save(tmp_path / "d.npy", two_stones() == 70000)
    assert areas(read_stones(tmp_path)) == {1: 375, 2: 375, 3: 375, 4: 600}


def test_folder_with_a_damaged_or_jpeg_mask(tmp_path):
    mask = (two_stones() == 300).astype(np.uint8) * np.uint8(255)
    jpeg(tmp_path / "a.jpg", mask)
    with pytest.raises(LabelImageError, match=r"E101.*a.jpg"):
        read_stones(tmp_path)
    assert abs(read_stones(tmp_path, settings=ReadSettings(mask=True)).by_id(1).area_px - 375) < 9
    buffer = io.BytesIO()
    Image.fromarray(mask).save(buffer, "PNG")
    (tmp_path / "b.png").write_bytes(buffer.getvalue()[:60])
    with pytest.raises(InputError, match=r"E106.*b.png"):
        read_stones(tmp_path, settings=ReadSettings(mask=True))


@pytest.mark.parametrize("given", [".", "..", "../set", "../set/"])
def test_folder_is_named_however_it_is_given(tmp_path, monkeypatch, given):
    (tmp_path / "set" / "deeper").mkdir(parents=True)
    monkeypatch.chdir(tmp_path / "set" / ("deeper" if given == ".." else "."))
    with pytest.raises(InputError, match=r"E111 set: the folder has no pictures"):
        read_stones(given)
    save_mask(tmp_path / "set" / "a.png", two_stones() == 300)
    assert read_stones(given).source.path == "set"
    (tmp_path / "set" / "c.png").write_bytes(b"none")
    with pytest.raises(InputError, match=r"E107 set/c.png"):
        read_stones(given)


def test_folder_of_a_plan(tmp_path):
    save_mask(tmp_path / "a.png", two_stones() == 300)
    for other in ("{", "[1]", '{"steps": []}'):
        (tmp_path / "plan.json").write_text(other)
        assert len(read_stones(tmp_path)) == 1
    (tmp_path / "plan.json").write_text('{"steps": [], "source": {}}')
    with pytest.raises(InputError, match=r"E113 .*this folder is a plan.*--from"):
        read_stones(tmp_path)


# -- settings ----------------------------------------------------------------------------------


def test_a_picture_has_no_images_to_choose_from(tmp_path):
    settings = ReadSettings(image="tray-3.jpg")
    save_mask(tmp_path / "a.png", two_stones() == 300)
    for source in (two_stones(), tmp_path, tmp_path / "a.png"):
        with pytest.raises(UsageError, match=r"E118.*'tray-3.jpg'.*Leave --image"):
            read_stones(source, settings=settings)


@pytest.mark.parametrize(
    "wrong", [{"pieces": "all"}, {"holes": "no"}, {"min_area_px": 0}, {"max_image_mpx": 0.0}]
)
def test_settings_that_mean_nothing(wrong):
    with pytest.raises(UsageError, match=rf"E119 ReadSettings: {next(iter(wrong))}"):
        ReadSettings(**wrong)
