"""The indices of one action together."""

import dataclasses

from drystone.indices.load_coefficient import limit_load_coefficient
from drystone.indices.values import Indices
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus

INDICES = Indices(SF=0.9, LFR=0.8, GDS=0.7, NHR=0.1, IWR=0.5, IS=-0.2, LLC=0.4, boundary=False)


def test_boundary_stones_are_judged_by_is_inner_ones_by_iwr() -> None:
    assert INDICES.third == 0.5
    assert dataclasses.replace(INDICES, boundary=True).third == -0.2


def test_names_are_those_of_the_paper() -> None:
    assert list(INDICES.as_dict()) == ["SF", "LFR", "GDS", "NHR", "IWR", "IS", "LLC"]
    assert list(INDICES.as_dict().values()) == [0.9, 0.8, 0.7, 0.1, 0.5, -0.2, 0.4]


def test_llc_is_the_smaller_factor_over_mu_and_none_without_one() -> None:
    left = LimitResult(LimitStatus.OPTIMAL, "left", 0.29)
    right = LimitResult(LimitStatus.OPTIMAL, "right", 0.58)
    fallen = LimitResult(LimitStatus.UNSTABLE, "right")
    assert limit_load_coefficient(LateralResistance(left, right, 0.58)) == 0.29 / 0.58
    assert limit_load_coefficient(LateralResistance(left, fallen, 0.58)) is None
