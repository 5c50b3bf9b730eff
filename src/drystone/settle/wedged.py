"""A stone that does not rest by itself, and the wedge that holds it (§3.7; DESIGN 4.6)."""

from dataclasses import dataclass

from drystone.kernels.polygons import Points, mirrored_polygon
from drystone.settle.rest import Repose, SettlingScene, Turned, touch_down
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import WedgeLimits, gridded, wedge_under


@dataclass(frozen=True, eq=False)
class Wedged:
    """A stone on a wedge."""

    repose: Repose
    wedge: Points  # (n, 2): corners of the wedge in the wall frame, counter-clockwise, source px


def wedged(
    stone: Turned,
    scene: SettlingScene,
    start: tuple[float, float],
    settings: SettleSettings,
    limits: WedgeLimits,
) -> Wedged | None:
    """Lower a stone from a start of the view without turning it, and wedge it there.

    None when no wedge holds it.
    """
    repose = touch_down(stone, scene, start, settings)
    return None if repose is None else held(repose, scene, limits)


def held(repose: Repose, scene: SettlingScene, limits: WedgeLimits) -> Wedged | None:
    """Wedge a stone where `touch_down` lowered it; None when no wedge holds it."""
    x, corners = repose.settled.x_px, repose.settled.corners
    if scene.side == "right":
        x, corners = scene.width_px - x, mirrored_polygon(corners, scene.width_px)
    centroid = (x, repose.settled.y_px)
    wedge = wedge_under(corners, centroid, scene.polygons, scene.width_px, limits)
    if wedge is None:
        return None
    if scene.side == "right":
        wedge = mirrored_polygon(wedge, scene.width_px)
    return Wedged(repose, gridded(wedge))
