"""Settings of laying a course plan."""

from dataclasses import dataclass

from drystone.model.settings import Ranged, ranged


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
    analysed: int = ranged(6, least=1)
    judged: int = ranged(10, least=1)
    llc: float = ranged(3.0, least=0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.analysed > self.judged:
            raise ValueError("analysed must not be above judged")
