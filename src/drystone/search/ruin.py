"""What is taken down of a wall before it is built up again."""

import math
from collections.abc import Callable

import numpy as np
from numpy.random import Generator

from drystone.kernels.polygons import Points
from drystone.metrics.frame import frame_wall
from drystone.metrics.paths import joint_mask, vertical_paths
from drystone.model.builder import HAND, BuilderErrors
from drystone.planner.build import Build
from drystone.planner.search_settings import SearchSettings
from drystone.search.rehearsal import groups_of, mean_size, rehearse
from drystone.statics.limit import lateral_resistance

Ids = frozenset[int]
Ruin = Callable[[Build, int, Generator], Ids]

BEARS = 0.2
"""A contact bears what is above it when its normal points up by at least this."""


def taken_down(build: Build, ruin: Ruin, settings: SearchSettings, rng: Generator) -> Ids:
    """Choose stones by a ruin, and all that rest on them."""
    most = max(1, round(settings.largest * len(build.actions)))
    return with_all_above(build, ruin(build, int(rng.integers(1, most + 1)), rng))


def with_all_above(build: Build, chosen: Ids) -> Ids:
    """Add the stones that rest on some, and those on these."""
    stone_of = {g.placement.stone_id: g.placement.stone_id for g in build.wall.groups}
    stone_of |= {w.id: w.under for g in build.wall.groups for w in g.wedges}
    above: dict[int, set[int]] = {}
    for one in build.model.interfaces:
        if abs(one.normal[1]) < BEARS or one.other not in stone_of or one.block not in stone_of:
            continue
        high, low = (one.block, one.other) if one.normal[1] > 0 else (one.other, one.block)
        above.setdefault(stone_of[low], set()).add(stone_of[high])
    found, todo = set(chosen), list(chosen)
    while todo:
        for stone in above.get(todo.pop(), set()) - found:
            found.add(stone)
            todo.append(stone)
    return frozenset(found)


def centres(build: Build) -> tuple[list[int], Points]:
    """Return the ids of the stones and their centroids in the wall frame, working px."""
    height = build.wall.site.height_px
    placements = build.wall.placements
    return (
        [p.stone_id for p in placements],
        np.array([p.centroid(height) for p in placements], float),
    )


def _least(build: Build, cost: Points, count: int) -> Ids:
    """Take the stones of least cost; of equal ones those that were placed first."""
    order = np.argsort(cost, kind="stable")
    return frozenset(build.wall.placements[k].stone_id for k in order[:count].tolist())


def _nearest(build: Build, point: Points, count: int) -> Ids:
    _, at = centres(build)
    return _least(build, np.hypot(*(at - point).T), count)


def around(build: Build, stone: int, count: int) -> Ids:
    """Take a stone and those nearest to it."""
    ids, at = centres(build)
    return _nearest(build, at[ids.index(stone)], count)


def disc(build: Build, count: int, rng: Generator) -> Ids:
    """Take the stones around one of them."""
    groups = build.wall.groups
    return around(build, groups[int(rng.integers(len(groups)))].placement.stone_id, count)


def top(build: Build, count: int, _: Generator) -> Ids:
    """Take the highest stones of the whole wall."""
    return _least(build, -centres(build)[1][:, 1], count)


def column(build: Build, count: int, rng: Generator) -> Ids:
    """Take the upper stones around a vertical line."""
    x, y = centres(build)[1].T
    middle = float(rng.uniform(0, build.wall.site.width_px))
    return _least(build, np.abs(x - middle) - 0.5 * y, count)


def end(build: Build, count: int, rng: Generator) -> Ids:
    """Take the stones at one end, from the top down."""
    (x, y), site = centres(build)[1].T, build.wall.site
    away = x if rng.integers(2) else site.width_px - x
    return _least(build, away - (y - site.height_px), count)


def joint(build: Build, count: int, rng: Generator) -> Ids:
    """Take the stones around a piece of one of the shortest vertical joint paths (F_AV)."""
    site, labels = build.wall.site, build.wall.labels
    above = int(np.flatnonzero(labels.any(axis=1))[0])
    paths = vertical_paths(joint_mask(frame_wall(labels, site.width_px).labels))[:5]
    if not paths:
        return disc(build, count, rng)
    pixels = paths[int(rng.integers(len(paths)))].pixels
    row, col = pixels[int(rng.integers(len(pixels)))].tolist()
    # The joint image has a pixel more on the left and on top, and no rows above the wall.
    return _nearest(build, np.array([col - 0.5, site.height_px - above - row + 0.5]), count)


def step(build: Build, count: int, rng: Generator) -> Ids:
    """Take the stones around a place where neighbours' tops are not level (F_AH, T_LEVEL)."""
    ids, at = centres(build)
    labels = build.wall.labels
    tops = {i: labels.shape[0] - p.row for i, p in zip(ids, build.wall.placements, strict=True)}
    beside = [
        (one.block, one.other)
        for one in build.model.interfaces
        if abs(one.normal[1]) < BEARS and one.block in tops and one.other in tops
    ]
    if not beside:
        return disc(build, count, rng)
    steps = np.array([abs(tops[a] - tops[b]) for a, b in beside], float) + 1e-3
    a, b = beside[int(rng.choice(len(beside), p=steps / steps.sum()))]
    return _nearest(build, (at[ids.index(a)] + at[ids.index(b)]) / 2.0, count)


def mechanism(build: Build, count: int, rng: Generator) -> Ids:
    """Take the stones around one that moves when the wall fails (F_LR)."""
    found = lateral_resistance(build.model, mechanism=True)
    sides = [side for side in (found.left, found.right) if side.mechanism is not None]
    if not sides:
        return disc(build, count, rng)
    weaker = min(sides, key=lambda side: math.inf if side.alpha is None else abs(side.alpha))
    assert weaker.mechanism is not None  # noqa: S101 - those without are left out
    ids, at = centres(build)
    velocity = dict(zip(weaker.mechanism.block_ids, weaker.mechanism.velocity, strict=True))
    speed = np.array([np.hypot(*velocity[i][:2]) for i in ids])
    if not speed.sum() > 0:
        return disc(build, count, rng)
    return _nearest(build, at[int(rng.choice(len(ids), p=speed / speed.sum()))], count)


def unsure(build: Build, count: int, rng: Generator) -> Ids:
    """Take the stones around the first one that falls in a rehearsal."""
    groups = groups_of(build.wall)
    errors = BuilderErrors.of_precision(HAND, mean_size(groups))
    first = rehearse(groups, errors, rng, mu=build.model.mu).first_fall
    if first is None:
        return disc(build, count, rng)
    return around(build, first, count)


RUINS: tuple[Ruin, ...] = (disc, top, column, end, joint, step, mechanism, unsure)
"""In the order in which they are drawn."""
