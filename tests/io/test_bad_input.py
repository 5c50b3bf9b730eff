"""The table of bad input (docs/users.md): each row has its coded error or warning."""

import re

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from drystone.errors import DrystoneError, ExitCode, InputError, LabelImageError, UsageError
from drystone.io.photo_beside import PhotoSidecar, write_sidecar
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.pictures import areas, codes, discs, many_stones, said, save_mask, two_stones

LARGEST = ReadSettings(pieces="keep-largest")
SPLIT = ReadSettings(pieces="split")
METHODS = ["BILINEAR", "BICUBIC", "LANCZOS", "HAMMING"]


def photo(shape=(200, 300)):
    rng = np.random.default_rng(3)
    base = ndimage.gaussian_filter(rng.random(shape), 6)
    base = 40 + 160 * (base - base.min()) / np.ptp(base)
    colours = base[..., None] * [1, 0.9, 0.8] + rng.normal(0, 8, (*shape, 3))
    return np.clip(colours, 0, 255).astype(np.uint8)


def changed(values, *changes):
    """An array with some values at other places."""
    values = np.array(values)
    for place, value in changes:
        values[place] = value
    return values


# -- lossy and blended labels (E101), photos (E102) --------------------------------------------


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("stones.jpg", {"quality": 50}),
        ("stones.png", {"format": "JPEG", "quality": 95}),
        ("stones.tif", {"compression": "jpeg"}),
    ],
)
def test_jpeg_labels(tmp_path, name, options):
    labels = many_stones(first=20, step=4).astype(np.uint8)
    Image.fromarray(labels).save(tmp_path / name, **options)
    values, counts = np.unique(np.asarray(Image.open(tmp_path / name)), return_counts=True)
    with pytest.raises(LabelImageError) as caught:
        read_stones(tmp_path / name)
    error = caught.value
    assert (error.code, error.where, error.exit_code) == ("E101", name, ExitCode.BAD_INPUT)
    assert f"{len(values)} values, {(counts < 10).sum()} of them on less than 10 px" in error.what
    assert "plain areas look like 48 stones" in error.what
    assert "PNG" in error.cure


def test_jpeg_of_a_mask_can_be_read_as_a_mask(tmp_path):
    mask = (many_stones() > 0).astype(np.uint8) * 255
    Image.fromarray(mask).save(path := tmp_path / "mask.jpg")
    with pytest.raises(LabelImageError, match=r"E101.*mask=True.*drystone segment PHOTO"):
        read_stones(path)
    stones = read_stones(path, settings=ReadSettings(mask=True))
    assert len(stones) == 48
    assert all(abs(stone.area_px - 576) < 12 for stone in stones)


@pytest.mark.parametrize("method", METHODS)
def test_labels_that_were_scaled_by_interpolation(method):
    labels = Image.fromarray(many_stones(first=20, step=4).astype(np.uint8))
    scaled = np.asarray(labels.resize((333, 261), Image.Resampling[method]))
    with pytest.raises(LabelImageError, match=r"E101.*blended at the edges.*about 48 are stones"):
        read_stones(scaled)
    for many in ((3, 3), (5, 6)):
        # Of ids 1 ... n every value between two is an id that is there.
        labels = Image.fromarray(many_stones(*many, first=1, step=1).astype(np.uint8))
        size = (labels.width * 2, labels.height * 2)
        with pytest.raises(LabelImageError, match=r"E101.*edges.*id of another") as told:
            read_stones(np.asarray(labels.resize(size, Image.Resampling[method])))
        assert len(str(told.value)) < 400


@pytest.mark.parametrize(("grey", "suffix"), [(True, "png"), (False, "png"), (True, "jpg")])
def test_photos(tmp_path, grey, suffix):
    image = Image.fromarray(photo())
    path = tmp_path / f"pile.{suffix}"
    (image.convert("L") if grey else image).save(path)
    with pytest.raises(LabelImageError, match=r"E102 pile.*looks like a photo.*label image"):
        read_stones(path)


