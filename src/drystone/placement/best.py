"""The best positions of a stone, best first (§3.6)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drystone.indices.local_filling import local_filling_ratio
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.placement.feasible import Positions, feasible_positions
from drystone.placement.objective import Floats, eq12_objective
from drystone.placement.settings import PlacementSettings
from drystone.placement.snug import snug_objective


@dataclass(frozen=True)
class Spot:
    """A feasible place for one of several poses.

    Parameters
    ----------
    pose : int
        Which of the poses.
    row, col : int
        Top-left corner of its mask, in the landscape's view.
    """

    pose: int
    row: int
    col: int


def best_spots(
    landscape: Landscape, poses: Sequence[PosedStone], settings: PlacementSettings
) -> list[Spot]:
    """Return feasible places of a stone, the best by the chosen rule first (§3.6).

    Parameters
    ----------
    landscape : Landscape
        What is built, in its view.
    poses : sequence of PosedStone
        Poses of the stone among which the rule may choose, in the same view.
    settings : PlacementSettings
        Rule, reach, and how many places are wanted.

    Returns
    -------
    spots : list of Spot
        At most `settings.tries`; empty when the stone fits nowhere.  Ties of the rule go to the
        lower place, then to the one further to the building side, then to the earlier pose.
    """
    merits, floors, cols, keys = [], [], [], []
    for index, posed in enumerate(poses):
        positions = feasible_positions(landscape, posed, settings.reach, settings.clearance_px)
        if len(positions):
            merits.append(_merit(landscape, posed, positions, settings))
            floors.append(positions[:, 0] + posed.height_px)
            cols.append(positions[:, 1])
            keys.append(np.column_stack([np.full(len(positions), index), positions]))
    if not keys:
        return []
    merit, floor, col = np.concatenate(merits), np.concatenate(floors), np.concatenate(cols)
    # A rounding error in the merit must not decide between equal places.
    ranked = [col, -floor, -np.round(merit, 12)]
    if settings.rule == "lowest":
        ranked = [col, -np.round(merit, 12), -floor]
    order = np.lexsort(ranked)[: settings.tries]
    return [Spot(*key) for key in np.concatenate(keys)[order].tolist()]


def _merit(
    landscape: Landscape, posed: PosedStone, positions: Positions, settings: PlacementSettings
) -> Floats:
    if settings.rule == "eq12":
        return eq12_objective(landscape, posed, positions, settings.beta)
    if settings.rule == "lowest":
        return local_filling_ratio(landscape, posed, positions)
    return snug_objective(landscape, posed, positions, settings)
