"""Block models given as rectangles or polygons (DESIGN §2): a dict in, a model out."""

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from math import inf, nan, sqrt
from typing import Any

import numpy as np
import shapely

from drystone.contacts.blocks import check_mu
from drystone.errors import InputError
from drystone.kernels.polygons import Points
from drystone.model.overlap import overlap_depth
from drystone.model.settings import of_type
from drystone.statics.joints import with_head_friction
from drystone.statics.model import FREEDOMS, GROUND, Block, Interface, RigidBlockModel

LARGEST = 1e50
"""Of numbers: moments, products of three of them, must not overflow."""

LARGEST_RATIO = 1e6
"""Of weights; errors of an answer are relative to the mean weight, up to 1e-8 of it."""

STRAIGHT = 1e-12
"""A corner this far from the line between its neighbours, in sizes of the block, is none."""

ASTRAY = 0.1
"""Points of an interface may lie so far from its blocks, over their size: mortar may be between."""

RELATIVE_TOLERANCE = 1e-5
"""Gaps and overlaps up to this share of the size of the smaller block, the root of its area, count
as contact: coordinates are written with six digits or so."""

SMALLEST = 1.0 / LARGEST
"""Of sizes and densities."""

MOST_TOUCHING = 1000, 8
"""Pairs that may touch: so many, and so many for each block.  Of blocks side by side in a plane
about 3 do for each, or 4 with those that only meet at their corners."""

FARTHEST = 1e9
"""From the origin, in sizes of a block: beyond it coordinates lack the digits to tell contacts."""


def model_from_json(data: Mapping[str, Any]) -> RigidBlockModel:
    """Make a rigid block model from what a block model file says.

    Parameters
    ----------
    data : mapping
        `{"blocks_xywh": [[x, y, w, h], ...], "mu": 0.65}`: rectangles by their lower left corner
        and size, numbered from 1; or `{"blocks": [{"id", "polygon": [[x, y], ...], "density",
        "fixed", "held"}, ...], "mu"}`, where density is 1 and fixed false unless given, and held
        lists what a guide keeps a block from: "x", "y", "turn".  Any unit of length, y up; what
        touches y = 0 stands on the ground, or on what is fixed in it.  `mu` is 0.58 unless given,
        `"mu_head"` is that of head joints, and `"friction": [{"between": [3, 1], "mu": 0.4}, ...]`
        that of all joints of a pair (0 is the ground).  `"interfaces": [{"between": [3, 1],
        "points": [[x, y], ...], "normal": [nx, ny], "mu"}, ...]` says where blocks touch, normals
        pointing into the first block of a pair; without it that is found.  Other keys are ignored.

    Returns
    -------
    RigidBlockModel
        With an interface on every common piece of two edges and a contact at a point where a
        corner touches the inside of an edge.

    Raises
    ------
    InputError
        E302 for mu, E303 for what is no block or interface, E304 for blocks that overlap or reach
        below the ground.

    Examples
    --------
    >>> model = model_from_json({"blocks_xywh": [[0, 0, 4, 2], [1, 2, 4, 2]], "mu": 0.65})
    >>> [(i.block, i.other, i.length) for i in model.interfaces]
    [(1, 0, 4.0), (2, 1, 3.0)]
    """
    given = _given_blocks(data)
    ids = [block.id for block, _ in given]
    if twice := [block for block, count in Counter(ids).items() if count > 1]:
        raise bad(f"two blocks have the id {twice[0]}.", "blocks", "Give each its own.")
    corners = {block.id: polygon for block, polygon in given}
    blocks = tuple(_measured(block, polygon) for block, polygon in given)
    weights = [block.weight for block in blocks if not block.fixed]
    if weights and max(weights) > LARGEST_RATIO * min(weights):
        what = f"the heaviest block weighs more than {LARGEST_RATIO:g} times the lightest."
        cure = "What has no weight of its own is a load: see --dead. What does not move is fixed."
        raise bad(what, "blocks", cure)
    if "interfaces" in data:
        interfaces = read_interfaces(read_list(data, "interfaces"), ids)
    else:
        sizes = {block.id: sqrt(block.area) for block in blocks}
        fixed = {block.id for block in blocks if block.fixed}
        found = [*_on_ground(corners, sizes, fixed), *_among_blocks(corners, sizes)]
        interfaces = tuple(sorted(found, key=lambda face: (face.block, face.other)))
    model = RigidBlockModel(blocks, interfaces, read_mu(data, "mu", 0.58))
    if "mu_head" in data:
        model = with_head_friction(model, read_mu(data, "mu_head", 0.0))
    if "friction" in data:
        model = with_pair_friction(model, read_list(data, "friction"), ids)
    return model


