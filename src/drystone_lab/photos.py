"""Suite "photos": stones found in rendered and in real photographs, beside the truth.

Where real ones are from, and which stones are in them, stands in ``photographs/real.toml``.
"""

import io
import json
import time
import tomllib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import skimage
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageOps, JpegImagePlugin
from scipy import ndimage
from scipy.spatial.distance import pdist
from skimage.metrics import contingency_table
from skimage.transform import matrix_transform

from drystone.errors import DrystoneError, ExitCode
from drystone.io.images import opened
from drystone.photo.segment_doubts import doubts_of, verdict_of
from drystone.photo.segment_photo import SegmentedPhoto, segment_photo
from drystone_lab.photographs.rendered import LEVELS, Photograph, PhotoLevel, layout_of, photograph
from drystone_lab.table import BENCH, BenchSettings, Cell, Rows, Table, worded

Labels = NDArray[np.uint16]

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
    drawn: Sequence[Sequence[float]] = ()
    drawn_px: int = 0
    part: bool = False  # only some of the stones are known: precision says nothing
    box: Box | None = None  # left, upper, right, lower: cut out


_FILE = tomllib.loads((Path(__file__).parent / "photographs/real.toml").read_text("utf-8"))

PHOTOS, COMPOSITES = (
    tuple(RealPhoto(**photo) for photo in _FILE[name]) for name in ("photos", "composites")
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
        return _drawn([ring.tolist() for ring in rings], size_px, 1.0)
    values = np.asarray(_opened(photo.mask, photo.box, data))
    labels = _on_board(values) if values.dtype == np.uint8 else values
    resized = Image.fromarray(labels.astype(np.int32)).resize(size_px, Image.Resampling.NEAREST)
    return np.asarray(resized).astype(np.uint16)


def _path(name: str, data: Path | None) -> Path | None:
    if "." not in name:
        return Path(skimage.__file__).parent / "data" / f"{name}.png"
    path = None if data is None else data / "photographs" / name
    return path if path is not None and path.is_file() else None


def _drawn(stones: Sequence[Sequence[float]], size_px: tuple[int, int], scale: float) -> Labels:
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


MATCHED = 0.5
"""Intersection over union from which on a stone counts as found."""


class Score(NamedTuple):
    """What was found of what is there."""

    stones: int  # stones, found: Whole stones in the photograph, and stones that were found
    found: int
    recall: float  # recall, precision: Share of either that has a match
    precision: float
    # Intersection over union of every stone with what covers it best, in the order of the stones
    ious: tuple[float, ...]


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Render the photographs, find the stones, compare."""

    def said(rows: Rows) -> Rows:
        for row in rows:
            settings.say(", ".join(map(str, row)))
            yield row

    words = BENCH["photos"]
    levels = tuple(_small(level) for level in LEVELS[::3]) if settings.quick else LEVELS
    rendered = worded(words["rendered"], said(map(_row, levels)))
    cases = ((name, "an error", _outcome(_small(level), way)) for name, level, way in _refused())
    refused = worded(words["refused"], said(cases))
    photos = [*said(_real_row(photo, settings.data) for photo in there(settings.data))]
    return rendered, refused, worded(words["real"], photos, there=len(photos), all=len(ALL))


def _real_row(photo: RealPhoto, data: Path | None) -> tuple[Cell, ...]:
    image = pixels_of(photo, data)
    full = truth_of(photo, data, (image.shape[1], image.shape[0]))
    about = (photo.name, photo.source, photo.licence, "yes" if photo.asked_for else "no")
    try:
        result = segment_photo(image)
    except DrystoneError as error:
        count = None if full is None else len(whole_stones(full))
        return (*about, count, 0, None, None, None, error.code, int(error.exit_code))
    doubtful = verdict_of(result.found, doubts_of(result.found))
    said = "doubtful" if doubtful else "found"
    code = int(ExitCode.CHECK_FAILED if doubtful else ExitCode.DONE)
    height, width = result.found.labels.shape
    if full is None:
        return (*about, None, result.found.count, None, None, None, said, code)
    truth = np.asarray(Image.fromarray(full.astype(np.int32)).resize((width, height), 0))
    got = _compared(truth.astype(np.uint16), whole_stones(truth), result.found.labels)
    found = [iou for iou in got.ious if iou >= MATCHED]
    return (
        *about, got.stones, got.found, round(got.recall, 3),
        None if photo.part else round(got.precision, 3),
        round(float(np.median(found)), 3) if found else None, said, code,
    )  # fmt: skip


def whole_stones(truth: NDArray[np.integer]) -> NDArray[np.int64]:
    """Return the numbers of the stones that the edge of the picture does not cut."""
    rim = np.concatenate([truth[0], truth[-1], truth[:, 0], truth[:, -1]])
    return np.setdiff1d(truth, np.append(rim, 0)).astype(np.int64)


def score(made: Photograph, result: SegmentedPhoto) -> Score:
    """Compare what was found in a rendered photograph with what is there."""
    labels = result.found.labels
    truth = made.truth_in(np.linalg.inv(result.from_photo), labels.shape)
    frame = made.truth_in(np.eye(3), (made.level.height_px, made.level.width_px))
    return _compared(truth, whole_stones(frame), labels)


def _compared(
    truth: NDArray[np.uint16], whole: NDArray[np.int64], labels: NDArray[np.uint16]
) -> Score:
    """Compare the stones that are whole with those that were found."""
    iou = overlaps(truth, labels)[whole - 1]
    best, count = iou.max(axis=1), iou.shape[1]
    # What is found of a stone that is cut is no mistake of telling stones from ground.
    matched = int((iou.max(axis=0) >= MATCHED).sum())
    recall = float((best >= MATCHED).mean())
    return Score(len(whole), count, recall, matched / count, tuple(best.tolist()))


def overlaps(truth: NDArray[np.uint16], labels: NDArray[np.uint16]) -> NDArray[np.float64]:
    """Return intersection over union of every true stone with every found one, (n, m).

    >>> overlaps(np.array([[1, 1, 0]], np.uint16), np.array([[0, 1, 1]], np.uint16)).round(3)
    array([[0.333]])
    """
    table = contingency_table(truth, labels).toarray()
    inside = table[1:, 1:]
    union = table[1:].sum(axis=1)[:, None] + table[:, 1:].sum(axis=0)[None] - inside
    return np.asarray(inside / np.maximum(union, 1))


def _scale_error(made: Photograph, result: SegmentedPhoto) -> float | None:
    """Return the largest error of distances between nine places of the ground, percent."""
    if result.px_per_m is None:
        return None
    level = made.level
    x, y = np.meshgrid(
        *(np.array([0.15, 0.5, 0.85]) * side for side in (level.width_px, level.height_px))
    )
    seen = np.column_stack([x.ravel(), y.ravel()])
    true = matrix_transform(seen, np.linalg.inv(made.homography)) / level.px_per_m
    found = matrix_transform(seen, result.from_photo) / result.px_per_m
    return float(100 * np.abs(pdist(found) / pdist(true) - 1).max())


def pixels(made: Photograph) -> NDArray[np.uint8]:
    """Return the photograph as a viewer shows it."""
    return np.asarray(ImageOps.exif_transpose(JpegImagePlugin.JpegImageFile(io.BytesIO(made.jpeg))))


def _row(level: PhotoLevel) -> tuple[Cell, ...]:
    made = photograph(level)
    image = pixels(made)
    start = time.perf_counter()
    try:
        result = segment_photo(image, layout_of(level))
    except DrystoneError as error:
        return (level.name, int(made.truth.max()), error.code, *[None] * 7)
    seconds = time.perf_counter() - start
    got, scale_error = score(made, result), _scale_error(made, result)
    return (
        level.name, got.stones, got.found, round(got.recall, 3), round(got.precision, 3),
        round(float(np.median(got.ious)), 3), round(min(got.ious), 3),
        None if scale_error is None else round(scale_error, 3),
        f"{level.shadow:g} / {1 - result.found.shadow_level:.2f}", round(seconds, 1),
    )  # fmt: skip


def _small(level: PhotoLevel) -> PhotoLevel:
    return replace(
        level, width_px=900, height_px=675, px_per_m=800.0, count=min(level.count, 10),
        gap_px=12, touching=min(level.touching, 2), cut=min(level.cut, 1),
    )  # fmt: skip


Change = Callable[[NDArray[np.uint8]], NDArray[np.uint8]]


def _refused() -> tuple[tuple[str, PhotoLevel, Change], ...]:
    easy, single = LEVELS[0], replace(LEVELS[0], markers="single")
    bare = replace(easy, markers="none")
    return (
        ("no marker", bare, lambda image: image),
        ("a sheet that is covered but for one marker", easy, _one_marker),
        ("one of four single markers printed 6 % too large",
         replace(single, wrong_print=1.06), lambda image: image),
        ("the photograph is mirrored", easy, lambda image: image[:, ::-1]),
        ("no stones", replace(easy, count=1, cut=1, angular=0.0), lambda image: image),
        ("noise", bare,
         lambda image: np.random.default_rng(1).integers(0, 256, image.shape, np.uint8)),
    )  # fmt: skip


def _one_marker(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Cover what is below and right of the first marker of the sheet."""
    from drystone.photo.markers import find_markers  # noqa: PLC0415

    changed = image.copy()
    for marker in find_markers(image)[1:]:
        (left, top), (right, bottom) = marker.corners_px.min(axis=0), marker.corners_px.max(axis=0)
        changed[int(top) : int(bottom) + 1, int(left) : int(right) + 1] = image[-1, -1]
    return changed


def _outcome(level: PhotoLevel, change: Change) -> str:
    made = photograph(level)
    layout = layout_of(level) or layout_of(replace(level, markers="sheet"))
    try:
        result = segment_photo(np.ascontiguousarray(change(pixels(made))), layout)
    except DrystoneError as error:
        return error.code
    return f"{result.found.count} stones: miss"
