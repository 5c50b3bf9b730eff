"""Valid pictures of three small stones in all kinds of files."""

import io
import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from fuzz.containers import png_of
from fuzz.mutate import Case
from fuzz.tiffs import DEFLATE, LZW, write_tiff

WIDTH, HEIGHT = 48, 32
STONES = {
    7: [(2.2, 2.2), (20.2, 3.2), (19.2, 13.2), (3.2, 14.2)],
    9: [(28.2, 4.2), (44.2, 6.2), (45.2, 26.2), (30.2, 28.2), (27.2, 15.2)],
    12: [(4.2, 17.2), (24.2, 16.2), (23.2, 29.2), (2.2, 30.2)],
}
"""Outlines by id, px, y down."""

_PASSES = (
    (0, 0, 8, 8),
    (0, 4, 8, 8),
    (4, 0, 8, 4),
    (0, 2, 4, 4),
    (2, 0, 4, 2),
    (0, 1, 2, 2),
    (1, 0, 2, 1),
)
"""First row and column, and steps, of the passes of an interlaced PNG."""

Array = NDArray[Any]


def label_image(dtype: str = "u1", *, times: int = 1) -> Array:
    """Return the stones as ids, multiplied to be larger."""
    image = Image.new("L", (WIDTH, HEIGHT))
    for stone, outline in STONES.items():
        ImageDraw.Draw(image).polygon(outline, fill=stone)
    return (np.asarray(image).astype(np.int64) * times).astype(dtype)


def colours(labels: Array, channels: int = 3) -> Array:
    """Return ids as colours, with alpha that says nothing for four channels."""
    parts = [labels >> shift & 255 for shift in (0, 8, 16)]
    return np.stack([*parts, np.full_like(labels, 255)][:channels], axis=-1).astype(np.uint8)


def pngs() -> Sequence[bytes]:
    """Return PNG of all colour types and depths."""
    grey, large = label_image(), label_image("u2", times=300)
    bits = [(depth, kind) for depth in (1, 2, 4) for kind in (0, 3)]
    clear = Image.fromarray(grey).convert("P")
    frames = [Image.fromarray(grey), Image.fromarray(grey[::-1].copy())]
    return [
        *(pillow(values, "PNG") for values in (grey, large, colours(label_image("u4", times=300)))),
        *(pillow(colours(label_image("u4"), 4)[..., :n], "PNG") for n in (2, 4)),
        *(png(grey % 2**depth, depth, kind) for depth, kind in bits),
        png(grey, 8, 0, interlaced=True),
        png(np.repeat(grey, 6, axis=1), 16, 2),  # refused: ids would merge
        pillow(clear, "PNG", transparency=0),
        pillow(np.dstack([grey, np.where(grey == 9, 0, 255).astype("u1")]), "PNG", exif=held()),
        pillow(np.dstack([grey * 0] * 3 + [grey * 20]), "PNG"),  # the mask is the alpha
        pillow(frames[0], "PNG", save_all=True, append_images=frames[1:]),
    ]


