"""The best positions of a stone, best first (§3.6)."""

import operator
import types
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from drystone.kernels.lowering import Positions
from drystone.kernels.spots import Place
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.placement.feasible import feasible_positions
from drystone.placement.objective import best_by_objective, lowest
from drystone.placement.settings import PlacementSettings, Rule
from drystone.placement.snug import snuggest

Choice = Callable[[Landscape, PosedStone, Positions, PlacementSettings], list[Place]]

_RULES: Mapping[Rule, Choice] = types.MappingProxyType(
    {"eq12": best_by_objective, "lowest": lowest, "snug": snuggest}
)


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

    @property
    def at(self) -> tuple[int, int]:
        """Row and column."""
        return self.row, self.col


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
    spots: list[tuple[tuple[float, ...], Spot]] = []
    for index, posed in enumerate(poses):
        positions = feasible_positions(landscape, posed, settings.reach, settings.clearance_px)
        if not len(positions):
            continue
        for merit, row, col in _RULES[settings.rule](landscape, posed, positions, settings):
            floor = row + posed.height_px
            order = (-floor, -merit) if settings.rule == "lowest" else (-merit, -floor)
            spots.append(((*order, col, index), Spot(index, row, col)))
    spots.sort(key=operator.itemgetter(0))
    return [spot for _, spot in spots[: settings.tries]]
