"""The paper's rule of placement (Eq. 12-13), and the rule of its released code."""

from drystone.kernels.lowering import Positions
from drystone.kernels.spots import Place, best_by_eq12, best_by_height
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.placement.settings import PlacementSettings


def best_by_objective(
    landscape: Landscape, posed: PosedStone, positions: Positions, settings: PlacementSettings
) -> list[Place]:
    """Return the positions of the largest LFR + H(GDS, beta) - x_c / w, the best first (Eq. 12a).

    Parameters
    ----------
    landscape : Landscape
        What is built, in its view.
    posed : PosedStone
        The stone, in the same view.
    positions : (n, 2) int array
        Feasible positions.
    settings : PlacementSettings
        Threshold of Eq. 13, and how many positions are wanted.
    """
    rays, built = landscape.rays, landscape.built_height_px
    beta, tries = settings.beta, settings.tries
    return best_by_eq12(positions, posed.silhouette, rays, built, posed.anchor[0], beta, tries)


def lowest(
    landscape: Landscape, posed: PosedStone, positions: Positions, settings: PlacementSettings
) -> list[Place]:
    """Return the lowest positions; of equal ones those of the largest LFR.

    Parameters
    ----------
    landscape, posed, positions, settings
        As for :func:`best_by_objective`.
    """
    rays = landscape.rays
    return best_by_height(positions, posed.silhouette, rays, settings.tries)
