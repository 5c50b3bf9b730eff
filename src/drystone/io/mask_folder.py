"""Which masks of a folder are not stones: those of one picture may be ground, parts or repeats."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from drystone.errors import LabelImageError, Notice
from drystone.io.images import Picture
from drystone.io.outlines_in.nested import Seen, not_stones, of_one_picture, said_of
from drystone.io.patches import StonePatch
from drystone.io.read_settings import ReadSettings


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
    if len(set(sizes)) > 1 or not (few or of_one_picture(patches)):
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
