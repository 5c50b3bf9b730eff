"""Whatever the stones and the site: walls of outlines hold what their plans claim."""

import math
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

from drystone.generate import (
    FourierSettings,
    PolygonSettings,
    RubbleSettings,
    fourier_stones,
    polygon_stones,
    rubble_stones,
)
from drystone.model.outlines import Outlines
from drystone.model.site import Site
from drystone.model.wall import outlined
from drystone.planner.planner import Planner
from drystone.search.plan_wall import plan_wall
from drystone.settle.rest import placed_outline
from tests.planner.scenes import WITH_WEDGES, few_stones, finish, greedy, outlines, proven, rubble
from tests.strategies import repeatable


@st.composite
def stone_sets(draw):
    """A few stones about 20 px wide, some with a hole that is kept."""
    found = draw(whole_stone_sets())
    if draw(st.booleans()):
        return found
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return replace(found, stones=tuple(with_hole(stone, rng) for stone in found))


def with_hole(stone, rng):
    """A round hole anywhere in a stone, up to two px from its rim."""
    depth = ndimage.distance_transform_edt(np.pad(stone.mask, 1))[1:-1, 1:-1]
    row, col = rng.choice(np.argwhere(depth >= depth.max() * rng.uniform(0.4, 1.0)))
    y, x = np.indices(stone.mask.shape)
    return replace(stone, mask=stone.mask & (np.hypot(y - row, x - col) > depth[row, col] - 2))


@st.composite
def whole_stone_sets(draw):
    """A few stones about 20 px wide."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    count = draw(st.integers(2, 5))
    kind = draw(st.sampled_from(["polygon", "concave", "fourier", "rubble"]))
    if kind == "fourier":
        round_ones = FourierSettings(count=count, smallest_radius_px=8, largest_radius_px=13)
        return fourier_stones(round_ones, rng)
    if kind == "rubble":
        return rubble_stones(RubbleSettings(count=count, width_px=90, height_px=40, courses=2), rng)
    flat = PolygonSettings(count=count, width_px=28, height_px=18, convex=kind == "polygon")
    return polygon_stones(flat, rng)


@st.composite
def cases(draw):
    """Stones, a site in source px, its scale, and settings."""
    changes = {
        "search": {"budget": draw(st.sampled_from([1, 1, 2]))},
        "two_sided": draw(st.booleans()),
        "skip_too_large": True,
        "settle": {"method": draw(st.sampled_from(["energy", "pivot"]))},
        "stabilise": {"method": draw(st.sampled_from(["both", "wedge", "rotation", "none"]))},
        "wedge": draw(st.sampled_from([{}, {"height": 0.6, "area": 0.4}])),
        "selection_rule": draw(st.sampled_from(["score", "algorithm2"])),
        "orientations": draw(st.sampled_from(["quarter", "sf", "45deg"])),
        "mu": draw(st.sampled_from([0.58, 0.3])),
    }
    size = draw(st.floats(45.0, 80.0)), draw(st.floats(28.0, 50.0))
    scale = draw(st.sampled_from([1.0, 0.5, 0.37]))
    return draw(stone_sets()), size, scale, greedy(changes)


def check(result, stones, settings, site):
    """See that a plan is true, that outlines keep apart, are the stones' own, and in the wall."""
    report = proven(result, stones)
    assert (report.overlap_depth, report.buried) == (0.0, ())
    assert len(report.prefixes) == len(result.wall.groups)
    assert all(p.alpha_left and p.alpha_right for p in report.prefixes)
    shapes, filled = [], 0
    for group in result.wall.groups:
        placement = group.placement
        outline = placement.posed.stone.outline_within(settings.settle.outline_px)
        x, y, corners = (
            placement.exact.x_px, placement.exact.y_px, placement.exact.corners
        )  # fmt: skip
        assert np.array_equal(placed_outline(outline, placement.posed.angle_deg, x, y), corners)
        shapes += [shapely.Polygon(c) for _, c in outlined(placement, group.wedges)]
        filled += placement.posed.area_px + sum(wedge.area_px for wedge in group.wedges)
    assert filled == np.count_nonzero(result.wall.labels)  # every pixel was filled by one of them
    for one, other in combinations(shapes, 2):
        assert one.distance(other) >= 0.49 * settings.settle.clearance_px
    (width, height), beyond = site.extent_px, settings.settle.beyond_px
    for shape in shapes:
        left, low, right, high = shape.bounds
        assert low >= 0.49 * settings.settle.clearance_px
        assert -beyond <= left < right <= width + beyond
        assert high <= height + beyond


