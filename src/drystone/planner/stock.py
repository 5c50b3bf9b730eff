"""What the planner needs to know of the stone set as a whole."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.sums import unfillable
from drystone.model.pose import PosedStone
from drystone.model.site import Site


@dataclass(frozen=True)
class Stock:
    """Sizes of the stones in their initial poses, working px."""

    narrowest_px: float  # width of the narrowest, which tells boundary stones from inner ones
    # means over the set
    mean_height_px: float
    mean_area_px: float
    median_area_px: float  # of the stones themselves, whatever their pixels
    # of the box of each stone, by id: the shorter and the longer one
    sides: Mapping[int, tuple[int, ...]] = field(default_factory=dict, compare=False)

    @classmethod
    def of(cls, initial: Iterable[PosedStone]) -> "Stock":
        """Return the sizes of a set of stones in their initial poses, at least one.

        Each pose is looked at once, so that poses of a large set need not exist together.
        """
        found = [
            (posed.stone.id, posed.height_px, posed.width_px, posed.area_px,
             posed.stone.area_px * posed.scale**2) for posed in initial
        ]  # fmt: skip
        ids, heights, widths, areas, own = zip(*found, strict=True)
        return cls(
            narrowest_px=float(min(widths)),
            mean_height_px=sum(heights) / len(found),
            mean_area_px=sum(areas) / len(found),
            median_area_px=float(np.median(own)),
            sides={i: tuple(sorted(sides)) for i, *sides in zip(ids, heights, widths, strict=True)},
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
    def of(cls, sides: Sequence[tuple[int, ...]], site: Site) -> "Rest":
        """Return it for the sides of the stones that are left, ascending."""
        flat = Counter(one[:1] for one in sides)
        return cls(unfillable(flat, site.height_px), unfillable(Counter(sides), site.width_px))
