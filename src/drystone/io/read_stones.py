"""Read stones from pictures, arrays, and files of outlines (paper §3.3; DESIGN 4.1)."""

import hashlib
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, LabelImageError, Notice
from drystone.io import checks, read_outlines
from drystone.io.files import given_bytes, listed, naming
from drystone.io.images import FORMATS, SUFFIXES, Picture, decode
from drystone.io.labels import Census, IdImage, check_no_zero, to_ids
from drystone.io.masks import (
    BinaryMask,
    components,
    find_mask,
    ground_in,
    is_npz,
    read_npz,
    without_others,
)
from drystone.io.outlines_in.model import OutlineFile
from drystone.io.patches import (
    MIN_AREA_PX,
    StonePatch,
    check_count,
    cut,
    smallest_of_mask_px,
    stone_set,
)
from drystone.io.photo_beside import LABELS, PAGE, read_sidecar, scale_beside
from drystone.io.read_settings import ReadSettings
from drystone.model.stone import Source, StoneSet, writable

__all__ = ["ReadSettings", "read_stones"]


def read_stones(
    source: str | Path | NDArray[Any], *, settings: ReadSettings | None = None
) -> StoneSet:
    """Read stones.

    Parameters
    ----------
    source : str, Path or array
        A label image, a picture of ids in colours, a binary mask (PNG, TIFF, BMP, GIF, NPY, NPZ),
        a folder of one-stone masks, an array like one of these; annotations (labelme, COCO, SAM,
        GeoJSON, Label Studio, VIA, CVAT, YOLO), a drawing (DXF, SVG), a mesh (OBJ, PLY, STL); or
        what `drystone segment` wrote.  The content tells them apart.
    settings : ReadSettings, optional
        Background, holes, pieces, units and the like.

    Returns
    -------
    StoneSet
        The stones under the picture's own ids; components of a mask are numbered in row order,
        masks of a folder in natural file order from 1; outlines keep the numbers of their file
        when all have different ones, else they are numbered in its order.  Its notices list every
        pixel that was left out or added.  Its source has a scale when the file says so itself.

    Raises
    ------
    LabelImageError, InputError
        E100 ... E118, see ``docs/errors.md``.
    UsageError
        E118 when the settings do not fit what is read.

    Examples
    --------
    >>> labels = np.zeros((40, 60), np.uint32)
    >>> labels[5:20, 5:30], labels[20:35, 10:50] = 300, 70000
    >>> [(stone.id, stone.area_px) for stone in read_stones(labels)]
    [(300, 375), (70000, 600)]
    """
    settings = settings or ReadSettings()
    if not isinstance(source, str | Path):
        return _read_array(source, settings)
    path = Path(source)
    if path.is_dir():
        labels = path / LABELS
        if read_sidecar(labels) is None:
            # Also of a folder that is given as "." or "..".
            name = path.resolve().name if path.name in ("", "..") else path.name
            with naming(writable(name)):
                return _read_folder(path, writable(name), settings)
        path = labels
    data, name = given_bytes(path), writable(path.name)
    with naming(name):
        reader = read_outlines.outline_reader(data, name)
        if reader is not None:
            return read_outlines.stones_and_outlines(reader, data, name, settings)[0]
        sidecar = read_sidecar(path)
        if is_npz(data):
            arrays = read_npz(data, _max_px(settings))
            if isinstance(arrays, OutlineFile):
                return read_outlines.stones_and_outlines(lambda *_: arrays, data, name, settings)[0]
            picture = Picture(arrays)
        else:
            picture = decode(data, _max_px(settings))
        # What has no two sides is refused below.
        scale = scale_beside(sidecar, picture.values.shape[1::-1], path)
        photograph = () if sidecar is None else sidecar.photograph
        digest = hashlib.sha256(data).hexdigest()
        del data  # as large as the picture when it is not compressed
        taken = Source(name, digest, px_per_m=scale, photograph=photograph)
        found = _read_picture(picture, taken, settings)
    if sidecar is None or not sidecar.doubtful:
        return found
    text = f"what was found in the photograph is doubtful: {'; '.join(sidecar.doubtful)}."
    notice = Notice("W183", text, f"Correct it in {PAGE} beside it, and give what that saves.")
    return replace(found, notices=(notice, *found.notices))


def _of_px(settings: ReadSettings) -> tuple[tuple[str, Any], ...]:
    """Return what a plan must keep of the settings with which a picture was read."""
    read_outlines.check_unit(None, settings)
    read_outlines.check_not_asked(settings, "image", "label", "up")
    return replace(settings, px_per_m=None).changed()


def _max_px(settings: ReadSettings) -> int:
    return int(settings.max_image_mpx * 1e6)


def _read_array(array: Any, settings: ReadSettings) -> StoneSet:
    if isinstance(array, np.ma.MaskedArray):
        array = array.filled(settings.background)
    values = np.ascontiguousarray(array)
    digest = hashlib.sha256(repr((values.shape, values.dtype.str)).encode())
    if values.dtype.kind in "biuf":
        digest.update(values.data.cast("B") if values.size else b"")
    with naming("array"):
        return _read_picture(Picture(values), Source("", digest.hexdigest()), settings)