@repeatable(16)
@given(case=cases(), seed=st.integers(0, 1000))
def test_every_plan_is_true(case, seed):
    stones, (width, height), scale, settings = case
    result = plan_wall(stones, width, height, seed=seed, settings=settings, scale=scale)
    check(result, stones, settings, Site.from_source(width, height, scale))
    assert result.notices == ()
    if settings.stabilise.method in ("wedge", "none"):
        assert all(p.rotation_moves == 0 for p in result.wall.placements)
    if settings.stabilise.method in ("rotation", "none"):
        assert result.wall.wedges == ()


WEDGES = greedy({**WITH_WEDGES, "search": {"budget": 4}})
WALL_PX = (84.0, 34.0)
SITE = Site.from_source(*WALL_PX, 0.5)


@pytest.mark.parametrize(("width", "px_per_m"), [(51.0, 137.3), (61.50156889234596, None)])
def test_a_plan_is_measured_by_its_own_size_whatever_its_digits_and_unit(width, px_per_m):
    """51 px are 25.5 working px; in metres and back they are a little less."""
    assert 51.0 / 137.3 * 137.3 < 51.0
    stones = few_stones()
    result = plan_wall(stones, width, 53, settings=greedy(), scale=0.5, px_per_m=px_per_m)
    assert result.wall.labels.shape[1] == math.floor(width / 2 + 0.5)
    proven(result, stones)


def test_walls_with_wedges_are_restored_as_they_were():
    first = finish(Planner(few_stones(), SITE, seed=3, settings=WEDGES))
    assert first.build.wall.wedges
    again = Planner(few_stones(), SITE, seed=3, settings=WEDGES)
    again.restore(first.build.wall, {})
    assert outlines(again) == outlines(first)
    assert again.workshop.next_wedge(again.build) == 6 + len(first.build.wall.wedges)
    for state, other in zip(again.build.states(), first.build.states(), strict=True):
        assert isinstance(state.wall.outlines, Outlines)
        for made, sought in ((state.model, other.model), (state.sturdy_model, other.sturdy_model)):
            assert made.blocks == sought.blocks
            assert [i.points.tobytes() for i in made.interfaces] == [
                i.points.tobytes() for i in sought.interfaces
            ]
            assert [i.mu for i in made.interfaces] == [i.mu for i in sought.interfaces]


def test_walls_of_a_search_are_true():
    stones = few_stones()
    result = plan_wall(stones, *WALL_PX, seed=3, settings=WEDGES, scale=0.5)
    check(result, stones, WEDGES, SITE)
    assert result.wall.wedges


def test_walls_that_are_no_whole_number_of_columns_take_stones_from_both_ends():
    # The last .45 px of the wall have no column, and stones at its end fill half of one there.
    stones, site = rubble(2, 10), Site.from_source(100.45, 36.0)
    result = plan_wall(stones, 100.45, 36.0, seed=1, settings=greedy())
    check(result, stones, greedy(), site)
    assert result.wall.labels.shape == (36, 100)
    corners = [p.settled.corners for p in result.wall.placements if p.settled is not None]
    assert max(float(one[:, 0].max()) for one in corners) > 100.5
    assert sum(p.side == "right" for p in result.wall.placements) > 1
