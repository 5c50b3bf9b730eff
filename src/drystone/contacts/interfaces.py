"""Pic-to-Ri: straight interfaces between the stones of a label image (§4.2; DESIGN 4.8)."""

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np

from drystone.kernels.boundary import EMPTY
from drystone.kernels.contacts import contacts_in
from drystone.kernels.patches import MARGIN_PX, Patch, whole_patch
from drystone.model.wall import Labels
from drystone.statics.model import Interface


def find_interfaces(labels: Labels) -> tuple[Interface, ...]:
    """Find all interfaces of a label image that stands on its lowest row (Pic-to-Ri, §4.2).

    There is one for each straight run of boundary between two stones, or a stone and the ground;
    then one for each contact at a point.  Points are pixel corners, in px, in the wall frame.  Of
    two stones the larger id is `block`.  They are sorted by ids and place.

    A run is a connected chain of pixel edges, split where it bends by more than sqrt 2 px.  Its
    contact points are its two ends; its normal is that of the line fitted to the midpoints of its
    edges.  A single edge that turns off at the end of a straight piece is a step of the grid and is
    left out.  Stones that touch only at a pixel corner, across two empty pixels, have an interface
    of one point.
    """
    return interfaces_in(whole_patch(labels))


def interfaces_in(patch: Patch) -> tuple[Interface, ...]:
    """Find the interfaces around new blocks that one of these takes part in.

    Adding block after block this way gives the interfaces of the whole image, except that a contact
    at a point disappears when a later block fills a pixel beside it: see :class:`PointContacts`.
    """
    found = contacts_in(patch)
    high, low, normals = found.high.tolist(), found.low.tolist(), found.normals.tolist()
    points = [*found.ends[: found.run_count], *found.ends[found.run_count :, :1]]
    return tuple(
        Interface(block, other, ends, (x, y))
        for block, other, ends, (x, y) in zip(high, low, points, normals, strict=True)
    )


@dataclass(frozen=True, eq=False)
class PointContacts:
    """Where a wall has contacts at a point, which one more stone may close in."""

    interfaces: tuple[Interface, ...]
    places: tuple[tuple[int, int, int], ...]
    """X and y of each contact at a point, px, and its position in `interfaces`; sorted."""

    @classmethod
    def of(cls, interfaces: tuple[Interface, ...]) -> "PointContacts":
        """Find the contacts at a point among the interfaces of a wall."""
        places = (
            (int(interface.points[0, 0]), int(interface.points[0, 1]), position)
            for position, interface in enumerate(interfaces)
            if len(interface.points) == 1
        )
        return cls(interfaces, tuple(sorted(places)))

    def closed_in(self, patch: Patch) -> tuple[int, ...]:
        """Return the positions of the contacts that new blocks have closed in, ascending.

        Where stones fill the pixels beside a contact at a point the joints with them carry the
        load; a corner exactly above a corner, as at the crossing of two joints, carries nothing.
        """
        left, top = patch.origin
        height, width = patch.cells.shape
        first = bisect_left(self.places, (left + MARGIN_PX,))
        last = bisect_left(self.places, (left + width - MARGIN_PX + 1,))
        closed = []
        for x, y, position in self.places[first:last]:
            row, col = top - y, x - left
            if MARGIN_PX <= row <= height - MARGIN_PX:
                around = patch.cells[row - 1 : row + 1, col - 1 : col + 1]
                if np.count_nonzero(around != EMPTY) > 2:
                    closed.append(position)
        return tuple(sorted(closed))
