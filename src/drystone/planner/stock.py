"""What the planner needs to know of the stone set as a whole."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.sums import unfillable
from drystone.model.pose import PosedStone
from drystone.model.site import Site

SideCounts = Counter[tuple[int, ...]]
"""How many stones in their initial poses have a box of these sides, working px, ascending."""


def sides_of(initial: Iterable[PosedStone]) -> SideCounts:
    """Count the sides of stones in their initial poses."""
    return Counter(tuple(sorted((posed.height_px, posed.width_px))) for posed in initial)


@dataclass(frozen=True)
class Stock:
    """Sizes of the stones in their initial poses, working px."""

    narrowest_px: float  # width of the narrowest, which tells boundary stones from inner ones
    # means over the set
    mean_height_px: float
    mean_area_px: float
    median_area_px: float  # of the stones themselves, whatever their pixels
    largest_id: int  # wedges are numbered after it
    sides: SideCounts = field(default_factory=Counter, compare=False)

    @classmethod
    def of(cls, initial: Iterable[PosedStone]) -> "Stock":
        """Return the sizes of a set of stones in their initial poses, at least one.

        Each pose is looked at once, so that poses of a large set need not exist together.
        """
        found = [
            (posed.height_px, posed.width_px, posed.area_px, posed.stone.id,
             posed.stone.area_px * posed.scale**2) for posed in initial
        ]  # fmt: skip
        heights, widths, areas, ids, own = zip(*found, strict=True)
        return cls(
            narrowest_px=float(min(widths)),
            mean_height_px=sum(heights) / len(found),
            mean_area_px=sum(areas) / len(found),
            median_area_px=float(np.median(own)),
            largest_id=max(ids),
            sides=Counter(tuple(sorted(sides)) for sides in zip(heights, widths, strict=True)),
        )


@dataclass(frozen=True, eq=False)
class Rest:
    """What the stones that are left could still fill."""

    # for every free height over a stone, and every free width beside it: what is left over
    # when the remaining stones fill it as well as they can, lying flat on top of each other
    # or side by side in any of two orientations
    height_px: NDArray[np.int64]
    width_px: NDArray[np.int64]

    @classmethod
    def of(cls, sides: SideCounts, site: Site) -> "Rest":
        """Return it for the sides of the stones that are left."""
        low: Counter[tuple[int, ...]] = Counter()
        for (shorter, _), count in sides.items():
            low[(shorter,)] += count
        return cls(unfillable(low, site.height_px), unfillable(sides, site.width_px))