def polygons_from_json(data: Mapping[str, Any]) -> dict[int, Points]:
    """Return the closed, counter-clockwise polygons of a block model file, by id; E303 as above."""
    return {block.id: polygon for block, polygon in _given_blocks(data)}


def _given_blocks(data: Mapping[str, Any]) -> list[tuple[Block, Points]]:
    if "blocks_xywh" in data:
        if "blocks" in data:
            raise bad("there are both 'blocks_xywh' and 'blocks'.", "block model", "Give one.")
        given = []
        for number, row in enumerate(read_list(data, "blocks_xywh"), start=1):
            where = f"blocks_xywh, block {number}"
            x, y, width, height = read_numbers(row, (4,), where)
            if width <= 0 or height <= 0:
                cure = "Give a width and height above 0."
                raise bad(f"a block of {width} x {height}.", where, cure)
            _check_size(min(width, height), max(abs(x), abs(y)), where)
            right, top = x + width, y + height
            corners = np.array([[x, y], [right, y], [right, top], [x, top], [x, y]])
            given.append((Block(number, 0.0, (0.0, 0.0)), corners))
        return given
    if "blocks" in data:
        return [_polygon_block(i, entry) for i, entry in enumerate(read_list(data, "blocks"))]
    raise bad("there is neither 'blocks_xywh' nor 'blocks'.", "block model", "Give one.")


def _polygon_block(place: int, entry: Any) -> tuple[Block, Points]:
    where = f"blocks, entry {place + 1}"
    if isinstance(entry, Mapping) and "xywh" in entry and "polygon" not in entry:
        cure = 'Give rectangles as "blocks_xywh": [[x, y, width, height], ...], without "blocks".'
        raise bad("it has 'xywh', which belongs into \"blocks_xywh\".", where, cure)
    if not isinstance(entry, Mapping) or "polygon" not in entry:
        raise bad("it has no 'polygon'.", where, "Give id and polygon.")
    (block_id,), fixed = _whole([entry.get("id")]) or [GROUND], entry.get("fixed", False)
    if not GROUND < block_id < 2**32:
        what = f"its id is {entry.get('id')!r}."
        raise bad(what, where, "Give a whole number from 1 to 4294967295.")
    density = float(read_numbers(entry.get("density", 1.0), (), where))
    if not isinstance(fixed, bool):
        raise bad(f"fixed is {fixed!r}.", where, "Give true or false.")
    if density < SMALLEST:
        raise bad(f"density must be above 0 ({SMALLEST:g} or more).", where, "Correct it.")
    held = entry.get("held", [])
    if not isinstance(held, list | tuple) or not all(one in FREEDOMS for one in held):
        raise bad(f"held is {held!r}.", where, 'List what is held: "x", "y", "turn".')
    corners = read_numbers(entry["polygon"], (-1, 2), where)
    if len(corners):
        size = float(np.ptp(corners, axis=0).max())
        _check_size(size, float(np.abs(corners).max()), where)
        # Of two corners that are one but for rounding, as one that closes a line may be, each would
        # be on the line through the other, and neither a corner.
        steps = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)
        corners = corners[steps > STRAIGHT * size]
    shape = shapely.Polygon(corners) if len(corners) >= 3 else shapely.Polygon()
    if shape.is_empty or not shape.is_valid or shape.area <= 0:
        raise bad("its polygon has no area or crosses itself.", where, "Correct its corners.")
    line = shapely.get_coordinates(shapely.remove_repeated_points(shape))
    if not shape.exterior.is_ccw:
        line = line[::-1].copy()
    line = _without_straight_corners(line)
    return Block(block_id, 0.0, (0.0, 0.0), density, fixed, tuple(held)), line


def _check_size(size: float, farthest: float, where: str) -> None:
    """Refuse what arithmetic cannot carry; a block without size is refused elsewhere."""
    if 0.0 < size < SMALLEST:
        what = f"its size, {size:g}, is below {SMALLEST:g}."
        raise bad(what, where, "Use another unit of length.")
    if 0.0 < size < farthest / FARTHEST:
        raise bad(
            f"it is {farthest / size:.0e} times as far from the origin as it is large: its"
            " coordinates have too few digits to tell what touches.",
            where,
            "Put the origin near the wall.",
        )


