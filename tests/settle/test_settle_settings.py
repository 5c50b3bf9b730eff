"""Settings of settling: what is refused."""

from typing import Any

import pytest

from drystone.settle.settings import SettleSettings


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"method": "glue"}, "unknown way of settling 'glue'"),
        ({"clearance_px": 0.0}, "clearance must be above 0"),
        ({"clearance_px": 0.051}, "contact_px at least twice"),
        ({"contact_px": 0.019}, "contact_px at least twice"),
        ({"outline_px": 0.0}, "clearance must be above 0"),
        *(
            ({name: -0.1}, "must not be negative")
            for name in ("lean", "margin", "max_turn_deg", "max_shift", "apart", "beyond_px")
        ),
        *(({name: 0}, "must be positive") for name in ("max_steps", "spots", "shortlist")),
        ({"per_stone": 0}, "must be positive"),
    ],
)
def test_what_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        SettleSettings(**changes)


@pytest.mark.parametrize(
    "changes",
    [
        {"method": "pivot"},
        {"clearance_px": 0.05},
        {"lean": 0.0, "margin": 0.0, "max_turn_deg": 0.0, "max_shift": 0.0, "apart": 0.0},
        {"beyond_px": 0.0},
        {"max_steps": 1, "spots": 1, "shortlist": 1, "per_stone": 1},
    ],
)
def test_what_is_allowed(changes: dict[str, Any]) -> None:
    settings = SettleSettings(**changes)
    assert all(getattr(settings, name) == value for name, value in changes.items())
