"""Settings of settling: what is refused."""

from typing import Any

import pytest

from drystone.settle.settings import SettleSettings


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"method": "glue"}, "unknown way of settling 'glue'"),
        ({"clearance_px": 0.00009}, "clearance_px must be .0001 or more"),
        ({"clearance_px": 0.0251}, "contact_px 4 times it"),
        ({"contact_px": 0.039}, "contact_px 4 times it"),
        ({"contact_px": 0.51}, "to .5"),
        ({"outline_px": 0.0}, "outline_px must be in"),
        ({"outline_px": 0.51}, "outline_px must be in"),
        ({"beyond_px": -0.1}, "beyond_px in"),
        ({"beyond_px": 1.1}, "beyond_px in"),
        ({"steep": -0.1}, "steep must be in"),
        ({"steep": 1.0}, "steep must be in"),
        *(
            ({name: -0.1}, "must not be negative")
            for name in ("lean", "margin", "max_turn_deg", "max_shift", "apart")
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
        {"clearance_px": 0.025},
        {"lean": 0.0, "margin": 0.0, "max_turn_deg": 0.0, "max_shift": 0.0, "apart": 0.0},
        {"beyond_px": 0.0},
        {"max_steps": 1, "spots": 1, "shortlist": 1, "per_stone": 1},
    ],
)
def test_what_is_allowed(changes: dict[str, Any]) -> None:
    settings = SettleSettings(**changes)
    assert all(getattr(settings, name) == value for name, value in changes.items())
