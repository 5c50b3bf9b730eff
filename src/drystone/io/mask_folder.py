"""Which masks of a folder are not stones: those of one picture may be ground, parts or repeats."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from drystone.errors import LabelImageError, Notice
from drystone.io.images import Picture
from drystone.io.outlines_in.nested import INSIDE, Seen, meeting_boxes, not_stones, said_of
from drystone.io.patches import StonePatch
from drystone.io.read_settings import ReadSettings

_TOUCHING = 0.1
"""Share of a mask from which it lies over another one."""


def ground_in(picture: Picture, background: int) -> NDArray[np.bool_]:
    """Return the mask, (h, w), of a picture that looks like the background of the others."""
    values = np.asarray(picture.values, float)
    grey = values if values.ndim == 2 else values[..., :3].max(axis=2)
    apart = np.abs(grey - background)
    return np.asarray(2.0 * apart >= apart.max())


def without_others(
    patches: Sequence[StonePatch],
    sizes: Sequence[tuple[int, ...]],
    doubtful: Mapping[int, LabelImageError],
    settings: ReadSettings,
) -> tuple[list[StonePatch], list[Notice]]:
    """Leave out what is not a stone of one picture, as a program masks it.

    A `doubtful` mask (E105) is refused as before, unless it is the ground of the others.
    """
    few = 0 < 2 * len(doubtful) <= len(patches)
    if len(set(sizes)) > 1 or not (few or _are_of_one_picture(patches, sizes[0])):
        left: dict[int, str] = {}
    else:
        masks = {p.id: p for p in patches if p.area_px and p.id not in settings.skip}
        size_px = (sizes[0][1], sizes[0][0])
        left = not_stones(Seen(masks, size_px, frozenset(settings.keep), by_program=True))
    for number, error in doubtful.items():
        if number not in {*left, *settings.keep, *settings.skip}:
            raise error
    kept = [patch for patch in patches if patch.id not in left]
    names = {patch.id: patch.name for patch in patches}
    return kept, [said_of(left, len(patches), names)] if left else []


def _are_of_one_picture(patches: Sequence[StonePatch], size: tuple[int, ...]) -> bool:
    """Tell masks of one picture from stones that each had a picture of its own.

    Those lie all over each other, where masks of one picture lie beside or in each other.
    """
    depth = np.zeros(size, np.uint16)
    for patch in patches:
        top, left, bottom, right = patch.sides
        depth[top:bottom, left:right] += patch.mask
    if 2 * int(depth.max(initial=0)) > len(patches):
        return False
    nested = partial = 0
    for i, j in meeting_boxes(patches):
        smaller = min(patches[i].area_px, patches[j].area_px)
        share = patches[i].common_px(patches[j]) / max(1, smaller)
        nested += share >= INSIDE
        partial += _TOUCHING <= share < INSIDE
    return partial <= nested
