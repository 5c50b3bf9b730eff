"""Arrays of NumPy from bytes: nothing is made before the bytes for it are known to be there."""

import io
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError
from drystone.io.file_errors import damaged, unread
from drystone.io.foreign import foreign
from drystone.io.pictures import check_size

BEGINNING = b"\x93NUMPY"


def array_of(data: bytes, max_px: int) -> NDArray[Any]:
    """Return the array of an NPY file; it can be read only."""
    with foreign(damaged):
        file = io.BytesIO(data)
        version = np.lib.format.read_magic(file)
        read = np.lib.format.read_array_header_1_0
        if version != (1, 0):
            read = np.lib.format.read_array_header_2_0
        shape, fortran, dtype = read(file)
    if dtype.hasobject:
        raise _pickled(data)
    if min(shape, default=0) < 0 or not dtype.itemsize:
        raise damaged("a side is below 0, or its values have no bytes")
    count, start = math.prod(shape), file.tell()
    if count * dtype.itemsize > len(data) - start:
        raise damaged("there are fewer bytes than its shape asks for")
    if count:
        height, width = (*shape, 1, 1)[:2]
        check_size(width, height, max_px)
    with foreign(damaged):
        values = np.frombuffer(data, dtype, count, start)
        return values.reshape(shape, order="F" if fortran else "C")


def _pickled(data: bytes) -> InputError:
    """Make the error for objects of Python; the masks of cellpose lie in such."""
    cellpose = all(name in data for name in (b"masks", b"outlines"))
    what = "objects of cellpose (_seg.npy)" if cellpose else "Python objects"
    masks = "Save masks as PNG" if cellpose else "Save the array of ids by itself"
    return unread(
        f"it holds {what}, and pickle is not read, as it may run programs.",
        f"Export the masks: in the cellpose window 'File > {masks}', or in Python "
        "`np.save('masks.npy', np.load(FILE, allow_pickle=True).item()['masks'])`."
        if cellpose
        else f"{masks}, as whole numbers.",
    )
