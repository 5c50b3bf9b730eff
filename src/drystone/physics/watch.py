"""How far blocks in a rigid-body engine get from where they were planned."""

import numpy as np
import shapely

from drystone.physics.scene import Points, Scene
from drystone.physics.table import Floats, TiltingTable


class Watch:
    """Keeps the largest movement and turn of every block on a table."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._arms: dict[int, Points] = {}
        self._centres: dict[int, Points] = {}
        for block, shape in scene.shapes.items():
            self._centres[block] = np.array(shape.centroid.coords[0])
            self._arms[block] = shapely.get_coordinates(shape)[:-1] - self._centres[block]
        self._moves = dict.fromkeys(scene.shapes, 0.0)
        self._turns = dict.fromkeys(scene.shapes, 0.0)

    def look(self, table: TiltingTable) -> float:
        """Take note of where the blocks are."""
        furthest = 0.0
        for block, corners, turn in self._now(table):
            way = corners - self._arms[block] - self._centres[block]
            # Of all points of a rigid body a corner moves furthest.
            move = float(np.hypot(*way.T).max())
            self._moves[block] = max(self._moves[block], move)
            self._turns[block] = max(self._turns[block], float(abs(np.degrees(turn))))
            furthest = max(furthest, move)
        return furthest

    def outlines(self, table: TiltingTable) -> dict[int, Points]:
        """Return the corners of every block on the table where it is now."""
        return {block: corners for block, corners, _ in self._now(table)}

    def planned(self) -> dict[int, Points]:
        """Return the corners of every block where it was planned."""
        return {block: self._arms[block] + centre for block, centre in self._centres.items()}

    def largest(self, block: int) -> tuple[float, float]:
        """Return the largest movement of any point (unit of the scene) and turn (degrees)."""
        return self._moves[block], self._turns[block]

    def _now(self, table: TiltingTable) -> list[tuple[int, Points, float]]:
        found = []
        poses: Floats = table.poses()
        for block, (x, y, turn) in zip(table.ids, poses.tolist(), strict=True):
            cos, sin = np.cos(turn), np.sin(turn)
            turned = self._arms[block] @ np.array([[cos, sin], [-sin, cos]])
            centre = np.array([x, y]) * self._scene.length + (0.0, self._scene.ground_y)
            found.append((block, turned + centre, turn))
        return found
