"""Slow, obvious versions of what the planner computes, and of the planner itself."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from drystone.clusters import cluster_stones
from drystone.contacts.blocks import model_from_labels
from drystone.indices import Indices
from drystone.model.placement import Placement, Wedge
from drystone.planner.settings import PlannerSettings
from drystone.poses import PoseBook
from drystone.selection.algorithm2 import Action
from drystone.selection.sampling import sample_stones
from drystone.stabilise.memory import StabiliseMemory
from tests.naive import indices, placement, rays, selection, statics


def unfillable(lengths, limit):
    """What is left of every length when all combinations of stones have been tried."""
    sums = {sum(choice) for choice in product(*[(0, *choices) for choices in lengths])}
    return [min(length - total for total in sums if total <= length) for length in range(limit + 1)]


@dataclass(frozen=True)
class Tried:
    """A candidate of a step."""

    placement: Placement
    wedges: tuple[Wedge, ...]
    alphas: tuple[float, float] | None
    action: Action


class SlowPlanner:
    """Algorithm 1 with the defaults of the paper, everything anew for every candidate.

    Stones are turned and made stable by the functions of the package, each one without memory;
    positions, indices, contacts and loads are found on whole images and by fresh programs.
    """

    def __init__(self, stones, site, seed=0):
        self.settings = PlannerSettings()
        self.site, self.seed = site, seed
        self.book = PoseBook(site.scale)
        self.poses = {s.id: self.quarter_turns(s) for s in stones}
        self.clusters = cluster_stones(stones, self.book)
        lying = [poses[0] for poses in self.poses.values()]
        self.mean_height = sum(posed.height_px for posed in lying) / len(lying)
        self.narrowest = min(posed.width_px for posed in lying)
        self.labels = np.zeros((site.height_px, site.width_px), np.uint32)
        # Numbered in the order of placement, without wedges.
        self.order = np.zeros_like(self.labels)
        self.built = []

    def quarter_turns(self, stone):
        """The poses of largest SF, lying first; those of the same pixels only once."""
        first = self.book.initial_angle(stone)
        found = []
        for quarter in range(4):
            posed = self.book.pose(stone, first + 90.0 * quarter)
            if not any(np.array_equal(posed.mask, other.mask) for other in found):
                found.append(posed)
        fitting = self.site.height_px, self.site.width_px
        return [p for p in found if p.height_px <= fitting[0] and p.width_px <= fitting[1]]

    def plan(self, at_most=None):
        """Place stones until the wall is full, none is left, or five samples in a row failed."""
        failures = 0
        while failures < self.settings.stop.failures and len(self.built) != at_most:
            placed = {tried.placement.stone_id for tried in self.built}
            remaining = [i for i in self.poses if i not in placed]
            area = sum(t.placement.posed.stone.area_px for t in self.built) * self.site.scale**2
            full = area / self.labels.size > self.settings.stop.filling
            if full or not remaining:
                break
            rng = np.random.default_rng([self.seed, len(self.built), failures])
            sample = sample_stones("variant", remaining, self.clusters, rng)
            found = [self.tried(posed, sample) for i in sample for posed in self.poses[i]]
            candidates = [tried for tried in found if tried is not None]
            actions = [tried.action for tried in candidates]
            chosen = selection.algorithm2(actions, self.settings.selection.weights)
            if chosen is None:
                failures += 1
                continue
            failures = 0
            self.build(candidates[actions.index(chosen)])
        return self.built

    def build(self, tried):
        """Paint a stone and its wedges."""
        self.built.append(tried)
        at = tried.placement
        self.labels[at.window][at.posed.mask] = at.stone_id
        self.order[at.window][at.posed.mask] = len(self.built)
        for wedge in tried.wedges:
            self.labels[wedge.window][wedge.mask] = wedge.id

    def tried(self, posed, sample):
        """Place, stabilise and judge one stone; None when it can stand nowhere."""
        occupied = self.labels > 0
        positions = placement.resting_by_areas(occupied, posed.mask, placement.areas_by_convolution)
        beta = self.settings.placement.beta
        spot = placement.best_by_eq12(occupied, posed.mask, posed.anchor[0], positions, beta)
        if spot is None:
            return None
        memory = StabiliseMemory(self.book, self.mean_height, self.settings.stabilise)
        next_wedge = max(self.poses) + sum(len(tried.wedges) for tried in self.built) + 1
        stabilised = memory.stabilise(occupied, (posed, *spot), "left", next_wedge)
        if stabilised is None:
            return None
        others = [
            float(other.height_px) for i in sample if i != posed.stone.id for other in self.poses[i]
        ]
        return self.judged(stabilised.placement, stabilised.wedges, others)

    def judged(self, at, wedges, other_heights):
        """Everything that selection asks for."""
        occupied = self.labels > 0
        grown = self.labels.copy()
        grown[at.window][at.posed.mask] = at.stone_id
        for wedge in wedges:
            grown[wedge.window][wedge.mask] = wedge.id
        alphas = statics.alphas_by_linprog(model_from_labels(grown, self.settings.mu).model)
        stone = indices.painted(occupied.shape, at.posed.mask, at.row, at.col)
        extent = indices.extent_of(stone)
        values = Indices(
            SF=indices.shape_factor(at.posed.stone.mask, at.posed.angle_deg),
            LFR=rays.filling_on_images(occupied, stone),
            GDS=indices.dice_score(occupied, stone),
            NHR=indices.neighbour_height_ratio(self.order, stone, other_heights),
            IWR=indices.interlocking(self.order, stone, self.narrowest),
            IS=indices.inward_slope(stone, at.col + at.posed.anchor[0]),
            LLC=None if alphas is None else min(alphas) / self.settings.mu,
            boundary=min(extent.x0, occupied.shape[1] - extent.x1) < self.narrowest,
        )
        return Tried(at, wedges, alphas, Action(at.stone_id, values))
