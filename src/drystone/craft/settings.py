"""What counts as a joint, a bearing, a big stone: settings of the craft rules."""

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class CraftSettings:
    """How a wall is looked at; lengths are shares of the mean height of its stones.

    All of these are definitions of our own; docs/craft.md says why.

    Parameters
    ----------
    joint : float
        Widest gap that is a joint between two neighbours; what is wider is a hole.
    sample : float
        Distance of the lines along which the wall is looked at.
    offset : float
        Sideways step up to which a joint goes on as the same joint in the next course, and
        height within which four corners meet at one point.
    hole : float
        Highest hole between two head joints that does not end a running joint, when no stone
        lies between them.
    bearing : float
        Least width of a bed on which a stone rests, as a share of its own width.
    lap : float
        Least lap over a joint below, as a share of the stone's width.
    elongation : float
        Length over breadth from which a stone has a longer side.
    big : float
        A stone of this many mean areas is a big one.
    steep_deg : float
        Slope from which a bed is named.
    outward : float
        Outward slope (rise over run) from which the upper edge of an end stone is named.
    stick_out : float
        How far a wedge may reach out beyond the stone that lies on it.
    """

    joint: float = 0.3
    sample: float = 1.0 / 24.0
    offset: float = 0.15
    hole: float = 0.5
    bearing: float = 0.1
    lap: float = 0.25
    elongation: float = 1.2
    big: float = 1.5
    steep_deg: float = 15.0
    outward: float = 0.1
    stick_out: float = 0.1

    def __post_init__(self) -> None:
        for field in fields(self):
            if not 0.0 < getattr(self, field.name) < float("inf"):
                raise ValueError(f"{field.name} must be a number above 0")
        if self.sample > 0.25 * self.joint:
            raise ValueError("sample must be at most a quarter of joint")
