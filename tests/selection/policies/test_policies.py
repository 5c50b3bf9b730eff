"""Policies by name pick what they should: by hand, as slow twins, and as Table 1 says."""

import json
import math
from collections import Counter
from dataclasses import replace
from importlib.metadata import EntryPoint, EntryPoints
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import UsageError
from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.policies import registry
from drystone.selection.policies.learned import (
    FEATURES,
    ValueModel,
    features,
    learned,
    model_from_json,
    shipped_model,
)
from drystone.selection.policies.registry import BUILT_IN, GROUP, policy_named, rule_of
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.policies.table1 import MARKS
from tests.selection.offers import OFFER, offered
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


def largest_sum(offers, at):
    """LLC, NHR, IWR or IS, GDS, LFR and SF; nothing is filtered."""

    def worth(one):
        of = one.indices
        third = of.IS if of.boundary else of.IWR
        return round(of.LLC - of.NHR + third + of.GDS + of.LFR + at.w_sf * of.SF, 9)

    return min(offers, key=lambda one: (-worth(one), one.stone_id)).stone_id


TWINS = {
    "lowest": first_lowest, "scalarised": largest_sum, "filter": sieved, "towers": cheapest_tower
}  # fmt: skip

SETTINGS = {
    "min_support": (0.3, 0.25),
    "min_interlocking": (0.2, 0.5),
    "max_step": (0.25, 0.05),
    "min_filling": (0.7, 0.85),
    "min_slope": (0.0, 0.2),
    "w_sf": (1.0, 0.5),
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
    "LLC": (0.1, 0.5),
    "GDS": (0.5, 0.6),
    "SF": (0.8, 0.9),
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


BETTER = {
    "packing": {"indices": {"LFR": 0.95}},
    "course": {"indices": {"NHR": 0.0}},
    "interlocking": {"indices": {"IWR": 0.9}, "touches": (5, 6, 7)},
    "footing": {"support_px": ((10.0, 0.0), (20.0, 0.0))},
    "sloping": {"indices": {"IS": 0.5}},
    "gravity": {"turned_deg": 0.0},
    "lateral": {"indices": {"LLC": 0.9}},
}
"""What makes an offer better in a component."""


@pytest.mark.parametrize("name", ["johns", "lambert", "liu2021", "thangavelu"])
@pytest.mark.parametrize("part", BETTER)
def test_a_policy_looks_at_its_components_and_at_no_others(name, part):
    end = {"boundary": True} if part == "sloping" else {}
    # The other one is lower, which decides where no component does.
    worse = {"turned_deg": 5.0, "support_px": ((14.0, 0.0), (16.0, 0.0))}
    plain = offered(1, **worse, indices=end, centroid_px=(15.0, 1.0))
    good = BETTER[part]
    better = offered(2, **{**worse, **good, "indices": {**end, **good.get("indices", {})}})
    assert chosen(name, plain, better) == 1 + (part in MARKS[name])
    assert chosen(name, plain, better, **{part: False}) == 1


def test_thangavelu_counts_touched_stones_and_learned_values_leave_out_what_a_system_lacks():
    bonded = offered(1, indices={"IWR": 1.0}, touches=(4,))
    touching = offered(2, indices={"IWR": 0.0}, touches=(4, 5))
    assert chosen("thangavelu", bonded, touching) == 2
    assert chosen("liu2021", bonded, touching) == 1
    plain, strong = offered(1), offered(2, indices={"LLC": 0.9})
    assert chosen("liu2018", plain, strong) == 2
    assert chosen("menezes", plain, strong) == chosen("liu2018", plain, strong, lateral=False) == 1


RNG = np.random.default_rng(0)


def row(name, *offers):
    return [float(value) for value in features(offers)[:, FEATURES.index(name)]]


def weighing(**weights):
    """Return a model of some weights, the others 0."""
    return ValueModel(tuple(weights.get(name, 0.0) for name in FEATURES), {})


def test_features_are_shares_of_wall_and_stone():
    # 100 x 40 wall; a stone of 10 x 4 on the ground, 10 px from the left end, borne all along.
    expected = {
        "LFR": 0.8, "GDS": 0.5, "NHR": 0.1, "IWR": 0.4, "IS": 0.0, "LLC": 0.5, "boundary": 0.0,
        "bottom": 0.0, "centroid": 0.05, "top": 0.1, "top_squared": 0.01, "headroom": 1.0,
        "sliver": 0.0, "flush": 0.0, "lying": 10 / 14, "from_end": 0.1, "end_sliver": 0.0,
        "support": 1.0, "off_centre": 0.0, "slope": 0.0, "turned": 0.0,
        "wedges": 0.0, "top_rank": 0.0, "LFR_rank": 0.0, "LLC_rank": 0.0,
    }  # fmt: skip
    assert dict(zip(FEATURES, features([OFFER])[0].tolist(), strict=True)) == pytest.approx(
        expected
    )


def test_features_stay_within_their_bounds():
    wild = offered(
        indices={"NHR": 7.0, "LLC": 9.0, "IS": -1.0, "boundary": True},
        wedges=5, turned_deg=180.0, support_px=None, top_px=400.0,
    )  # fmt: skip
    found = features([wild, OFFER])
    assert np.abs(found).max() == 1.0
    assert row("slope", wild) == row("off_centre", wild) == [1.0]
    assert row("IWR", wild) == [0.0]
    assert row("IS", wild) == [-1.0]


def test_room_for_half_a_stone_is_a_sliver_and_ranks_compare_with_the_others():
    # A stone of 16 px area has a size of 4 px; the wall is 40 px high and 100 px wide.
    tops = [20.0, 36.0, 37.0, 38.0, 40.0]
    offers = [offered(1, area_px=16.0, top_px=top) for top in tops]
    assert row("headroom", *offers) == [1.0, 1.0, 0.75, 0.5, 0.0]
    assert row("sliver", *offers) == [0.0, 0.0, 0.5, 1.0, 0.0]
    assert row("flush", *offers) == [0.0, 0.0, 0.0, 0.0, 1.0]
    ends = [offered(1, area_px=16.0, left_px=2.0), offered(1, area_px=16.0, right_px=99.0)]
    assert row("end_sliver", *ends) == [1.0, 0.5]
    low, high = offered(1, top_px=4.0), offered(2, top_px=8.0)
    highest = offered(3, top_px=9.0)
    assert row("top_rank", high, low, highest) == [0.5, 0.0, 1.0]
    assert row("top_rank", low, replace(low, stone_id=2), high) == [0.0, 0.0, 1.0]
    assert features([]).shape == (0, len(FEATURES))


def test_the_largest_value_is_chosen():
    offers = [offered(1), offered(2, indices={"LFR": 0.9}), offered(3, indices={"LLC": 0.9})]
    assert learned(weighing(LFR=1.0)).choose(offers, RNG) == 1
    assert learned(weighing(LLC=1.0)).choose(offers, RNG) == 2
    assert learned(weighing(LLC=-1.0, LFR=-5.0)).choose(offers, RNG) == 0
    assert weighing(LFR=2.0).values(offers).tolist() == pytest.approx([1.6, 1.8, 1.6])


def test_weights_of_the_package_prefer_low_tight_places():
    good = offered(1, indices={"LFR": 0.95, "GDS": 0.9, "LLC": 0.6})
    worse = {"indices": {"LFR": 0.5, "GDS": 0.2, "LLC": 0.1}, "bottom_px": 20.0}
    # Stood on end on top of the course, on a point and a wedge.
    stood = {"left_px": 10.0, "right_px": 14.0, "top_px": 30.0, "centroid_px": (12.0, 25.0),
             "support_px": ((12.0, 20.0), (12.5, 20.0)), "wedges": 1}  # fmt: skip
    # The same lying stone, high up, with a gap under it.
    lying = {"top_px": 24.0, "centroid_px": (15.0, 22.0)}
    for bad in (offered(1, **worse, **stood), offered(1, **worse, **lying)):
        assert learned().choose([bad, good], RNG) == 1
        assert learned().choose([good, bad], RNG) == 0


def test_file_is_read_as_it_was_written_and_weights_are_finite():
    model = replace(weighing(LFR=0.1, top=-1 / 3), trained={"seed": 4})
    again = model_from_json(model.to_json(), "w.json")
    assert again == model
    assert again.to_json() == model.to_json()
    for weights in ((1.0,), (float("nan"),) * len(FEATURES)):
        with pytest.raises(ValueError, match="finite"):
            ValueModel(weights, {})


def test_refuses_other_files():
    shipped = json.loads(shipped_model().to_json())
    for text, why in (
        (json.dumps(shipped | {"schema": "drystone-values/0"}), "version"),
        (json.dumps(shipped | {"weights": dict.fromkeys(FEATURES, 1.0)}), "checksum"),
        ("{}", "version None"),
        ("[1]", "not a file of weights"),
        ("{", "not a file of weights"),
    ):
        with pytest.raises(UsageError, match=why) as caught:
            model_from_json(text, "w.json")
        assert (caught.value.code, caught.value.where) == ("E152", "w.json")


class First:
    """A policy of another package."""

    def choose(self, candidates, rng): ...


class NeedsMore(First):
    def __init__(self, more): ...


@pytest.fixture
def installed(monkeypatch):
    """Pretend that packages with some entry points are installed."""

    def install(*given):
        points = EntryPoints(EntryPoint(name, value, GROUP) for name, value in given)
        monkeypatch.setattr(registry, "entry_points", points.select)

    return install


def named(name):
    return policy_named(name, PolicySettings(), SelectionSettings())


def test_those_built_in_and_those_of_other_packages_are_there(installed):
    ours = f"{__name__}:First"
    installed(("first", ours), ("other", "nowhere:Other"), ("random", ours))
    assert [rule_of(name) for name in (*BUILT_IN, "first")] == [*BUILT_IN, "first"]
    assert rule_of("paper") == "algorithm2"
    policy = named("first")
    assert type(policy).__name__ == "First"
    assert named("first") is not policy  # it is made anew
    # Names of ours cannot be taken.
    assert type(named("random")).__module__.startswith("drystone.")
    with pytest.raises(UsageError, match="E146"):
        named("paper")  # it is the planner's own rule


@pytest.mark.parametrize("name", ["fist", "algorithm2", "score", "First", " "])
def test_unknown_ones_are_refused_with_the_known_ones(name, installed):
    installed(
        ("first", f"{__name__}:First"),
        ("score", f"{__name__}:First"),
        ("paper", f"{__name__}:First"),
    )
    for find in (rule_of, named):
        with pytest.raises(UsageError, match="E146") as caught:
            find(name)
        assert repr(name) in caught.value.what
        known = f"paper, {', '.join(BUILT_IN)}, first."
        asked = "Did you mean `first`? " if name in ("fist", "First") else ""
        assert caught.value.cure == f"{asked}Choose one of {known}"


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("no_such_module:First", "cannot be loaded: ModuleNotFoundError"),
        (f"{__name__}:Second", "cannot be loaded: AttributeError"),
        (f"{__name__}:NeedsMore", "cannot be loaded: TypeError"),
        (f"{__name__}:RNG", "cannot be loaded: TypeError"),
        ("sys:exit", "cannot be loaded: SystemExit"),
        ("builtins:dict", "has no method `choose`"),
    ],
)
def test_broken_ones_are_named(value, said, installed):
    installed(("mine", value))
    with pytest.raises(UsageError, match="E147 --policy: the policy 'mine' ") as caught:
        named("mine")
    assert said in caught.value.what


def test_a_name_in_two_packages_is_refused(installed):
    installed(("mine", f"{__name__}:First"), ("mine", "other:First"))
    with pytest.raises(UsageError, match=r"E147 .*several packages.*other:First"):
        named("mine")
    installed(("mine", f"{__name__}:First"), ("mine", f"{__name__}:First"))
    assert named("mine")
