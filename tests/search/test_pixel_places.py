"""Where planned stones of pixels are put down, and what it costs where they lie."""

import math
from itertools import pairwise

import numpy as np
import pytest

from drystone.model.landscape import Landscape
from drystone.model.placement import Placement, Side
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.search.laying_settings import PutDownSettings
from drystone.search.pixel_places import PixelAim, PixelHand
from drystone.stabilise.stabilise import Stabilised
from tests.planner.scenes import blocks, rubble
from tests.search.pixel_yards import PixelYard

SITE = Site(100, 60)
SIDES: tuple[Side, ...] = ("left", "right")


class _Scene:
    """A stone of some rubble over three that lie on the ground."""

    def __init__(self, side: Side, settings: PutDownSettings, seed: int = 2) -> None:
        yard = PixelYard(rubble(seed, 8), SITE)
        stone, *below = [
            yard.workshop.book.pose(s, angle)
            for s, angle in zip(yard.stones, (0.0, 10.0, 90.0, 30.0), strict=False)
        ]
        self.wall, col = yard.empty().wall, 2
        for posed in below:
            self.wall = self.wall.add(Placement(posed, SITE.height_px - posed.height_px, col))
            col += posed.width_px + seed
        self.landscape = Landscape.of(self.wall, side)
        self.posed, self.view = stone, self.landscape.view(stone)
        self.unit = yard.workshop.stock.mean_height_px
        self.hand = PixelHand(settings, yard.workshop.memory)
        self.drops = [(self.row(col), col) for col in range(SITE.width_px - stone.width_px + 1)]
        self.top = SITE.height_px - sorted(row for row, _ in self.drops)[len(self.drops) // 3]

    def row(self, col: int) -> int:
        """Lower the stone until a pixel of it would meet something."""
        tops: list[int] = self.landscape.skyline.tolist()
        bottoms: list[int] = self.view.bottom.tolist()
        return min(tops[col + j] - bottom for j, bottom in enumerate(bottoms)) - 1

    def aim(self, left: float | None, top: float) -> PixelAim:
        return PixelAim(left, top, 0.0, self.unit)

    def void(self, row: int, col: int) -> int:
        """Count what is free below a stone, above what is there."""
        mask, occupied = self.view.mask, self.landscape.occupied
        count = 0
        for j in range(mask.shape[1]):
            below = row + max(i for i in range(len(mask)) if mask[i, j]) + 1
            while below < len(occupied) and not occupied[below, col + j]:
                below, count = below + 1, count + 1
        return count

    def cost(self, row: int, col: int, aim: PixelAim) -> float:
        settings = self.hand.settings
        cost = settings.top * abs(SITE.height_px - row - aim.top) / self.unit
        if aim.left is not None:
            cost += settings.width * max(0.0, col - aim.left) / self.unit
        return cost + settings.void * self.void(row, col) / self.view.area_px


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("left", [12.3, None])
@pytest.mark.parametrize("seed", [2, 5])
def test_places_are_the_cheapest_near_the_aim(side: Side, left: float | None, seed: int) -> None:
    settings = PutDownSettings(places=6, reach=0.6, astray=0.8, top=1.3, width=0.7, void=0.9)
    scene = _Scene(side, settings, seed)
    aim = scene.aim(left, scene.top)
    reach = settings.reach * math.sqrt(scene.view.area_px)
    ranked = sorted(
        (round(scene.cost(row, col, aim), 9), col, row)
        for row, col in scene.drops
        if abs(SITE.height_px - row - aim.top) <= settings.astray * scene.unit
        and (left is None or abs(col - left) <= reach)
    )
    places = scene.hand.places(scene.landscape, scene.view, aim)
    assert places == [(row, col) for _, col, row in ranked[:6]]
    assert len(places) == 6


@pytest.mark.parametrize("side", SIDES)
def test_what_lies_is_stable_and_was_lowered_there(side: Side) -> None:
    settings = PutDownSettings(places=60, turn=0.5, wedge=0.7, astray=0.6)
    turned = wedged = 0
    for seed in range(2, 7):
        scene = _Scene(side, settings, seed)
        aim = scene.aim(None, scene.top)
        lying = scene.hand.lying(scene.wall, scene.landscape, scene.posed, aim, 100)
        assert all(one.cost <= other.cost for one, other in pairwise(lying))
        places = set()
        for one in lying:
            at = one.stabilised.placement
            wall = scene.wall.add(at, one.stabilised.wedges)  # refuses what overlaps
            places.add((at.posed.angle_deg, at.row, at.col))
            assert at.side == side
            assert abs(SITE.height_px - at.row - aim.top) <= settings.astray * scene.unit
            _check_way_down(scene.wall.occupied, at.posed, at.row, at.col)
            scene.view = scene.landscape.view(at.posed)
            col = scene.landscape.view_col(at.posed, at.col)
            turn = settings.turn * abs(at.posed.angle_deg) / 10.0
            extra = turn + settings.wedge * len(one.stabilised.wedges)
            assert one.cost == pytest.approx(scene.cost(at.row, col, aim) + extra)
            turned += bool(at.rotation_moves)
            wedged += bool(one.stabilised.wedges)
            assert [w.id for w in wall.wedges[len(scene.wall.wedges) :]] in ([], [100], [100, 101])
        assert len(places) == len(lying)
    assert turned
    assert wedged


def _check_way_down(occupied: np.ndarray, posed: PosedStone, row: int, col: int) -> None:
    """Nothing is in the way as a stone comes down."""
    height, width = posed.mask.shape
    scene = np.vstack([np.zeros((height, occupied.shape[1]), bool), occupied])
    window = scene[:, col : col + width]
    assert not any((window[at : at + height] & posed.mask).any() for at in range(row + height + 1))


def test_settings_are_checked() -> None:
    for change in (
        {"places": 0}, {"astray": 0.0}, {"void": -1.0}, {"reach": -0.1}, {"llc": -1.0},
        {"analysed": 0}, {"analysed": 9, "judged": 8},
    ):  # fmt: skip
        with pytest.raises(ValueError, match="must"):
            PutDownSettings(**change)


@pytest.mark.parametrize("side", SIDES)
def test_where_a_stone_cannot_be_lowered_to_it_does_not_lie(side: Side) -> None:
    yard = PixelYard(blocks({1: (10, 10), 2: (60, 6)}), SITE)
    low, roof = (yard.workshop.book.pose(stone, 0.0) for stone in yard.stones)
    col = 0 if side == "left" else SITE.width_px - roof.width_px
    landscape = Landscape.of(yard.empty().wall.add(Placement(roof, 20, col)), side)
    hand = PixelHand(PutDownSettings(), yard.workshop.memory)
    row = SITE.height_px - low.height_px
    costs = []
    for left in (10, 80):  # under the roof, and beside it
        at = landscape.view_col(low, left)
        found = Stabilised(Placement(low, row, at, side), ())
        costs.append(hand._cost(landscape, found, PixelAim(float(left), 10.0, 0.0, 10.0)))
    assert costs[0] == math.inf
    assert costs[1] < math.inf
