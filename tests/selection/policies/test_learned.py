"""The learned value."""

import json
from dataclasses import replace

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.selection.policies.learned import (
    FEATURES,
    ValueModel,
    features,
    learned,
    model_from_json,
    shipped_model,
)
from tests.selection.offers import OFFER, offered

RNG = np.random.default_rng(0)


def row(name, *offers):
    """Return one feature of some offers."""
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


def test_room_for_half_a_stone_is_a_sliver():
    # A stone of 16 px area has a size of 4 px; the wall is 40 px high and 100 px wide.
    tops = [20.0, 36.0, 37.0, 38.0, 40.0]
    offers = [offered(1, area_px=16.0, top_px=top) for top in tops]
    assert row("headroom", *offers) == [1.0, 1.0, 0.75, 0.5, 0.0]
    assert row("sliver", *offers) == [0.0, 0.0, 0.5, 1.0, 0.0]
    assert row("flush", *offers) == [0.0, 0.0, 0.0, 0.0, 1.0]
    ends = [offered(1, area_px=16.0, left_px=2.0), offered(1, area_px=16.0, right_px=99.0)]
    assert row("end_sliver", *ends) == [1.0, 0.5]


def test_ranks_compare_with_the_others():
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


def worse(**changes):
    indices = {"LFR": 0.5, "GDS": 0.2, "LLC": 0.1} | changes.pop("indices", {})
    return offered(1, indices=indices, **changes)


@pytest.mark.parametrize(
    "bad",
    [
        # Stood on end on top of the course, on a point and a wedge.
        worse(
            left_px=10.0, right_px=14.0, bottom_px=20.0, top_px=30.0, centroid_px=(12.0, 25.0),
            support_px=((12.0, 20.0), (12.5, 20.0)), wedges=1,
        ),
        # The same lying stone, high up, with a gap under it.
        worse(bottom_px=20.0, top_px=24.0, centroid_px=(15.0, 22.0)),
    ],
)  # fmt: skip
def test_weights_of_the_package_prefer_low_tight_places(bad):
    good = offered(1, indices={"LFR": 0.95, "GDS": 0.9, "LLC": 0.6})
    assert learned().choose([bad, good], RNG) == 1
    assert learned().choose([good, bad], RNG) == 0


def test_file_is_read_as_it_was_written():
    model = replace(weighing(LFR=0.1, top=-1 / 3), trained={"seed": 4})
    again = model_from_json(model.to_json(), "w.json")
    assert again == model
    assert again.to_json() == model.to_json()


def edited(**changes):
    return json.dumps(json.loads(shipped_model().to_json()) | changes)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (edited(schema="drystone-values/0"), "version"),
        (edited(weights=dict.fromkeys(FEATURES, 1.0)), "checksum"),
        ("{}", "version None"),
        ("[1]", "not a file of weights"),
        ("{", "not a file of weights"),
    ],
)
def test_refuses_other_files(text, why):
    with pytest.raises(UsageError, match=why) as caught:
        model_from_json(text, "w.json")
    assert caught.value.code == "E152"
    assert caught.value.where == "w.json"


@pytest.mark.parametrize("weights", [(1.0,), (float("nan"),) * len(FEATURES)])
def test_refuses_other_weights(weights):
    with pytest.raises(ValueError, match="finite"):
        ValueModel(weights, {})
