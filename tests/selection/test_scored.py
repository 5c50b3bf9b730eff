"""Selecting by cost: our own rule."""

import dataclasses

import pytest

from drystone.selection.scored import Craft, ScoreSettings, cheapest_first, craft_cost

NOTHING = Craft(**dict.fromkeys((field.name for field in dataclasses.fields(Craft)), 0.0))


@pytest.mark.parametrize("name", [field.name for field in dataclasses.fields(Craft)])
def test_each_cost_has_its_own_weight_and_bulk_is_a_bonus(name):
    weights = ScoreSettings(**{name: 3.0})
    cost = craft_cost(dataclasses.replace(NOTHING, **{name: 2.0}), weights)
    assert cost == (-6.0 if name in ("area", "thickness") else 6.0)


def test_equal_costs_go_by_their_keys():
    costs, keys = [0.3, 0.1 + 0.2, -1.0, 0.3], [(9.0,), (2.0,), (5.0,), (1.0,)]
    assert cheapest_first(costs, keys) == [2, 3, 1, 0]


def test_at_least_one_action_is_analysed():
    with pytest.raises(ValueError, match="analysed must be at least 1"):
        ScoreSettings(analysed=0)
