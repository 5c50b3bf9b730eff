"""Feasible positions, the best of them, ties and rules (§3.6, Fig. 8, DESIGN 4.4)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels import spots
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.placement.best import Spot, best_spots
from drystone.placement.feasible import can_be_lowered, feasible_positions
from drystone.placement.settings import PlacementSettings
from tests.naive import placement as naive
from tests.naive.rays import local_filling_ratio
from tests.strategies import landscapes, masks, repeatable


def posed(mask, anchor_x=0.5):
    return PosedStone(Stone(1, mask), 0.0, 1.0, mask.copy(), (anchor_x, 0.5))


@repeatable(100)
@given(landscapes(16), masks(), st.integers(0, 3))
def test_positions_are_those_of_loops_and_some_can_be_reached_from_above(occupied, mask, clearance):
    landscape, stone = Landscape(occupied, ()), posed(mask)
    lowered = naive.positions_from_above(occupied, mask, clearance)
    found = feasible_positions(landscape, stone, "above", clearance)
    assert (found.dtype, found.flags.c_contiguous) == (np.int64, True)
    assert [tuple(at) for at in found.tolist()] == lowered
    found = [tuple(at) for at in feasible_positions(landscape, stone).tolist()]
    assert found == naive.resting_positions(occupied, mask)
    for at in found:
        assert can_be_lowered(landscape, stone, *at, clearance) == (at in lowered)


WEIGHTS = [(0, 0, 0, 0), (0, 0, -0.5, 0), (0, -0.5, 0, 0), (1.6, 0.5, 0.7, 0.25), (0, 1, 1, -0.5)]


@st.composite
def landscapes_with_floors(draw):
    """Rays downwards are filled, but for dents."""
    occupied, floor = draw(landscapes()), draw(st.integers(0, 12))
    dents = draw(st.lists(st.integers(0, occupied.shape[1] - 1), max_size=3))
    occupied[occupied.shape[0] - floor :] = True
    occupied[-floor - 1 :, dents] = False
    return occupied


def merit(settings, occupied, stone, at):
    mask, area_px = stone.mask, stone.area_px
    if settings.rule == "eq12":
        return naive.eq12(occupied, mask, stone.anchor[0], at, settings.beta)
    if settings.rule == "lowest":
        return local_filling_ratio(occupied, mask, *at)
    height, width = occupied.shape
    return -(
        settings.height_weight * (height - at[0] - stone.height_px) / stone.height_px
        + settings.void_weight * naive.void_below(occupied, mask, at) / area_px
        + settings.gap_weight * min(1.0, naive.gap_beside(occupied, mask, at) / area_px)
        + settings.end_weight * at[1] / width
    )


@pytest.mark.parametrize("rule", ["eq12", "lowest", "snug"])
@repeatable(120)
@given(
    occupied=landscapes_with_floors(),
    poses=st.lists(
        st.builds(posed, masks(8), st.integers(0, 511).map(lambda k: k / 64)), max_size=3
    ),
    clearance=st.none() | st.integers(0, 3),
    beta=st.sampled_from([0.0, 0.3, 0.7, 1.0]),
    weights=st.sampled_from(WEIGHTS),
    tries=st.sampled_from([1, 2, 5, 1000]),
    guesses=st.sampled_from([0, 3, 16]),
)
def test_rules_rank_all_places_of_all_poses(
    rule, occupied, poses, clearance, beta, weights, tries, guesses
):
    """What snug counts below a stone is open from above only.  Most places are passed over."""
    if clearance is None and rule != "snug":
        reach, places_of = "any", naive.resting_positions
    else:
        reach, clearance = "above", clearance or 0
        places_of = lambda *on: naive.positions_from_above(*on, clearance)  # noqa: E731
    names = ("height_weight", "void_weight", "gap_weight", "end_weight")
    settings = PlacementSettings(
        rule=rule,
        reach=reach,
        clearance_px=clearance or 0,
        beta=beta,
        tries=tries,
        **dict(zip(names, weights, strict=True)),
    )
    ranks = []
    for k, stone in enumerate(poses):
        for at in places_of(occupied, stone.mask):
            worth = -round(merit(settings, occupied, stone, at), 9)
            floor = -at[0] - stone.height_px
            first = (floor, worth) if rule == "lowest" else (worth, floor)
            ranks.append((*first, at[1], k, at[0]))
    expected = [Spot(k, row, col) for *_, col, k, row in sorted(ranks)[:tries]]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(spots, "GUESSES", guesses)
        assert best_spots(Landscape(occupied, ()), poses, settings) == expected