def _without_straight_corners(line: Points) -> Points:
    """Drop corners at which a closed line goes straight on: a corner on one would be on an edge.

    Some digits of rounding do not make a corner.
    """
    corners = line[:-1]
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    area = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
    chord = np.hypot(*(before + after).T)
    # How far the corner is from the line between those beside it.
    kept = corners[area > STRAIGHT * chord * np.ptp(line, axis=0).max()]
    return np.concatenate((kept, kept[:1]))


def _measured(block: Block, polygon: Points) -> Block:
    """Fill in area and centroid of a closed, counter-clockwise polygon."""
    # About its first corner, so that a block far from the origin loses no digits.  Without any
    # corner, as all are straight to its size, it has no area either.
    x, y = (polygon - polygon[:1]).T
    cross = x[:-1] * y[1:] - x[1:] * y[:-1]
    area = float(cross.sum()) / 2.0
    if not 0.0 < area < inf:
        what = "it is too small or too large to have an area."
        raise bad(what, f"block {block.id}", "Use another unit of length.")
    cx = float((x[:-1] + x[1:]) @ cross) / (6.0 * area) + float(polygon[0, 0])
    cy = float((y[:-1] + y[1:]) @ cross) / (6.0 * area) + float(polygon[0, 1])
    return replace(block, area=area, centroid=(cx, cy))


def _on_ground(
    corners: dict[int, Points], sizes: dict[int, float], fixed: Collection[int]
) -> list[Interface]:
    """Find where free blocks touch the ground: what is fixed stands by itself, and bears first."""
    found = []
    spans = {i: (polygon[:, 0].min(), polygon[:, 0].max()) for i, polygon in corners.items()}
    footings = [i for i in fixed if corners[i][:, 1].min() < 0.0]
    for block, polygon in corners.items():
        if block in fixed:
            continue
        tolerance = RELATIVE_TOLERANCE * sizes[block]
        depth = -float(polygon[:, 1].min())
        if depth > tolerance:
            what = f"block {block} reaches {depth:g} below the ground, y = 0."
            cure = "Move the wall up, or say that the block is fixed."
            raise InputError("E304", what, where="block model", cure=cure)
        if depth >= -tolerance:
            left, right = spans[block][0] - sizes[block], spans[block][1] + sizes[block]
            bare: shapely.Geometry = shapely.LineString([[right, 0.0], [left, 0.0]])
            for one in footings:
                if spans[one][0] < right and left < spans[one][1]:
                    risen = min(tolerance, RELATIVE_TOLERANCE * sizes[one])
                    bare = bare.difference(shapely.Polygon(corners[one] + (0.0, risen)))
            for low, _, high, _ in shapely.bounds(shapely.get_parts(bare)):
                ground = np.array([[high, 0.0], [low, 0.0]])
                found += touching_interfaces(block, polygon, GROUND, ground, tolerance)
    return found


def _among_blocks(corners: dict[int, Points], sizes: dict[int, float]) -> list[Interface]:
    if not corners:
        return []
    ids = sorted(corners)
    shapes = np.array([shapely.Polygon(corners[i]) for i in ids])
    reach = RELATIVE_TOLERANCE * np.array([sizes[i] for i in ids])
    tree, pairs = shapely.STRtree(shapes), 0
    most = MOST_TOUCHING[0] + MOST_TOUCHING[1] * len(ids)
    found = []
    for high, (block, shape) in enumerate(zip(ids, shapes, strict=True)):
        near = tree.query(shape, predicate="dwithin", distance=reach[high])
        for low in np.sort(near[near < high]).tolist():
            pairs += 1
            if pairs > most:
                what = f"more than {most} pairs of its {len(ids)} blocks touch."
                raise bad(what, "block model", "Let fewer blocks meet at one point.")
            other, tolerance = ids[low], float(min(reach[high], reach[low]))
            depth = overlap_depth(shape, shapes[low])
            if depth > tolerance:
                what = f"blocks {other} and {block} overlap by {depth:g}."
                raise InputError("E304", what, where="block model", cure="Move them apart.")
            found += touching_interfaces(block, corners[block], other, corners[other], tolerance)
    return found


