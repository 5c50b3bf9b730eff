"""Each policy picks what it should among candidates made by hand."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.policies.choices import lacking_support, slope_rad
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


def low(height):
    """A centroid at some height."""
    return {"centroid_px": (15.0, height)}


def test_random_takes_all_with_the_same_chance():
    policy = policy_named("random", PolicySettings(), SelectionSettings())
    rng, offers = np.random.default_rng(0), [offered(i) for i in range(1, 5)]
    drawn = Counter(policy.choose(offers, rng) for _ in range(4000))
    assert sorted(drawn) == [0, 1, 2, 3]
    assert all(900 < count < 1100 for count in drawn.values())


def test_the_lowest_centroid_comes_first():
    assert chosen("lowest", offered(1, **low(3.0)), offered(2, **low(2.5))) == 2
    # ... whatever else speaks for another.
    better = offered(1, indices={"LFR": 1.0, "LLC": 0.9}, **low(2.6))
    assert chosen("lowest", better, offered(2, indices={"LFR": 0.1}, **low(2.5))) == 2


def test_of_equal_heights_the_tightest_then_the_building_side():
    loose, tight = offered(1, indices={"LFR": 0.6}), offered(2, indices={"LFR": 0.7})
    assert chosen("lowest", loose, tight) == 2
    inner = offered(1, left_px=12.0, right_px=22.0)
    assert chosen("lowest", inner, offered(2)) == 2
    right = offered(2, side="right", left_px=85.0, right_px=95.0)
    assert chosen("lowest", offered(1), right) == 2  # 5 px from its end, not 10


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


NARROW = {"support_px": ((12.0, 0.0), (14.5, 0.0))}
"""A support of a quarter of the stone's width."""


@pytest.mark.parametrize(
    "fails",
    [
        NARROW,
        {"support_px": None},
        {"indices": {"IWR": 0.19}},
        {"indices": {"boundary": True, "IS": -0.01, "IWR": 0.9}},
        {"indices": {"NHR": 0.26}},
        {"indices": {"LFR": 0.69}},
    ],
)
def test_what_fails_a_filter_is_out_however_low_it_is(fails):
    assert chosen("filter", offered(1, **low(0.5), **fails), offered(2, **low(30.0))) == 2


@pytest.mark.parametrize(
    "passes",
    [
        {"indices": {"IWR": 0.2, "IS": -1.0}},
        {"indices": {"boundary": True, "IS": 0.0, "IWR": 0.0}},
        {"indices": {"NHR": 0.25}},
        {"indices": {"LFR": 0.7, "LLC": 0.01, "GDS": 0.0, "SF": 0.1}},
    ],
)
def test_of_what_passes_all_the_lowest_is_taken(passes):
    assert chosen("filter", offered(2), offered(1, **low(1.0), **passes)) == 1


def test_filters_have_an_order():
    """An earlier rule outweighs a later one; a filter that none passes changes nothing."""
    loose, stepped = {"LFR": 0.1}, {"NHR": 0.9}
    assert chosen("filter", offered(1, indices=stepped), offered(2, indices=loose)) == 2
    unbonded = {"IWR": 0.0}
    assert chosen("filter", offered(1, indices=unbonded), offered(2, indices=stepped)) == 2
    assert chosen("filter", offered(1, **NARROW), offered(2, indices=unbonded)) == 2
    both = [offered(1, indices=loose, **low(1.5)), offered(2, indices=loose, **low(1.0))]
    assert chosen("filter", *both) == 2


@pytest.mark.parametrize(
    ("name", "value", "indices"),
    [
        ("min_interlocking", 0.5, {}),
        ("max_step", 0.05, {}),
        ("min_filling", 0.85, {}),
        ("min_slope", 0.2, {"boundary": True}),
    ],
)
def test_thresholds_are_settings(name, value, indices):
    good = {"IWR": 1.0, "IS": 1.0, "NHR": 0.0, "LFR": 1.0, **indices}
    offers = offered(1, indices=indices, **low(1.0)), offered(2, indices=good)
    assert chosen("filter", *offers) == 1
    assert chosen("filter", *offers, **{name: value}) == 2


@pytest.mark.parametrize(
    ("term", "worse"),
    [
        ("w_area", {"support_px": ((11.0, 0.0), (19.0, 0.0))}),
        ("w_energy", {"turned_deg": 0.5}),
        ("w_distance", {"centroid_px": (16.0, 2.0)}),
        ("w_normal", {"support_px": ((10.0, 0.0), (20.0, 1.0))}),
    ],
)
def test_towers_weigh_four_terms(term, worse):
    offers = offered(1, **worse), offered(2)
    assert chosen("towers", *offers) == 2
    assert chosen("towers", *offers, **{term: 0.0}) == 1  # then they are equal


def test_towers_weigh_as_their_source():
    """The worst of one term each: the one of the smallest weight is taken."""
    offers = [
        offered(1, turned_deg=9.0),
        offered(2, support_px=((13.0, 0.0), (17.0, 0.0))),
        offered(3, support_px=((10.0, 0.0), (20.0, 9.0))),
        offered(4, centroid_px=(18.0, 2.0)),
    ]
    order = []
    while len(left := [offer for offer in offers if offer.stone_id not in order]) > 1:
        order.append(chosen("towers", *left))
    assert order == [4, 2, 3]  # .094, .179, .254; .472 is left


def test_stones_without_support_are_the_last_of_a_tower():
    hanging = offered(1, support_px=None)
    sloping = offered(2, support_px=((10.0, 0.0), (11.0, 5.0)), centroid_px=(18.0, 2.0))
    assert chosen("towers", hanging, sloping) == 2
    assert chosen("towers", hanging, offered(2)) == 2
    assert chosen("towers", hanging, offered(2), w_area=0.0) == 2
    assert lacking_support(hanging) == 1.0
    assert slope_rad(offered(support_px=((3.0, 1.0), (3.0, 1.0)))) == 0.0


finite = st.floats(0.0, 1.0)


@st.composite
def offers(draw):
    """Some candidates of different stones."""
    made = []
    for stone_id in range(1, draw(st.integers(1, 6)) + 1):
        names = ("SF", "LFR", "GDS", "NHR", "IWR", "IS", "LLC")
        indices = {name: draw(finite) for name in names} | {"boundary": draw(st.booleans())}
        left, right = sorted(draw(st.tuples(st.floats(10, 20), st.floats(10, 20))))
        support = draw(st.sampled_from([None, ((left, 0.0), (right, draw(finite)))]))
        turned = draw(st.floats(0, 15))
        height = draw(st.floats(1, 30))
        made.append(
            offered(stone_id, indices=indices, support_px=support, turned_deg=turned, **low(height))
        )
    return made


@repeatable(40)
@given(offers=offers(), name=st.sampled_from([n for n in BUILT_IN if n != "random"]))
def test_the_order_of_the_candidates_does_not_matter(offers, name):
    assert chosen(name, *offers) in {offer.stone_id for offer in offers}


@repeatable(40)
@given(offers=offers())
def test_what_filters_choose_passes_what_any_of_the_first_filter_passes(offers):
    stone_id = chosen("filter", *offers)
    borne = {o.stone_id for o in offers if o.support_width_px >= 0.3 * o.width_px}
    assert not borne or stone_id in borne
    tight = [o for o in offers if o.stone_id in borne and o.indices.third >= 0.2]
    tight = [o for o in tight if o.indices.NHR <= 0.25 and o.indices.LFR >= 0.7]
    if tight:
        (taken,) = (o for o in offers if o.stone_id == stone_id)
        assert taken.centroid_px[1] <= min(o.centroid_px[1] for o in tight)
