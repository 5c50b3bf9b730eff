"""Settings of placement."""

from dataclasses import dataclass
from typing import Literal

from drystone.model.settings import Ranged, ranged
from drystone.placement.feasible import Reach

Rule = Literal["eq12", "lowest", "snug"]


@dataclass(frozen=True, kw_only=True)
class PlacementSettings(Ranged):
    """How the best position of a stone is found (§3.6).

    Parameters
    ----------
    rule : {"eq12", "lowest", "snug"}
        ``"eq12"``: the paper's objective; ``"lowest"``: the lowest row, then the largest LFR, then
        the building side; ``"snug"``: the least weighted sum of height, void below, void beside and
        distance from the building side (:func:`drystone.kernels.spots.snug_merits`).
    reach : {"any", "above"}
        Every position of the image, or only those that can be reached from above.
    clearance_px : int
        For ``"above"``: free working px wanted at both sides on the way down.
    beta : float
        Threshold of H(GDS, beta) (Eq. 13).
    tries : int
        How many positions of a stone are tried until one can be made stable; 1 in the paper.
    compare : bool
        Stabilise all of these and keep the one of the least craft cost, instead of the first.
    height_weight, void_weight, gap_weight, end_weight : float
        Weights of ``"snug"``.
    """

    rule: Rule = "eq12"
    reach: Reach = "any"
    clearance_px: int = ranged(0, least=0)
    beta: float = 0.7
    tries: int = ranged(1, least=1)
    compare: bool = False
    height_weight: float = 1.6
    void_weight: float = 0.5
    gap_weight: float = 0.7
    end_weight: float = 0.25
