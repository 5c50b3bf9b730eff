"""F_AV and F_AH by another sensible definition, against walls that suit only the first.

A search finds walls that are good by the definition it goes by; no search goes by this one.  It
differs in what DESIGN 5 had to choose.
"""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.paths import row_lengths, step_counts
from drystone.kernels.raster import Mask
from drystone.metrics import paths
from drystone.metrics.frame import frame_wall
from drystone.model.outlines import Outlines
from drystone.model.site import Site
from drystone.model.wall import Labels, Wall

FINER = 3
"""Resolution at which joints are looked at, over the working resolution."""

STARTS = 10
"""Paths from each of the two sides between which they lead; even."""


def second_arrangement(labels: Labels) -> tuple[float | None, float | None]:
    """Return F_AV and F_AH of a wall by the second definition.

    F_AV is by how much paths between the top and the foot of the wall are longer than straight,
    percent (higher is better), None where a stone from end to end leaves no path.  F_AH is the same
    between its ends (lower is better), None where a stone is as high as the wall.

    Stones are eroded and all else is joint, as in :func:`drystone.metrics.paths.joint_mask`, but
    there is open joint only along the sides where paths start and end, one px of it: paths cannot
    pass by the wall.  :data:`STARTS` paths start evenly spread on each of two sides that face each
    other, and end anywhere on the other one: 100 (v - s) / s, with v their length and s that of a
    straight one, is averaged over all of them.  The wall is at :data:`FINER` times the working
    resolution, and cut to its stones: where it is a little shorter than planned, paths must not
    run through the slit at its end.
    """
    joint = paths.joint_mask(frame_wall(labels).labels)
    rows, cols = slice(paths.PAD_TOP, -paths.PAD_BOTTOM), slice(paths.PAD_LEFT, -paths.PAD_RIGHT)
    # As wide on both sides, so that a wall and its mirror image are worth the same.
    with_top_and_foot = joint[paths.PAD_TOP - 1 : 1 - paths.PAD_BOTTOM, cols]
    with_ends = joint[rows, paths.PAD_LEFT - 1 : 1 - paths.PAD_RIGHT]
    return _mean_excess(with_top_and_foot.T), _mean_excess(with_ends)


def finer_labels(labels: Labels) -> Labels:
    """Repeat every pixel of a wall that is known at the working resolution only."""
    return labels.repeat(FINER, axis=0).repeat(FINER, axis=1)


def finer_picture(wall: Wall) -> Labels:
    """Draw a planned wall at the resolution of the second definition, by its outlines if any."""
    if wall.outlines is None:
        return finer_labels(wall.labels)
    scale = FINER * wall.site.scale
    finer = Site(FINER * wall.site.width_px, FINER * wall.site.height_px, scale)
    return Outlines.empty(finer).added(wall.outlines.blocks, scale).shares.labels


def _mean_excess(joint: Mask) -> float | None:
    """Return by how much paths between the left and the right side are longer than straight.

    All pixels of a side are joint, so there is a path from each of them, or from none.
    """
    straight = joint.shape[1] - 1
    # In the middle of equal parts of the side, from both ends alike.
    side = joint.shape[0]
    first = (2 * np.arange(STARTS // 2) + 1) * side // (2 * STARTS)
    starts = np.concatenate([first, side - 1 - first[::-1]])
    lengths = [*_lengths_across(joint, starts), *_lengths_across(joint[:, ::-1], starts)]
    return paths.mean_excess(lengths, straight)


def _lengths_across(joint: Mask, rows: NDArray[np.intp]) -> list[float]:
    """Return the lengths of the shortest ways from the left end of rows to anywhere at the right.

    A way on through the mirror image to its end of the same row is twice as long as the way to the
    last column, where both images meet.
    """
    both = np.hstack([joint, joint[:, -2::-1]])
    lengths = row_lengths(both, rows).tolist()
    return [paths.length_px(*step_counts(length // 2)) for length in lengths if length >= 0]