# -- labels that only look blended or like a photo ---------------------------------------------


def bricks():
    """Bricks with joints of a value between ids."""
    ids = np.random.default_rng(3).permutation([i for i in range(1, 50) if i != 30])
    labels = np.full((6 * 22 + 12, 8 * 42 + 12), 30, np.uint8)
    for number, stone in enumerate(ids):
        row, col = 6 + 22 * (number // 8), 6 + 42 * (number % 8)
        labels[row : row + 20, col : col + 40] = stone
    return labels


def touching():
    """Stones of about 4.5 px, each between a lower and a higher id at its corners."""
    points = np.random.default_rng(1).random((500, 2)) * 100
    rows, cols = np.indices((100, 100))
    far = (rows[..., None] - points[:, 0]) ** 2 + (cols[..., None] - points[:, 1]) ** 2
    return np.pad(far.argmin(axis=2) + 1, 3)


def slivers():
    labels = np.zeros((120, 120), np.uint8)
    labels[5:50, 5:115] = 250
    for i in range(30):
        labels[55 + i // 6 * 4 : 57 + i // 6 * 4, 2 + i % 6 * 19 : 18 + i % 6 * 19] = 10 + i
    return labels


@pytest.mark.parametrize(
    ("labels", "count", "settings"),
    [
        (bricks(), 48, ReadSettings(background=30)),
        (touching(), 500, ReadSettings(min_area_px=1, pieces="keep-largest")),
        (slivers(), 31, None),
        (many_stones(40, 40, size=5, gap=1, first=1, step=977), 1600, None),
    ],
)
def test_labels_that_are_sound(labels, count, settings):
    assert len(read_stones(labels, settings=settings)) == count


# -- touching stones, pieces, holes and specks -------------------------------------------------


def test_two_stones_under_one_id_are_suspected():
    labels = many_stones(3, 4, size=20, gap=8)
    labels[8:28, 8:28] = labels[8:28, 36:56] = 500
    labels[15:21, 28:36] = 500  # a neck of 6 px
    stones = read_stones(labels)
    assert codes(stones) == ["W110"]
    assert "stone 500 has 2.1 times the median area and a neck of about 6 px" in said(stones)


def pieces(second=375):
    labels = two_stones(5, 9)
    labels[2, 40 : 40 + second % 20] = 5
    if second == 375:
        labels[5:20, 32:57] = 5
    return labels


HOLED = changed(two_stones(5, 9), (np.s_[6:10, 6:11], 0))
WITHIN = changed(two_stones(5, 9), (np.s_[8:14, 8:14], 77))
SPECKS = changed(two_stones(5, 9), (np.s_[1:4, 50:53], 11), (np.s_[38, 0], 12))
LAST = np.select([pieces() == 9, pieces() == 5], [2**32 - 1, 1], 0)
WHOLE = {5: 375, 9: 600}


@pytest.mark.parametrize(
    ("labels", "settings", "found", "codes_", "text"),
    [
        (pieces(7), SPLIT, WHOLE, "W111 W113", "10 of 7 px at column 40, row 2"),
        (pieces(), SPLIT, {**WHOLE, 10: 375, 11: 15}, "W111", "stone 5: 10 (375 px), 11 (15 px)"),
        (LAST, SPLIT, {1: 375, 2: 375, 3: 15, 2**32 - 1: 600}, "W111", "stone 1: 2 (375 px)"),
        (HOLED, None, WHOLE, "W112", "holes filled: stone 5: 20 px."),
        (HOLED, ReadSettings(holes="keep"), {5: 355, 9: 600}, "W112", "holes kept open"),
        (WITHIN, None, {**WHOLE, 77: 36}, "W112", "stone 5: 36 px, 36 px of them other stones'"),
        (SPECKS, None, WHOLE, "W113", "2 specks < 10 px left out (10 px in all)"),
        (SPECKS, None, WHOLE, "W113", "11 of 9 px at column 50, row 1, 12 of 1 px at column 0"),
        (SPECKS, ReadSettings(min_area_px=1), {**WHOLE, 11: 9, 12: 1}, "", ""),
        # An id that is scattered as noise is a speck, not a broken stone.
        (changed(two_stones(5, 9), (np.s_[0, ::2], 11)), None, WHOLE, "W113", "11 of 30 px"),
    ],
)
def test_what_is_left_out_or_added_is_said(labels, settings, found, codes_, text):
    stones = read_stones(labels, settings=settings)
    assert areas(stones) == found
    assert codes(stones) == codes_.split()
    assert text in said(stones)


def test_pieces_of_two_percent_are_refused_by_default():
    labels = pieces(7)
    with pytest.raises(LabelImageError, match=r"E103"):
        read_stones(labels, settings=ReadSettings(pieces="error"))
    labels[2, 47] = 5  # 8 of 383 px
    with pytest.raises(LabelImageError, match=r"E103.*stone 5: 375 px .* row 5, 8 px .* row 2"):
        read_stones(labels)
    assert areas(read_stones(labels, settings=LARGEST)) == WHOLE
    assert areas(read_stones(labels, settings=ReadSettings(skip=(5,)))) == {9: 600}


def test_speck_limit_grows_with_the_stones():
    labels = many_stones(2, 2, size=150)
    labels[0, :21] = 99  # 0.1 % of the median 22,500 px are 22.5 px
    assert len(read_stones(labels)) == 4
    labels[1, :2] = 99
    assert len(read_stones(labels)) == 5


# -- pictures that are refused -----------------------------------------------------------------

WHITE = changed(two_stones(5, 9, np.uint8), (two_stones() == 0, 255))
ON_WHITE = ReadSettings(background=255)
MINUS = changed(two_stones().astype(np.int64), (two_stones() == 0, -1))


def with_value(value, dtype=float):
    return changed(two_stones().astype(dtype), (np.s_[7, 9], value))


@pytest.mark.parametrize(
    ("values", "settings", "text"),
    [
        *((np.full((48, 64), v, np.uint8), {}, rf"E104.*all 64 x 48 px are {v}") for v in (0, 9)),
        (changed(np.zeros((20, 20), int), (([3, 9], [3, 9]), [4, 5])), {}, r"E104.*2 specks"),
        (two_stones(), {"skip": (300, 70000)}, r"E104.*skipped"),
        (np.zeros((0, 5), int), {}, r"E104.*no pixels"),
        (WHITE, {}, r"E105.*value 255 fills.*Use --background 255 "),
        (np.where(WHITE == 255, 255, 5), {}, r"E105.*Use --background 255 "),
        (np.where(WHITE == 5, 0, WHITE), {"background": 255}, r"E108.*value 0 .*background 255"),
        (with_value(np.inf), {}, r"E108.*1 px are not finite.*column 9, row 7"),
        (with_value(2.5), {}, r"E108.*1 px are not whole numbers.*column 9, row 7"),
        (with_value(2.0**32), {}, r"E108.*1 px are not from 0 to.*column 9, row 7"),
        (with_value(-2, np.int64), {}, r"E108.*outside 0 ... 2\^32-1.*column 9, row 7"),
        (changed(MINUS, (np.s_[0, 0], 0)), {"background": -1}, r"E108"),
        *(
            (two_stones().astype(kind), {}, r"E108.*are not ids")
            for kind in (complex, "U3", object)
        ),
        (two_stones(), {"image": "tray-3.jpg"}, r"E118.*'tray-3.jpg'.*Leave --image"),
    ],
)
def test_values_that_are_refused(values, settings, text):
    with pytest.raises(DrystoneError) as caught:
        read_stones(values, settings=ReadSettings(**settings))
    assert re.match(text, str(caught.value))
    assert caught.value.where == "array"


def test_another_background_can_be_named():
    assert areas(read_stones(WHITE, settings=ON_WHITE)) == WHOLE
    black = np.where(WHITE == 255, 255, 0)
    assert areas(read_stones(black, settings=ON_WHITE)) == {1: 375, 2: 600}
    assert areas(read_stones(MINUS, settings=ReadSettings(background=-1))) == areas(
        read_stones(two_stones())
    )
    assert areas(read_stones(np.ma.masked_equal(two_stones(), 300))) == {70000: 600}


def test_a_stone_cropped_to_its_box_is_no_background():
    labels = np.full((30, 40), 7, np.uint8)
    labels[:6, :6] = 0  # one corner is missing
    assert areas(read_stones(labels)) == {7: 1164}
    labels[:4, -4:] = labels[-4:, :4] = labels[-4:, -4:] = 0
    labels[12:18, 12:18] = 9  # a stone lies on it, and it has no corners
    assert areas(read_stones(labels)) == {7: 1116, 9: 36}


# -- folder of masks ---------------------------------------------------------------------------


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
    assert "notes.txt" in said(stones)
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
    stones = read_stones(tmp_path, settings=LARGEST)
    assert areas(stones) == {2: 72, 3: 375}
    assert "1 (a.png) of 0 px" in said(stones)
    assert f"{tmp_path.name}/b.png is stone to all its edges" in said(stones)
    split = read_stones(tmp_path, settings=SPLIT)
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
    cover = discs((40, 40), [(20, 20)], 12) * 255  # anti-aliased
    Image.fromarray(cover.astype(np.uint8)).save(tmp_path / "e.png")
    found = {1: 375, 2: 375, 3: 375, 4: 600, 5: int((cover >= 127.5).sum())}
    assert areas(read_stones(tmp_path)) == found


def test_folder_with_a_damaged_or_jpeg_mask(tmp_path):
    mask = (two_stones() == 300).astype(np.uint8) * np.uint8(255)
    Image.fromarray(mask).save(tmp_path / "a.jpg")
    with pytest.raises(LabelImageError, match=r"E101.*a.jpg"):
        read_stones(tmp_path)
    assert abs(read_stones(tmp_path, settings=ReadSettings(mask=True)).by_id(1).area_px - 375) < 9
    Image.fromarray(mask).save(path := tmp_path / "b.png")
    path.write_bytes(path.read_bytes()[:60])
    with pytest.raises(InputError, match=r"E106.*b.png"):
        read_stones(tmp_path, settings=ReadSettings(mask=True))


@pytest.mark.parametrize("given", [".", "..", "../set/"])
def test_folder_is_named_however_it_is_given(tmp_path, monkeypatch, given):
    (tmp_path / "set" / "deeper").mkdir(parents=True)
    monkeypatch.chdir(tmp_path / "set" / ("deeper" if given == ".." else "."))
    with pytest.raises(InputError, match=r"E111 set: the folder has no pictures"):
        read_stones(given)
    save_mask(tmp_path / "set" / "a.png", two_stones() == 300)
    assert read_stones(given).source.path == "set"
    with pytest.raises(UsageError, match=r"E118 set: .*'tray-3.jpg'"):
        read_stones(given, settings=ReadSettings(image="tray-3.jpg"))
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


@pytest.mark.parametrize(
    ("shape", "beside"), [((), True), ((7,), True), ((3, 4, 5, 6), False), ((0, 3), True)]
)
def test_an_array_of_other_dimensions_in_a_file(tmp_path, shape, beside):
    np.save(tmp_path / "stones.npy", np.ones(shape, np.uint8))
    if beside:
        write_sidecar(PhotoSidecar(3, 4, labels="stones.npy"), tmp_path)
    with pytest.raises(InputError, match=r"E1\d\d"):
        read_stones(tmp_path / "stones.npy")


def test_settings_that_mean_nothing():
    wrong = {"pieces": "all", "holes": "no", "min_area_px": 0, "max_image_mpx": 0.0, "unit": "yard"}
    for name, value in (*wrong.items(), ("px_per_m", 0.0), ("px_per_m", float("inf"))):
        with pytest.raises(UsageError, match=rf"E119 ReadSettings: {name}"):
            ReadSettings(**{name: value})