def png(values: Array, depth: int, kind: int, *, interlaced: bool = False) -> bytes:
    """Return a PNG with rows that no filter changed."""
    samples = 6 if depth == 16 else 1
    passes = _PASSES if interlaced else ((0, 0, 1, 1),)
    rows = b""
    for row, column, down, right in passes:
        part = np.unpackbits(values[row::down, column::right, None].astype(np.uint8), axis=2)
        part = part[..., 8 - min(depth, 8) :]
        packed = np.packbits(part.reshape(len(part), -1), axis=1)
        rows += b"".join(b"\0" + line.tobytes() for line in packed)
    height, width = values.shape
    palette = bytes(range(3 * 2**depth)) if kind == 3 else b""
    return png_of(width // samples, height, depth, kind, rows, palette, interlaced=interlaced)


def pillow(values: Array | Image.Image, kind: str, **options: Any) -> bytes:
    """Return a picture as Pillow writes it."""
    image = values if isinstance(values, Image.Image) else Image.fromarray(values)
    buffer = io.BytesIO()
    image.save(buffer, kind, **options)
    return buffer.getvalue()


def tiffs() -> Sequence[bytes]:
    """Return TIFF of all numbers, orders and compressions."""
    grey, wide = label_image(), label_image("u4", times=70000)
    mask = Image.fromarray(grey > 0)
    packed = ("tiff_lzw", "packbits", "tiff_adobe_deflate", "tiff_deflate", "jpeg")
    rgb = colours(wide)
    return [
        *(tiff(label_image(kind)) for kind in ("u1", "u2", "u4", "i2", "i4", "f4", "f8")),
        tiff(grey > 0),
        *(tiff(wide, **options) for options in (
            {"byteorder": ">"}, {"bigtiff": True}, {"bigtiff": True, "byteorder": ">"},
            {"compression": "zlib"}, {"compression": "zlib", "predictor": 2}, {"tile": (16, 16)},
            {"rowsperstrip": 5}, {"software": "a", "description": "b", "resolution": (9, 9)},
        )),
        *(pillow(grey, "TIFF", compression=kind) for kind in packed),
        *(pillow(mask, "TIFF", compression=kind) for kind in ("group3", "group4", "tiff_ccitt")),
        pillow(label_image("i4"), "TIFF", compression="tiff_lzw"),
        pillow(Image.fromarray(grey).convert("P"), "TIFF"),
        pillow(grey, "TIFF", tiffinfo={262: 0, 274: 6}),
        tiff(rgb, photometric="rgb"), tiff(rgb, photometric="rgb", compression="zlib"),
        tiff(np.moveaxis(rgb, -1, 0), photometric="rgb", planarconfig="separate"),
        tiff(colours(wide, 4), photometric="rgb", extrasamples=["unassalpha"]),
        tiff(np.stack([grey, grey])),
        write_tiff(grey, 4), write_tiff(grey, 4, LZW),
        write_tiff(grey, 8, DEFLATE, tile=16, sparse=[0]),
        write_tiff(grey, 32, DEFLATE, sample=3, predictor=3, tags={42113: b"-1\0"}),
        tiff(grey[None], imagej=True), tiff(grey, ome=True, metadata={"axes": "YX", "UUID": "a"}),
    ]  # fmt: skip


def tiff(values: Array, **options: Any) -> bytes:
    """Return a TIFF as tifffile writes it."""
    buffer = io.BytesIO()
    tifffile.imwrite(buffer, values, **options)
    return buffer.getvalue()


def gifs() -> Sequence[bytes]:
    """Return GIF, also of two frames."""
    grey = label_image()
    frames = [Image.fromarray(grey), Image.fromarray(grey[::-1].copy())]
    return [
        pillow(grey, "GIF", optimize=False),
        pillow(grey, "GIF", optimize=False, interlace=0, transparency=0),
        pillow(frames[0], "GIF", save_all=True, append_images=frames[1:]),
    ]


def bmps() -> Sequence[bytes]:
    """Return BMP of 1, 8, 24 and 32 bits."""
    grey = label_image()
    of_colours = [colours(label_image("u4", times=300), n) for n in (3, 4)]
    return [pillow(values, "BMP") for values in (grey, grey > 0, *of_colours)]


def jpegs() -> Sequence[bytes]:
    """Return JPEG of masks, with more parts than they need."""
    mask, exif = Image.fromarray((label_image() > 0).astype(np.uint8) * 255), held()
    return [
        pillow(mask, "JPEG", quality=95), pillow(mask, "JPEG", progressive=True, exif=exif),
        pillow(mask.convert("RGB"), "JPEG", comment=b"a", dpi=(9, 9)),
        pillow(mask.convert("CMYK"), "JPEG"),
    ]  # fmt: skip


def held(orientation: int = 6) -> Image.Exif:
    """Return the tag that says how a camera was held: sideways, where nothing else is said."""
    exif = Image.Exif()
    exif[274] = orientation
    return exif


def npys() -> Sequence[bytes]:
    """Return NPY of all kinds of numbers, and one of objects, which is refused."""
    grey = label_image()
    kinds = ("u1", "<u2", ">u4", "i8", "f4", "f8", "?")
    arrays = [*(label_image(kind) for kind in kinds), np.asfortranarray(grey), grey[None]]
    arrays += [colours(label_image("u4", times=300)), np.array([{}])]
    arrays += [np.where(grey == 0, ground, label_image("f4")) for ground in (-1, np.nan)]
    near = np.pad(grey, 1)[2:, 2:] | np.pad(grey, 1)[:-2, :-2] | grey
    arrays += [np.where((grey == 0) & (near > 0), 255, grey)]  # a void around all stones
    return [npy(array) for array in arrays] + [npy(grey, version=(2, 0))]


def npy(array: Array, version: tuple[int, int] | None = None) -> bytes:
    """Return an array as NumPy writes it."""
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, array, version)
    return buffer.getvalue()


