"""The two ends of the range of alpha that a growing wall carries, and what they tell (§4.1)."""

from collections.abc import Iterable
from typing import NamedTuple

from drystone.kernels.certificate import Figures
from drystone.statics.certificate import fall_of, no_alpha_of, optimum_of
from drystone.statics.grown import Grown
from drystone.statics.limit import _MESSAGE as MESSAGE
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import Certificate, LateralResistance, LimitResult, LimitStatus
from drystone.statics.solvers.highs import TOLERANCE


class End(NamedTuple):
    """One end of the range of alpha, certified.

    Parameters
    ----------
    alpha : float
        Load multiplier; NaN when there is none at all.
    certificate : Certificate
        That it is the end, or that there is none.
    falls : Certificate or None
        That the blocks do not stand by themselves.
    solver : str
        Which one found it.
    """

    alpha: float
    certificate: Certificate
    falls: Certificate | None
    solver: str


def optimum(found: Figures, alpha: float, sign: int, solver: str) -> End | None:
    """Return the greatest (sign 1) or least (-1) alpha, if the figures prove it."""
    return certified(optimum_of(found, alpha, sign), found, alpha, sign, solver)


def certified(
    certificate: Certificate, found: Figures, alpha: float, sign: int, solver: str
) -> End | None:
    """Return the same, with a certificate that was made before."""
    if not certificate.holds:
        return None
    if not sign * alpha < -TOLERANCE:
        return End(alpha, certificate, None, solver)
    falls = fall_of(found)
    return End(alpha, certificate, falls, solver) if falls.holds else None


def no_alpha(found: Figures, solver: str) -> End | None:
    """Return that no alpha holds the blocks up, if the figures of a mechanism prove it."""
    certificate = no_alpha_of(found)
    return End(float("nan"), certificate, certificate, solver) if certificate.holds else None


def told(model: RigidBlockModel, ends: Iterable[End | None]) -> Grown:
    """Tell the resistance of a wall.

    Parameters
    ----------
    model : RigidBlockModel
        The wall.
    ends : iterable of End or None
        The greatest alpha, then the least, which is not looked at when the first says enough.
        Without a certificate for one of them the wall is solved from the start.
    """
    found = []
    for end in ends:
        if end is None:
            return Grown(lateral_resistance(model), solved_cold=True)
        if end.falls is not None:
            return Grown(_falling(end.falls, end.solver, model.mu))
        found.append(end)
    greatest, least = found
    return Grown(_standing(least, greatest, model.mu))


def _falling(certificate: Certificate, solver: str, mu: float) -> LateralResistance:
    status = LimitStatus.UNSTABLE
    said = MESSAGE[status]
    return LateralResistance(
        LimitResult(status, "left", certificate=certificate, message=said, solver=solver),
        LimitResult(status, "right", certificate=certificate, message=said, solver=solver),
        mu,
    )


def _standing(least: End, greatest: End, mu: float) -> LateralResistance:
    status = LimitStatus.OPTIMAL
    said = MESSAGE[status]
    left, right = max(0.0, -least.alpha), max(0.0, greatest.alpha)
    of_left, of_right = least.certificate, greatest.certificate
    return LateralResistance(
        LimitResult(status, "left", left, None, None, of_left, said, least.solver),
        LimitResult(status, "right", right, None, None, of_right, said, greatest.solver),
        mu,
    )
