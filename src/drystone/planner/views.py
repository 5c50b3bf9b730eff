"""What is built on outlines, as each side sees it: it grows with the wall (DESIGN 4.9)."""

from dataclasses import dataclass, replace

from drystone.kernels.polygons import Polygons, mirrored_polygon, no_polygons
from drystone.kernels.profiles import HeightProfile, bare, raised
from drystone.model.placement import Side
from drystone.settle.rest import SettlingScene


@dataclass(frozen=True, eq=False)
class SideView:
    """What is built and how high it is, seen so that the building side is on the left."""

    scene: SettlingScene
    profile: HeightProfile
    column_px: float  # width of the profile's columns, source px

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
    """The last views from each side of a wall; only what is new is added to them.

    A view depends on what is built alone, not on what was asked for before.
    """

    def __init__(self, width_px: float) -> None:
        self._width_px = width_px
        self._last: dict[tuple[Side, float, int, float], tuple[Polygons, SideView]] = {}

    def of(
        self, built: Polygons, side: Side, mu: float, columns: int, column_px: float
    ) -> SideView:
        """Return the view of outlines from a side, with so many columns of a width, source px."""
        key = side, mu, columns, column_px
        before, view = self._last.get(key, (no_polygons(), None))
        # Bit by bit the same, and more after it.
        first = built.leading(min(len(before), len(built)))
        if view is None or _bits(first) != _bits(before):
            scene = SettlingScene(no_polygons(), self._width_px, side, mu)
            view = SideView(scene, bare(columns), column_px)
        view = view.grown(built)
        self._last[key] = built, view
        return view


def _bits(polygons: Polygons) -> tuple[bytes, bytes]:
    return polygons.first.tobytes(), polygons.corners.tobytes()
