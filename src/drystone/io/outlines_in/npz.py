"""NPZ: one array, an array of labels, or a mask a stone."""

import io
import zipfile
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError
from drystone.io.images import DAMAGE, check_size
from drystone.io.outlines_in.fill import trimmed
from drystone.io.outlines_in.model import (
    OutlinedStone,
    OutlineFile,
    PlacedMask,
    damaged,
    number_in,
)

_LABELS = "labels"
_BYTES_PER_PX = 8


def is_npz(data: bytes) -> bool:
    """Tell NPZ by its beginning and the arrays in it."""
    return data.startswith(b"PK\x03\x04") and b".npy" in data[:200]


def read_npz(data: bytes, where: str, max_px: int) -> NDArray[Any] | OutlineFile:
    """Read the arrays of an archive.

    Returns
    -------
    array or OutlineFile
        The only array, or that of the name labels, as it is; else a stone for every array.

    Raises
    ------
    InputError
        E106 for a damaged file, E110 for arrays that are too large, E114 for arrays that are no
        masks of one picture.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            largest = max((entry.file_size for entry in archive.infolist()), default=0)
        check_size(largest // _BYTES_PER_PX, 1, where, max_px)
        with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
            found = {name: arrays[name] for name in arrays.files}
    except (*DAMAGE, zipfile.BadZipFile) as error:
        raise InputError(
            "E106", f"the file is damaged or cut short ({error}).", where=where,
            cure="Export it again, without pickled objects.",
        ) from error  # fmt: skip
    if _LABELS in found:
        return np.asarray(found[_LABELS])
    if len(found) == 1:
        return np.asarray(next(iter(found.values())))
    return _masks(found, where)


def _masks(found: Mapping[str, NDArray[Any]], where: str) -> OutlineFile:
    stones = []
    shapes = {array.shape for array in found.values()}
    if len(shapes) != 1 or len(next(iter(shapes))) != 2:
        raise damaged(where, f"its arrays are no masks of one picture: shapes {sorted(shapes)}")
    for name, array in found.items():
        values = np.unique(array)
        if len(values) > 2 or array.dtype.kind not in "biuf" or (len(values) == 2 and values[0]):
            raise damaged(where, f"the array {name!r} is no mask (0 and one other value)")
        mask = trimmed(PlacedMask(array.astype(bool), 0, 0))
        stones.append(OutlinedStone(number_in(name), name, masks=() if mask is None else (mask,)))
    height, width = next(iter(shapes))
    return OutlineFile(tuple(stones), size_px=(width, height))
