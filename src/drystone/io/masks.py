"""Masks: which pictures are binary ones, and archives of arrays (NPZ; DESIGN 4.1)."""

import io
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, LabelImageError, Notice
from drystone.io.checks import blended
from drystone.io.files import damaged, foreign, too_large, unfit, unusable
from drystone.io.images import Picture, array_of
from drystone.io.labels import Census, IdImage, components
from drystone.io.outlines_in.classes import Gathered
from drystone.io.outlines_in.model import OutlineFile, trimmed
from drystone.io.outlines_in.nested import not_stones, of_one_picture, said_of
from drystone.io.patches import PlacedMask, StonePatch
from drystone.io.read_settings import ReadSettings
from drystone.kernels.ids import numbered
from drystone.kernels.raster import Mask

_USUAL_STONE_VALUES = (1, 255, 65535, 2**32 - 1)
_LOST = 0.2
"""Largest share of plain areas that a mask may lose: of ids 1 to 30 it is about a half."""
_NOISE = 1 / 16
"""Of the way from the background to the stones: what JPEG makes of a plain background."""


@dataclass(frozen=True, eq=False)
class BinaryMask:
    """A picture read as stone and background."""

    mask: Mask  # (h, w), True where there is stone
    background: int  # this and the next: the two values of the picture
    stone: int
    between_px: int  # pixels with values between them (anti-aliasing), given to the nearer one


def find_mask(image: IdImage, wanted: bool | None, *, lossy: bool = False) -> BinaryMask | None:
    """Read a picture as a binary mask if it is one; ids that are to be read as one are refused.

    There are at least two values.  `wanted` forces a mask, or forbids it; None decides: two values,
    one of them the background, are a mask, and so is a picture of two values and blended edges.
    Compression (`lossy`) left noise in the background.
    """
    if wanted is False:
        return None
    ids = image.census
    if len(ids.values) == 2 and (wanted or image.background in ids.values):
        binary = _split(ids, image.background)
        return binary if wanted or not _is_one_id(binary) else None
    if image.brightness is None:
        grey = ids
    elif wanted or image.nearly_grey:
        grey = Census(*numbered(image.brightness))
    else:
        return None
    if len(grey.values) > 1 and wanted:
        binary = _split(grey, image.background)
        # Blurred edges of a mask have values between, too, but they are not plain.
        share = np.abs(grey.values - binary.background) / abs(binary.stone - binary.background)
        off = share > (_NOISE if lossy else 0.0)
        plain, between = (
            np.count_nonzero(grey.of(some) & grey.solid) for some in (off, off & (2 * share < 1))
        )
        if between > _LOST * plain:
            raise unfit(
                f"{between / plain:.0%} of its plain areas are neither background "
                f"({binary.background}) nor near to stone ({binary.stone}), and would be lost.",
                "If the values are ids, leave --mask (mask=True in Python) out, and export them "
                "as PNG where they are in a JPEG.",
            )
        return binary
    if len(grey.values) > 1 and _is_antialiased(grey, image.background):
        return _split(grey, image.background)
    return None


def _split(census: Census, background: int) -> BinaryMask:
    """Give every value to the nearer end of the range, halves to the stones."""
    low, high = int(census.values[0]), int(census.values[-1])
    if abs(low - background) > abs(high - background):
        low, high = high, low
    stone = 2 * np.abs(census.values - low) >= abs(high - low)
    ends = census.counts[0] + census.counts[-1]
    return BinaryMask(census.of(stone), low, high, int(census.index.size - ends))


def _is_one_id(binary: BinaryMask) -> bool:
    """Tell a label image of a single stone (0 and 300, in one piece) from a mask."""
    if binary.stone in _USUAL_STONE_VALUES or binary.stone == 0:
        return False
    found, count = components(binary.mask)
    areas = np.sort(np.bincount(found.ravel())[1:])
    return count == 1 or int(areas[:-1].sum()) < 0.02 * int(areas.sum())


