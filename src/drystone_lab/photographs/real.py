"""Real photographs: where they are from, and which stones are in them.

The pictures are other people's and are not part of this project.  Published masks are the truth
where there are any; the polygons and circles here were drawn by hand, on the picture at the width
that is named.
"""

import io
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw
from scipy import ndimage

from drystone.io.pictures import opened

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


_GRAINS = "zsylvester/segmenteverygrain"
_IMAGEGRAINS = "dmair1989/imagegrains"
_IBOIS = "ibois-epfl/augmented-stacking"
_BOARD = "EVS-GIS/2D-Roundness-Toolbox, Computing/000_0573.JPG"
_SKIMAGE = "scikit-image, skimage/data"

_COINS = (
    (134, 162, 63), (301, 168, 56), (466, 153, 69), (647, 153, 69), (828, 158, 60), (1004, 131, 86),
    (137, 373, 61), (309, 378, 56), (461, 383, 56), (617, 374, 59), (812, 360, 73), (1010, 375, 57),
    (132, 592, 56), (306, 587, 64), (463, 594, 57), (638, 580, 70), (822, 583, 66),
    (1042, 561, 95), (139, 781, 82), (342, 797, 63), (518, 785, 78), (733, 791, 72),
    (903, 791, 74), (1074, 804, 65),
)  # fmt: skip

_BOULDERS = (
    (240, 130, 300, 128, 400, 133, 545, 150, 600, 200, 625, 290, 640, 370, 662, 480, 655, 550,
     575, 574, 490, 552, 405, 520, 385, 470, 350, 350, 300, 285, 225, 275, 225, 200),
    (95, 352, 160, 315, 270, 302, 330, 340, 360, 430, 240, 440, 130, 458, 95, 435),
    (625, 290, 690, 255, 800, 238, 855, 262, 858, 318, 745, 370, 640, 352),
    (685, 370, 760, 362, 790, 400, 720, 426),
)  # fmt: skip

_FRAME = (
    (200, 203, 320, 203, 342, 228, 312, 308, 208, 292, 192, 262),
    (500, 222, 540, 240, 568, 224, 632, 262, 618, 328, 520, 340, 470, 330, 470, 300),
    (698, 218, 780, 205, 850, 230, 820, 330, 700, 345, 690, 300),
    (180, 325, 240, 325, 258, 370, 190, 482, 125, 485, 122, 450),
    (350, 390, 450, 375, 520, 390, 545, 430, 540, 485, 400, 490, 320, 460),
    (600, 350, 690, 348, 740, 372, 742, 430, 690, 437, 600, 425, 578, 385),
    (810, 350, 900, 336, 1010, 365, 1028, 415, 990, 435, 870, 425, 815, 385),
    (545, 418, 650, 422, 698, 505, 695, 565, 600, 545, 570, 500),
)  # fmt: skip

_RIVER = (
    (95, 175, 122, 220, 95, 297, 5, 238, 45, 200),
    (130, 195, 180, 180, 228, 215, 200, 265, 145, 245),
    (590, 185, 650, 200, 680, 280, 640, 400, 590, 395, 555, 300),
    (620, 410, 680, 450, 670, 520, 610, 540, 560, 490, 575, 430),
    (440, 520, 520, 520, 560, 580, 490, 680, 420, 660, 430, 590),
    (420, 400, 480, 380, 555, 440, 500, 490, 430, 475),
    (790, 255, 860, 250, 1000, 370, 880, 430, 780, 390, 770, 320),
    (730, 650, 880, 575, 905, 640, 840, 720, 750, 725),
    (400, 785, 470, 830, 465, 910, 410, 980, 320, 960, 305, 880, 340, 810),
    (740, 855, 845, 880, 850, 930, 770, 998, 685, 990, 690, 910),
    (330, 120, 415, 105, 400, 190, 340, 238, 305, 200),
    (690, 470, 790, 480, 790, 540, 720, 570, 690, 530),
)  # fmt: skip

