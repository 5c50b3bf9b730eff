"""Which values a picture has, where and how often; counted once, used by every check."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.ids import counted, looked_up, numbered


@dataclass(frozen=True, eq=False)
class Census:
    """The different values of an image."""

    index: NDArray[np.int32]  # (h, w), pixel by pixel 1 + the position of its value in `values`
    values: NDArray[np.int64]  # (n,), different values, ascending

    @cached_property
    def counts(self) -> NDArray[np.int64]:
        """Number of pixels of each value."""
        return counted(self.index, len(self.values))[1:]

    @property
    def commonest(self) -> int:
        """Position of the most frequent value."""
        return int(np.argmax(self.counts))

    @cached_property
    def solid(self) -> NDArray[np.bool_]:
        """True where the 3 x 3 px around a pixel all have its value; (h, w), the rim is False."""
        solid = np.zeros(self.index.shape, bool)
        a = self.index
        if min(a.shape) >= 3:
            same = (a[:, :-2] == a[:, 1:-1]) & (a[:, 1:-1] == a[:, 2:])
            down = a[:-1, 1:-1] == a[1:, 1:-1]
            solid[1:-1, 1:-1] = same[:-2] & same[1:-1] & same[2:] & down[:-1] & down[1:]
        return solid

    def pixels(self, chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return the (h, w) mask of the pixels whose value is chosen; `chosen` is (n,) bool."""
        return self.of(chosen)

    def of(self, told: NDArray[Any], out: NDArray[Any] | None = None) -> NDArray[Any]:
        """Return pixel by pixel, (h, w), what is told of each value; `told` is (n,)."""
        return looked_up(np.concatenate((told[:1], told)), self.index, out)


def take_census(ids: NDArray[Any]) -> Census:
    """Count the values of an image of integers, none of them negative."""
    return Census(*numbered(ids))
