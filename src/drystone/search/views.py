"""A growing wall, as the stones that are laid from one of its ends see it."""

import math
from dataclasses import dataclass

from drystone.kernels.polygons import mirrored_polygon, no_polygons
from drystone.kernels.profiles import HeightProfile, bare, raised
from drystone.model.outlines import Outlines
from drystone.model.placement import Side
from drystone.settle.rest import SettlingScene


@dataclass(frozen=True, eq=False)
class View:
    """What is built and how high it is, seen so that the building side is on the left.

    Parameters
    ----------
    scene : SettlingScene
        What is there.
    profile : HeightProfile
        How high it is.
    column_px : float
        Width of the profile's columns, source px.
    """

    scene: SettlingScene
    profile: HeightProfile
    column_px: float

    @classmethod
    def bare(cls, width_px: float, side: Side, mu: float, column_px: float) -> "View":
        """Look at the bare ground.

        Parameters
        ----------
        width_px : float
            Of the wall, source px.
        side : {"left", "right"}
            Building side.
        mu : float
            Coefficient of friction.
        column_px : float
            Width of the profile's columns, source px.
        """
        scene = SettlingScene(no_polygons(), width_px, side, mu)
        return cls(scene, bare(math.ceil(width_px / column_px)), column_px)

    def grown(self, outlines: Outlines) -> "View":
        """Return the view of a wall that has more stones than this one, after the same ones."""
        scene, profile = self.scene, self.profile
        seen = len(scene.polygons)
        new = [outlines.polygons.polygon(i) for i in range(seen, len(outlines.polygons))]
        if not new:
            return self
        if scene.side == "right":
            new = [mirrored_polygon(corners, scene.width_px) for corners in new]
        for index, corners in enumerate(new, seen):
            profile = raised(profile, corners, index, self.column_px)
        polygons = scene.polygons.added(new)
        return View(
            SettlingScene(polygons, scene.width_px, scene.side, scene.mu), profile, self.column_px
        )
