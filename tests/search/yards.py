"""Stones, a site, and course plans for them."""

import numpy as np

from drystone.kernels.profiles import bare, hanging, raised
from drystone.kernels.raster import turn
from drystone.planner.workshop import Workshop
from drystone.search.courses import CoursePlan, PlannedStone
from drystone.search.mason import lay
from drystone.search.yard import Yard
from tests.planner.scenes import greedy


class Plot:
    """A yard, and plans for it."""

    def __init__(self, stones, site, changes=None):
        self.stones, self.site = stones, site
        settings = greedy(changes)
        self.yard = Yard(Workshop.prepare(stones, site, settings), settings)

    def corners(self, stone_id, angle_deg=0.0):
        stone = self.stones.by_id(stone_id)
        return turn(self.yard.workshop.outlines.outline(stone), angle_deg)

    def planned(self, stone_id, left, bottom, side="left", angle=0.0, top=None):
        corners = self.corners(stone_id, angle)
        low, high = corners.min(axis=0), corners.max(axis=0)
        y = bottom - low[1]
        return PlannedStone(
            stone_id, angle, side, left - low[0], y, left, left + high[0] - low[0],
            y + high[1] if top is None else top,
        )  # fmt: skip

    def lay(self, *courses, laying=None):
        plan = CoursePlan(tuple(map(tuple, courses)), 0.0)
        return lay(plan, self.yard.planner().build, self.yard, laying)

    def rows(self, count):
        """Fill courses with stones as they come, from both sides."""
        width, profile, ids = self.site.width_px, bare(self.site.width_px), 0
        courses = []
        stones = iter(self.stones)
        stone = next(stones, None)
        while stone is not None and len(courses) < count:
            course = []
            ends = {"left": 0, "right": width}
            side = "left"
            while stone is not None:
                hung = hanging(self.corners(stone.id), 1.0)
                columns = len(hung.bottoms)
                if ends["right"] - ends["left"] < columns:
                    break
                left = ends["left"] if side == "left" else ends["right"] - columns
                y = float((profile.tops[left : left + columns] - hung.bottoms).max())
                course.append(self.planned(stone.id, left, y + hung.bottom, side))
                corners = self.corners(stone.id) + np.array([left - hung.left, y])
                profile, ids = raised(profile, corners, ids, 1.0), ids + 1
                ends[side] = left + columns if side == "left" else left
                side = "right" if side == "left" else "left"
                stone = next(stones, None)
            courses.append(course)
        return courses
