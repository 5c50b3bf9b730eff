"""What a policy sees of a candidate, on pixels and on outlines."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.model.site import Site
from drystone.planner.build import Build
from drystone.planner.choose import choose_by_policy
from drystone.planner.offers import offer, support_px
from drystone.planner.planner import Planner
from drystone.selection.policies.settings import PolicySettings
from drystone.statics.model import Interface
from tests.planner.scenes import RUBBLE_SITE, blocks, finish, greedy, of_rubble, rubble

EXACT = greedy()
RASTER = greedy({"geometry": "raster"})


@pytest.mark.parametrize("scale", [1.0, 0.5])
@pytest.mark.parametrize("settings", [EXACT, RASTER])
def test_an_offer_is_where_the_stone_is_in_working_px(settings, scale):
    site = Site.from_source(100, 36, scale)
    for candidate in finish(Planner(rubble(1), site, seed=2, settings=settings)).build.actions:
        seen, placement = offer(candidate, site), candidate.stabilised.placement
        assert (seen.wall_width_px, seen.wall_height_px) == (site.width_px, site.height_px)
        assert (seen.stone_id, seen.side) == (candidate.stone_id, candidate.side)
        assert seen.indices is candidate.indices
        assert seen.wedges == len(candidate.stabilised.wedges)
        assert seen.centroid_px == placement.centroid(site.height_px)
        assert seen.left_px < seen.centroid_px[0] < seen.right_px
        assert seen.bottom_px < seen.centroid_px[1] < seen.top_px
        # A pixel that an outline covers by less than half is not filled.
        rows, cols = placement.window
        assert seen.left_px == pytest.approx(cols.start, abs=1)
        assert seen.right_px == pytest.approx(cols.stop, abs=1)
        assert seen.top_px == pytest.approx(site.height_px - rows.start, abs=1)
        assert seen.bottom_px == pytest.approx(site.height_px - rows.stop, abs=1)
        assert seen.area_px == pytest.approx(placement.posed.stone.area_px * scale**2, rel=0.1)
        assert 0 <= seen.turned_deg <= 15
        assert seen.support_px is not None  # all of these rest on something
        (left, low), (right, high) = seen.support_px
        assert seen.left_px - 1e-9 <= left <= right <= seen.right_px + 1e-9
        assert min(low, high) >= seen.bottom_px - 0.2


@pytest.mark.parametrize("geometry", ["raster", "exact"])
def test_the_support_of_blocks(geometry):
    """Two blocks and a third that bridges them: it bears on both, neighbours hold no one."""
    stones = blocks({1: (10, 6), 2: (10, 6), 3: (20, 6)})
    settings = greedy({"geometry": geometry, "order": "given", "two_sided": False, "vary": 0.0})
    settings = settings.updated({"orientations": "sf"})
    actions = finish(Planner(stones, Site(20, 12), settings=settings)).build.actions
    seen = [offer(action, Site(20, 12)) for action in actions]
    assert [one.stone_id for one in seen] == [1, 2, 3]
    supports = [np.array(one.support_px) for one in seen]
    assert supports[0] == pytest.approx(np.array([[0, 0], [10, 0]]), abs=0.4)
    assert supports[1] == pytest.approx(np.array([[10, 0], [20, 0]]), abs=0.4)
    assert supports[2] == pytest.approx(np.array([[0, 6], [20, 6]]), abs=0.4)


def _interface(block, other, points, normal):
    return Interface(block, other, np.array(points), normal)


def test_only_what_bears_from_below_supports():
    beside = _interface(3, 1, [[0.0, 2.0], [0.0, 9.0]], (1.0, 0.05))
    above = _interface(3, 2, [[-9.0, 9.0], [9.0, 9.0]], (0.0, -1.0))
    others = _interface(2, 1, [[-8.0, 1.0], [8.0, 1.0]], (0.0, 1.0))
    below = _interface(3, 1, [[3.0, 1.0], [1.0, 2.0]], (0.0, 1.0))
    turned_round = _interface(1, 3, [[4.0, 3.0], [4.0, 1.0]], (0.6, -0.8))

    def found(*interfaces):
        return support_px(interfaces, 3, 0.5)

    assert found(beside, above, others) is None
    assert found(beside, below, above, others) == ((0.5, 1.0), (1.5, 0.5))
    assert found(below, turned_round) == ((0.5, 1.0), (2.0, 0.5))
    assert found(_interface(3, 0, [[2.0, 0.0]], (0.0, 1.0))) == ((1.0, 0.0), (1.0, 0.0))


def test_only_walls_that_stand_are_offered():
    seen = []

    class Last:
        def choose(self, candidates, rng):  # noqa: ARG002
            seen.append([one.stone_id for one in candidates])
            return len(candidates) - 1

    made = of_rubble(RASTER).build.actions[:5]
    kept = [
        made[0],
        replace(made[1], sturdy=False),
        replace(made[2], indices=replace(made[2].indices, LLC=None)),
        replace(made[3], indices=replace(made[3].indices, LLC=0.0)),
        made[4],
    ]

    def choose(candidates):
        return choose_by_policy(
            [one.proposal for one in candidates],
            lambda _: candidates,
            Last(),
            name="last",
            build=Build.empty(RUBBLE_SITE, 0.58, 100.0),
            settings=PolicySettings(),
            rng=np.random.default_rng(0),
        )

    assert choose(kept) is made[4]
    assert choose(kept[1:4]) is None
    assert seen == [[made[0].stone_id, made[4].stone_id]]
