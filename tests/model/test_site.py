"""The site: working size and units."""

import math

import pytest

from drystone.errors import UsageError
from drystone.model.site import Site, working_px


@pytest.mark.parametrize(
    ("length", "scale", "expected"), [(5, 0.5, 3), (7, 0.5, 4), (1445, 0.2, 289), (383, 0.3, 115)]
)
def test_halves_round_up(length, scale, expected):
    assert working_px(length, scale) == expected


def test_units():
    assert Site.from_source(560, 160, 0.5).units_per_px == 2.0
    assert Site.from_source(560, 160, 0.5, px_per_m=400.0).units_per_px == 0.005


def test_a_site_of_too_few_or_too_many_pixels_is_refused_with_the_cure():
    with pytest.raises(UsageError, match=r"E121 --wall: .*Give a larger wall"):
        Site.from_source(2, 160, 0.2)
    with pytest.raises(UsageError, match=r"E121.*--scale"):
        Site.from_source(9999, 9999)
    assert Site.from_source(9999, 9999, scale=0.5).width_px == 5000


def test_numbers_that_are_no_size_or_scale_are_refused():
    for size in ((math.nan, 20), (60, math.inf)):
        with pytest.raises(UsageError, match=r"E127 --wall: .* is not a wall size"):
            Site.from_source(*size)
    for px_per_m in (0.0, -400.0, math.nan, math.inf):
        with pytest.raises(UsageError, match=r"E138 --px-per-m: .* is not a scale"):
            Site.from_source(560, 160, px_per_m=px_per_m)


def test_outlines_must_stay_within_the_lengths_in_source_px():
    # 26 working px are 52 source px, but the wall is 51 wide.
    site = Site.from_source(51, 33.4, 0.5)
    assert (site.width_px, site.height_px) == (26, 17)
    assert site.extent_px == (51, 33.4)
    assert Site(26, 17, 0.5).extent_px == (52.0, 34.0)
    assert Site.from_source(51, 33.4, 0.5, px_per_m=400.0).extent_px == (51, 33.4)
