"""The table of bad input (docs/users.md): each row has its coded error or warning."""

import re

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage
from scipy.spatial.distance import cdist

from drystone.errors import DrystoneError, ExitCode, InputError, LabelImageError, UsageError
from drystone.io.photo_beside import PhotoSidecar, write_sidecar
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.pictures import areas, codes, discs, many_stones, said, save_mask, two_stones

LARGEST = ReadSettings(pieces="keep-largest")
SPLIT = ReadSettings(pieces="split")


def test_photos(tmp_path):
    rng = np.random.default_rng(3)
    base = ndimage.gaussian_filter(rng.random((200, 300)), 6)
    base = 40 + 160 * (base - base.min()) / np.ptp(base)
    colours = base[..., None] * [1, 0.9, 0.8] + rng.normal(0, 8, (200, 300, 3))
    image = Image.fromarray(np.clip(colours, 0, 255).astype(np.uint8))
    for made, suffix in ((image, "png"), (image.convert("L"), "png"), (image.convert("L"), "jpg")):
        made.save(path := tmp_path / f"pile.{suffix}")
        with pytest.raises(LabelImageError, match=r"E102 pile.*looks like a photo.*label image"):
            read_stones(path)


def changed(values, *changes):
    """An array with some values at other places."""
    values = np.array(values)
    for place, value in changes:
        values[place] = value
    return values


def test_jpeg_labels(tmp_path):
    labels = many_stones(first=20, step=4).astype(np.uint8)
    for name, options in (
        ("stones.jpg", {"quality": 50}),
        ("stones.png", {"format": "JPEG", "quality": 95}),
        ("stones.tif", {"compression": "jpeg"}),
    ):
        Image.fromarray(labels).save(path := tmp_path / name, **options)
        values, counts = np.unique(np.asarray(Image.open(path)), return_counts=True)
        few = np.count_nonzero(counts < 10)
        with pytest.raises(LabelImageError) as caught:
            read_stones(path)
        error = caught.value
        assert (error.code, error.where, error.exit_code) == ("E101", name, ExitCode.BAD_INPUT)
        assert f"{len(values)} values, {few} of them on less than 10 px" in error.what
        assert "plain areas look like 48 stones" in error.what
        assert "PNG" in error.cure
        Image.fromarray((labels > 0) * np.uint8(255)).save(path, **options)
        with pytest.raises(LabelImageError, match=r"E101.*mask=True.*drystone segment PHOTO"):
            read_stones(path)
        stones = read_stones(path, settings=ReadSettings(mask=True))
        assert len(stones) == 48
        assert all(abs(stone.area_px - 576) < 12 for stone in stones)


@pytest.mark.parametrize("method", ["BILINEAR", "BICUBIC", "LANCZOS", "HAMMING"])
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


