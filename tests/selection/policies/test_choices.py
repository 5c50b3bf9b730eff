"""Each policy picks what it should, among candidates made by hand and as a slow twin does."""

import math
from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.policies.registry import BUILT_IN, policy_named
from drystone.selection.policies.settings import PolicySettings
from tests.selection.offers import offered
from tests.strategies import repeatable


def chosen(name, *offers, **settings):
    """Return the stone that a policy chooses, whatever the order of the candidates."""
    policy = policy_named(name, PolicySettings(**settings), SelectionSettings())
    found = {
        some[policy.choose(some, np.random.default_rng(0)) or 0].stone_id
        for some in (offers, offers[::-1])
    }
    (stone_id,) = found
    return stone_id


def test_random_takes_all_with_the_same_chance():
    policy = policy_named("random", PolicySettings(), SelectionSettings())
    rng, offers = np.random.default_rng(0), [offered(i) for i in range(1, 5)]
    drawn = Counter(policy.choose(offers, rng) for _ in range(4000))
    assert sorted(drawn) == [0, 1, 2, 3]
    assert all(900 < count < 1100 for count in drawn.values())


@pytest.mark.parametrize("name", [name for name in BUILT_IN if name != "random"])
def test_ties_go_to_the_lower_id_then_to_the_first(name):
    assert chosen(name, offered(4), offered(3), offered(7)) == 3
    policy = policy_named(name, PolicySettings(), SelectionSettings())
    turned = [offered(angle_deg=angle) for angle in (90.0, -90.0, 0.0)]
    assert policy.choose(turned, np.random.default_rng(0)) == 0


@pytest.mark.parametrize(
    ("better", "worse"),
    [
        ({"LLC": 0.6}, {"LLC": 0.5}),
        ({"NHR": 0.0}, {"NHR": 0.1}),
        ({"IWR": 0.5}, {"IWR": 0.4}),
        ({"boundary": True, "IS": 0.5, "IWR": 0.0}, {}),
        ({"GDS": 0.6}, {}),
        ({"LFR": 0.9}, {}),
        ({"SF": 0.9}, {}),
        ({"LLC": 0.1, "GDS": 1.0}, {"LLC": 0.5, "GDS": 0.5}),  # nothing is filtered
    ],
)
def test_every_index_is_in_the_sum(better, worse):
    assert chosen("scalarised", offered(1, indices=worse), offered(2, indices=better)) == 2


def first_lowest(offers, _=None):
    """The lowest, then the tightest, then the nearest to the building side."""

    def rank(one):
        at_left = one.side == "left"
        from_end = one.left_px if at_left else one.wall_width_px - one.right_px
        return one.centroid_px[1], -one.indices.LFR, from_end, one.stone_id

    return min(offers, key=rank).stone_id


def width(one):
    """Of what bears a stone from below."""
    return 0.0 if one.support_px is None else one.support_px[1][0] - one.support_px[0][0]


def sieved(offers, at):
    """Filters one after the other; one that nothing passes is left out; of the rest the lowest."""
    for passes in (
        lambda o: width(o) >= at.min_support * (o.right_px - o.left_px),
        lambda o: (
            o.indices.IS >= at.min_slope
            if o.indices.boundary
            else o.indices.IWR >= at.min_interlocking
        ),
        lambda o: o.indices.NHR <= at.max_step,
        lambda o: o.indices.LFR >= at.min_filling,
    ):
        offers = [offer for offer in offers if passes(offer)] or offers
    return first_lowest(offers)


def cheapest_tower(offers, at):
    """Four terms, each as a share of the largest; what nothing bears has the largest."""

    def terms(one):
        if one.support_px is None:
            return 1.0, one.turned_deg, None, None
        (left, low), (right, high) = one.support_px
        aside = abs(one.centroid_px[0] - (left + right) / 2)
        lacking = 1.0 - (right - left) / (one.right_px - one.left_px)
        return lacking, one.turned_deg, aside, math.atan2(abs(high - low), right - left)

    def shares(values):
        most = max((value for value in values if value is not None), default=0.0)
        if most == 0.0:
            return [float(value is None) for value in values]
        return [1.0 if value is None else value / most for value in values]

    weights = at.w_area, at.w_energy, at.w_distance, at.w_normal
    columns = [shares(column) for column in zip(*map(terms, offers), strict=True)]
    costs = (np.array(weights) @ np.array(columns)).round(9)
    return min(zip(costs, (one.stone_id for one in offers), strict=True))[1]


TWINS = {"lowest": first_lowest, "filter": sieved, "towers": cheapest_tower}

SETTINGS = {
    "min_support": (0.3, 0.25),
    "min_interlocking": (0.2, 0.5),
    "max_step": (0.25, 0.05),
    "min_filling": (0.7, 0.85),
    "min_slope": (0.0, 0.2),
    "w_area": (0.179, 0.0),
    "w_energy": (0.472, 0.2),
    "w_distance": (0.094, 0.5),
    "w_normal": (0.254, 0.0),
}
"""What they are by themselves, and another value."""

VALUES = {
    "IWR": (0.19, 0.2, 0.5),
    "IS": (-0.01, 0.0, 0.2),
    "NHR": (0.05, 0.25, 0.26),
    "LFR": (0.69, 0.7, 0.85),
    "boundary": (False, True),
}
"""At thresholds, and beside them."""

SUPPORTS = [
    None,
    *(((10.0, 0.0), end) for end in ((12.5, 0.0), (13.0, 0.0), (20.0, 0.0), (19.0, 4.0))),
]


@st.composite
def candidates(draw):
    """Some offers of different stones, many of them alike in something."""

    def one_of(*values):
        return draw(st.sampled_from(values))

    return [
        offered(
            stone_id,
            indices={name: one_of(*values) for name, values in VALUES.items()},
            support_px=one_of(*SUPPORTS),
            turned_deg=one_of(0.0, 3.0, 9.0),
            centroid_px=(one_of(15.0, 16.0, 18.0), one_of(1.0, 2.0, 30.0)),
            side=one_of("left", "right"),
        )
        for stone_id in range(1, draw(st.integers(1, 6)) + 1)
    ]


@repeatable(400)
@given(candidates(), st.sampled_from([*TWINS]), st.sets(st.sampled_from([*SETTINGS])))
def test_policies_choose_as_their_slow_twins(offers, name, changed):
    at = {key: values[key in changed] for key, values in SETTINGS.items()}
    settings = {key: at[key] for key in changed}
    assert chosen(name, *offers, **settings) == TWINS[name](offers, SimpleNamespace(**at))
