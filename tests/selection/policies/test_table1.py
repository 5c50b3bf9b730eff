"""The systems of Table 1: seven different choices, each with switches for what it looks at."""

import numpy as np
import pytest

from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.policies.registry import policy_named
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.policies.table1 import MARKS
from tests.selection.offers import offered

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


def chosen(name, *offers, **switches):
    policy = policy_named(name, PolicySettings(**switches), SelectionSettings())
    return policy.choose(offers, np.random.default_rng(0))


@pytest.mark.parametrize("name", ["johns", "lambert", "liu2021", "thangavelu"])
@pytest.mark.parametrize("part", BETTER)
def test_a_policy_looks_at_its_components_and_at_no_others(name, part):
    end = {"boundary": True} if part == "sloping" else {}
    # The other one is lower, which decides where no component does.
    worse = {"turned_deg": 5.0, "support_px": ((14.0, 0.0), (16.0, 0.0))}
    plain = offered(1, **worse, indices=end, centroid_px=(15.0, 1.0))
    good = BETTER[part]
    better = offered(2, **{**worse, **good, "indices": {**end, **good.get("indices", {})}})
    assert chosen(name, plain, better) == (part in MARKS[name])
    assert chosen(name, plain, better, **{part: False}) == 0


def test_thangavelu_counts_the_stones_that_are_touched():
    bonded = offered(1, indices={"IWR": 1.0}, touches=(4,))
    touching = offered(2, indices={"IWR": 0.0}, touches=(4, 5))
    assert chosen("thangavelu", bonded, touching) == 1
    assert chosen("liu2021", bonded, touching) == 0


def test_learned_values_leave_out_what_a_system_does_not_have():
    plain, strong = offered(1), offered(2, indices={"LLC": 0.9})
    assert chosen("liu2018", plain, strong) == 1
    assert chosen("menezes", plain, strong) == chosen("liu2018", plain, strong, lateral=False) == 0
