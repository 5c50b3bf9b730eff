"""What the search for better walls (:mod:`drystone.search`) goes by."""

from dataclasses import dataclass

from drystone.model.settings import Ranged, ranged

UNLIMITED = 1_000_000
"""Budget of a search that the clock ends."""

AIMS = ("F_SF", "F_LR", "F_AV", "F_AH")
"""Figures of merit that may have an aim."""


@dataclass(frozen=True, kw_only=True)
class GoalSettings(Ranged):
    """What makes a finished wall good: the weighted sum of its figures of merit.

    Parameters
    ----------
    filling : float
        Weight of F_SF over the largest that the stones allow.
    resistance, vertical, horizontal, level, flush : float
        Weights of F_LR (the smaller one of both flow rules, up to 1), F_AV, F_AH, T_LEVEL and
        E_FLUSH; the last three count against a wall.
    bond : float
        Weight of faults of the bond for each stone (:func:`drystone.craft.bond.bond_faults`).
    fallen : float
        Weight of the share of the stones that fall when the wall is rehearsed
        (:mod:`drystone.search.rehearsal`).
    F_SF, F_LR, F_AV, F_AH : float
        Aims: what is better than its aim counts no more than the aim; 0 is none.
    urgent : float
        Factor on the weight of figures that have an aim.
    """

    filling: float = 15.0
    resistance: float = 2.0
    vertical: float = 0.01
    horizontal: float = 0.25
    level: float = 0.5
    flush: float = 0.25
    bond: float = 2.0
    fallen: float = 15.0
    F_SF: float = ranged(0.0, least=0)
    F_LR: float = ranged(0.0, least=0)
    F_AV: float = ranged(0.0, least=0)
    F_AH: float = ranged(0.0, least=0)
    urgent: float = ranged(4.0, above=0)


@dataclass(frozen=True, kw_only=True)
class SearchSettings(Ranged):
    """How better walls are looked for after the first.

    Parameters
    ----------
    budget : int
        How many walls are built, the first one among them; 1 in the paper.  1000000 leaves it to
        the time limit, or without one to the number of stones: 32 walls of up to 40, 8 at least.
    passes : int
        How many of them at most are first walls, from seed to seed; then the search goes on from
        the best.
    chains : int
        How many walls are improved side by side, each from its own.
    share_every : int
        Walls of each chain after which the one that is furthest behind goes on from the best.
    largest : float
        Largest share of the stones that is chosen to be taken down; what rests on them goes too.
    spread : float
        Standard deviation of the logarithm of the random factors on the craft weights with which
        the wall is built up again.
    polish : float
        Share of the walls of a chain of planned walls that are made by taking down a part of its
        best wall, before anything is known of what helps.
    joint : float
        Every other wall has open joints (`settle.joint_px`), so wide over the mean size of stones.
    wedges : int
        How many wedges may be added in the gaps of a wall each time.
    wedge_below : float
        They are added when its merit is at most so much below the best of its chain.
    warm, cold : float
        Temperatures of annealing, in units of merit, at the start and at the end of each cycle.
    cycle : int
        Walls of a chain in its first cycle; every further one is twice as long.
    patience : int
        After so many walls for each of its stones in which the best hardly gets better, the search
        begins again with other first walls.
    """

    budget: int = ranged(1, least=1)
    passes: int = ranged(12, least=1)
    chains: int = ranged(4, least=1)
    share_every: int = ranged(8, least=1)
    largest: float = ranged(0.3, above=0, most=1)
    spread: float = ranged(0.5, least=0)
    polish: float = ranged(0.2, least=0, most=1)
    joint: float = ranged(0.03, least=0, most=0.1)
    wedges: int = ranged(6, least=0)
    wedge_below: float = ranged(0.12, least=0)
    warm: float = ranged(0.15, above=0)
    cold: float = ranged(0.01, above=0)
    cycle: int = ranged(64, least=1)
    patience: int = ranged(12, least=1)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.cold > self.warm:
            raise ValueError("cold must not be above warm")
