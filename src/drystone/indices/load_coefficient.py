"""LLC: the lateral load that the wall carries with the stone in it (Eq. 11)."""

from drystone.statics.result import LateralResistance


def limit_load_coefficient(resistance: LateralResistance) -> float | None:
    """Return min(alpha_left, alpha_right) / mu, never rounded (Eq. 11).

    None when the wall does not stand or the limit analysis failed.
    """
    return resistance.value