def touching_interfaces(
    block: int, polygon: Points, other: int, neighbour: Points, tolerance: float
) -> list[Interface]:
    """Find where two polygons touch; normals point into `block`.

    `polygon` and `neighbour` are (n, 2), counter-clockwise and closed: the first corner is repeated
    at the end.  A line that is not closed counts as well; its inside is to the left.  Gaps and
    overlaps up to the tolerance touch.  Straight pieces come in the order of the edges of
    `polygon`, then contacts at a point.  A corner that touches only a corner has no normal and is
    not a contact.
    """
    found = [
        Interface(block, other, ends, normal)
        for ends, normal in _common_pieces(polygon, neighbour, tolerance)
    ]
    taken = [interface.points for interface in found]
    resting = _corners_on_edges(polygon, neighbour, tolerance)
    carrying = [(p, (-x, -y)) for p, (x, y) in _corners_on_edges(neighbour, polygon, tolerance)]
    for point, normal in (*resting, *carrying):
        near = (np.hypot(*(ends - point).T).min() <= 2.0 * tolerance for ends in taken)
        if not any(near):
            found.append(Interface(block, other, point[None, :], normal))
            taken.append(point[None, :])
    return found


def _common_pieces(
    polygon: Points, neighbour: Points, tolerance: float
) -> list[tuple[Points, tuple[float, float]]]:
    """List the pieces on which edges run against each other, with the normal into `polygon`."""
    along, length, start = _edges(polygon)
    first_s, first_h = _in_edge_frames(along, start, neighbour[:-1])
    last_s, last_h = _in_edge_frames(along, start, neighbour[1:])
    run = last_s - first_s
    opposite = run < 0.0
    low, high = np.maximum(last_s, 0.0), np.minimum(first_s, length[:, None])
    slope = (last_h - first_h) / np.where(opposite, run, 1.0)
    gap = np.maximum(
        np.abs(first_h + slope * (low - first_s)), np.abs(first_h + slope * (high - first_s))
    )
    pieces = []
    for i, j in np.argwhere(opposite & (high - low > tolerance) & (gap <= tolerance)):
        ends = start[i] + np.outer([low[i, j], high[i, j]], along[i])
        pieces.append((ends, (float(-along[i, 1]), float(along[i, 0]))))
    return pieces


def _corners_on_edges(
    polygon: Points, neighbour: Points, tolerance: float
) -> list[tuple[Points, tuple[float, float]]]:
    """List the corners of `polygon` inside edges of `neighbour`, with the normal into `polygon`."""
    along, length, start = _edges(neighbour)
    s, h = _in_edge_frames(along, start, polygon[:-1])
    inside = (s > tolerance) & (s < length[:, None] - tolerance) & (np.abs(h) <= tolerance)
    return [
        (polygon[corner], (float(along[edge, 1]), float(-along[edge, 0])))
        for edge, corner in np.argwhere(inside)
    ]


