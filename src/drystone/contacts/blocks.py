"""Rigid block models of label images (Pic-to-Ri, §4.2; DESIGN 4.8)."""

from dataclasses import dataclass

import numpy as np

from drystone.contacts.interfaces import PointContacts, find_interfaces, interfaces_in
from drystone.errors import InputError, Notice, counted
from drystone.kernels.label_runs import label_runs, runs_in_pieces
from drystone.kernels.patches import painted_patch
from drystone.model.placement import Placement, Wedge
from drystone.model.wall import Labels, picture_of_ids
from drystone.statics.model import Block, RigidBlockModel

LARGEST_MU = 1e300
"""A coefficient of friction from which forces do not overflow."""

NAMED = 5
"""A notice names this many stones."""


@dataclass(frozen=True, eq=False)
class ImageModel:
    """The rigid blocks of a label image."""

    model: RigidBlockModel  # lengths in px; y = 0 at the lowest stone pixel's lower edge
    ground_row: int
    """The ground is the upper edge of this image row, or the image's lower edge; y of the wall
    frame is `ground_row` minus the row coordinate."""
    notices: tuple[Notice, ...] = ()
    """W301 when empty rows below the stones were left out, W304 when pixels of a stone lie apart
    from it."""


def model_from_labels(labels: Labels, mu: float = 0.58) -> ImageModel:
    """Make the rigid block model of a label image that stands on its lowest stone pixel.

    Parameters
    ----------
    labels : (h, w) integer array
        0 where nothing is, otherwise the id of a stone or wedge; row 0 at the top.  All pixels
        of an id are one block.
    mu : float
        Coefficient of friction, the same everywhere.

    Returns
    -------
    ImageModel
        A model without blocks for an empty image.

    Raises
    ------
    LabelImageError
        E301 when the array is not a picture of ids.
    InputError
        E302 when mu is not a number >= 0.

    Examples
    --------
    >>> labels = np.array([[7, 7], [7, 7], [0, 0]], np.uint32)
    >>> picture = model_from_labels(labels)
    >>> picture.model.blocks[0].centroid, picture.ground_row, picture.notices[0].code
    ((1.0, 1.0), 2, 'W301')
    """
    labels = picture_of_ids(labels)
    check_mu(mu)
    filled = np.flatnonzero((labels > 0).any(axis=1))
    height = int(filled[-1]) + 1 if filled.size else labels.shape[0]
    above = labels[:height]
    runs = label_runs(above)
    ids, place = np.unique(runs.labels, return_inverse=True)
    # All sums are multiples of a half, exact in floats in any order.
    area = np.bincount(place, runs.lengths, len(ids))
    x = np.bincount(place, runs.lengths * (runs.begins + runs.ends) / 2.0, len(ids)) / area
    y = np.bincount(place, runs.lengths * (height - runs.rows - 0.5), len(ids)) / area
    columns = zip(ids.tolist(), area.tolist(), x.tolist(), y.tolist(), strict=True)
    blocks = tuple(Block(i, a, (cx, cy)) for i, a, cx, cy in columns)
    model = RigidBlockModel(blocks, find_interfaces(above), mu)
    return ImageModel(model, height, notices_of(labels))


def model_with(
    model: RigidBlockModel,
    labels: Labels,
    placement: Placement,
    wedges: tuple[Wedge, ...] = (),
    points: PointContacts | None = None,
) -> RigidBlockModel:
    """Return the model of a wall with one more stone and its wedges.

    Only what is around them is looked at, however large the wall is.  `labels` are the wall without
    them; the lower edge is the ground.  `points` belong to `model`: whoever asks for many
    candidates finds them once.  Blocks and interfaces are those of :func:`model_from_labels`, in
    the order of construction.
    """
    parts = [(placement.stone_id, placement.row, placement.col, placement.posed.mask)]
    parts += [(wedge.id, wedge.row, wedge.col, wedge.mask) for wedge in wedges]
    patch, sums = painted_patch(labels, parts)
    blocks = []
    for (block_id, row, col, mask), (area, cols, rows) in zip(parts, sums, strict=True):
        x = (cols + 0.5 * area) / area
        y = (area * mask.shape[0] - rows - 0.5 * area) / area
        bottom = labels.shape[0] - row - mask.shape[0]
        blocks.append(Block(block_id, float(area), (col + x, bottom + y)))
    if points is None or points.interfaces is not model.interfaces:
        points = PointContacts.of(model.interfaces)
    return model.with_added(tuple(blocks), interfaces_in(patch), points.closed_in(patch))


def check_mu(mu: float) -> None:
    """Raise InputError (E302) unless mu is a number >= 0 that forces can be multiplied by."""
    if not 0 <= mu <= LARGEST_MU:
        what = f"a coefficient of friction of {mu} makes no sense."
        cure = "Give a number >= 0; dry stone has about 0.58."
        raise InputError("E302", what, where="mu", cure=cure)


def pieces_apart(labels: Labels) -> tuple[tuple[int, int], ...]:
    """Return (id, pixels apart from its largest piece) of each id that is not in one piece.

    Pixels that touch at a corner are in one piece.
    """
    runs = label_runs(labels)
    ids, place = np.unique(runs.labels, return_inverse=True)
    piece = runs_in_pieces(runs)
    sizes = np.bincount(piece, runs.lengths)
    block = np.zeros(len(sizes), np.intp)
    block[piece] = place
    largest = np.zeros(len(ids))
    np.maximum.at(largest, block, sizes)
    apart = np.bincount(block, sizes, len(ids)) - largest
    return tuple((int(ids[k]), int(apart[k])) for k in np.flatnonzero(apart).tolist())


def notices_of(labels: Labels) -> tuple[Notice, ...]:
    """Say how many rows below the stones are empty (W301), and whose pixels lie apart (W304)."""
    filled, apart = np.append(labels[::-1].any(axis=1), False), pieces_apart(labels)
    below = int(np.argmax(filled))
    rows = f"{counted(below, 'empty row')} below the stones left out"
    notices = (Notice("W301", f"{rows}: the wall stands on its lowest stone pixel."),) * (below > 0)
    if not apart:
        return notices
    told = [f"{px} pixel{'s' * (px > 1)} of stone {block}" for block, px in apart[:NAMED]]
    if len(apart) > NAMED:
        told.append(f"pixels of {len(apart) - NAMED} more")
    one = len(apart) == 1
    verb, them = "lies" if one and apart[0][1] == 1 else "lie", "it" if one else "them"
    what = f"{', '.join(told)} {verb} apart from {them}; all pixels of an id are one rigid block."
    cure = "Give every piece an id of its own, or clean the picture."
    return (*notices, Notice("W304", what, cure))
