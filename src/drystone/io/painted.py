"""Stones back into one picture, each where it was read and under its id."""

import numpy as np

from drystone.errors import InputError, Notice
from drystone.io.file_errors import MANY, listed
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels

MOST_HIDDEN = 0.5
"""A stone of which more lies under others is not where it was drawn: masks were cropped."""


def painted(stones: StoneSet) -> tuple[Labels, tuple[Notice, ...]]:
    """Return a label image of the size of the source, and which stones lie over each other.

    What several stones have in common goes to the smallest (W119).  E304: half of a stone lies
    under others.
    """
    height, width = stones.source.height_px, stones.source.width_px
    labels = np.zeros((height, width), np.uint32)
    for stone in sorted(stones, key=lambda one: (-one.area_px, one.id)):
        rows, cols = stone.mask.shape
        top = height - stone.bottom_px - rows
        window = labels[top : top + rows, stone.left_px : stone.left_px + cols]
        window[stone.mask] = stone.id
    ids, counts = np.unique(labels, return_counts=True)
    left = dict(zip(ids.tolist(), counts.tolist(), strict=True))
    under = {stone.id: stone.area_px - left.get(stone.id, 0) for stone in stones}
    hidden = [stone.id for stone in stones if under[stone.id] > MOST_HIDDEN * stone.area_px]
    if hidden:
        raise InputError(
            "E304",
            f"more than half of these stones lies under others: {listed(hidden)}.",
            where=stones.source.path,
            cure="Nothing says where they lie in the wall if their masks were cropped: give masks "
            "of the whole picture. --skip leaves out a stone that lies over others.",
        )
    found = [f"{stone} ({px} px)" for stone, px in sorted(under.items()) if px]
    if not found:
        return labels, ()
    text = f"what stones have in common went to the smaller one, from: {listed(found, most=MANY)}."
    return labels, (Notice("W119", text, "Draw them beside each other."),)