PHOTOS: tuple[RealPhoto, ...] = (
    RealPhoto("pebbles on a red board", "000_0573.JPG", _BOARD, "none said", True,
              "000_0573-B.JPG", box=(62, 270, 1182, 1385)),
    RealPhoto("the board and the beach around it", "000_0573.JPG", _BOARD, "none said", False,
              "000_0573-B.JPG"),
    RealPhoto("coins, light from one side", "coins", f"{_SKIMAGE}/coins.png",
              "no known copyright", True, drawn=_COINS, drawn_px=1152),
    RealPhoto("gravel", "gravel", f"{_SKIMAGE}/gravel.png", "CC0", False),
    RealPhoto("brick wall", "brick", f"{_SKIMAGE}/brick.png", "CC0", False),
    RealPhoto("lawn", "grass", f"{_SKIMAGE}/grass.png", "CC0", False),
    RealPhoto("pebble beach", "torrey_pines_beach_image.jpg",
              f"{_GRAINS}, examples/torrey_pines_beach", "Apache-2.0", False,
              "torrey_pines_grains.geojson"),
    RealPhoto("cobbles with a scale card", "barton_creek_image.jpg",
              f"{_GRAINS}, examples/barton_creek", "Apache-2.0", False, part=True),
    *(
        RealPhoto(f"gravel pit {k}", f"{file}.jpg", f"{_IMAGEGRAINS}, demo_data/FH", "BSD-3", False,
                  f"{file}_mask.tif")
        for k, file in enumerate(
            ("1_P1060330_1", "2_P1060338_0", "3_P1060343_3", "4_P1060348_3", "5_P1060351_2",
             "6_P1060355_0", "7_P1060359_3"), start=1)
    ),
    RealPhoto("river bank with a folding rule", "K1_C2_385.jpg", f"{_IMAGEGRAINS}, demo_data/K1",
              "BSD-3", False, part=True),
    RealPhoto("river bed from above", "ortho_resolution_1.2mmPerPix.tif",
              "UP-RS-ESP/PebbleCounts, example_data", "GPL-3", False, drawn=_RIVER, drawn_px=1000,
              part=True),
    RealPhoto("boulders with paint on concrete", "stone_stacking.jpg", f"{_IBOIS}, img", "MIT",
              False, drawn=_BOULDERS, drawn_px=1008),
    RealPhoto("boulders in a timber frame", "IMG_20220520_182302.jpg", f"{_IBOIS}, img", "MIT",
              False, drawn=_FRAME, drawn_px=1040, part=True),
    RealPhoto("one boulder with paint", "pcd_position_with_stone.jpg", f"{_IBOIS}, img", "MIT",
              False, drawn=((400, 305, 440, 345, 560, 460, 620, 550, 622, 640, 600, 668, 450, 635,
                             245, 525, 275, 450, 290, 420),), drawn_px=756),
    RealPhoto("people in a workshop", "IMG_20220204_101414.jpg", f"{_IBOIS}, img", "MIT", False),
    RealPhoto("a dark workshop", "IMG_20220204_122843.jpg", f"{_IBOIS}, img", "MIT", False),
    RealPhoto("a lecture room", "IMG_20220302_152714.jpg", f"{_IBOIS}, img", "MIT", False),
    RealPhoto("an entrance hall", "5meters.jpg", "braydennoh/GravelometerSegment, raw", "MIT",
              False),
)  # fmt: skip
"""The photographs of the study."""

_PEBBLES = PHOTOS[0]
_FLOOR = "stone_stacking.jpg"


def _pasted(
    name: str, file: str, on: str, licence: str, asked_for: bool, box: Box | None = None
) -> RealPhoto:
    source = f"{_BOARD}, pasted on {on}"
    return RealPhoto(f"composite: pebbles on {name}", file, source, licence, asked_for, box=box)


COMPOSITES: tuple[RealPhoto, ...] = (
    _pasted("concrete", _FLOOR, f"{_IBOIS}, img/{_FLOOR}", "none said, MIT", True,
            box=(0, 2320, 1560, 3024)),
    _pasted("concrete, uneven light", _FLOOR, f"{_IBOIS}, img/{_FLOOR}", "none said, MIT", True,
            box=(2400, 2320, 4032, 3024)),
    _pasted("a lawn", "grass", f"{_SKIMAGE}/grass.png", "none said, CC0", False),
    _pasted("gravel", "gravel", f"{_SKIMAGE}/gravel.png", "none said, CC0", False),
)  # fmt: skip
"""Real pebbles of the first photograph on other real grounds: edges and shadows are not real."""

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
    with opened(path.read_bytes(), _any_size) as picture:
        return picture.crop(box or (0, 0, *picture.size))


def _any_size(width: int, height: int) -> None:
    """Refuse nothing: these pictures are known."""
    del width, height


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
    with opened(file.getvalue(), _any_size) as picture:
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
        import skimage  # noqa: PLC0415

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