def _read_picture(picture: Picture, source: Source, settings: ReadSettings) -> StoneSet:
    """Read a picture of several stones: a mask or ids."""
    reading = _of_px(settings)
    image = to_ids(picture, settings.background)
    height, width = image.ids.shape
    given = image.census.values
    image, binary = _checked(image, picture.lossy, settings)
    if binary is None:
        values = image.census.values
        check_count(len(values) - 1)
        # What became background is left out already.
        skip = tuple(i for i in settings.skip if i in values or i not in given)
        settings = replace(settings, skip=skip)
        check_no_zero(image)
        patches = cut(image.census.index, np.where(values == image.background, 0, values))
        notices = image.notices
    else:
        labels, count = components(binary.mask)
        check_count(count)
        patches = cut(labels, np.arange(1, count + 1))
        settings = replace(settings, min_area_px=smallest_of_mask_px(patches, settings))
        between = ""
        if binary.between_px:
            between = f"; {binary.between_px} px of values between them went to the nearer one"
        said = f"{binary.background} background, {binary.stone} stone{between}"
        text = f"read as a binary mask ({said}): {count} components, numbered in row order."
        notices = (*image.said, Notice("W114", text))
    source = replace(source, width_px=width, height_px=height, reading=reading)
    return stone_set(patches, notices, source, settings)


def _checked(
    image: IdImage, lossy: bool, settings: ReadSettings
) -> tuple[IdImage, BinaryMask | None]:
    """Refuse what is no picture of stones; return it repaired, and the mask if it is one."""
    checks.check_not_uniform(image)
    if lossy and not settings.mask:
        checks.check_not_lossy(image)
    binary = find_mask(image, settings.mask, lossy=lossy)
    if binary is None:
        checks.check_not_photo(image.census)
        if settings.mask is None and (net := checks.without_net(image)) is not image:
            image = net
            checks.check_not_uniform(image)
            binary = find_mask(image, None)
    if binary is None:
        checks.check_background(image.census, image.background, rim_px=int(image.has_edges))
        image = checks.without_blends(image, settings.min_area_px or MIN_AREA_PX)
        checks.check_not_resampled(image)
    else:
        ends = np.array([binary.background, binary.stone])
        checks.check_background(
            Census(binary.mask.view(np.uint8) + np.uint8(1), ends), binary.background
        )
    return image, binary


def _read_folder(folder: Path, name: str, settings: ReadSettings) -> StoneSet:
    """Read one-stone masks, numbered from 1 in natural file order."""
    checks.check_no_plan(folder)
    entries = [entry for entry in folder.iterdir() if not entry.name.startswith(".")]
    files = [entry for entry in entries if entry.is_file() and entry.suffix.lower() in SUFFIXES]
    if not files:
        cure = f"Stones are read from {FORMATS}."
        raise InputError("E111", "the folder has no pictures in it.", cure=cure)
    files.sort(key=_natural_order)
    ignored = sorted({entry.name for entry in entries} - {file.name for file in files})
    notices = []
    if ignored:
        notices.append(Notice("W117", f"not pictures, left aside: {writable(listed(ignored))}."))
    digest, patches, sizes = hashlib.sha256(), [], []
    doubtful: dict[int, LabelImageError] = {}
    names = tuple(writable(file.name) for file in files)
    for number, (file, own) in enumerate(zip(files, names, strict=True), start=1):
        data = given_bytes(file)
        digest.update(hashlib.sha256(data).digest())
        where = f"{name}/{own}"
        with naming(where):
            picture = decode(data, _max_px(settings))
            said: tuple[Notice, ...] = ()
            try:
                mask, said = _mask_of_one(picture, where, settings)
            except LabelImageError as error:
                if error.code != "E105":
                    raise
                error.where = where
                doubtful[number] = error
                mask = ground_in(picture, settings.background)
        sizes.append(mask.shape)
        notices += said
        patches += cut(mask.astype(np.int32), np.array([number]), own) or [
            StonePatch(np.zeros((1, 1), bool), 0, 0, number, len(mask), name=own)
        ]
    patches, left_out = without_others(patches, sizes, doubtful, settings)
    notices += left_out
    height, width = np.max(sizes, axis=0).tolist()
    source = Source(name, digest.hexdigest(), width, height, names, _of_px(settings))
    return stone_set(patches, notices, source, settings)


def _natural_order(path: Path) -> tuple[list[str | int], str]:
    parts = re.split(r"([0-9]+)", path.name.casefold())
    # Numbers are every other part; between them there may be digits of other scripts.
    return [int(part) if i % 2 else part for i, part in enumerate(parts)], path.name


def _mask_of_one(
    picture: Picture, where: str, settings: ReadSettings
) -> tuple[NDArray[np.bool_], tuple[Notice, ...]]:
    """Read the mask, (h, w), of one stone; an empty one has no pixel."""
    image = to_ids(picture, settings.background)
    height, width = image.ids.shape
    value = int(image.ids.flat[0])
    if (image.ids == value).all():
        full = value != image.background
        text = f"{where} is stone to all its edges ({width} x {height} px of {value})."
        notice = Notice("W118", text, "Check that it is not an empty picture.")
        return np.full((height, width), full), (notice,) if full else ()
    # mask=False is about pictures of many stones: here every picture is a mask.
    image, binary = _checked(image, picture.lossy, ReadSettings(mask=settings.mask or None))
    said = tuple(replace(notice, message=f"{where}: {notice.message}") for notice in image.said)
    if binary is not None:
        return binary.mask, said
    values = image.census.values
    if len(values) == 2:
        return image.ids != image.background, said
    what = f"{len(values)} values in a mask of one stone."
    cure = "A folder holds one black-and-white mask a stone; give a label image by itself."
    raise LabelImageError("E111", what, cure=cure)
