"""Offers made by hand."""

from dataclasses import replace

from drystone.indices import Indices
from drystone.selection.policy import Offer

INDICES = Indices(SF=0.8, LFR=0.8, GDS=0.5, NHR=0.1, IWR=0.4, IS=0.1, LLC=0.5, boundary=False)
OFFER = Offer(
    stone_id=1,
    angle_deg=0.0,
    turned_deg=0.0,
    side="left",
    indices=INDICES,
    area_px=40.0,
    left_px=10.0,
    bottom_px=0.0,
    right_px=20.0,
    top_px=4.0,
    centroid_px=(15.0, 2.0),
    support_px=((10.0, 0.0), (20.0, 0.0)),
    wedges=0,
    wall_width_px=100,
    wall_height_px=40,
)


def offered(stone_id=1, *, indices=None, **changes):
    """Return an offer that differs from the others by what is said."""
    return replace(OFFER, stone_id=stone_id, indices=replace(INDICES, **(indices or {})), **changes)
