"""Real photographs: where they are from, and which stones are in them (``real.toml``)."""

import io
import json
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import skimage
from numpy.typing import NDArray
from PIL import Image, ImageDraw
from scipy import ndimage

from drystone.io.images import opened

Labels = NDArray[np.uint16]

FOLDER = "photographs"
"""Folder of the published data that has them, by the name below."""


Box = tuple[int, int, int, int]


@dataclass(frozen=True)
class RealPhoto:
    """A photograph, and how its stones are known."""

    name: str
    file: str  # in the folder; the name of a picture of scikit-image, which is installed
    source: str  # repository and path
    licence: str
    asked_for: bool  # whether it is what docs/photographs.md asks for: plain ground, gaps
    mask: str = ""  # a published mask or outlines, in the same folder
    # Columns and rows of the stones that were drawn by hand (three numbers are a circle: middle
    # and radius), in a picture of this width.
    drawn: tuple[tuple[float, ...], ...] = ()
    drawn_px: int = 0
    part: bool = False  # only some of the stones are known: precision says nothing
    box: Box | None = None  # left, upper, right, lower: cut out


_FILE = tomllib.loads(Path(__file__).with_name("real.toml").read_text("utf-8"))


def _frozen(value: Any) -> Any:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


PHOTOS, COMPOSITES = (
    tuple(RealPhoto(**{name: _frozen(value) for name, value in photo.items()}) for photo in photos)
    for photos in (_FILE["photos"], _FILE["composites"])
)
"""The photographs of the study; and real pebbles of the first one on other real grounds: edges
and shadows are not real."""

_PEBBLES = PHOTOS[0]

ALL = (*PHOTOS, *COMPOSITES)


def there(data: Path | None) -> Iterator[RealPhoto]:
    """Yield the photographs whose files are there; those of scikit-image always are."""
    for photo in ALL:
        names = [name for name in (photo.file, photo.mask) if name]
        if photo in COMPOSITES:
            names += [_PEBBLES.file, _PEBBLES.mask]
        if all(_path(name, data) is not None for name in names):
            yield photo


def pixels_of(photo: RealPhoto, data: Path | None) -> NDArray[np.uint8]:
    """Return the photograph, (h, w, 3)."""
    if photo in COMPOSITES:
        return _composite(photo, data)[0]
    return np.asarray(_opened(photo.file, photo.box, data).convert("RGB"))


def _opened(name: str, box: Box | None, data: Path | None) -> Image.Image:
    path = _path(name, data)
    if path is None:
        raise FileNotFoundError(name)
    with opened(path.read_bytes(), lambda *_: None) as picture:
        return picture.crop(box or (0, 0, *picture.size))


def _composite(photo: RealPhoto, data: Path | None) -> tuple[NDArray[np.uint8], Labels]:
    """Paste pebbles on a ground, apart from each other; return that and where they are."""
    ground = np.asarray(_opened(photo.file, photo.box, data).convert("RGB")).astype(float)
    pebbles = pixels_of(_PEBBLES, data)
    known = np.asarray(truth_of(_PEBBLES, data, (pebbles.shape[1], pebbles.shape[0])))
    boxes = ndimage.find_objects(known)
    rng = np.random.default_rng(1)
    labels = np.zeros(ground.shape[:2], np.uint16)
    for _ in range(400):
        if labels.max() == 20:
            break
        number = int(rng.integers(len(boxes)))
        box = boxes[number]
        mask = ndimage.binary_erosion(known[box] == number + 1, iterations=2)
        row, col = (
            int(rng.integers(8, side - own - 8))
            for side, own in zip(ground.shape[:2], mask.shape, strict=True)
        )
        at = (slice(row, row + mask.shape[0]), slice(col, col + mask.shape[1]))
        if (ndimage.binary_dilation(labels > 0, iterations=14)[at] & mask).any():
            continue
        soft = ndimage.gaussian_filter(mask.astype(float), 0.8)[..., None]
        ground[at] = ground[at] * (1 - soft) + pebbles[box] * soft
        labels[at][mask] = labels.max() + 1
    file = io.BytesIO()
    Image.fromarray(ground.astype(np.uint8)).save(file, "JPEG", quality=80)
    with opened(file.getvalue(), lambda *_: None) as picture:
        return np.asarray(picture), labels


def truth_of(photo: RealPhoto, data: Path | None, size_px: tuple[int, int]) -> Labels | None:
    """Return the stones that are known, in a picture of this width and height; None without any."""
    if photo in COMPOSITES:
        return _composite(photo, data)[1]
    if photo.drawn:
        return _drawn(photo.drawn, size_px, size_px[0] / photo.drawn_px)
    path = _path(photo.mask, data) if photo.mask else None
    if path is None:
        return None
    if path.suffix == ".geojson":
        features = json.loads(path.read_text(encoding="utf-8"))["features"]
        rings = (np.ravel(one["geometry"]["coordinates"][0]) for one in features)
        return _drawn(tuple(tuple(map(float, ring)) for ring in rings), size_px, 1.0)
    values = np.asarray(_opened(photo.mask, photo.box, data))
    labels = _on_board(values) if values.dtype == np.uint8 else values
    resized = Image.fromarray(labels.astype(np.int32)).resize(size_px, Image.Resampling.NEAREST)
    return np.asarray(resized).astype(np.uint16)


def _path(name: str, data: Path | None) -> Path | None:
    if "." not in name:
        return Path(skimage.__file__).parent / "data" / f"{name}.png"
    path = None if data is None else data / FOLDER / name
    return path if path is not None and path.is_file() else None


def _drawn(stones: tuple[tuple[float, ...], ...], size_px: tuple[int, int], scale: float) -> Labels:
    picture = Image.new("I", size_px)
    draw = ImageDraw.Draw(picture)
    for number, stone in enumerate(stones, start=1):
        values = [scale * value for value in stone]
        if len(values) == 3:
            x, y, radius = values
            draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=number)
        else:
            draw.polygon(values, fill=number)
    return np.asarray(picture).astype(np.uint16)


def _on_board(values: NDArray[np.uint8]) -> NDArray[np.int32]:
    """Return numbers of what is dark on the bright board of a mask; specks are its noise."""
    board = values > 127
    inside = ndimage.binary_fill_holes(board)
    pieces, count = ndimage.label(ndimage.binary_opening(inside & ~board, iterations=3))
    large = np.bincount(pieces.ravel(), minlength=count + 1) > 300
    large[0] = False
    return np.asarray(np.where(large, np.cumsum(large), 0)[pieces], np.int32)
