"""Indices counted again, pixel by pixel, in the picture of an action (§3.5)."""

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.wall import Labels
from drystone_lab.pictures.action import Action


def recounted(action: Action, name: str) -> float | None:
    """Return an index counted in the label image; None where the picture does not show it.

    Parameters
    ----------
    action : Action
        The stone where it is, and what its indices measure.
    name : {"SF", "LFR", "GDS", "NHR", "IWR", "IS"}
        Which.  SF is that of the working pixels here; the planner's is that of the source image.
    """
    counts = {"SF": _shape, "LFR": _filling, "GDS": _dice, "NHR": _height, "IWR": _joints,
              "IS": _slope}  # fmt: skip
    return counts[name](action)


def _shape(action: Action) -> float:
    return float(action.posed.mask.mean())


def _filling(action: Action) -> float:
    swept = action.labels[action.swept] > 0
    return float(swept.mean()) if swept.size else 1.0


def _dice(action: Action) -> float:
    built = np.zeros(action.labels.shape, bool)
    filled = np.flatnonzero((action.labels > 0).any(axis=1))
    built[filled[0] if filled.size else len(built) :] = True
    stone = action.stone_pixels
    area = np.count_nonzero(stone)
    inside = np.count_nonzero(stone & built)
    return float(np.count_nonzero(built) / area * inside / np.count_nonzero(stone | built))


def _height(action: Action) -> float | None:
    if action.neighbour is None:
        return None
    top, other = _rows(action.stone_pixels), _rows(_pixels(action.labels, action.neighbour.id))
    return abs(top[0] - other[0]) / (top[1] - top[0])


def _joints(action: Action) -> float | None:
    below1, below2 = action.below
    if below1 is None or below2 is None:
        return None
    left, right = _cols(action.stone_pixels)
    start1, end1 = _cols(_pixels(action.labels, below1.id))
    start2, end2 = _cols(_pixels(action.labels, below2.id))
    terms = (abs(left - end1) / (end1 - start1), abs(right - start2) / (end2 - start2))
    return sum(min(1.0, term) for term in terms) / 2


def _slope(action: Action) -> float | None:
    if action.peaks is None or action.peaks[0] == action.peaks[1]:
        return None
    left, right = (action.col + column for column in action.peaks)
    stone = action.stone_pixels
    fall = int(np.argmax(stone[:, right])) - int(np.argmax(stone[:, left]))
    side = np.sign(action.col + action.posed.anchor[0] - action.labels.shape[1] / 2)
    return float(np.clip(fall / (left - right) * side, -1.0, 1.0))


def _pixels(labels: Labels, block: int) -> Mask:
    return np.asarray(labels == block)


def _rows(pixels: Mask) -> tuple[int, int]:
    """Return the first row of some pixels and the row after the last."""
    rows = np.flatnonzero(pixels.any(axis=1))
    return int(rows[0]), int(rows[-1]) + 1


def _cols(pixels: Mask) -> tuple[int, int]:
    return _rows(pixels.T)
