"""A tilting table in a rigid-body engine (pymunk): blocks on a ground, gravity that turns."""

from collections.abc import Iterable
from math import atan, cos, sin, sqrt
from operator import itemgetter
from typing import Any, Self

import numpy as np
import shapely

from drystone.errors import extra
from drystone.kernels.polygons import Points
from drystone.kernels.profiles import Floats
from drystone.physics.convex import convex_parts, without_straight_corners
from drystone.physics.scene import EngineScene, EngineSettings

GROUND_THICKNESS = 2.0
"""In mean block sizes; thick enough that nothing gets through."""

STEP, STEPS = 0.02, 60
"""A block is brought apart from what it overlaps by so much of its size, so often."""


class TiltingTable:
    """Blocks on a table; lengths in mean block sizes L, times in sqrt(L / g).

    Turning gravity is the same as turning the table, seen from the table.  The engine has the
    blocks in the order of the scene; all of them stand on it unless some are given as `placed`.
    """

    def __init__(
        self, scene: EngineScene, settings: EngineSettings, placed: Iterable[int] | None = None
    ) -> None:
        self.ids: tuple[int, ...] = ()
        self._settings = settings
        self._space = load_engine().Space()
        self._space.iterations = settings.iterations
        self._space.collision_slop = settings.slop
        self._space.collision_bias = settings.overlap_left
        self._space.damping = settings.speed_left
        self._reaches: Floats = np.zeros(0)
        for block in scene.shapes if placed is None else placed:
            self.place(scene, block)
        left, _, right, _ = shapely.GeometryCollection(list(scene.shapes.values())).bounds
        left, right = (2 * left - right) / scene.length, (2 * right - left) / scene.length
        low = -GROUND_THICKNESS
        ground = np.array([[left, low], [right, low], [right, 0.0], [left, 0.0]])
        self._add_shape(self._space.static_body, ground, scene.mu)

    def place(self, scene: EngineScene, block: int) -> None:
        """Put a block where its scene has it, whatever the others have done since."""
        engine = load_engine()
        shape = scene.shapes[block]
        centre = np.array(shape.centroid.coords[0])
        corners = (shapely.get_coordinates(shape)[:-1] - centre) / scene.length
        if block in scene.fixed:
            body = engine.Body(body_type=engine.Body.STATIC)
        else:
            mass = shape.area / scene.length**2
            body = engine.Body(mass, engine.moment_for_poly(mass, corners.tolist()))
            self.ids += (block,)
            self._reaches = np.append(self._reaches, np.hypot(*corners.T).max())
        body.position = tuple((centre / scene.length).tolist())
        self._space.add(body)
        for part in convex_parts(corners):
            self._add_shape(body, part, scene.mu)

    def put_down(self, scene: EngineScene, block: int, most: float) -> float:
        """Place a free block, and bring it apart from what it overlaps there.

        It goes by `most` of its size at most, each step along the normal of the deepest contact.
        Between two others it may not come free: it ends halfway, and the engine pushes all of them
        apart, slowly.  Returns how deep it lay in others, or in the ground.
        """
        self.place(scene, block)
        body = self._free()[-1]
        size = scene.shapes[block].area ** 0.5 / scene.length
        start, first = body.position, 0.0
        for step in range(STEPS):
            hits = [
                (-point.distance, hit.contact_point_set.normal)
                for part in body.shapes
                for hit in self._space.shape_query(part)
                if hit.shape is not None and hit.shape.body is not body
                for point in hit.contact_point_set.points
            ]
            depth, normal = max(hits, key=itemgetter(0), default=(0.0, None))
            first = first if step else max(depth, 0.0)
            if depth <= self._settings.slop:
                break
            now = body.position - min(depth, STEP * size) * normal
            if (now - start).length > most * size:
                break
            body.position = now
            self._space.reindex_shapes_for_body(body)
        return first

    def _add_shape(self, body: Any, corners: Points, mu: float) -> None:
        radius = self._settings.corner_radius
        inner = shapely.Polygon(corners).buffer(-radius, join_style="mitre")
        # A part too thin to be rounded keeps its corners.
        if radius > 0 and isinstance(inner, shapely.Polygon) and not inner.is_empty:
            ring = shapely.get_coordinates(shapely.orient_polygons(inner))[:-1]
            corners = without_straight_corners(ring)
        else:
            radius = 0.0
        shape = load_engine().Poly(body, corners.tolist(), radius=radius)
        # The friction of a pair is the product of both.
        shape.friction = sqrt(mu)
        shape.elasticity = 0.0
        self._space.add(shape)

    def tilt(self, alpha: float) -> None:
        """Turn gravity so that its horizontal share (towards +x) is alpha times the vertical."""
        angle = atan(alpha)
        self._space.gravity = (sin(angle), -cos(angle))

    def advance(self, duration: float) -> None:
        """Let time pass."""
        for _ in range(round(duration / self._settings.time_step)):
            self._space.step(self._settings.time_step)

    def ride(self, ground: Iterable[float]) -> None:
        """Let a time step pass for each horizontal acceleration of the table, +x, in g.

        Seen from the table, every block is pulled the other way, and keeps all its speed.
        """
        self._space.damping = 1.0
        for acceleration in ground:
            self._space.gravity = (-acceleration, -1.0)
            self._space.step(self._settings.time_step)
        self._space.damping = self._settings.speed_left

    def copy(self) -> Self:
        """Return the same state, which goes its own way."""
        twin = object.__new__(type(self))
        twin.ids, twin._settings, twin._reaches = self.ids, self._settings, self._reaches
        twin._space = self._space.copy()
        return twin

    def poses(self) -> Floats:
        """Return x, y of the centroid and angle of every free block, (n, 3)."""
        return np.array([(*body.position, body.angle) for body in self._free()])

    def speeds(self) -> Floats:
        """Return the largest speed of any point of every free block, (n,)."""
        reached = zip(self._free(), self._reaches, strict=True)
        return np.array([b.velocity.length + abs(b.angular_velocity) * r for b, r in reached])

    def shifts(self, before: Floats) -> Floats:
        """Return how far any point of every free block has come since some poses, (n,)."""
        change = self.poses() - before
        turns = np.minimum(np.abs(change[:, 2]), np.pi)
        return np.asarray(np.hypot(change[:, 0], change[:, 1]) + turns * self._reaches)

    def _free(self) -> list[Any]:
        dynamic = load_engine().Body.DYNAMIC
        return [body for body in self._space.bodies if body.body_type == dynamic]


def load_engine() -> Any:
    """Return pymunk; it is an extra, so it is loaded only when it is needed."""
    return extra("pymunk", "runs the tilt test", "tilt test", "physics")
