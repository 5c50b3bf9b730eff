"""Settings of planning course by course."""

from dataclasses import dataclass

from drystone.model.settings import Ranged, ranged


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
    left_out: float = ranged(8.0, least=0)
    across: float = ranged(0.08, least=0)
    down: float = ranged(0.012, least=0)
    target: float = ranged(100.0, least=0)
    apart: float = ranged(0.01, least=0)
    evaluations: int = ranged(3_000, least=1)
    most_evaluations: int = ranged(1_000_000, least=1)
    temperature: float = ranged(6.0, above=0)
    coldest: float = ranged(0.05, above=0)
    doubt: float = ranged(2.0, least=0)
    again: float = ranged(0.035, above=0, most=1)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.coldest > self.temperature * self.again:
            raise ValueError("coldest must not be above temperature times again")
