"""A stone turned by an angle and rasterised at the working resolution."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask, mirrored
from drystone.kernels.silhouette import Silhouette, silhouette
from drystone.model.stone import Stone


@dataclass(frozen=True, eq=False)
class PosedStone:
    """A rigid copy of a stone, turned and rasterised; where it goes is not decided yet."""

    stone: Stone
    angle_deg: float  # counter-clockwise from the source image, in [-180, 180)
    scale: float  # working resolution over source resolution
    mask: Mask  # (h, w): at the working resolution, cropped, row 0 at the top
    # the stone's centroid (x, y) from the mask's bottom-left corner, working px, y up;
    # multiples of 1/64
    anchor: tuple[float, float]

    def __post_init__(self) -> None:
        self.mask.flags.writeable = False

    @property
    def height_px(self) -> int:
        """Height of the mask in working px."""
        return int(self.mask.shape[0])

    @property
    def width_px(self) -> int:
        """Width of the mask in working px."""
        return int(self.mask.shape[1])

    @cached_property
    def area_px(self) -> int:
        """Area of the mask in working px."""
        return int(self.mask.sum())

    @cached_property
    def bottom(self) -> NDArray[np.intp]:
        """Row of the lowest pixel of each column."""
        return np.asarray(self.height_px - 1 - np.argmax(self.mask[::-1], axis=0))

    @cached_property
    def top(self) -> NDArray[np.intp]:
        """Row of the highest pixel of each column."""
        return np.asarray(np.argmax(self.mask, axis=0))

    @cached_property
    def top_roughness_px(self) -> float:
        """Mean deviation of the top of the columns from their median height."""
        ordered, half = np.sort(self.top), len(self.top) // 2
        # The median; of few numbers NumPy takes it more slowly than it sorts them.
        median = (ordered[half] + ordered[-1 - half]) / 2
        return float(np.abs(self.top - median).mean())

    @cached_property
    def silhouette(self) -> Silhouette:
        """What placement asks of the mask."""
        return silhouette(self.mask)

    @cached_property
    def mirrored(self) -> "PosedStone":
        """The mirror image; for views of a mirrored site only, never for placing."""
        anchor = self.width_px - self.anchor[0], self.anchor[1]
        return PosedStone(self.stone, self.angle_deg, self.scale, mirrored(self.mask), anchor)
