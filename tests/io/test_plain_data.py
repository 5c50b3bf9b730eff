"""Dataclasses are JSON and the same again; what is of another type is refused."""

import json
import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.io.json_text import as_json, from_plain
from tests.strategies import repeatable


@dataclass(frozen=True)
class Inner:
    side: Literal["left", "right"]
    place: tuple[int, int] | tuple[float, float]


@dataclass(frozen=True)
class Outer:
    name: str
    count: int
    share: float
    sure: bool
    maybe: Inner | None
    many: tuple[Inner, ...]


ONE = Outer("a", 1, 0.1, True, None, (Inner("left", (1, 2)), Inner("right", (1.0, 2.5))))


def again(value):
    return from_plain(type(value), json.loads(as_json(value)))


@repeatable(30)
@given(st.floats(allow_nan=False), st.integers(), st.text())
def test_values_are_the_same_again(share, count, name):
    value = Outer(name, count, share, False, Inner("left", (share, -share)), ONE.many)
    found = again(value)
    assert found == value
    assert math.copysign(1.0, found.share) == math.copysign(1.0, share)
    assert [type(one.place[0]) for one in found.many] == [int, float]
    assert as_json(Inner("left", (np.int64(3), np.float64(4)))) == '{"side":"left","place":[3,4.0]}'


@pytest.mark.parametrize(
    "change",
    [
        {"name": 3},
        {"count": 1.0},
        {"share": True},
        {"share": float("nan")},
        {"share": 10**400},
        {"sure": 1},
        {"maybe": {"side": "left"}},
        {"maybe": {"side": ["left"], "place": [1, 2]}},
        {"maybe": {"side": "left", "place": [1, 2, 3]}},
        {"maybe": {"side": "left", "place": {"0": 1, "1": 2}}},
        {"many": [None]},
        {"more": 1},
    ],
)
def test_what_is_of_another_type_is_refused(change):
    data = json.loads(as_json(ONE)) | change
    with pytest.raises(ValueError, match=r"this is no|is not of type"):
        from_plain(Outer, data)
    data = json.loads(as_json(ONE))
    del data[next(iter(change.keys() & data.keys()), "name")]
    with pytest.raises(ValueError, match="this is not of type Outer"):
        from_plain(Outer, data)
