"""What the search for better walls (:mod:`drystone.search`) goes by, and its course plans."""

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
        How many walls are built, the first one among them; 1 in the paper, on pixels and with a
        policy.  1000000 leaves it to the time limit, or without one to the number of stones: 32
        walls of up to 40, 8 at least.
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
    passes: int = ranged(16, least=1)
    chains: int = ranged(4, least=1)
    share_every: int = ranged(8, least=1)
    largest: float = ranged(0.3, above=0, most=1)
    spread: float = ranged(0.5, least=0)
    polish: float = ranged(0.2, least=0, most=1)
    joint: float = ranged(0.03, least=0, most=0.1)
    wedges: int = ranged(6, least=0)
    wedge_below: float = ranged(0.12, least=0)
    warm: float = ranged(0.15, above=0)
    cold: float = ranged(0.01, above=0, within=("warm",))
    cycle: int = ranged(64, least=1)
    patience: int = ranged(12, least=1)


@dataclass(frozen=True, kw_only=True)
class CourseSettings(Ranged):
    """What a course plan costs, and how long it is looked for.

    Lengths in the weights are shares of the mean size of a stone, the root of its area.

    Parameters
    ----------
    step : float
        Weight of the ups and downs along the top of a course.
    level : float
        Of how far the tops of a course are off their mean, for each stone.
    top : float
        The same in the last course.
    joint : float
        Of a head joint right above another.
    reach : float
        Head joints this far from those below are crossed.
    overflow : float
        Of what the stones of a course are too wide for the wall.
    slack : float
        Of what is free in head joints, over the area of a mean stone, times its width.
    void : float
        Of voids under stones, over the area of a mean stone.
    turn : float
        Of how far the ends of a stone go up or down when it turns until it rests.
    rock : float
        Of how far a stone still stays above what should carry it on one side.
    support : float
        Of the width by which a centroid is too near to the end of its support, over that of the
        stone.
    margin : float
        So far inside its support, over the stone's width, a centroid should be.
    steepest_deg : float
        A stone turns by no more until it rests.
    overhead : float
        Of what a stone stands out above the wall's height.
    high : float
        Of a stone that does at all.
    flush : float
        Of the distance between the faces of end stones and the ends of the wall.
    upright : float
        Of how much higher than wide a stone stands, over its width.
    left_out : float
        Of a stone of mean area that is left out.
    across : float
        Of a percent of F_AH, as far as the plan's bed joints tell, for each stone of the stock:
        what counts by the stone grows with the wall, F_AH and F_AV do not.
    down : float
        Of a percent by which F_AV is short of `target`, as far as its head joints tell; the same.
    target : float
        F_AV that is enough, percent.
    apart : float
        Stones are planned so much further apart than their faces need.
    evaluations : int
        How many plans are looked at, for each stone; at most `most_evaluations` in all.
    most_evaluations : int
        See there.
    temperature, coldest : float
        At the start and at the end.
    doubt : float
        A changed plan is given up when, up to the highest course that changed or one above it, it
        costs more by this than it may: what is above seldom makes up for it.
    again : float
        Temperature at which upper courses are planned again, over the first one.
    """

    step: float = ranged(2.0, least=0)
    level: float = ranged(0.6, least=0)
    top: float = ranged(1.5, least=0)
    joint: float = ranged(4.0, least=0)
    reach: float = ranged(0.6, least=0)
    overflow: float = ranged(20.0, least=0)
    slack: float = ranged(2.0, least=0)
    void: float = ranged(1.0, least=0)
    turn: float = ranged(0.5, least=0)
    rock: float = ranged(1.0, least=0)
    support: float = ranged(3.0, least=0)
    margin: float = ranged(0.2, least=0)
    steepest_deg: float = ranged(8.0, least=0, below=45)
    overhead: float = ranged(20.0, least=0)
    high: float = ranged(6.0, least=0)
    flush: float = ranged(1.0, least=0)
    upright: float = ranged(2.0, least=0)
    left_out: float = ranged(8.0, least=0)
    across: float = ranged(0.08, least=0)
    down: float = ranged(0.012, least=0)
    target: float = ranged(100.0, least=0)
    apart: float = ranged(0.01, least=0)
    evaluations: int = ranged(3_000, least=1)
    most_evaluations: int = ranged(1_000_000, least=1)
    temperature: float = ranged(6.0, above=0)
    coldest: float = ranged(0.05, above=0, within=("temperature", "again"))
    doubt: float = ranged(2.0, least=0)
    again: float = ranged(0.035, above=0, most=1)


@dataclass(frozen=True, kw_only=True)
class LayingSettings(Ranged):
    """From where a planned stone is let go, and what it costs to rest elsewhere than planned.

    Costs are sums of these weights; heights and widths are shares of the mean stone height.

    Parameters
    ----------
    column_px : float
        Columns of the height profile onto which stones are dropped, source px.
    starts : int
        From how many places a stone is let go in each pose.
    apart : float
        Least distance between these, over the stone's size (the root of its area).
    spread : float
        The same of a stone that may be laid anywhere along the wall.
    enough : int
        A stone is let go from no more places in a pose once it rests in so many near the plan.
    reach : float
        How far beside its planned place a stone is let go, over its size.
    astray : float
        How far above or below the planned top a stone's top may be, in mean stone heights.
    top : float
        Cost of a top one mean stone height above or below the planned one.
    width : float
        Cost of a mean stone height of width that is lost.
    turn : float
        Cost of a turn by 10 degrees from the planned angle.
    rest : float
        Cost of a rest that would end with the least lean of gravity; at a lean of mu it is 0.
    wedge : float
        Cost of a wedge.
    analysed : int
        How many of the cheapest places after which the wall stands are compared by LLC.
    judged : int
        How many places of a stone in a pose are judged at most.
    llc : float
        Bonus for LLC = 1.
    """

    column_px: float = ranged(1.0, above=0)
    starts: int = ranged(5, least=1)
    apart: float = ranged(0.03, least=0)
    spread: float = ranged(0.3, least=0)
    enough: int = ranged(3, least=1)
    reach: float = ranged(0.5, least=0)
    astray: float = ranged(0.5, above=0)
    top: float = ranged(1.0, least=0)
    width: float = ranged(2.0, least=0)
    turn: float = ranged(0.3, least=0)
    rest: float = ranged(0.1, least=0)
    wedge: float = ranged(0.2, least=0)
    analysed: int = ranged(6, least=1, within=("judged",))
    judged: int = ranged(10, least=1)
    llc: float = ranged(3.0, least=0)
