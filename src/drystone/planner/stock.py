"""What the planner needs to know of the stone set as a whole."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.sums import unfillable
from drystone.model.pose import PosedStone
from drystone.model.site import Site


@dataclass(frozen=True)
class Stock:
    """Sizes of the stones in their initial poses, working px.

    Parameters
    ----------
    narrowest_px : float
        Width of the narrowest, which tells boundary stones from inner ones.
    mean_height_px, mean_area_px : float
        Means over the set.
    largest_id : int
        Wedges are numbered after it.
    """

    narrowest_px: float
    mean_height_px: float
    mean_area_px: float
    largest_id: int

    @classmethod
    def of(cls, initial: Sequence[PosedStone]) -> "Stock":
        """Return the sizes of a set of stones in their initial poses, at least one."""
        count = len(initial)
        return cls(
            narrowest_px=float(min(posed.width_px for posed in initial)),
            mean_height_px=sum(posed.height_px for posed in initial) / count,
            mean_area_px=sum(posed.area_px for posed in initial) / count,
            largest_id=max(posed.stone.id for posed in initial),
        )


@dataclass(frozen=True, eq=False)
class Rest:
    """What the stones that are left could still fill.

    Parameters
    ----------
    height_px, width_px : int arrays
        For every free height over a stone, and every free width beside it: what is left over when
        the remaining stones fill it as well as they can, lying flat on top of each other or side
        by side in any of two orientations.
    """

    height_px: NDArray[np.int64]
    width_px: NDArray[np.int64]

    @classmethod
    def of(cls, initial: Iterable[PosedStone], site: Site) -> "Rest":
        """Return it for the initial poses of the stones that are left."""
        sides = [sorted((posed.height_px, posed.width_px)) for posed in initial]
        return cls(
            unfillable([(low,) for low, _ in sides], site.height_px),
            unfillable([(low, high) for low, high in sides], site.width_px),
        )
