"""The site: working size and units."""

import math

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.model.site import Site, working_px


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
    for px_per_m in (0.0, -400.0, math.nan, math.inf):
        with pytest.raises(UsageError, match=r"E138 --px-per-m: .* is not a scale"):
            Site.from_source(560, 160, px_per_m=px_per_m)
