"""The site: working size and units."""

import math

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.io.plan_json import plan_schema
from drystone.model.site import LARGEST, LONGEST, SHORTEST, Site, working_px


def test_halves_round_up_and_outlines_must_stay_within_the_lengths_in_source_px():
    for length, scale, expected in ((5, 0.5, 3), (7, 0.5, 4), (1445, 0.2, 289), (383, 0.3, 115)):
        assert working_px(length, scale) == expected
    # 26 working px are 52 source px, but the wall is 51 wide.
    site = Site.from_source(51, 33.4, 0.5)
    assert (site.width_px, site.height_px, site.units_per_px) == (26, 17, 2.0)
    assert site.extent_px == (51, 33.4)
    assert Site(26, 17, 0.5).extent_px == (52.0, 34.0)
    metric = Site.from_source(51, 33.4, 0.5, px_per_m=400.0)
    assert (metric.extent_px, metric.units_per_px) == ((51, 33.4), 0.005)
    short = Site.from_source(np.float32(270), np.int16(135), 0.5, px_per_m=np.float32(300))
    assert {type(one) for one in (*short.extent_px, short.scale, short.px_per_m)} == {float}


def test_sizes_and_scales_that_are_none_are_refused_with_the_cure():
    with pytest.raises(UsageError, match=r"E121 --wall: .*Give a larger wall"):
        Site.from_source(2, 160, 0.2)
    with pytest.raises(UsageError, match=r"E121.*--scale"):
        Site.from_source(9999, 9999)
    assert Site.from_source(9999, 9999, scale=0.5).width_px == 5000
    for size in ((math.nan, 20), (60, math.inf)):
        with pytest.raises(UsageError, match=r"E127 --wall: .* is not a wall size"):
            Site.from_source(*size)
    for made in (Site, Site.from_source):
        for px_per_m in (0.0, -400.0, math.nan, math.inf):
            with pytest.raises(UsageError, match=r"E138 --px-per-m: .* is not a scale"):
                made(560, 160, px_per_m=px_per_m)
        for scale in (0.0, -0.5, math.nan, math.inf):
            with pytest.raises(UsageError, match=r"E125 --scale: .* is not above 0"):
                made(560, 160, scale=scale)


@pytest.mark.parametrize(("most", "px_per_m"), [(560, 5e-7), (560, 1e-12), (0.9, 1e9)])
def test_walls_in_metres_that_no_plan_can_have_are_refused_at_once(most, px_per_m):
    with pytest.raises(UsageError, match=r"E138 --px-per-m: with .* px in a metre the wall is"):
        Site.from_source(max(most, 1), most, px_per_m=px_per_m)


def test_the_limits_of_walls_are_those_of_plans():
    parts = plan_schema()["properties"]
    width, area = (parts[a]["properties"][b] for a, b in (("wall", "width"),
                                                          ("metrics", "wedge_area")))  # fmt: skip
    assert (width["minimum"], width["maximum"], area["maximum"]) == (SHORTEST, LONGEST, LARGEST)
