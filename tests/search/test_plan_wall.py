"""What is no input of `plan_wall` is said, before anything is planned."""

import math
from typing import Any

import numpy as np
import pytest

import drystone as ds


@pytest.fixture(scope="module")
def stones() -> ds.StoneSet:
    """Three bricks."""
    bricks = ds.generate.BrickSettings(count=3, height_px=10, aspect=2)
    return ds.generate.brick_stones(bricks, np.random.default_rng(1))


@pytest.mark.parametrize(
    ("size", "options", "code"),
    [
        ((60, 20), {"seed": -1}, "E138"),
        ((60, 20), {"px_per_m": -400.0}, "E138"),
        ((60, 20), {"scale": math.nan}, "E125"),
        ((60, 20), {"method": "worst"}, "E124"),
        ((math.nan, 20), {}, "E127"),
        ((60, math.inf), {}, "E127"),
        ((0, 20), {}, "E121"),
    ],
)
def test_values_that_make_no_sense(
    stones: ds.StoneSet, size: tuple[float, float], options: dict[str, Any], code: str
) -> None:
    with pytest.raises(ds.DrystoneError) as caught:
        ds.plan_wall(stones, *size, **options)
    assert caught.value.code == code
    assert caught.value.cure


@pytest.mark.parametrize("settings", [{"mu": 0.6}, {}, "best"])
def test_settings_of_the_wrong_type(stones: ds.StoneSet, settings: Any) -> None:
    with pytest.raises(TypeError, match="settings must be PlannerSettings, not "):
        ds.plan_wall(stones, 60, 20, settings=settings)
