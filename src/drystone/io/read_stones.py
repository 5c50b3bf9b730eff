"""Read stones from pictures, arrays, and files of outlines (paper §3.3; DESIGN 4.1)."""

import hashlib
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, LabelImageError, Notice
from drystone.io.census import Census, take_census
from drystone.io.checks import (
    check_background,
    check_no_plan,
    check_not_lossy,
    check_not_photo,
    check_not_resampled,
    check_not_uniform,
)
from drystone.io.file_bytes import file_bytes
from drystone.io.found import Found, stone_set
from drystone.io.images import FORMATS, SUFFIXES, Picture, decode
from drystone.io.labels import IdImage, to_ids
from drystone.io.listed import listed
from drystone.io.masks import BinaryMask, check_mask, components, find_mask
from drystone.io.outlines_in.detect import outline_reader
from drystone.io.outlines_in.model import OutlineFile
from drystone.io.outlines_in.npz import is_npz, read_npz
from drystone.io.patches import Patch, check_count, cut
from drystone.io.photo_sidecar import LABELS, SIDECAR, PhotoSidecar, read_sidecar
from drystone.io.read_outlines import check_no_image, check_unit, stones_of
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
        a folder of one-stone masks, an array like one of these; annotations in JSON (labelme,
        COCO, SAM, GeoJSON), a drawing (DXF, SVG), a mesh (OBJ, PLY, STL); or what `drystone
        segment` wrote.  The content tells them apart.
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
            return _read_folder(path, settings)
        path = labels
    data, name = _bytes_of(path), writable(path.name)
    reader = outline_reader(data, name)
    if reader is not None:
        return stones_of(reader, data, name, settings)
    sidecar = read_sidecar(path)
    if is_npz(data):
        arrays = read_npz(data, name, _max_px(settings))
        if isinstance(arrays, OutlineFile):
            return stones_of(lambda *_: arrays, data, name, settings)
        picture = Picture(arrays)
    else:
        picture = decode(data, name, _max_px(settings))
    scale = None if sidecar is None else _scale_beside(sidecar, picture, path)
    digest = hashlib.sha256(data).hexdigest()
    del data  # as large as the picture when it is not compressed
    return _read_picture(picture, Source(name, digest, px_per_m=scale), settings)


def _scale_beside(sidecar: PhotoSidecar, picture: Picture, path: Path) -> float | None:
    """Return the scale of a photograph's label image; E117 when it is of another picture."""
    height, width = picture.values.shape[:2]
    if (width, height) != (sidecar.width_px, sidecar.height_px):
        raise InputError(
            "E117",
            f"it has {width} x {height} px, but {SIDECAR} beside it is of one of "
            f"{sidecar.width_px} x {sidecar.height_px}.",
            where=str(path),
            cure=f"Find the stones again with `drystone segment`, or remove {SIDECAR}, and give "
            "the scale of the new picture.",
        )
    return sidecar.px_per_m


def _of_px(settings: ReadSettings, where: str) -> tuple[tuple[str, Any], ...]:
    """Return what a plan must keep of the settings with which a picture was read."""
    check_unit(None, settings, where)
    check_no_image(settings, where)
    return replace(settings, px_per_m=None).changed()


def _max_px(settings: ReadSettings) -> int:
    return int(settings.max_image_mpx * 1e6)


def _bytes_of(path: Path) -> bytes:
    try:
        return file_bytes(path)
    except FileNotFoundError:
        raise InputError(
            "E100", "there is no such file or folder.", where=str(path), cure="Check the path."
        ) from None
    except OSError as error:
        raise InputError(
            "E100",
            f"it cannot be read ({error.strerror or error}).",
            where=str(path),
            cure="Check that it is a file and that you may read it.",
        ) from error


def _read_array(array: Any, settings: ReadSettings) -> StoneSet:
    if isinstance(array, np.ma.MaskedArray):
        array = array.filled(settings.background)
    values = np.ascontiguousarray(array)
    digest = hashlib.sha256(repr((values.shape, values.dtype.str)).encode())
    if values.dtype.kind in "biuf":
        digest.update(values.data.cast("B") if values.size else b"")
    return _read_picture(Picture(values), Source("", digest.hexdigest()), settings)


def _read_picture(picture: Picture, source: Source, settings: ReadSettings) -> StoneSet:
    """Read a picture of several stones: a mask or ids."""
    where = source.path or "array"
    reading = _of_px(settings, where)
    image = to_ids(picture.values, settings.background, where)
    height, width = image.ids.shape
    census = take_census(image.ids)
    binary = _check(image, census, picture.lossy, settings, where)
    if binary is None:
        check_count(len(census.values) - 1, where)
        ids = _stone_ids(census.values, image.background, where)
        found = Found(cut(census.index, ids), list(image.notices), where)
    else:
        labels, count = components(binary.mask)
        check_count(count, where)
        patches = cut(labels, np.arange(1, count + 1))
        found = Found(patches, [_mask_notice(binary, count)], where)
    source = replace(source, width_px=width, height_px=height, reading=reading)
    return stone_set(found, source, settings)


