"""Selecting by cost: our own rule."""

import dataclasses

import pytest

from drystone.selection.scored import Craft, ScoreSettings, craft_cost

NOTHING = Craft(**dict.fromkeys((field.name for field in dataclasses.fields(Craft)), 0.0))


@pytest.mark.parametrize("name", [field.name for field in dataclasses.fields(Craft)])
def test_each_cost_has_its_own_weight_and_bulk_is_a_bonus(name):
    weights = ScoreSettings(**{name: 3.0})
    cost = craft_cost(dataclasses.replace(NOTHING, **{name: 2.0}), weights)
    assert cost == (-6.0 if name in ("area", "thickness") else 6.0)
