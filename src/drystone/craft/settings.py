"""What counts as a joint, a bearing, a big stone: settings of the craft rules."""

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class CraftSettings:
    """How a wall is looked at; lengths are shares of the mean height of its stones.

    All of these are definitions of our own; docs/craft.md says why.
    """

    joint: float = 0.3  # widest gap that is a bed joint; what is wider is a hole
    # widest gap between neighbours that is a head joint: as wide as a small stone, which parts a
    # wall all the more
    slot: float = 0.8
    sample: float = 1.0 / 24.0  # distance of the lines along which the wall is looked at
    # sideways step up to which a joint goes on as the same joint in the next course, and height
    # within which four corners meet at one point
    offset: float = 0.15
    # highest hole between two head joints that does not end a running joint, when no stone lies
    # between them
    hole: float = 0.5
    bearing: float = 0.1  # least width of a bed on which a stone rests, as a share of its own width
    lap: float = 0.25  # least lap over a joint below, as a share of the stone's width
    elongation: float = 1.2  # length over breadth from which a stone has a longer side
    big: float = 1.5  # a stone of this many mean areas is a big one
    steep_deg: float = 15.0  # slope from which a bed is named
    # outward slope (rise over run) from which the upper edge of an end stone is named
    outward: float = 0.1
    stick_out: float = 0.1  # how far a wedge may reach out beyond the stone that lies on it
    # air by which a column of a stone's lower side that bears may exceed the nearest one, and its
    # greatest slope (rise over run): what is steeper is a side, not a seat
    near: float = 0.06
    slope: float = 0.7
    # least width of a seat, and least distance of the stone's middle from its ends; both over the
    # root of the stone's area
    seat: float = 0.2
    middle: float = 0.1
    # a stone whose size (root of the area) is below this share of that of the mean area is small
    small: float = 0.5
    # share of a stone's width at a lower corner from which nothing beneath it is a void
    void: float = 0.25

    def __post_init__(self) -> None:
        for field in fields(self):
            if not 0.0 < getattr(self, field.name) < float("inf"):
                raise ValueError(f"{field.name} must be a number above 0")
        if self.sample > 0.25 * self.joint:
            raise ValueError("sample must be at most a quarter of joint")