def _check(
    image: IdImage, census: Census, lossy: bool, settings: ReadSettings, where: str
) -> BinaryMask | None:
    """Refuse what is no picture of stones; return the mask if it is one."""
    check_not_uniform(census, image.background, where)
    if lossy and not settings.mask:
        brightness = image.ids if image.brightness is None else image.brightness
        check_not_lossy(census, brightness, where)
    binary = find_mask(image, census, settings.mask, lossy=lossy)
    if binary is not None and settings.mask:
        check_mask(binary, where)
    if binary is None:
        check_not_photo(census, where)
        check_background(census.index, census, image.background, where)
        check_not_resampled(census, image.background, where)
    else:
        ends = np.array([binary.background, binary.stone])
        two = Census(binary.mask.astype(np.int32) + np.int32(1), ends)
        check_background(two.index, two, binary.background, where)
    return binary


def _mask_notice(binary: BinaryMask, count: int) -> Notice:
    between = ""
    if binary.between_px:
        between = f"; {binary.between_px} px of values between them went to the nearer one"
    return Notice(
        "W114",
        f"read as a binary mask ({binary.background} background, {binary.stone} stone{between}): "
        f"{count} components, numbered in row order.",
    )


def _stone_ids(values: NDArray[np.int64], background: int, where: str) -> NDArray[np.int64]:
    """Return the ids with 0 for the background."""
    if background != 0 and values[0] == 0:
        raise LabelImageError(
            "E108",
            f"the value 0 is there beside the background {background}, and no stone can be 0.",
            where=where,
            cure=f"Set those pixels to {background} if they are background, else to a free id.",
        )
    return np.where(values == background, 0, values)


def _read_folder(folder: Path, settings: ReadSettings) -> StoneSet:
    """Read one-stone masks, numbered from 1 in natural file order."""
    name = writable(_name_of(folder))
    check_no_plan(folder, name)
    entries = [entry for entry in folder.iterdir() if not entry.name.startswith(".")]
    files = [entry for entry in entries if entry.is_file() and entry.suffix.lower() in SUFFIXES]
    if not files:
        raise InputError(
            "E111", "the folder has no pictures in it.", where=name,
            cure=f"Stones are read from {FORMATS}.",
        )  # fmt: skip
    files.sort(key=_natural_order)
    ignored = sorted({entry.name for entry in entries} - {file.name for file in files})
    notices = []
    if ignored:
        notices.append(Notice("W117", f"not pictures, left aside: {writable(listed(ignored))}."))
    digest, patches, sizes = hashlib.sha256(), [], []
    names = tuple(writable(file.name) for file in files)
    for number, (file, own) in enumerate(zip(files, names, strict=True), start=1):
        data = _bytes_of(file)
        digest.update(hashlib.sha256(data).digest())
        where = f"{name}/{own}"
        patch, size, notice = _read_one(decode(data, where, _max_px(settings)), where, settings)
        sizes.append(size)
        notices += [notice] if notice else []
        patches += cut(patch.astype(np.int32), np.array([number]), own) or [
            Patch(number, np.zeros((1, 1), bool), 0, 0, size[0], name=own)
        ]
    height, width = (max(size[axis] for size in sizes) for axis in (0, 1))
    reading = _of_px(settings, name)
    source = Source(name, digest.hexdigest(), width, height, names, reading)
    return stone_set(Found(patches, notices, name), source, settings)


def _name_of(folder: Path) -> str:
    """Return the name of a folder, also of one that is given as "." or ".."."""
    return folder.resolve().name if folder.name in ("", "..") else folder.name


def _natural_order(path: Path) -> tuple[list[str | int], str]:
    parts = re.split(r"([0-9]+)", path.name.casefold())
    # Numbers are every other part; between them there may be digits of other scripts.
    return [int(part) if i % 2 else part for i, part in enumerate(parts)], path.name


def _read_one(
    picture: Picture, where: str, settings: ReadSettings
) -> tuple[NDArray[np.bool_], tuple[int, int], Notice | None]:
    """Read the mask of one stone; an empty one has no pixel."""
    image = to_ids(picture.values, settings.background, where)
    height, width = image.ids.shape
    value = int(image.ids.flat[0])
    if (image.ids == value).all():
        full = value != image.background
        text = f"{where} is stone to all its edges ({width} x {height} px of {value})."
        notice = Notice("W118", text, "Check that it is not an empty picture.") if full else None
        return np.full((height, width), full), (height, width), notice
    census = take_census(image.ids)
    # mask=False is about pictures of many stones: here every picture is a mask.
    forced = ReadSettings(mask=settings.mask or None)
    binary = _check(image, census, picture.lossy, forced, where)
    if binary is not None:
        return binary.mask, (height, width), None
    if len(census.values) == 2:
        return image.ids != image.background, (height, width), None
    raise LabelImageError(
        "E111",
        f"{len(census.values)} values in a mask of one stone.",
        where=where,
        cure="A folder holds one black-and-white mask a stone; give a label image by itself.",
    )