def _edges(line: Points) -> tuple[Points, Points, Points]:
    """Return the unit vectors, lengths and starts of the edges of a line."""
    step = np.diff(line, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    return step / length[:, None], length, line[:-1]


def _in_edge_frames(along: Points, start: Points, points: Points) -> tuple[Points, Points]:
    """Coordinates of points along (edges, points) and to the left of each edge."""
    relative = points[None, :, :] - start[:, None, :]
    s = relative @ along[:, :, None]
    h = along[:, None, 0] * relative[:, :, 1] - along[:, None, 1] * relative[:, :, 0]
    return s[:, :, 0], h


def bad(what: str, where: str, cure: str) -> InputError:
    """Return the error (E303) for what is no block model."""
    return InputError("E303", what, where=where, cure=cure)


def read_list(data: Mapping[str, Any], key: str) -> Sequence[Any]:
    """Return a list of the file."""
    value = data[key]
    if not isinstance(value, list | tuple):
        raise bad(f"'{key}' is not a list.", "block model", f"Give a list of {key}.")
    return value


def read_numbers(value: Any, shape: tuple[int, ...], where: str) -> Points:
    """Read finite numbers; -1 in `shape` stands for any length."""
    try:
        given = np.array(value, dtype=object)
        flat = [of_type(one, float, where) for one in given.ravel()]
        array: Points = np.array(flat).reshape(given.shape)
    except (TypeError, ValueError, OverflowError):
        array = np.full((), nan)
    fits = [n for n, m in zip(array.shape, shape, strict=False) if m in (n, -1)]
    if not len(fits) == array.ndim == len(shape) or not np.isfinite(array).all():
        raise bad(f"{value!r} is not made of finite numbers as it should be.", where, "Correct it.")
    if np.abs(array).max(initial=0.0) > LARGEST:
        raise bad(f"{value!r} holds a number above {LARGEST:g}.", where, "Use another unit.")
    return array


def _whole(values: Iterable[Any]) -> list[int] | None:
    """Return whole numbers, of NumPy too; None when one of the values is none."""
    try:
        return [of_type(one, int, "") for one in values]
    except TypeError:
        return None


def read_mu(data: Mapping[str, Any], key: str, default: float) -> float:
    """Read a coefficient of friction."""
    try:
        mu: float = of_type(data.get(key, default), float, key)
    except TypeError as error:
        raise bad(f"{error}.", key, "Give a number.") from None
    except OverflowError:  # a whole number of hundreds of digits
        mu = inf
    check_mu(mu)
    return mu


def with_pair_friction(
    model: RigidBlockModel, entries: Sequence[Any], ids: Collection[int]
) -> RigidBlockModel:
    """Give all interfaces of pairs of ids, in either order, the friction that a file names."""
    friction: dict[frozenset[int], float] = {}
    for place, entry in enumerate(entries):
        pair = _between(entry, ids, where := f"friction, entry {place + 1}")
        if "mu" not in entry:
            raise bad("it has no 'mu'.", where, "Give the friction of this pair.")
        mu = read_mu(entry, "mu", 0.0)
        if friction.setdefault(frozenset(pair), mu) != mu:
            what = f"blocks {pair[0]} and {pair[1]} have another friction further up."
            raise bad(what, where, "Leave one of them out.")
    faces = (
        replace(face, mu=friction.get(frozenset((face.block, face.other)), face.mu))
        for face in model.interfaces
    )
    return replace(model, interfaces=tuple(faces))


def refuse_astray(model: RigidBlockModel, corners: Mapping[int, Points]) -> None:
    """Refuse interfaces (E303) that lie off the outlines of their blocks, or point out of one."""
    shapes = {block: shapely.Polygon(outline) for block, outline in corners.items()}
    for place, face in enumerate(model.interfaces, 1):
        where = f"interfaces, entry {place}"
        for body in {face.block, face.other} - {GROUND}:
            away = float(shapely.distance(shapes[body], shapely.points(face.points)).max())
            if away > ASTRAY * sqrt(shapes[body].area):
                cure = "Give points at which both touch."
                raise bad(f"its points lie up to {away:.3g} from block {body}.", where, cure)
        step = 0.1 * ASTRAY * sqrt(shapes[face.block].area) * np.array(face.normal)
        ahead, behind = shapely.points(face.points + step), shapely.points(face.points - step)

        def nearer(body: int, here: Points, there: Points) -> bool:
            one, other = (shapely.distance(shapes[body], at).sum() for at in (here, there))
            return bool(one < other)

        ground = face.other == GROUND
        if nearer(face.block, behind, ahead) and (ground or nearer(face.other, ahead, behind)):
            raise bad(f"its normal points out of block {face.block}.", where, "Turn it round.")


def read_interfaces(entries: Sequence[Any], ids: Collection[int]) -> tuple[Interface, ...]:
    """Read where blocks touch."""
    found = []
    for place, entry in enumerate(entries):
        where = f"interfaces, entry {place + 1}"
        block, other = _between(entry, ids, where)
        if block == GROUND:
            raise bad("the ground is its first block.", where, "Name it second.")
        points = read_numbers(entry.get("points"), (-1, 2), where)
        normal = read_numbers(entry.get("normal"), (2,), where)
        length = float(np.hypot(*normal))
        if len(points) == 0 or length == 0:
            raise bad("it has no points or no normal.", where, "Give both.")
        mu = read_mu(entry, "mu", 0.0) if "mu" in entry else None
        x, y = (normal / length).tolist()
        if len(points) > 2:  # others go by the first and the last one as its ends
            points = points[np.argsort(points @ (y, -x), kind="stable")]
        found.append(Interface(block, other, points, (x, y), mu))
    return tuple(found)


def _between(entry: Any, ids: Collection[int], where: str) -> tuple[int, int]:
    pair = entry.get("between") if isinstance(entry, Mapping) else None
    whole = _whole(pair) if isinstance(pair, list | tuple) else None
    if whole is None or len(whole) != 2 or not {GROUND, *ids}.issuperset(whole):
        raise bad(f"it is between {pair!r}.", where, 'Give "between": two ids; 0 is the ground.')
    if whole[0] == whole[1]:
        raise bad(f"it is between {whole[0]} and itself.", where, "Name two blocks.")
    return whole[0], whole[1]