def npzs() -> Sequence[bytes]:
    """Return archives of labels, of one array, and of masks."""
    grey = label_image()
    masks = {f"stone_{stone}": grey == stone for stone in STONES}
    found = []
    for save, arrays in (
        (np.savez, {"labels": grey, "photo": colours(grey)}), (np.savez_compressed, {"a": grey}),
        (np.savez_compressed, masks), (np.savez, masks),
    ):  # fmt: skip
        buffer = io.BytesIO()
        save(buffer, **arrays)
        found.append(buffer.getvalue())
    return found


def folders() -> Sequence[Case]:
    """Return folders of a mask a stone."""
    grey = label_image()
    masks = {f"s{stone}.png": pillow(grey == stone, "PNG") for stone in STONES}
    return [
        masks,
        {**{name[:-3] + "bmp": data for name, data in masks.items()}, "read.txt": b"me"},
        {"1.npy": npy((grey == 7).astype(np.uint8) * 255), "2.tif": tiff(grey == 9)},
    ]


def photos() -> Sequence[bytes]:
    """Return photographs of stones on plain ground."""
    light = np.full((HEIGHT, WIDTH), 60) + 140 * (label_image() > 0)
    light = np.kron(light, np.ones((2, 2), int))
    light += np.arange(light.size).reshape(light.shape) * 7 % 11
    grey = light.astype(np.uint8)
    rgb = np.stack([grey, grey, grey // 2], axis=-1)
    picture = Image.fromarray(rgb)
    exif = held()
    return [
        pillow(rgb, "JPEG", quality=90), pillow(rgb, "JPEG", exif=exif, progressive=True),
        pillow(picture.convert("CMYK"), "JPEG"), pillow(grey, "JPEG"), pillow(rgb, "PNG"),
        pillow(rgb, "PNG", exif=exif), pillow(picture.convert("P"), "PNG"),
        pillow(light.astype(np.uint16) * 257, "PNG"), pillow(picture.convert("RGBA"), "PNG"),
        pillow(rgb, "TIFF", compression="tiff_lzw"), pillow(rgb, "TIFF", tiffinfo={274: 6}),
        tiff(rgb.astype(np.uint16) * 257, photometric="rgb"), tiff(grey, compression="zlib"),
        pillow(picture.convert("CMYK"), "TIFF"), pillow(rgb, "TIFF", compression="jpeg"),
    ]  # fmt: skip


def segmented() -> Sequence[Case]:
    """Return what `drystone segment` writes: labels, what is known of them, a photograph."""
    sidecar = {
        "schema": "drystone-photo/1", "labels": "stones.png", "width_px": WIDTH,
        "height_px": HEIGHT, "px_per_m": 100.0, "photo": "photo.jpg", "stones_found": len(STONES),
    }  # fmt: skip
    return [
        {
            "stones.json": json.dumps(sidecar).encode(),
            "stones.png": pngs()[1],
            "photo.jpg": photos()[0],
        }
    ]
