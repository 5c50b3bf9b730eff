"""Ranges and choices of settings are kept, at their very ends."""

import dataclasses
import math
import re

import pytest

from drystone.model.settings import Ranged, ranged
from drystone.planner.settings import PlannerSettings
from drystone.settle.settings import SettleSettings


def test_numbers_out_of_their_range_are_refused():
    default = PlannerSettings()
    groups = [default, *(getattr(default, field.name) for field in dataclasses.fields(default))]
    checked = [(type(one), one) for one in groups if isinstance(one, Ranged)]
    assert len(checked) > 9
    for kind, field in (
        (kind, field) for kind, one in checked for field in dataclasses.fields(one)
    ):
        allowed, step = field.metadata, 1 if isinstance(field.default, int) else 1e-9
        ends = {"least": -step, "above": 0, "most": step, "below": 0}
        wrong = [allowed[name] + away for name, away in ends.items() if name in allowed]
        assert bool(wrong) == bool(allowed)
        for value in (*wrong, math.nan) if wrong else ():  # which is of another type than 1
            with pytest.raises((ValueError, TypeError), match=rf"^{field.name} must be (?!one)"):
                kind(**{field.name: value})


@dataclasses.dataclass(frozen=True)
class Some(Ranged):
    share: float = ranged(0.5, least=0, most=1)
    count: int = ranged(2, above=1, below=4)


def test_the_ends_of_a_range_are_in_it_where_they_are_allowed_and_choices_those_of_the_type():
    assert [Some(share=end).share for end in (0.0, 1.0)] == [0.0, 1.0]
    assert [Some(count=count).count for count in (2, 3)] == [2, 3]
    for count in (1, 4):
        with pytest.raises(ValueError, match=rf"count must be in \(1, 4\), not {count}"):
            Some(count=count)
    with pytest.raises(ValueError, match=re.escape("method must be one of 'energy', 'pivot', not")):
        SettleSettings(method="glue")


@pytest.mark.parametrize(("changes", "said"), [
    ({"settle": {"clearance_px": 0.03}}, "at most 0.25 times `contact_px`, not 0.03"),
    ({"search": {"cold": 0.2}}, "cold must be above 0 and at most `warm`, not 0.2."),
    ({"courses": {"coldest": 5.0}}, "at most `temperature` times `again`, not 5"),
    ({"laying": {"judged": 4}}, "at most `judged`, not 6. Change laying.judged"),
])  # fmt: skip
def test_settings_that_do_not_go_together_are_refused(changes, said):
    with pytest.raises(Exception, match=said):
        PlannerSettings().updated(changes)
