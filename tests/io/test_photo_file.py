import hashlib

import cv2
import numpy as np
import pytest
import tifffile
from fuzz.pictures import held, pillow, tiff
from PIL import Image

from drystone.errors import InputError
from drystone.io.photo_file import MAX_SIDE_PX, read_photo
from tests.io.pictures import codes

PICTURE = np.random.default_rng(3).integers(0, 256, (6, 9, 3), dtype=np.uint8)
LARGE = np.tile(PICTURE, (40, 40, 1))
FOUR = np.dstack([PICTURE, PICTURE[..., 0]]).astype(np.uint16)


def saved(path, values=PICTURE, mode=None, **more):
    image = Image.fromarray(values)
    (image.convert(mode) if mode else image).save(path, **more)
    return path


def test_values_are_kept_and_grey_palette_and_cmyk_become_rgb(tmp_path):
    for name in ("photo.png", "photo.tif", "photo.TIFF"):
        path = saved(tmp_path / name)
        photo = read_photo(path)
        assert np.array_equal(photo.values, PICTURE)
        assert (photo.name, photo.size_px, photo.notices) == (name, (9, 6), ())
        assert photo.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    grey = read_photo(saved(tmp_path / "grey.jpg", PICTURE[..., 0]))
    assert grey.values.shape == (6, 9, 3)
    assert (grey.values[..., 0] == grey.values[..., 2]).all()
    two = np.where(PICTURE[..., :1] > 127, 255, 0).astype(np.uint8).repeat(3, axis=2)
    assert np.array_equal(read_photo(saved(tmp_path / "p.png", two, "P")).values, two)
    cmyk = read_photo(saved(tmp_path / "cmyk.tif", two, "CMYK"))
    assert np.abs(cmyk.values.astype(int) - two).max() <= 1


def test_photos_are_turned_as_opencv_does_also_in_any_compression_and_by_xmp(tmp_path):
    smooth = np.zeros((24, 32, 3), dtype=np.uint8)
    smooth[:12, :16], smooth[12:, :16] = (250, 20, 20), (20, 20, 250)
    for orientation, ending in (*((turn, "jpg") for turn in range(2, 9)), (3, "png"), (6, "png")):
        path = saved(tmp_path / f"photo.{ending}", smooth, exif=held(orientation), quality=95)
        theirs = cv2.imread(str(path), cv2.IMREAD_COLOR_RGB)
        photo = read_photo(path)
        assert np.abs(photo.values.astype(int) - theirs).max() < 12
        assert codes(photo) == ["W173"]
        assert path.name in photo.notices[0].message
    xmp = b'<rdf:Description tiff:Orientation="4"/>'
    for tags, compression in (({274: 4}, None), ({274: 4}, "tiff_lzw"), ({700: xmp}, None)):
        photo = read_photo(saved(tmp_path / "a.tif", tiffinfo=tags, compression=compression))
        assert np.array_equal(photo.values, PICTURE[::-1])
        assert codes(photo) == ["W173"]


def test_16_bits_are_scaled_and_alpha_is_ignored_and_both_are_said(tmp_path):
    deep, grey = PICTURE.astype(np.uint16) * 257, np.repeat(PICTURE[..., :1], 3, axis=2)
    tifffile.imwrite(tmp_path / "deep.tif", deep, photometric="rgb")
    cv2.imwrite(str(tmp_path / "deep.png"), deep[..., ::-1])
    saved(tmp_path / "grey.png", deep[..., 0])
    less = np.round(PICTURE * (4095 / 255)).astype(np.uint16)
    tifffile.imwrite(tmp_path / "12.tif", less, photometric="rgb")
    tifffile.imwrite(tmp_path / "less.tif", 4095 - less[..., 0], photometric="miniswhite")
    clear = np.dstack([PICTURE, np.full(PICTURE.shape[:2], 100, dtype=np.uint8)])
    saved(tmp_path / "clear.png", clear)
    for name in ("deep.tif", "deep.png", "grey.png", "12.tif", "less.tif", "clear.png"):
        photo = read_photo(tmp_path / name)
        assert np.array_equal(photo.values, grey if name in ("grey.png", "less.tif") else PICTURE)
        assert codes(photo) == ["W174"]
        assert ("4095" in photo.notices[0].message) == (name in ("12.tif", "less.tif"))
    clear[..., 3] = 255
    assert read_photo(saved(tmp_path / "clear.png", clear)).notices == ()


