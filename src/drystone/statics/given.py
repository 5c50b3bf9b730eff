"""Block models given as rectangles or polygons (DESIGN §2): a dict in, a model out."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely

from drystone.errors import InputError
from drystone.statics.blocks import check_mu
from drystone.statics.model import GROUND, Block, Interface, RigidBlockModel
from drystone.statics.touching import Points, touching_interfaces

RELATIVE_TOLERANCE = 1e-6
"""Gaps up to this share of the model's extent count as contact."""


def model_from_json(data: Mapping[str, Any]) -> RigidBlockModel:
    """Make a rigid block model from what a block model file says.

    Parameters
    ----------
    data : mapping
        `{"blocks_xywh": [[x, y, w, h], ...], "mu": .65}`: rectangles by their lower left corner
        and size, numbered from 1; or `{"blocks": [{"id", "polygon": [[x, y], ...], "density",
        "fixed"}, ...], "mu"}`, where density is 1 and fixed false unless given.  Any unit of
        length, y up; what touches y = 0 stands on the ground.  `mu` is 0.58 unless given; other
        keys are ignored.

    Returns
    -------
    RigidBlockModel
        With an interface on every common piece of two edges and a contact at a point where a
        corner touches the inside of an edge.

    Raises
    ------
    InputError
        E302 for mu, E303 for what is no block, E304 for blocks that overlap or reach below the
        ground.

    Examples
    --------
    >>> model = model_from_json({"blocks_xywh": [[0, 0, 4, 2], [1, 2, 4, 2]], "mu": 0.65})
    >>> [(i.block, i.other, i.length) for i in model.interfaces]
    [(1, 0, 4.0), (2, 1, 3.0)]
    """
    mu = data.get("mu", 0.58)
    if not isinstance(mu, int | float):
        raise _bad(f"mu is {mu!r}.", "mu", "Give a number.")
    check_mu(mu)
    if "blocks_xywh" in data:
        rows = enumerate(_list(data, "blocks_xywh"), start=1)
        given = [(Block(i, 0.0, (0.0, 0.0)), _rectangle(i, row)) for i, row in rows]
    elif "blocks" in data:
        given = [_polygon_block(i, entry) for i, entry in enumerate(_list(data, "blocks"))]
    else:
        raise _bad("there is neither 'blocks_xywh' nor 'blocks'.", "block model", "Give one.")
    ids = [block.id for block, _ in given]
    if len(set(ids)) != len(ids):
        raise _bad("two blocks have the same id.", "blocks", "Give every block its own id.")
    corners = {block.id: polygon for block, polygon in given}
    blocks = tuple(_measured(block, polygon) for block, polygon in given)
    return RigidBlockModel(blocks, _all_interfaces(corners), float(mu))


def _bad(what: str, where: str, cure: str) -> InputError:
    return InputError("E303", what, where=where, cure=cure)


def _list(data: Mapping[str, Any], key: str) -> Sequence[Any]:
    value = data[key]
    if not isinstance(value, list | tuple):
        raise _bad(f"'{key}' is not a list.", "block model", "Give a list of blocks.")
    return value


def _numbers(value: Any, shape: tuple[int, ...], where: str) -> Points:
    """Read finite numbers; -1 in `shape` stands for any length."""
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    fits = array.ndim == len(shape) and all(
        n in (m, -1) for n, m in zip(shape, array.shape, strict=True)
    )
    if not fits or not np.isfinite(array).all():
        raise _bad(
            f"{value!r} is not made of finite numbers as it should be.", where, "Correct it."
        )
    return array


def _rectangle(number: int, row: Any) -> Points:
    where = f"blocks_xywh, block {number}"
    x, y, width, height = _numbers(row, (4,), where)
    if width <= 0 or height <= 0:
        raise _bad(f"a block of {width} x {height}.", where, "Give a width and height above 0.")
    right, top = x + width, y + height
    return np.array([[x, y], [right, y], [right, top], [x, top], [x, y]])


