"""Rigid block models of settled stones: what their outlines touch (§4.1; DESIGN 4.9).

Settled stones keep a small clearance from each other; what is nearer than a tolerance touches.
Interfaces are listed block by block in the order of construction, their normals into the later
block of the two.
"""

from collections.abc import Sequence
from typing import NamedTuple

from drystone.contacts.blocks import check_mu
from drystone.kernels.meetings import meetings
from drystone.kernels.polygons import Polygons, area_and_centroid, no_polygons
from drystone.model.outlines import Outlined, Outlines
from drystone.statics.model import GROUND, Block, Interface, RigidBlockModel

SETBACK = 0.01
"""Contacts stay away from the ends of faces by so much of the size of the smaller stone."""


class PlacedPolygons(NamedTuple):
    """Blocks, in the order of construction, of which the outlines are all that is known."""

    ids: tuple[int, ...]
    polygons: Polygons


def model_with_outlines(
    model: RigidBlockModel,
    blocks: Sequence[Outlined],
    around: Outlines | PlacedPolygons,
    tolerance: float,
    setback: float = SETBACK,
) -> RigidBlockModel:
    """Return the model of a wall with one more stone and its wedges, `blocks`, that stone first.

    Blocks touch up to a gap or overlap of `tolerance`.  For `setback` see
    :func:`drystone.kernels.meetings.meetings`.
    """
    ids = (*around.ids, *(block_id for block_id, _ in blocks))
    polygons = around.polygons.added(corners for _, corners in blocks[:-1])
    new: list[Block] = []
    found: list[Interface] = []
    for place, (block_id, corners) in enumerate(blocks, len(around.ids)):
        area, x, y = area_and_centroid(corners)
        new.append(Block(block_id, area, (x, y)))
        met = meetings(corners, polygons.leading(place), tolerance, setback)
        others, counts, normals = met.others.tolist(), met.counts.tolist(), met.normals.tolist()
        found += [
            Interface(block_id, ids[other] if other >= 0 else GROUND, points[:count], (x, y))
            for other, count, (x, y), points in zip(
                others, counts, normals, met.points, strict=True
            )
        ]
    return model.with_added(tuple(new), tuple(found))


def model_of_outlines(
    blocks: Sequence[Outlined], mu: float = 0.58, tolerance: float = 0.1, setback: float = SETBACK
) -> RigidBlockModel:
    """Make the rigid block model of a wall of settled stones; mu below 0 is an InputError (E302).

    A `setback` of 0 leaves contacts up to the ends of faces.
    """
    check_mu(mu)
    empty, nothing = RigidBlockModel((), (), mu), PlacedPolygons((), no_polygons())
    return model_with_outlines(empty, blocks, nothing, tolerance, setback).forgetting()
