"""A stone that does not rest by itself, and the wedge that holds it (§3.7; DESIGN 4.6)."""

from dataclasses import dataclass

from drystone.kernels.polygons import Points, mirrored_polygon
from drystone.settle.rest import Repose, Scene, Turned, touch_down
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import WedgeLimits, gridded, wedge_under


@dataclass(frozen=True, eq=False)
class Wedged:
    """A stone on a wedge."""

    repose: Repose
    wedge: Points  # (n, 2): corners of the wedge in the wall frame, counter-clockwise, source px


def wedged(
    stone: Turned,
    scene: Scene,
    start: tuple[float, float],
    settings: SettleSettings,
    limits: WedgeLimits,
) -> Wedged | None:
    """Lower a stone without turning it, and wedge it there; None when no wedge holds it.

    Parameters
    ----------
    stone : Turned
        As the scene sees it.
    scene : Scene
        What is there.
    start : (float, float)
        Centroid where it is let go, in the view.
    settings : SettleSettings
        How it is lowered.
    limits : WedgeLimits
        Sizes of wedges.
    """
    repose = touch_down(stone, scene, start, settings)
    return None if repose is None else held(repose, scene, limits)


def held(repose: Repose, scene: Scene, limits: WedgeLimits) -> Wedged | None:
    """Wedge a stone where it was lowered; None when no wedge holds it.

    Parameters
    ----------
    repose : Repose
        Of the stone, as :func:`drystone.settle.rest.touch_down` found it.
    scene : Scene
        What is there.
    limits : WedgeLimits
        Sizes of wedges.
    """
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
