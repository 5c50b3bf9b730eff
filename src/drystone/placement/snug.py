"""The placement rule of our own: low first, snug against the neighbours second."""

from drystone.kernels.lowering import Positions
from drystone.kernels.merits import SnugWeights
from drystone.kernels.spots import Place, best_by_snugness
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.placement.settings import PlacementSettings


def snuggest(
    landscape: Landscape, posed: PosedStone, positions: Positions, settings: PlacementSettings
) -> list[Place]:
    """Return the positions of the least weighted sum of four costs, the best first.

    The costs are those of :func:`drystone.kernels.merits.snug_merits`: height, void below, void
    beside, distance from the building side.

    Eq. 12 lets a stone that stands half above the course open the next one while there is room
    beside it; here height costs more than any distance along the wall can win back.

    Parameters
    ----------
    landscape, posed, positions, settings
        As for :func:`drystone.placement.objective.best_by_objective`.
    """
    weights = SnugWeights(
        settings.height_weight, settings.void_weight, settings.gap_weight, settings.end_weight
    )
    top, rays = landscape.skyline, landscape.rays
    return best_by_snugness(positions, posed.silhouette, top, rays, weights, settings.tries)