def test_labels_that_only_look_blended_or_like_a_photo_are_sound():
    # Bricks with joints of a value between ids.
    ids = np.random.default_rng(3).permutation([i for i in range(1, 50) if i != 30])
    bricks = np.kron(ids.reshape(6, 8), np.pad(np.ones((20, 40), int), ((0, 2), (0, 2))))
    bricks = np.pad(np.where(bricks, bricks, 30), 6, constant_values=30)
    # Stones of about 4.5 px, each between a lower and a higher id at its corners.
    points = np.random.default_rng(1).random((500, 2)) * 100
    far = cdist(np.indices((100, 100)).reshape(2, -1).T, points)
    touching = np.pad(far.argmin(axis=1).reshape(100, 100) + 1, 3)
    slivers = np.zeros((120, 120), np.uint8)
    slivers[5:50, 5:115] = 250
    for i in range(30):
        slivers[55 + i // 6 * 4 : 57 + i // 6 * 4, 2 + i % 6 * 19 : 18 + i % 6 * 19] = 10 + i
    for labels, count, settings in (
        (bricks, 48, ReadSettings(background=30)),
        (touching, 500, ReadSettings(min_area_px=1, pieces="keep-largest")),
        (slivers, 31, None),
        (many_stones(40, 40, size=5, gap=1, first=1, step=977), 1600, None),
    ):
        assert len(read_stones(labels, settings=settings)) == count


def test_two_stones_under_one_id_are_suspected_and_the_speck_limit_grows_with_the_stones():
    labels = many_stones(3, 4, size=20, gap=8)
    labels[8:28, 8:28] = labels[8:28, 36:56] = 500
    labels[15:21, 28:36] = 500  # a neck of 6 px
    stones = read_stones(labels)
    assert codes(stones) == ["W110"]
    assert "stone 500 has 2.1 times the median area and a neck of about 6 px" in said(stones)
    labels = many_stones(2, 2, size=150)
    labels[0, :21] = 99  # 0.1 % of the median 22,500 px are 22.5 px
    assert len(read_stones(labels)) == 4
    labels[1, :2] = 99
    assert len(read_stones(labels)) == 5


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


def test_what_is_left_out_or_added_is_said():
    for labels, settings, found, codes_, text in (
        (pieces(7), SPLIT, WHOLE, "W111 W113", "10 of 7 px at column 40, row 2"),
        (pieces(), SPLIT, {**WHOLE, 10: 375, 11: 15}, "W111", "stone 5: 10 (375 px), 11 (15 px)"),
        (LAST, SPLIT, {1: 375, 2: 375, 3: 15, 2**32 - 1: 600}, "W111", "stone 1: 2 (375 px)"),
        (HOLED, None, WHOLE, "W112", "holes filled: stone 5: 20 px."),
        (HOLED, ReadSettings(holes="keep"), {5: 355, 9: 600}, "W112", "holes kept open"),
        (WITHIN, None, {**WHOLE, 77: 36}, "W112", "stone 5: 36 px, 36 px of them other stones'"),
        (WITHIN, ReadSettings(skip=(77,)), WHOLE, "W112", "holes filled: stone 5: 36 px."),
        (SPECKS, None, WHOLE, "W113", "2 specks < 10 px left out (10 px in all): "
         "11 of 9 px at column 50, row 1, 12 of 1 px at column 0"),
        (SPECKS, ReadSettings(min_area_px=1), {**WHOLE, 11: 9, 12: 1}, "", ""),
        # An id that is scattered as noise is a speck, not a broken stone.
        (changed(two_stones(5, 9), (np.s_[0, ::2], 11)), None, WHOLE, "W113", "11 of 30 px"),
    ):  # fmt: skip
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


WHITE = changed(two_stones(5, 9, np.uint8), (two_stones() == 0, 255))
MINUS = changed(two_stones().astype(np.int64), (two_stones() == 0, -1))


def with_value(value, dtype=float):
    return changed(two_stones().astype(dtype), (np.s_[7, 9], value))


def test_values_that_are_refused():
    for values, settings, text in (
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
        (with_value(-2, np.int64), {}, r"E108.*1 px are -2, outside 0 ... 2\^32-1 .*umn 9, row 7"),
        (with_value(2**63, np.uint64), {}, r"E108.*1 px are 9223372036854775808, outside 0"),
        (changed(MINUS, (np.s_[0, 0], 0)), {"background": -1}, r"E108"),
        *((two_stones().astype(k), {}, r"E108.*are not ids") for k in (complex, "U3", object)),
        (two_stones(), {"image": "tray-3.jpg"}, r"E118.*'tray-3.jpg'.*Leave --image"),
    ):
        with pytest.raises(DrystoneError) as caught:
            read_stones(values, settings=ReadSettings(**settings))
        assert re.match(text, str(caught.value))
        assert caught.value.where == "array"


def test_another_background_can_be_named():
    for black, known in ((WHITE, WHOLE), (np.where(WHITE == 255, 255, 0), {1: 375, 2: 600})):
        assert areas(read_stones(black, settings=ReadSettings(background=255))) == known
    assert areas(read_stones(np.ma.masked_equal(two_stones(), 300))) == {70000: 600}
    labels = np.full((30, 40), 7, np.uint8)  # a stone that is cropped to its box
    labels[:6, :6] = 0  # one corner is missing
    assert areas(read_stones(labels)) == {7: 1164}
    labels[:4, -4:] = labels[-4:, :4] = labels[-4:, -4:] = 0
    labels[12:18, 12:18] = 9  # a stone lies on it, and it has no corners
    assert areas(read_stones(labels)) == {7: 1116, 9: 36}


ONE = two_stones() == 300


def test_folder_is_numbered_in_natural_order(tmp_path):
    folder = tmp_path / "set"
    folder.mkdir()
    for name, side in (("s10.png", 10), ("s9.png", 9), ("s1.png", 4), ("S2.png", 5)):
        save_mask(folder / name, np.pad(np.ones((side, side)), ((2, 18 - side), (3, 7))))
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
    save_mask(folder / "s9.png", np.pad(np.ones((9, 8), bool), 2))
    assert read_stones(folder).source.sha256 != stones.source.sha256


def test_folder_with_an_empty_a_full_and_a_broken_mask(tmp_path):
    save_mask(tmp_path / "a.png", np.zeros((9, 9), bool))
    save_mask(tmp_path / "b.png", np.ones((8, 9), bool))
    save_mask(tmp_path / "c.png", changed(ONE, (np.s_[30:35, 30:32], True)))
    with pytest.raises(LabelImageError, match=r"E103.*stone 3 \(c.png\)"):
        read_stones(tmp_path)
    stones = read_stones(tmp_path, settings=LARGEST)
    assert areas(stones) == {2: 72, 3: 375}
    assert "1 (a.png) of 0 px" in said(stones)
    assert f"{tmp_path.name}/b.png is stone to all its edges" in said(stones)
    split = read_stones(tmp_path, settings=SPLIT)
    assert areas(split) == {2: 72, 3: 375, 4: 10}
    assert split.by_id(4).name == "c.png"


def test_folder_masks_of_any_stone_value_or_other_things(tmp_path):
    with pytest.raises(InputError, match=r"E111.*no pictures"):
        read_stones(tmp_path)
    for name, value in (("a", 1), ("b", 255), ("c", 128)):
        Image.fromarray(ONE * np.uint8(value)).save(tmp_path / f"{name}.png")
    np.save(tmp_path / "d.npy", two_stones() == 70000)
    cover = discs((40, 40), [(20, 20)], 12) * 255  # anti-aliased
    Image.fromarray(cover.astype(np.uint8)).save(tmp_path / "e.png")
    found = {1: 375, 2: 375, 3: 375, 4: 600, 5: int((cover >= 127.5).sum())}
    assert areas(read_stones(tmp_path)) == found
    Image.fromarray(two_stones(7, 9, np.uint8)).save(tmp_path / "labels.png")
    with pytest.raises(LabelImageError, match=r"E111.*labels.png: 3 values in a mask of one stone"):
        read_stones(tmp_path)


def test_folder_with_a_damaged_or_jpeg_mask(tmp_path):
    save_mask(tmp_path / "a.jpg", ONE)
    with pytest.raises(LabelImageError, match=r"E101.*a.jpg"):
        read_stones(tmp_path)
    assert abs(read_stones(tmp_path, settings=ReadSettings(mask=True)).by_id(1).area_px - 375) < 9
    save_mask(path := tmp_path / "b.png", ONE)
    path.write_bytes(path.read_bytes()[:60])
    with pytest.raises(InputError, match=r"E106.*b.png"):
        read_stones(tmp_path, settings=ReadSettings(mask=True))


def test_folder_is_named_however_it_is_given(tmp_path, monkeypatch):
    folder = tmp_path / "set"
    (folder / "deeper").mkdir(parents=True)
    ways = (("", "."), ("deeper", ".."), ("", "../set/"))
    for there, given in ways:
        monkeypatch.chdir(folder / there)
        with pytest.raises(InputError, match=r"E111 set: the folder has no pictures"):
            read_stones(given)
    save_mask(folder / "a.png", ONE)
    for there, given in ways:
        monkeypatch.chdir(folder / there)
        assert read_stones(given).source.path == "set"
        with pytest.raises(UsageError, match=r"E118 set: .*'tray-3.jpg'"):
            read_stones(given, settings=ReadSettings(image="tray-3.jpg"))
    (folder / "c.png").write_bytes(b"none")
    with pytest.raises(InputError, match=r"E107 set/c.png"):
        read_stones(given)


def test_folder_of_a_plan(tmp_path):
    save_mask(tmp_path / "a.png", ONE)
    for other in ("{", "[1]", '{"steps": []}'):
        (tmp_path / "plan.json").write_text(other)
        assert len(read_stones(tmp_path)) == 1
    (tmp_path / "plan.json").write_text('{"steps": [], "source": {}}')
    with pytest.raises(InputError, match=r"E113 .*this folder is a plan.*--from"):
        read_stones(tmp_path)


def test_an_array_of_other_dimensions_in_a_file(tmp_path):
    for shape in ((3, 4, 5, 6), (), (7,), (0, 3)):
        np.save(tmp_path / "stones.npy", np.ones(shape, np.uint8))
        with pytest.raises(InputError, match=r"E1\d\d"):
            read_stones(tmp_path / "stones.npy")
        write_sidecar(PhotoSidecar(3, 4, labels="stones.npy"), tmp_path)


def test_settings_that_mean_nothing():
    wrong = {"pieces": "all", "holes": "no", "min_area_px": 0, "max_image_mpx": 0.0, "unit": "yard"}
    for name, value in (*wrong.items(), ("px_per_m", 0.0), ("px_per_m", float("inf"))):
        with pytest.raises(UsageError, match=rf"E119 ReadSettings: {name}"):
            ReadSettings(**{name: value})
