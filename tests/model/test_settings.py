"""Ranges and choices of settings are kept, at their very ends."""

import dataclasses
import math
import re

import pytest

from drystone.model.settings import Ranged, ranged
from drystone.planner.settings import PlannerSettings
from drystone.settle.settings import SettleSettings


def kinds():
    """The settings of the planner that check themselves."""
    default = PlannerSettings()
    groups = [getattr(default, field.name) for field in dataclasses.fields(default)]
    yield from (type(one) for one in (default, *groups) if isinstance(one, Ranged))


RANGES = [
    pytest.param(kind, field, id=f"{kind.__name__}.{field.name}")
    for kind in kinds()
    for field in dataclasses.fields(kind)
    if field.metadata
]


@pytest.mark.parametrize(("kind", "field"), RANGES)
def test_numbers_out_of_their_range_are_refused(kind, field):
    allowed, step = field.metadata, 1 if isinstance(field.default, int) else 1e-9
    ends = {"least": -step, "above": 0, "most": step, "below": 0}
    wrong = [allowed[name] + away for name, away in ends.items() if name in allowed]
    assert wrong
    for value in (*wrong, math.nan):
        with pytest.raises(ValueError, match=rf"^{field.name} must be (?!one)"):
            kind(**{field.name: value})


@dataclasses.dataclass(frozen=True)
class Some(Ranged):
    share: float = ranged(0.5, least=0, most=1)
    count: int = ranged(2, above=1, below=4)


def test_the_ends_of_a_range_are_in_it_where_they_are_allowed():
    assert [Some(share=end).share for end in (0.0, 1.0)] == [0.0, 1.0]
    assert [Some(count=count).count for count in (2, 3)] == [2, 3]
    for count in (1, 4):
        with pytest.raises(ValueError, match=rf"count must be in \(1, 4\), not {count}"):
            Some(count=count)


def test_choices_are_those_of_the_type():
    with pytest.raises(ValueError, match=re.escape("method must be one of 'energy', 'pivot', not")):
        SettleSettings(method="glue")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"settle": {"clearance_px": 0.03}}, "contact_px must be at least 4 times clearance_px"),
        ({"search": {"cold": 0.2}}, "cold must not be above warm"),
        ({"courses": {"coldest": 5.0}}, "coldest must not be above temperature times again"),
        ({"laying": {"judged": 4}}, "analysed must not be above judged"),
    ],
)
def test_settings_that_do_not_go_together_are_refused(changes, said):
    with pytest.raises(Exception, match=said):
        PlannerSettings().updated(changes)
