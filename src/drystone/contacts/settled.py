"""Rigid block models of settled stones: what their outlines touch (§4.1; DESIGN 4.9).

Settled stones keep a small clearance from each other; what is nearer than a tolerance touches.
Interfaces are listed block by block in the order of construction, their normals into the later
block of the two.
"""

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import NamedTuple

from drystone.contacts.blocks import check_mu
from drystone.kernels.meetings import Meetings, meetings
from drystone.kernels.polygons import Points, Polygons, area_and_centroid, no_polygons
from drystone.model.outlines import Outlined, Outlines
from drystone.statics.model import GROUND, Block, Interface, RigidBlockModel

SETBACK = 0.01
"""Contacts stay away from the ends of faces by so much of the size of the smaller stone."""


class PlacedPolygons(NamedTuple):
    """Blocks, in the order of construction, of which the outlines are all that is known."""

    ids: tuple[int, ...]
    polygons: Polygons

    @classmethod
    def of(cls, blocks: Iterable[Outlined]) -> "PlacedPolygons":
        """Collect blocks in the order of construction."""
        listed = list(blocks)
        ids = tuple(block_id for block_id, _ in listed)
        return cls(ids, no_polygons().added(corners for _, corners in listed))


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
    new: list[Block] = []
    found: list[Interface] = []
    ids, polygons = list(around.ids), around.polygons
    for place, (block_id, corners) in enumerate(blocks):
        if place:
            earlier, outline = blocks[place - 1]
            ids.append(earlier)
            polygons = polygons.added([outline])
        new.append(_block(block_id, corners))
        found += _interfaces(block_id, ids, meetings(corners, polygons, tolerance, setback))
    return model.with_added(tuple(new), tuple(found))


def model_of_outlines(
    placed: Outlines | PlacedPolygons,
    mu: float = 0.58,
    tolerance: float = 0.1,
    setback: float = SETBACK,
) -> RigidBlockModel:
    """Make the rigid block model of a wall of settled stones; mu below 0 is an InputError (E302).

    It has the blocks and interfaces that :func:`model_with_outlines` adds one after the other.  A
    `setback` of 0 leaves contacts up to the ends of faces.
    """
    check_mu(mu)
    ids, polygons = placed.ids, placed.polygons
    outlines = [polygons.polygon(place) for place in range(len(ids))]
    interfaces = chain.from_iterable(
        _interfaces(ids[place], ids, meetings(corners, polygons.leading(place), tolerance, setback))
        for place, corners in enumerate(outlines)
    )
    return RigidBlockModel(tuple(map(_block, ids, outlines)), tuple(interfaces), mu)


def _block(block_id: int, corners: Points) -> Block:
    area, x, y = area_and_centroid(corners)
    return Block(block_id, area, (x, y))


def _interfaces(block_id: int, ids: Sequence[int], found: Meetings) -> list[Interface]:
    """Return the interfaces of a block with others, known by their places, and the ground."""
    points = found.points
    told = zip(found.others.tolist(), found.counts.tolist(), found.normals.tolist(), strict=True)
    return [
        Interface(block_id, ids[other] if other >= 0 else GROUND, points[k, :count], (x, y))
        for k, (other, count, (x, y)) in enumerate(told)
    ]
