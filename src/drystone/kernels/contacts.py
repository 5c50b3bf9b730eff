"""Where labelled regions of an image touch: straight runs of boundary, single corners (§4.2)."""

from dataclasses import dataclass
from itertools import pairwise
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.boundary import Boundary, Cells, boundary_of
from drystone.kernels.patches import MARGIN_PX, Patch
from drystone.kernels.straight import (
    HOOK_NEEDS_PX,
    SQUARED_TOLERANCE_PX,
    normal_beside,
    straight_runs,
)

_fast = compiled("contacts")


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts between regions: first straight runs, then single points.

    Parameters
    ----------
    high, low : (k,) int64 array
        The two labels, the larger first.
    ends : (k, 2, 2) float64 array
        (x, y) of both ends, in the sense in which `high` lies to the left; twice the same for a
        point.
    normals : (k, 2) float64 array
        Unit vectors into `high`.
    run_count : int
        The first so many are runs.
    """

    high: NDArray[np.int64]
    low: NDArray[np.int64]
    ends: NDArray[np.float64]
    normals: NDArray[np.float64]
    run_count: int


def contacts_in(patch: Patch) -> Contacts:
    """Find the contacts in a patch of which at least one side is fresh.

    Parameters
    ----------
    patch : Patch
        Of which all cells of a label are fresh, or none.

    Returns
    -------
    Contacts
        Runs sorted by labels and place, then points from the top down.

    Notes
    -----
    A run is a connected chain of pixel edges, split where it bends
    (:mod:`drystone.kernels.straight`).  Regions that touch only at a pixel corner, across two
    empty cells, have a contact at that point.

    Examples
    --------
    >>> from drystone.kernels.patches import whole_patch
    >>> contacts_in(whole_patch(np.array([[0, 5, 5], [3, 3, 3]]))).ends.tolist()
    [[[0.0, 0.0], [3.0, 0.0]], [[1.0, 1.0], [3.0, 1.0]]]
    """
    boundary = boundary_of(patch.cells, patch.fresh)
    if _fast is None:
        return contacts_numpy(patch.cells, boundary, patch.origin)
    return Contacts(
        *_fast.contacts(
            patch.cells,
            boundary.labels,
            boundary.begins,
            boundary.nodes,
            boundary.corners,
            patch.origin,
            (SQUARED_TOLERANCE_PX, HOOK_NEEDS_PX, MARGIN_PX),
        )
    )


def contacts_numpy(cells: Cells, boundary: Boundary, origin: tuple[int, int]) -> Contacts:
    """Turn a boundary into contacts without compiled code."""
    x0, y0 = origin
    rows, cols = boundary.nodes.T
    all_x, all_y = (x0 + cols).tolist(), (y0 - rows).tolist()
    pairs, ends, normals = [], [], []
    for pair, (begin, end) in zip(
        boundary.labels.tolist(), pairwise(boundary.begins.tolist()), strict=True
    ):
        x, y = all_x[begin:end], all_y[begin:end]
        for first, last in straight_runs(x, y):
            pairs.append(pair)
            ends.append((x[first], y[first], x[last], y[last]))
            normals.append(normal_beside(x, y, first, last))
    run_count = len(pairs)
    for above, below, row, col in boundary.corners.tolist():
        pairs.append((max(above, below), min(above, below)))
        ends.append((x0 + col, y0 - row) * 2)
        normals.append(_normal_at_point(cells, above, below, row, col))
    high, low = np.array(pairs, np.int64).reshape(-1, 2).T.copy()
    return Contacts(
        high,
        low,
        np.array(ends, np.float64).reshape(-1, 2, 2),
        np.array(normals, np.float64).reshape(-1, 2),
        run_count,
    )


def _normal_at_point(
    cells: Cells, above: int, below: int, row: int, col: int
) -> tuple[float, float]:
    """Return the normal of two regions that touch at a node across two empty cells.

    The normal is that of the region whose boundary passes the node rather than ends in it: the
    first moment of its pixels around the node points away from its boundary.  Each region counts
    by how many of its pixels lie outside the quadrant of its corner pixel.  A square corner on a
    square corner has no tangent: there the upper stone stands on the lower one, so that it slides
    off freely as it would on a flat bed.
    """
    toward_right = 1 if cells[row - 1, col] == above else -1
    top, left = max(row - MARGIN_PX, 0), max(col - MARGIN_PX, 0)
    seen = cells[top : row + MARGIN_PX, left : col + MARGIN_PX].tolist()
    normal_x = normal_y = 0  # into the upper region; arms are twice those of the pixel centres
    for label, sign in ((above, 1), (below, -1)):
        outside = moment_x = moment_y = 0
        for r, line in enumerate(seen, top):
            up = 2 * (row - r) - 1
            for c, cell in enumerate(line, left):
                if cell == label:
                    right = 2 * (c - col) + 1
                    moment_x += right
                    moment_y += up
                    outside += sign * up < 0 or sign * toward_right * right < 0
        normal_x += sign * outside * moment_x
        normal_y += sign * outside * moment_y
    if normal_x == 0 and normal_y == 0:
        normal_y = 1
    length = sqrt(normal_x * normal_x + normal_y * normal_y)
    if above < below:
        length = -length
    return normal_x / length + 0.0, normal_y / length + 0.0
