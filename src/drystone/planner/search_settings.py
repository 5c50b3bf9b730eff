"""What the search for better walls (:mod:`drystone.search`) goes by."""

from dataclasses import dataclass

UNLIMITED = 1_000_000
"""Budget of a search that the clock ends."""

AIMS = ("F_SF", "F_LR", "F_AV", "F_AH")
"""Figures of merit that may have an aim."""


@dataclass(frozen=True, kw_only=True)
class GoalSettings:
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
    F_SF, F_LR, F_AV, F_AH : float
        Aims: what is better than its aim counts no more than the aim; 0 is none.
    urgent : float
        Factor on the weight of figures that have an aim.
    """

    filling: float = 15.0
    resistance: float = 1.0
    vertical: float = 0.01
    horizontal: float = 0.25
    level: float = 0.5
    flush: float = 0.25
    bond: float = 2.0
    F_SF: float = 0.0
    F_LR: float = 0.0
    F_AV: float = 0.0
    F_AH: float = 0.0
    urgent: float = 4.0

    def __post_init__(self) -> None:
        if not self.urgent > 0:
            raise ValueError("urgent must be positive")
        if min(self.F_SF, self.F_LR, self.F_AV, self.F_AH) < 0:
            raise ValueError("aims must not be negative")


@dataclass(frozen=True, kw_only=True)
class SearchSettings:
    """How better walls are looked for after the first.

    Parameters
    ----------
    budget : int
        How many walls are built, the first one among them; 1 in the paper.
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
    wedges : int
        How many wedges may be added in the gaps of a wall of outlines each time,
    wedge_below : float
        when its merit is at most so much below the best of its chain.
    warm, cold : float
        Temperatures of annealing, in units of merit, at the start and at the end of each cycle.
    cycle : int
        Walls of a chain in its first cycle; every further one is twice as long.
    patience : int
        After so many walls for each of its stones in which the best hardly gets better, the search
        begins again with other first walls.
    """

    budget: int = 1
    passes: int = 24
    chains: int = 4
    share_every: int = 8
    largest: float = 0.3
    spread: float = 0.5
    polish: float = 0.2
    wedges: int = 6
    wedge_below: float = 0.12
    warm: float = 0.15
    cold: float = 0.01
    cycle: int = 64
    patience: int = 12

    def __post_init__(self) -> None:
        counts = (self.budget, self.passes, self.chains, self.share_every, self.cycle)
        if min(*counts, self.patience) < 1:
            raise ValueError(
                "budget, passes, chains, share_every, cycle and patience must be positive"
            )
        if not 0 <= self.polish <= 1:
            raise ValueError("polish must be in [0, 1]")
        if self.wedges < 0 or self.wedge_below < 0:
            raise ValueError("wedges and wedge_below must not be negative")
        if not 0 < self.largest <= 1 or self.spread < 0:
            raise ValueError("largest must be in (0, 1], spread not negative")
        if not 0 < self.cold <= self.warm:
            raise ValueError("temperatures must be positive, cold not above warm")
