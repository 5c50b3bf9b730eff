"""Planar shapes to areas, and the side from which bodies and drawings in space are seen."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from drystone.io.outlines_in.model import Area
from drystone.io.outlines_in.nested import frames, meeting
from drystone.io.read_settings import Up
from drystone.kernels.polygons import Points

_MOST_CROSSINGS = 2000
_MOST_PAIRS = 200_000
_MOST_TURNS = 20_000_000


def areas_of(shape: Any) -> tuple[Area, ...]:
    """Return the polygons of a planar shape; points and lines are nothing."""
    return tuple(
        Area(tuple(shapely.get_coordinates(line)[:-1] for line in (part.exterior, *part.interiors)))
        for part in shapely.get_parts(shapely.get_parts(shape))
        if part.geom_type == "Polygon" and part.area > 0.0
    )


def with_holes(rings: Sequence[Points]) -> list[tuple[int, Area]]:
    """Return outlines with the rings in them as holes, as drawings for cutting mean them.

    Each comes with its position; a ring in a hole is an outline again.  What is drawn around
    nearly all rings is a frame, and has no holes.  ValueError when there are too many crossings,
    or rings in each other, to find out.
    """
    shapes = _valid(np.array([shapely.Polygon(ring) for ring in rings], dtype=object))
    size = shapely.area(shapes)
    inside: dict[int, set[int]] = {i: set() for i in range(len(rings))}
    count = 0
    for within, outer in meeting(shapes, "covered_by"):
        count += len(within)
        if count > _MOST_PAIRS:
            raise ValueError("outlines lie in each other too often")
        smaller = size[within] < size[outer]
        for i, j in zip(within[smaller].tolist(), outer[smaller].tolist(), strict=True):
            inside[j].add(i)
    framed = frames(dict(enumerate(size.tolist())), inside)
    around: dict[int, list[int]] = {i: [] for i in inside}
    for j, held in inside.items():
        for i in held if j not in framed else ():
            around[i].append(j)
    holes: dict[int, list[int]] = {i: [] for i, found in around.items() if len(found) % 2 == 0}
    for i, found in around.items():
        if i not in holes:
            holes[min(found, key=lambda j: (size[j], j))].append(i)
    return [(i, Area((rings[i], *(rings[j] for j in of)))) for i, of in holes.items()]


def region(rings: Sequence[Points], rule: str) -> Any:
    """Return what rings enclose by a fill rule; ValueError when they cross too often."""
    shapes = np.array([shapely.Polygon(ring) for ring in rings], dtype=object)
    if len(shapes) == 1 and shapely.is_valid(shapes[0]):
        return shapes[0]
    edges = np.concatenate([np.stack([ring, np.roll(ring, -1, axis=0)], axis=1) for ring in rings])
    if _crossings(edges, _MOST_CROSSINGS) > _MOST_CROSSINGS:
        raise ValueError(f"outlines cross themselves more than {_MOST_CROSSINGS} times")
    lines = shapely.union_all(shapely.linestrings(edges))
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(lines)))
    if len(faces) * len(edges) > _MOST_TURNS:
        raise ValueError("outlines of too many corners lie in each other")
    points = shapely.get_coordinates(shapely.point_on_surface(faces))
    turns = np.array([_turns(edges, point) for point in points], dtype=int)
    inside = turns % 2 == 1 if rule == "evenodd" else turns != 0
    return shapely.union_all(faces[inside])


def _turns(edges: NDArray[np.float64], point: Points) -> int:
    """Count how often closed lines, (n, 2, 2) edges, turn around a point."""
    (x0, y0), (x1, y1) = (edges - point).transpose(1, 2, 0)
    left = x0 * y1 - x1 * y0 > 0.0
    return int(((y0 <= 0.0) & (y1 > 0.0) & left).sum() - ((y1 <= 0.0) & (y0 > 0.0) & ~left).sum())


def shadow(polygons: Sequence[Points]) -> tuple[Area, ...]:
    """Return the union of a body's faces, (n, 2) each, in the plane of the picture.

    Faces that are seen from the side have no area.
    """
    ends = np.repeat(np.arange(len(polygons)), [len(polygon) for polygon in polygons])
    shapes = shapely.polygons(shapely.linearrings(np.concatenate(polygons), indices=ends))
    # Edges of neighbours are the same numbers, so the union leaves no slits.
    return areas_of(shapely.union_all(_valid(shapes[shapely.area(shapes) > 0.0])))


def outer_edge(rings: Sequence[Points], within: Any = None, near: float = 1e-9) -> Points | None:
    """Return the edge, (n, 2), counter-clockwise and not closed, of what rings enclose.

    Holes are filled, and of pieces the largest counts; None without an area, or where no three
    corners are farther apart than `near`.  ValueError for too many crossings.
    """
    filled = shapely.union_all([shapely.Polygon(part.rings[0]) for part in shadow(rings)])
    parts = [area.rings[0] for area in areas_of(filled if within is None else filled & within)]
    if not parts:
        return None
    largest = max(map(shapely.Polygon, parts), key=shapely.area)
    edge = tidy_edge(largest, near)
    return None if edge is None else edge[:-1]


def tidy_edge(shape: shapely.Polygon, near: float = 1e-9) -> Points | None:
    """Return the outer edge of a shape, closed, counter-clockwise, no corner twice in a row.

    None where no three corners are farther apart than `near`.
    """
    try:
        tidy = shapely.orient_polygons(shapely.remove_repeated_points(shape, near))
    except shapely.GEOSException:
        return None
    edge = shapely.get_coordinates(tidy.exterior)
    return np.asarray(edge) if len(edge) > 3 else None


def _valid(shapes: NDArray[Any]) -> NDArray[Any]:
    """Make valid polygons; ValueError when that takes too long, as it is quadratic in crossings."""
    left = _MOST_CROSSINGS
    for shape in shapes[~shapely.is_valid(shapes)]:
        ring = shapely.get_coordinates(shape.exterior)
        left -= _crossings(np.stack([ring[:-1], ring[1:]], axis=1), left)
        if left < 0:
            raise ValueError(f"outlines cross themselves more than {_MOST_CROSSINGS} times")
    return np.asarray(shapely.make_valid(shapes))


def _crossings(ends: NDArray[np.float64], most: int) -> int:
    """Count how often edges of closed rings meet that are no neighbours, up to some number."""
    found = -3 * len(ends)  # each meets itself and its two neighbours
    for some, _ in meeting(shapely.linestrings(ends), "intersects"):
        found += len(some)
        if found > 2 * most + 1:
            break
    return found // 2


Vector = NDArray[np.float64]

_AXES = np.eye(3)
_FLAT = 1.0 - 5e-7
"""Cosine of the angle between planes that are the same, about .001."""
_MOST = 0.9
"""Share of the area of all outlines that makes their plane that of the drawing."""


@dataclass(frozen=True, eq=False)
class Sight:
    """What is to the right and up, when one looks against the normal of a plane."""

    right: Vector  # (3,)
    up: Vector

    @property
    def said(self) -> str:
        """Say it as CAD programs do."""
        along = np.abs(np.cross(self.right, self.up))
        sides = f"with {_word(self.right)} to the right and {_word(self.up)} up"
        return f"along {_word(along)}, {sides}"

    def of(self, points: Vector) -> Vector:
        """Return points, (n, 3), as they are seen, (n, 2)."""
        return np.asarray(points @ np.column_stack([self.right, self.up]))


def view(normal: Vector, up: Up) -> Sight:
    """Return the view of what faces a normal, where an axis is up.

    What faces up is seen with X to the right.
    """
    above = _AXES["xyz".index(up[:1] or "z")]
    right = np.cross(above, normal)
    if np.abs(right).max() < 1e-3:
        right = _AXES[0]
    right = right / np.linalg.norm(right)
    return Sight(right + 0.0, np.cross(normal, right) + 0.0)


def usual_side(normal: Vector, up: Up) -> Vector:
    """Return a normal or its opposite: that of the view from the top, the front or the right."""
    axis = int(np.argmax(np.abs(normal)))
    side = -1.0 if axis == 1 and up[:1] != "y" else 1.0
    return normal if normal[axis] * side > 0.0 else -normal


def asked(normal: Vector, up: Up) -> Sight:
    """Return the view of a plane that a user asks for."""
    seen = view(usual_side(normal, up), up)
    return Sight(0.0 - seen.right, seen.up) if up.endswith("-back") else seen


def plane_of(rings: Sequence[Vector]) -> tuple[Vector, NDArray[np.float64]]:
    """Return the normal of the plane that outlines, (n, 3) each, lie in, and how they lean to it.

    That is the cosine of the angle between each and the plane.  Where most do not lie in one
    plane, the normal is the nearest axis.
    """
    # Normals that are as long as the areas are large.
    moved = [ring - ring[0] for ring in rings]
    areas = [np.cross(ring, np.roll(ring, -1, axis=0)).sum(axis=0) / 2.0 for ring in moved]
    vectors = np.array(areas).reshape(-1, 3)
    sizes = np.linalg.norm(vectors, axis=1)
    if not sizes.sum() > 0.0:
        return _AXES[2], np.ones(len(rings))
    safe = np.where(sizes > 0.0, sizes, 1.0)[:, None]
    units = np.where(sizes[:, None] > 0.0, vectors / safe, _AXES[2])
    normal = units[int(np.argmax(sizes))]
    flat = np.abs(units @ normal) > _FLAT
    if sizes[flat].sum() < _MOST * sizes.sum():
        normal = np.linalg.eigh((units * sizes[:, None]).T @ units)[1][:, -1]
        normal = _AXES[int(np.argmax(np.abs(normal)))]
    elif np.abs(normal).max() > _FLAT:
        normal = _AXES[int(np.argmax(np.abs(normal)))]
    leaning = np.where(sizes > 0.0, np.abs(units @ normal), 1.0)
    return normal, np.where(leaning > _FLAT, 1.0, leaning)


def _word(vector: Vector) -> str:
    """Name an axis, or a direction by its numbers."""
    for axis, name in zip((*_AXES, *-_AXES), ("X", "Y", "Z", "-X", "-Y", "-Z"), strict=True):
        if np.abs(vector - axis).max() < 1e-6:
            return name
    return f"({', '.join(f'{number:.2f}' for number in vector)})"
