"""The best positions of a stone, best first (§3.6)."""

import operator
from collections.abc import Sequence
from dataclasses import dataclass

from drystone.kernels.lowering import Positions
from drystone.kernels.spots import (
    Eq12,
    Place,
    SnugWeights,
    best_by_eq12,
    best_by_height,
    best_by_snugness,
)
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.placement.feasible import feasible_positions
from drystone.placement.settings import PlacementSettings


@dataclass(frozen=True)
class Spot:
    """A feasible place for one of several poses."""

    pose: int  # which of the poses
    # top-left corner of its mask, in the landscape's view
    row: int
    col: int


def best_spots(
    landscape: Landscape, poses: Sequence[PosedStone], settings: PlacementSettings
) -> list[Spot]:
    """Return feasible places of a stone, the best by the chosen rule first (§3.6).

    The rule may choose among the poses, which are in the view of the landscape.  At most
    `settings.tries` places; none when the stone fits nowhere.  Ties of the rule go to the lower
    place, then to the one further to the building side, then to the earlier pose.
    """
    spots: list[tuple[tuple[float, ...], Spot]] = []
    for index, posed in enumerate(poses):
        positions = feasible_positions(landscape, posed, settings.reach, settings.clearance_px)
        if not len(positions):
            continue
        for merit, row, col in _best(landscape, posed, positions, settings):
            floor = row + posed.height_px
            order = (-floor, -merit) if settings.rule == "lowest" else (-merit, -floor)
            spots.append(((*order, col, index), Spot(index, row, col)))
    spots.sort(key=operator.itemgetter(0))
    return [spot for _, spot in spots[: settings.tries]]


def _best(
    landscape: Landscape, posed: PosedStone, positions: Positions, settings: PlacementSettings
) -> list[Place]:
    """Return the best of some positions of a pose, by the rule of the settings."""
    stone, rays, tries = posed.silhouette, landscape.rays, settings.tries
    if settings.rule == "eq12":
        # The paper's own: the largest LFR + H(GDS, beta) - x_c / w (Eq. 12a, Eq. 13).
        eq12 = Eq12(landscape.built_height_px, posed.anchor[0], settings.beta)
        return best_by_eq12(positions, stone, rays, eq12, tries)
    if settings.rule == "lowest":
        # That of the paper's released code; of equal heights the largest LFR.
        return best_by_height(positions, stone, rays, tries)
    # Our own.  Eq. 12 lets a stone that stands half above the course open the next one while there
    # is room beside it; here height costs more than any distance along the wall can win back.
    weights = SnugWeights(
        settings.height_weight, settings.void_weight, settings.gap_weight, settings.end_weight
    )
    return best_by_snugness(positions, stone, landscape.skyline, rays, weights, tries)
