"""Settings of laying a course plan."""

from dataclasses import dataclass, field


@dataclass(frozen=True, kw_only=True)
class LetGoSettings:
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
    """

    column_px: float = 1.0
    starts: int = 5
    apart: float = 0.03
    spread: float = 0.3
    enough: int = 3
    reach: float = 0.5
    astray: float = 0.5
    top: float = 1.0
    width: float = 2.0
    turn: float = 0.3
    rest: float = 0.1
    wedge: float = 0.2

    def __post_init__(self) -> None:
        if not self.column_px > 0 or min(self.starts, self.enough) < 1 or not self.astray > 0:
            raise ValueError("column_px, starts, enough and astray must be positive")
        weights = (self.top, self.width, self.turn, self.rest, self.wedge)
        if min(self.apart, self.spread, self.reach, *weights) < 0:
            raise ValueError("distances and weights must not be negative")


@dataclass(frozen=True, kw_only=True)
class LayingSettings:
    """How a course plan is laid.

    Parameters
    ----------
    let_go : LetGoSettings
        From where stones are let go, and what it costs to rest elsewhere than planned.
    analysed : int
        How many of the cheapest places after which the wall stands are compared by LLC.
    judged : int
        How many places of a stone in a pose are judged at most.
    llc : float
        Bonus for LLC = 1.
    """

    let_go: LetGoSettings = field(default_factory=LetGoSettings)
    analysed: int = 6
    judged: int = 10
    llc: float = 3.0

    def __post_init__(self) -> None:
        if not 1 <= self.analysed <= self.judged:
            raise ValueError("analysed must be positive, and judged not less")
        if self.llc < 0:
            raise ValueError("llc must not be negative")
