"""The indices of one action together."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Indices:
    """Indices of an action: of the stabilised pose on the landscape before it (LLC: after it).

    Parameters
    ----------
    SF, LFR, GDS, NHR, IWR, IS : float
        Eq. 3 to Eq. 10; NHR is best at 0, the others at 1.
    LLC : float or None
        Eq. 11; None when the wall would not stand.
    boundary : bool
        True for a stone at an end of the wall, where IS stands in for IWR.
    """

    SF: float
    LFR: float
    GDS: float
    NHR: float
    IWR: float
    IS: float
    LLC: float | None
    boundary: bool

    @property
    def third(self) -> float:
        """IS for a boundary stone, IWR for an inner one (§3.8)."""
        return self.IS if self.boundary else self.IWR

    def as_dict(self) -> dict[str, float | None]:
        """Return the seven indices under their names in the paper."""
        return {
            "SF": self.SF, "LFR": self.LFR, "GDS": self.GDS, "NHR": self.NHR,
            "IWR": self.IWR, "IS": self.IS, "LLC": self.LLC,
        }  # fmt: skip
