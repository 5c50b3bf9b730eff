"""Height and width of the stones as they lie in a wall."""

from collections.abc import Collection
from dataclasses import dataclass

from scipy import ndimage

from drystone.errors import LabelImageError
from drystone.kernels.ids import counted, numbered
from drystone.model.wall import Labels


@dataclass(frozen=True)
class StoneSizes:
    """What the stones of a wall measure, wedges left out.

    Parameters
    ----------
    count : int
        Number of stones.
    area_px : int
        Pixels of all stones together.
    mean_height_px, mean_width_px : float
        Of their upright bounding boxes.
    """

    count: int
    area_px: int
    mean_height_px: float
    mean_width_px: float


def stone_sizes(labels: Labels, wedge_ids: Collection[int] = frozenset()) -> StoneSizes:
    """Measure the stones of a wall.

    Parameters
    ----------
    labels : (h, w) integer array
        0 where nothing is.
    wedge_ids : collection of int
        Labels that are wedges, not stones.

    Raises
    ------
    LabelImageError
        E104 when there is no stone in the image, or nothing but wedges.

    Examples
    --------
    >>> import numpy as np
    >>> stone_sizes(np.array([[0, 7, 7], [9, 7, 7]], np.uint32), wedge_ids={9})
    StoneSizes(count=1, area_px=4, mean_height_px=2.0, mean_width_px=2.0)
    """
    index, ids = numbered(labels)
    boxes = ndimage.find_objects(index)
    areas = counted(index, len(ids))[1:]
    stones = [i for i, stone in enumerate(ids.tolist()) if stone and stone not in wedge_ids]
    if not stones:
        raise LabelImageError(
            "E104",
            f"no stones: all {labels.shape[1]}x{labels.shape[0]} px are background or wedges.",
            cure="Give an image of labels in which stones have positive ids.",
        )
    heights = [boxes[i][0].stop - boxes[i][0].start for i in stones]
    widths = [boxes[i][1].stop - boxes[i][1].start for i in stones]
    return StoneSizes(
        count=len(stones),
        area_px=int(areas[stones].sum()),
        mean_height_px=sum(heights) / len(stones),
        mean_width_px=sum(widths) / len(stones),
    )