def _is_antialiased(census: Census, background: int) -> bool:
    """Tell a mask with grey edges: all other values lie between two plain ones, at edges."""
    if len(census.values) < 3:
        return False
    ends = np.zeros(len(census.values), bool)
    ends[[0, -1]] = True
    most = set(np.argsort(census.counts)[-2:].tolist())
    if most != {0, len(ends) - 1} or background not in census.values[ends]:
        return False
    between: NDArray[Any] = census.of(~ends)
    at_edge = blended(census, between)
    plain = census.solid[between]
    return bool(at_edge.mean() >= 0.8 and at_edge[plain].all())


def ground_in(picture: Picture, background: int) -> NDArray[np.bool_]:
    """Return the mask, (h, w), of a picture that looks like the background of the others."""
    values = np.asarray(picture.values, float)
    grey = values if values.ndim == 2 else values[..., :3].max(axis=2)
    apart = np.abs(grey - background)
    return np.asarray(2.0 * apart >= apart.max())


def without_others(
    patches: Sequence[StonePatch],
    sizes: Sequence[tuple[int, ...]],
    doubtful: Mapping[int, LabelImageError],
    settings: ReadSettings,
) -> tuple[list[StonePatch], list[Notice]]:
    """Leave out what is not a stone of one picture, as a program masks it.

    A `doubtful` mask (E105) is refused as before, unless it is the ground of the others.
    """
    few = 0 < 2 * len(doubtful) <= len(patches)
    left: dict[int, str] = {}
    if len(set(sizes)) == 1 and (few or of_one_picture(patches)):
        masks = {p.id: p for p in patches if p.area_px and p.id not in settings.skip}
        left = not_stones(masks, (sizes[0][1], sizes[0][0]), settings.keep, by_program=True)
    for number, error in doubtful.items():
        if number not in {*left, *settings.keep, *settings.skip}:
            raise error
    kept = [patch for patch in patches if patch.id not in left]
    names = {patch.id: patch.name for patch in patches}
    return kept, [said_of(left, len(patches), names)] if left else []


_BYTES_PER_PX = 8


def is_npz(data: bytes) -> bool:
    """Tell NPZ by its beginning and the arrays in it."""
    return data.startswith(b"PK\x03\x04") and b".npy" in data[:200]


def read_npz(data: bytes, max_px: int) -> NDArray[Any] | OutlineFile:
    """Read the arrays of an archive.

    The only array, or that of the name labels, is returned as it is; else each is a stone.
    """
    with foreign(_broken):
        archive = zipfile.ZipFile(io.BytesIO(data))
        entries = archive.infolist()
    # Before anything is unpacked.
    total, most = sum(entry.file_size for entry in entries), _BYTES_PER_PX * max_px
    if total > most:
        raise too_large(
            f"its arrays have {total / 1e6:.0f} MB; the limit is {most / 1e6:g} MB.",
            "Give arrays of fewer or smaller values; only in Python can the limit be raised "
            "(max_image_mpx).",
        )
    unpacked = {}
    for entry in entries:
        # Of others zipfile unpacks all that there is, whatever size they name.
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise _broken("it is packed as NumPy packs none")
        with foreign(_broken), archive.open(entry) as member:
            unpacked[entry.filename] = member.read(entry.file_size)
    found = {name.removesuffix(".npy"): array_of(one, max_px) for name, one in unpacked.items()}
    alone = found.get("labels", next(iter(found.values())) if len(found) == 1 else None)
    return _masks(found, max_px) if alone is None else np.asarray(alone)


def _broken(why: str) -> InputError:
    return damaged(why, cure="Export it again, without pickled objects.")


def _masks(found: Mapping[str, NDArray[Any]], max_px: int) -> OutlineFile:
    gathered = Gathered(max_px)
    shapes = {array.shape for array in found.values()}
    if len(shapes) != 1 or len(next(iter(shapes))) != 2:
        raise unusable(f"its arrays are not masks of one picture: shapes {sorted(shapes)}")
    for name, array in found.items():
        values = np.unique(array)
        if len(values) > 2 or array.dtype.kind not in "biuf" or (len(values) == 2 and values[0]):
            raise unusable(f"the array {name!r} is not a mask (0 and one other value)")
        gathered.labelled(name, name, trimmed(PlacedMask(array.astype(bool), 0, 0)))
    height, width = next(iter(shapes))
    return gathered.file(size_px=(width, height), seen_by="either", names_images=False)
