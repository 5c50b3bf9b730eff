"""Stones that are pixels, a site, and course plans for them."""

from collections.abc import Mapping, Sequence
from typing import Any

from drystone.model.placement import Side
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.planner.build import Build
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.course_plan import PlannedStone
from drystone.search.laying import Laid, lay
from drystone.search.laying_settings import LayingSettings
from drystone.search.pixel_outlines import posed_outline
from tests.planner.scenes import greedy
from tests.search.yards import plan_of


def raster(changes: Mapping[str, Any] | None = None) -> PlannerSettings:
    """The default method on pixels, without a search."""
    return greedy({"geometry": "raster", **(changes or {})})


class PixelYard:
    """Stones that are pixels, a site, and plans for them."""

    def __init__(
        self, stones: StoneSet, site: Site, changes: Mapping[str, Any] | None = None
    ) -> None:
        self.stones, self.site = stones, site
        self.settings = raster(changes)
        self.workshop = Workshop.prepare(stones, site, self.settings)

    def empty(self) -> Build:
        return Build.empty(self.site, self.settings.mu, self.workshop.stock.mean_area_px)

    def planned(
        self, stone_id: int, left: float, bottom: float, side: Side = "left", angle: float = 0.0,
        top: float | None = None,
    ) -> PlannedStone:  # fmt: skip
        corners = posed_outline(self.workshop.book.pose(self.stones.by_id(stone_id), angle))
        low, high = corners.min(axis=0), corners.max(axis=0)
        y = bottom - low[1]
        return PlannedStone(
            stone_id, angle, side, left - low[0], y, left, left + high[0] - low[0],
            y + high[1] if top is None else top,
        )  # fmt: skip

    def lay(self, *courses: Sequence[PlannedStone], laying: LayingSettings | None = None) -> Laid:
        return lay(plan_of(*courses), self.empty(), self.workshop, self.settings, laying)


def pixel_boxes(laid: Laid) -> dict[int, tuple[int, int, int, int]]:
    """Left, bottom, right and top of each stone, working px."""
    height = laid.build.wall.site.height_px
    return {
        p.stone_id: (
            p.col, height - p.row - p.posed.height_px, p.col + p.posed.width_px, height - p.row
        )
        for p in laid.build.wall.placements
    }  # fmt: skip


def statuses(laid: Laid) -> list[list[str]]:
    return [[one.status for one in course] for course in laid.courses]