def test_files_that_are_no_photographs(tmp_path):
    path = tmp_path / "photo.jpg"
    for data, code in (
        (None, "E100"),
        (b"", "E106"),
        (b"hello", "E107"),
        (b"\xff\xd8\xff\xe0 broken", "E106"),
        (b"II*\0\x08\0\0\0", "E106"),
        (pillow(LARGE, "JPEG")[:3000], "E106"),
        (tiff(np.stack([PICTURE, PICTURE]), photometric="rgb"), "E109"),
        (tiff(PICTURE.astype(np.float32), photometric="rgb"), "E107 .*8 or 16 bits"),
        (cv2.imencode(".png", PICTURE.astype(np.uint16) * 16)[1].tobytes(), "E107 .*as TIFF"),
        (tiff(FOUR, photometric="separated"), r"E107 .*16 bits a channel in CMYK.*8 bits"),
    ):
        if data is not None:
            path.write_bytes(data)
        with pytest.raises(InputError, match=code) as caught:
            read_photo(path)
        assert caught.value.where == str(path)


def test_photographs_that_are_too_large(tmp_path):
    with pytest.raises(InputError, match=r"E110 .*only in Python .*\(max_px\)") as caught:
        read_photo(saved(tmp_path / "photo.jpg", LARGE), max_px=1000)
    assert "nearest neighbour" not in str(caught.value)
    most = saved(tmp_path / "most.png", np.zeros((1, MAX_SIDE_PX), np.uint8))
    assert read_photo(most).size_px == (MAX_SIDE_PX, 1)
    wide = saved(tmp_path / "wide.png", np.zeros((1, MAX_SIDE_PX + 1), np.uint8))
    with pytest.raises(InputError, match=r"E110.*32767 x 1 px; the limit of a side"):
        read_photo(wide)


@pytest.mark.parametrize(("dtype", "channels"), [(np.uint8, 1), (np.uint16, 1), (np.uint16, 2)])
def test_white_is_zero_is_light_all_the_same(tmp_path, dtype, channels):
    light = np.array([[0, 51, 255], [10, 20, 30]], np.uint8)
    white = np.iinfo(dtype).max
    values = (255 - light).astype(dtype) * dtype(white // 255)
    more = {}
    if channels == 2:
        values = np.stack([values, np.full_like(values, white)], axis=-1)
        more = {"extrasamples": ["unassalpha"], "planarconfig": "contig"}
    path = tmp_path / "negative.tif"
    tifffile.imwrite(path, values, photometric="miniswhite", **more)
    read = read_photo(path)
    assert (read.values == light[..., None]).all()
    assert not any("ransparency" in notice.message for notice in read.notices)


def test_a_label_image_is_no_photograph_whatever_its_depth(tmp_path):
    """Ids in greys, colours, 16 bits and a palette; a mask too.  Light on black cloth is one."""
    labels = np.zeros((80, 100), np.uint8)
    labels[10:40, 10:45], labels[45:70, 20:60], labels[10:60, 65:95] = 1, 2, 200
    made = (labels, np.where(labels, 255, 0).astype(np.uint8), labels.astype(np.uint16) * 257)
    paths = [saved(tmp_path / f"{number}.png", values) for number, values in enumerate(made)]
    paths += [saved(tmp_path / "rgb.tif", np.stack([labels, 2 * labels, labels], axis=-1))]
    palette = Image.fromarray(labels, "P")
    palette.putpalette(np.repeat(np.arange(256), 3).tolist())
    palette.save(tmp_path / "palette.png")
    for path in (*paths, tmp_path / "palette.png"):
        said = f"E175 .*label image already.*drystone plan {path.name}"
        with pytest.raises(InputError, match=said):
            read_photo(path)
    noise = np.random.default_rng(3).integers(0, 40, (*labels.shape, 3), np.uint8)
    lit = np.where(labels[..., None] > 0, 100 + noise, 0).astype(np.uint8)
    read_photo(saved(tmp_path / "cloth.png", lit))
