"""Images of walls beside their plans."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from drystone.io.walls import shows


def plan(geometry: str) -> Any:
    """Stones 3 and 7, and wedge 9."""
    stones = (SimpleNamespace(stone=3), SimpleNamespace(stone=7))
    wedges = (SimpleNamespace(id=9),)
    return SimpleNamespace(
        settings={"geometry": geometry},
        steps=stones + wedges,
        stone_steps=stones,
        wedge_steps=wedges,
    )


@pytest.mark.parametrize(
    ("seen", "raster", "exact"),
    [
        ([3, 7, 9], True, True),
        ([3, 7], False, True),  # a wedge that fills no pixel
        ([3, 9], False, False),
        ([3, 7, 8], False, False),
        ([3, 7, 8, 9], False, False),
    ],
)
def test_an_image_shows_what_is_in_the_plan(seen: list[int], raster: bool, exact: bool) -> None:
    labels = np.array([[0, *seen]], np.uint32)
    assert shows(labels, plan("raster")) is raster
    assert shows(labels, plan("exact")) is exact
