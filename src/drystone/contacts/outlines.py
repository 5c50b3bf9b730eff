"""Outlines of the stones of a label image that share their joints (DESIGN 4.8, 4.9)."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
import shapely
from scipy import ndimage

from drystone.contacts.settled import model_of_outlines
from drystone.kernels.outline import pixel_rings
from drystone.kernels.polygons import Points
from drystone.kernels.segments import REACH_PX, Line, fitted_lines, meeting_point, with_area
from drystone.model.overlap import common_parts
from drystone.model.stone import OUTLINE_TOLERANCE_PX
from drystone.model.wall import Labels
from drystone.statics.model import RigidBlockModel

Node = tuple[int, int]
RingPiece = tuple[Node, ...]
"""Pixel corners (x, y) from one junction to the next, or around a stone that has none."""
Fit = tuple[list[int], list[Line]]

CONTACT_TOLERANCE = 0.1
"""Gaps and overlaps of outlines up to this are contacts."""

SAME_SHARE = 0.88
"""An outline covers at least this share of its pixels; small stones keep their pixel edges else."""


def outlines_of_labels(labels: Labels) -> dict[int, Points]:
    """Find the outlines of all stones of a label image, (n, 2) by id.

    Corners are in the wall frame, px, counter-clockwise and closed: the first one is repeated at
    the end.  The ground, y = 0, is the image's lower edge.

    The contour (the midpoints of pixel edges) is cut where three or more stones, ground and nothing
    meet, and every piece is simplified once, for both its sides, into fitted lines. Then its
    corners move a little so that the area beside it is that of the pixels.  A stone that has no
    such outline, as some of a few pixels, keeps its pixel edges.  Holes are filled, with whatever
    lies in them; of an id in several pieces the largest is taken.
    """
    rings = _rings(labels)
    junctions = _junctions(labels)
    pieces = {block: _pieces(ring, junctions) for block, ring in rings.items()}
    users = defaultdict[RingPiece, list[int]](list)
    for block, mine in pieces.items():
        for piece in mine:
            users[_key(piece)].append(block)
    ends = defaultdict[Node, list[tuple[RingPiece, int]]](list)  # which pieces end where
    for piece in users:
        ends[piece[0]].append((piece, 0))
        ends[piece[-1]].append((piece, -1))
    fits = {piece: fitted_lines(np.array(piece, float), OUTLINE_TOLERANCE_PX) for piece in users}
    drawn, outlines, unsound = dict[RingPiece, Points](), dict[int, Points](), set[int]()
    anew = set(users)
    while anew:
        drawn |= {piece: _drawn(piece, ends, fits) for piece in anew}
        for block in {block for piece in anew for block in users[piece]}:
            mine, ring = pieces[block], rings[block]
            free = [len(users[_key(p)]) == 1 and _key(p) in fits for p in mine]
            outlines[block] = _assembled(mine, drawn, free, ring)
            unsound.discard(block)
            if not _is_sound(outlines[block], ring):
                unsound.add(block)
        # The shortest piece first: two junctions close together are most often the reason.
        keys = [sorted((_key(p) for p in pieces[block]), key=len) for block in unsound]
        blocky = {next((key for key in mine if key in fits), None) for mine in keys} - {None}
        fits = {piece: fit for piece, fit in fits.items() if piece not in blocky}
        # What meets them is drawn anew; pixel edges may pass one corner twice, but never cross.
        anew = {piece for key in blocky if key for i in (0, -1) for piece, _ in ends[key[i]]}
    return {block: outlines[block] for block in rings}


def model_of_traced(
    outlines: Mapping[int, Points], mu: float = 0.58, *, setback: float = 0.0
) -> RigidBlockModel:
    """Make the rigid block model of stones with given outlines, (n, 2), closed, counter-clockwise.

    Blocks and interfaces are sorted by ids; of two the larger id is `block`.  Edges and corners
    touch up to a gap or overlap of `CONTACT_TOLERANCE`, in the unit of the outlines.  Overlaps are
    not looked for: whoever makes outlines checks them.
    """
    blocks = [(block, outlines[block][:-1]) for block in sorted(outlines)]
    return model_of_outlines(blocks, mu, CONTACT_TOLERANCE, setback)


def _rings(labels: Labels) -> dict[int, RingPiece]:
    """Return the pixel corners around the largest piece of each id, counter-clockwise."""
    ids, place = np.unique(labels, return_inverse=True)
    if len(ids) and ids[0] > 0:
        ids, place = np.concatenate([[0], ids]), place + 1
    rings = {}
    windows = ndimage.find_objects(place.reshape(labels.shape))
    for block, window in zip(ids[1:].tolist(), windows, strict=True):
        largest = max(pixel_rings(labels[window] == block), key=_area)
        corner = window[1].start, labels.shape[0] - window[0].stop
        rings[block] = tuple(map(tuple, (largest + corner).astype(int).tolist()))
    return rings


def _junctions(labels: Labels) -> set[Node]:
    """Return the pixel corners (x, y) where three or four pixel edges meet."""
    cells = np.pad(labels.astype(np.int64), 1)
    cells[-1] = -1  # the ground is not nothing
    a, b, c, d = cells[:-1, :-1], cells[:-1, 1:], cells[1:, :-1], cells[1:, 1:]
    edges = np.sum([a != b, c != d, a != c, b != d], axis=0)
    row, col = np.nonzero(edges >= 3)
    return set(zip(col.tolist(), (labels.shape[0] - row).tolist(), strict=True))


def _pieces(ring: RingPiece, junctions: set[Node]) -> list[RingPiece]:
    """Cut a closed ring at its junctions."""
    at = [i for i, node in enumerate(ring[:-1]) if node in junctions]
    if not at:  # it begins at its furthest point, which is a corner if it has any
        nodes = np.array(ring[:-1], float)
        at = [int(np.hypot(*(nodes - nodes.mean(axis=0)).T).argmax())]
    turned = (*ring[at[0] : -1], *ring[: at[0] + 1])
    cuts = [*(i - at[0] for i in at), len(ring) - 1]
    return [turned[first : last + 1] for first, last in pairwise(cuts)]


def _key(piece: RingPiece) -> RingPiece:
    """Return the piece in the sense that both its sides know it by."""
    return min(piece, piece[::-1])


def _assembled(
    pieces: Sequence[RingPiece],
    drawn: Mapping[RingPiece, Points],
    free: Sequence[bool],
    ring: RingPiece,
) -> Points:
    """Join the pieces around a stone to its outline.

    Junctions that move take area from one stone to another; a free side gives it back.
    """
    lines = [drawn[_key(p)] if p == _key(p) else drawn[_key(p)][::-1] for p in pieces]
    movable = [i for i, line in enumerate(lines) if free[i] and len(line) > 2]
    if movable:
        longest = max(movable, key=lambda i: len(pieces[i]))
        lost = _area(_joined(lines)) - _area(np.array(ring, float))
        lines[longest] = with_area(lines[longest], lines[longest], -lost)
    return _joined(lines)


def _drawn(
    piece: RingPiece,
    ends: Mapping[Node, Sequence[tuple[RingPiece, int]]],
    fits: Mapping[RingPiece, Fit],
) -> Points:
    """Simplify a piece; without a fit it keeps its pixel edges, and what meets it its corner."""
    nodes = np.array(piece, float)
    if piece not in fits:
        # Without the pixel corners that lie between two others on one line.
        step = np.diff(nodes, axis=0)
        turns = (step[1:] != step[:-1]).any(axis=1)
        return np.asarray(nodes[np.concatenate([[True], turns, [True]])])
    cuts, lines = fits[piece]
    first, last = (
        meeting_point([fits[other][1][end] for other, end in ends[piece[i]]], nodes[i])
        if all(other in fits for other, _ in ends[piece[i]])
        else nodes[i]
        for i in (0, -1)
    )
    inner = [
        meeting_point(list(lines[i - 1 : i + 1]), nodes[cuts[i]]) for i in range(1, len(lines))
    ]
    return with_area(np.array([first, *inner, last]), nodes)


def _joined(lines: list[Points]) -> Points:
    """Join lines to a closed one; junctions that moved to one place become one corner."""
    corners = np.vstack([*(line[:-1] for line in lines), lines[0][:1]])
    apart = np.abs(np.diff(corners, axis=0)).max(axis=1) > 1e-9
    return np.asarray(corners[np.concatenate([apart, [True]])])


def _is_sound(outline: Points, ring: RingPiece) -> bool:
    """Tell whether an outline does not cross itself and follows its pixel edges everywhere."""
    if len(outline) < 4:
        return False
    pixels, shape = shapely.Polygon(ring), shapely.Polygon(outline)
    if not shape.is_valid:
        return False
    away = shapely.hausdorff_distance(pixels.exterior, shape.exterior)
    # Pixel edges that pass one corner twice make no valid area; a hair's breadth inside is one.
    common = sum(part.area for part in common_parts(pixels.buffer(-1e-6), shape))
    return bool(away <= OUTLINE_TOLERANCE_PX + REACH_PX and common >= SAME_SHARE * pixels.area)


def _area(polygon: Points) -> float:
    x, y = polygon.T
    return float(x[:-1] @ y[1:] - x[1:] @ y[:-1]) / 2.0
