"""What is built on outlines, as each side sees it: it grows with the wall (DESIGN 4.9)."""

import math
from dataclasses import dataclass, replace

from drystone.kernels.polygons import Polygons, mirrored_polygon, no_polygons
from drystone.kernels.profiles import HeightProfile, bare, raised
from drystone.model.placement import Side
from drystone.model.site import Site
from drystone.settle.rest import SettlingScene


@dataclass(frozen=True, eq=False)
class SideView:
    """What is built and how high it is, seen so that the building side is on the left."""

    scene: SettlingScene
    profile: HeightProfile
    column_px: float  # width of the profile's columns, source px

    @classmethod
    def bare(cls, width_px: float, side: Side, mu: float, column_px: float) -> "SideView":
        """Look at the bare ground, with a column for the last piece of it."""
        scene = SettlingScene(no_polygons(), width_px, side, mu)
        return cls(scene, bare(math.ceil(width_px / column_px)), column_px)

    def grown(self, built: Polygons) -> "SideView":
        """Return the view of outlines, in the wall frame, that begin with those of this one."""
        profile, width_px = self.profile, self.scene.width_px
        count = len(self.scene.polygons)
        new = [built.polygon(index) for index in range(count, len(built))]
        if not new:
            return self
        if self.scene.side == "right":
            new = [mirrored_polygon(corners, width_px) for corners in new]
        for index, corners in enumerate(new, count):
            profile = raised(profile, corners, index, self.column_px)
        scene = replace(self.scene, polygons=self.scene.polygons.added(new))
        return replace(self, scene=scene, profile=profile)


class Views:
    """The last view from each side, by working px; only what is new is added to it.

    A view depends on what is built alone, not on what was asked for before.
    """

    def __init__(self, site: Site) -> None:
        self._site = site
        self._last: dict[tuple[Side, float], tuple[Polygons, SideView]] = {}

    def of(self, built: Polygons, side: Side, mu: float) -> SideView:
        """Return the view of outlines from a side."""
        before, view = self._last.get((side, mu), (no_polygons(), None))
        # Bit by bit the same, and more after it.
        first = built.leading(min(len(before), len(built)))
        if view is None or _bits(first) != _bits(before):
            scene = SettlingScene(no_polygons(), self._site.extent_px[0], side, mu)
            view = SideView(scene, bare(self._site.width_px), 1.0 / self._site.scale)
        view = view.grown(built)
        self._last[side, mu] = built, view
        return view


def _bits(polygons: Polygons) -> tuple[bytes, bytes]:
    return polygons.first.tobytes(), polygons.corners.tobytes()
