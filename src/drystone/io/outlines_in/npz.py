"""NPZ: one array, an array of labels, or a mask a stone."""

import io
import zipfile
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError
from drystone.io.file_errors import damaged, too_large, unusable
from drystone.io.foreign import foreign
from drystone.io.images import array_of
from drystone.io.outlines_in.fill import trimmed
from drystone.io.outlines_in.gathered import Gathered
from drystone.io.outlines_in.model import OutlineFile
from drystone.io.patches import PlacedMask

_BYTES_PER_PX = 8


def is_npz(data: bytes) -> bool:
    """Tell NPZ by its beginning and the arrays in it."""
    return data.startswith(b"PK\x03\x04") and b".npy" in data[:200]


def read_npz(data: bytes, max_px: int) -> NDArray[Any] | OutlineFile:
    """Read the arrays of an archive.

    The only array, or that of the name labels, is returned as it is; else each is a stone.
    """
    found = {
        name.removesuffix(".npy"): array_of(member, max_px)
        for name, member in _members(data, max_px).items()
    }
    alone = found.get("labels", next(iter(found.values())) if len(found) == 1 else None)
    return _masks(found) if alone is None else np.asarray(alone)


def _members(data: bytes, max_px: int) -> dict[str, bytes]:
    """Unpack the arrays of an archive, of which the sizes are added up first."""
    with foreign(_broken):
        archive = zipfile.ZipFile(io.BytesIO(data))
        entries = archive.infolist()
    total, most = sum(entry.file_size for entry in entries), _BYTES_PER_PX * max_px
    if total > most:
        raise too_large(
            f"its arrays have {total / 1e6:.0f} MB; the limit is {most / 1e6:g} MB.",
            "Give arrays of fewer or smaller values; only in Python can the limit be raised "
            "(max_image_mpx).",
        )
    found = {}
    for entry in entries:
        # Of others zipfile unpacks all that there is, whatever size they name.
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise _broken("it is packed as NumPy packs none")
        with foreign(_broken), archive.open(entry) as member:
            found[entry.filename] = member.read(entry.file_size)
    return found


def _broken(why: str) -> InputError:
    return damaged(why, cure="Export it again, without pickled objects.")


def _masks(found: Mapping[str, NDArray[Any]]) -> OutlineFile:
    gathered = Gathered()
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
