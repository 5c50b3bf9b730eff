"""Where a mask rests on a landscape, for all positions at once, on packed bits (§3.6).

A run of L stone pixels meets something where the landscape, dilated by L, is set; dilations are
made by doubling and shared by all masks.  A mask rests where it meets nothing, and does one row
lower: two readings of one map.

Rows above the first occupied one are never stored.
"""

import numpy as np

from drystone.kernels.backend import compiled
from drystone.kernels.lowering import Positions
from drystone.kernels.raster import Mask
from drystone.kernels.silhouette import Ints, Silhouette

_fast = compiled("bits")


def bit_landscape(occupied: Mask, top: Ints) -> "BitLandscape":
    """Pack a landscape of a skyline (:func:`~drystone.kernels.lowering.skyline`)."""
    packed: BitLandscape = (BitLandscape if _fast is None else _fast.BitLandscape)(occupied, top)
    return packed


class BitLandscape:
    """A packed landscape with its dilations; never changed, so threads may share it.

    In Python it is one long integer, a bit a pixel, row after row.
    """

    def __init__(self, occupied: Mask, top: Ints) -> None:
        self._height, self._width = occupied.shape
        self._first = int(top.min())
        packed = np.packbits(occupied[self._first :].ravel(), bitorder="little")
        bits = int.from_bytes(packed.tobytes(), "little")
        # doubled[k] has bit p set where any of the 2**k pixels from p to the right is occupied.
        # The last columns of a row look into the next row; no valid position reads them.
        doubled = [bits]
        while 2 ** len(doubled) <= self._width:
            last = doubled[-1]
            doubled.append(last | last >> 2 ** (len(doubled) - 1))
        self._doubled = tuple(doubled)

    def resting(self, mask: Silhouette) -> Positions:
        """Return all positions (n, 2) of a mask in one piece where it rests, by row, then column.

        That is where no pixel of it meets an occupied one and some would one row lower, or would be
        in the ground.
        """
        width, cols = self._width, self._width - mask.width + 1
        highest = self._first - mask.height  # any higher, it meets nothing one row lower
        count = self._height - mask.height - highest + 1
        if cols <= 0:
            return np.zeros((0, 2), np.int64)
        # Bit 0 is for the corner in the first column of the row `highest`.
        hit = ((1 << width) - 1) << (count * width)
        for row, start, length in mask.runs.tolist():
            hit |= self._dilated(length) << ((mask.height - row) * width - start)
        rests = hit >> width & ~hit & ((1 << count * width) - 1)
        raw = np.frombuffer(rests.to_bytes((count * width + 7) // 8, "little"), np.uint8)
        flags = np.unpackbits(raw, count=count * width, bitorder="little").reshape(count, width)
        above = max(0, -highest)
        positions = np.argwhere(flags[above:, :cols])
        positions[:, 0] += highest + above
        return np.ascontiguousarray(positions, np.int64)

    def _dilated(self, length: int) -> int:
        power = length.bit_length() - 1
        spread = self._doubled[power]
        return spread | spread >> (length - (1 << power)) if length > 1 << power else spread
