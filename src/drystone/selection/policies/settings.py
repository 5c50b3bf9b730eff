"""Settings of the policies."""

from dataclasses import dataclass

from drystone.model.settings import Ranged, ranged


@dataclass(frozen=True, kw_only=True)
class PolicySettings(Ranged):
    """Weights and thresholds of policies; those shared with the paper's are in `[selection]`.

    Parameters
    ----------
    packing, course, interlocking, footing, sloping, gravity, lateral : bool
        Components of the policies of Table 1; false takes one from a policy that has it.
    w_sf : float
        ``"scalarised"``: weight of SF, beside the five of `[selection]`.
    min_support : float
        ``"filter"``: least width of the support, as a share of the stone's width.
    min_interlocking : float
        ``"filter"``: least IWR of an inner stone.
    min_slope : float
        ``"filter"``: least IS of a stone at an end of the wall.
    max_step : float
        ``"filter"``: largest NHR.
    min_filling : float
        ``"filter"``: least LFR.
    w_area, w_energy, w_distance, w_normal : float
        ``"towers"``: weights of the support's area, the kinetic energy, the distance of the
        centres and the deviation of the normal.
    """

    packing: bool = True
    course: bool = True
    interlocking: bool = True
    footing: bool = True
    sloping: bool = True
    gravity: bool = True
    lateral: bool = True
    w_sf: float = 1.0
    min_support: float = 0.3
    min_interlocking: float = 0.2
    min_slope: float = 0.0
    max_step: float = 0.25
    min_filling: float = 0.7
    w_area: float = ranged(0.179, least=0)
    w_energy: float = ranged(0.472, least=0)
    w_distance: float = ranged(0.094, least=0)
    w_normal: float = ranged(0.254, least=0)