def _polygon_block(place: int, entry: Any) -> tuple[Block, Points]:
    where = f"blocks, entry {place + 1}"
    if not isinstance(entry, Mapping) or "polygon" not in entry:
        raise _bad("it has no 'polygon'.", where, "Give id and polygon.")
    block_id, fixed, density = entry.get("id"), entry.get("fixed", False), entry.get("density", 1.0)
    if not isinstance(block_id, int) or isinstance(block_id, bool) or block_id <= GROUND:
        raise _bad(f"its id is {block_id!r}.", where, "Give a whole number above 0.")
    density = float(_numbers(density, (), where))
    if density <= 0 or not isinstance(fixed, bool):
        raise _bad("density must be above 0 and fixed true or false.", where, "Correct it.")
    corners = _numbers(entry["polygon"], (-1, 2), where)
    shape = shapely.Polygon(corners) if len(corners) >= 3 else shapely.Polygon()
    if shape.is_empty or not shape.is_valid or shape.area <= 0:
        raise _bad("its polygon has no area or crosses itself.", where, "Correct its corners.")
    line = shapely.get_coordinates(shapely.remove_repeated_points(shape))
    if not shape.exterior.is_ccw:
        line = line[::-1].copy()
    return Block(block_id, 0.0, (0.0, 0.0), density, fixed), line


def _measured(block: Block, polygon: Points) -> Block:
    """Fill in area and centroid of a closed, counter-clockwise polygon."""
    # About its first corner, so that a block far from the origin loses no digits.
    x, y = (polygon - polygon[0]).T
    cross = x[:-1] * y[1:] - x[1:] * y[:-1]
    area = float(cross.sum()) / 2.0
    cx = float((x[:-1] + x[1:]) @ cross) / (6.0 * area) + float(polygon[0, 0])
    cy = float((y[:-1] + y[1:]) @ cross) / (6.0 * area) + float(polygon[0, 1])
    return Block(block.id, area, (cx, cy), block.density, block.fixed)


def _all_interfaces(corners: dict[int, Points]) -> tuple[Interface, ...]:
    """Find the interfaces of all polygons, sorted by ids; of two the larger id is `block`."""
    if not corners:
        return ()
    everything = np.concatenate(list(corners.values()))
    lowest, highest = everything.min(axis=0), everything.max(axis=0)
    extent = float((highest - lowest).max())
    tolerance = RELATIVE_TOLERANCE * extent
    ground = np.array([[highest[0] + extent, 0.0], [lowest[0] - extent, 0.0]])
    on_ground = _on_ground(corners, ground, tolerance)
    among_blocks = _among_blocks(corners, tolerance)
    found = (*on_ground, *among_blocks)
    return tuple(sorted(found, key=lambda interface: (interface.block, interface.other)))


def _on_ground(corners: dict[int, Points], ground: Points, tolerance: float) -> list[Interface]:
    found = []
    for block, polygon in corners.items():
        depth = -float(polygon[:, 1].min())
        _check_depth(depth, tolerance, f"block {block} reaches {depth:g} below the ground, y = 0.")
        if depth >= -tolerance:
            found += touching_interfaces(block, polygon, GROUND, ground, tolerance)
    return found


def _among_blocks(corners: dict[int, Points], tolerance: float) -> list[Interface]:
    ids = sorted(corners)
    shapes = np.array([shapely.Polygon(corners[i]) for i in ids])
    near = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=tolerance)
    found = []
    for high, low in near.T.tolist():
        if high <= low:  # each pair is found twice, and each block with itself
            continue
        block, other = ids[high], ids[low]
        both = shapely.intersection(shapes[high], shapes[low])
        depth = 2.0 * both.area / both.length if both.length > 0 else 0.0
        _check_depth(depth, tolerance, f"blocks {other} and {block} overlap by about {depth:g}.")
        found += touching_interfaces(block, corners[block], other, corners[other], tolerance)
    return found


def _check_depth(depth: float, tolerance: float, what: str) -> None:
    if depth > tolerance:
        raise InputError("E304", what, where="block model", cure="Move them apart.")
