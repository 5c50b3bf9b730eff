"""Pins and wedges: they fill, they do not carry, and a mason would cut them so."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from drystone.craft.finding import Case, Evidence, Limit, worst_first
from drystone.craft.masonry import Masonry
from drystone.kernels.polygons import Points
from drystone.model.wedge_shape import WedgeRule, WedgeSettings, WedgeShape, open_sides
from drystone.statics.joints import is_head_joint, loose_blocks
from drystone.statics.lp.highs import HighsSession
from drystone.statics.lp.program import Floats, assemble
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import LimitStatus

EASE = 0.2
"""Wedges may miss their sizes by so much: a planner's go by all stones, not by those placed."""

UNKNOWN = "What the wedges carry is not known"


def pins(masonry: Masonry, limit: Limit) -> Evidence:
    """Find wedges that carry, that stick out, and that no mason would cut.

    Wedges are known in plans; in a label image or block model they have to be named.  The rule is
    broken when a wedge sticks out, or is none that a mason would cut where wedges shall be cut to
    their outlines.
    """
    wedges = sorted(set(masonry.wedge_ids))
    if not wedges:
        return Evidence(None, note="There is no wedge, or none is marked.")
    resting = resting_on(masonry)
    outside = [case for wedge in wedges for case in _outside(masonry, wedge, resting[wedge])]
    unfit = [case for wedge in wedges for case in _unfit(masonry, wedge, resting[wedge])]
    figures: dict[str, float | None] = {
        "wedges": float(len(wedges)),
        "wedges that stick out": float(len(outside)),
        "wedges that no mason would cut": float(len(unfit)),
    }
    bad = (*outside, *unfit)
    loads, note = _loads(masonry, frozenset(wedges))
    if masonry.model is None or loads is None:
        return Evidence(None, bad, figures, note, broken=bool(bad))
    weights = {block.id: block.weight for block in masonry.model.blocks}
    shares, carrying = [], []
    for wedge in wedges:
        on_it = sum(weights[stone] for stone in resting[wedge])
        share = loads[wedge] / on_it if on_it else 0.0
        shares.append(share)
        if share > limit.good + 1e-9:
            words = f"the wedge carries at least {share:.2f} of the weight of the stone on it"
            stones = (wedge, *resting[wedge])
            carrying.append(Case(stones, round(share, 6), words, _frame(masonry, wedge)))
    figures["wedges that carry"] = float(len(carrying))
    figures["mean load"] = float(np.mean(shares))
    return Evidence(
        round(max(shares), 9), (*bad, *worst_first(carrying)), figures, note, broken=bool(bad)
    )


def _loads(masonry: Masonry, wedges: frozenset[int]) -> tuple[Mapping[int, float] | None, str]:
    """Return what wedges cannot help carrying, and a remark.

    Stones squeezed between their neighbours could hang on the upright joints, in theory with any
    force; a mason does not count on it.
    """
    model, fallen = masonry.model, "the wall does not stand as it is drawn."
    if model is None or loose_blocks(model):
        return None, f"{UNKNOWN}: {fallen}"
    open_heads = tuple(face for face in model.interfaces if not is_head_joint(face))
    pressed = "The wall stands only by pressure in upright joints, which was counted on."
    for faces, note in ((open_heads, ""), (model.interfaces, pressed)):
        loads = least_wedge_loads(replace(model, interfaces=faces), wedges)
        if not isinstance(loads, LimitStatus):
            return loads, note
        if loads is LimitStatus.FAILED:
            return None, f"{UNKNOWN}: the solver gave up."
    return None, f"{UNKNOWN}: {fallen}"


def _frame(masonry: Masonry, wedge: int) -> tuple[Points, ...]:
    """Return a frame around a wedge, which may be too small to be seen."""
    room = 0.12 * masonry.mean_height
    x0, y0, x1, y1 = masonry.boxes[wedge]
    low, high = (x0 - room, y0 - room), (x1 + room, y1 + room)
    return (np.array([low, (high[0], low[1]), high, (low[0], high[1]), low]),)


def resting_on(masonry: Masonry) -> dict[int, tuple[int, ...]]:
    """Return the stones that lie on each wedge: next above it in a column, within a joint."""
    found: dict[int, set[int]] = {wedge: set() for wedge in masonry.wedge_ids}
    widest = masonry.settings.joint * masonry.mean_height
    for runs in masonry.columns.runs:
        for one, other in pairwise(runs):
            near = other.begin - one.end <= widest
            if one.id in found and other.id in masonry.stones and near:
                found[one.id].add(other.id)
    return {wedge: tuple(sorted(stones)) for wedge, stones in found.items()}


def _outside(masonry: Masonry, wedge: int, resting: tuple[int, ...]) -> list[Case]:
    """Say whether a wedge reaches out sideways beyond what lies on it, into the open."""
    if not resting:
        return []
    x0, y0, x1, y1 = masonry.boxes[wedge]
    left = min(masonry.boxes[i][0] for i in resting) - x0
    right = x1 - max(masonry.boxes[i][2] for i in resting)
    out = max(left, right) / masonry.mean_height
    opened = open_sides(masonry.loops[wedge], masonry.polygons)[0 if left > right else 1]
    if out <= masonry.settings.stick_out + 1e-9 or not opened:
        return []
    y = 0.5 * (y0 + y1)
    line = np.array([[x0, y], [x0 + left, y]] if left > right else [[x1 - right, y], [x1, y]])
    words = f"the wedge sticks out by {out:.2f} mean stone heights"
    return [Case((wedge, *resting), round(out, 6), words, (line,))]


def _unfit(masonry: Masonry, wedge: int, resting: tuple[int, ...]) -> list[Case]:
    """Say what is wrong with a wedge that no mason would cut; lengths in sizes of the stones."""
    if not (masonry.cut and masonry.stones):
        return []
    size = float(np.median([masonry.areas[i] for i in masonry.stones])) ** 0.5
    mu = 0.58 if masonry.model is None else masonry.model.mu
    per_m = None if masonry.per_m is None else masonry.per_m / size
    rule = WedgeRule.of(WedgeSettings(), mu, 1.0, per_m)
    rule = replace(
        rule,
        least_thickness=(1.0 - EASE) * rule.least_thickness,
        greatest_height=(1.0 + EASE) * rule.greatest_height,
        greatest_area=(1.0 + EASE) ** 2 * rule.greatest_area,
    )
    faults = list(rule.faults(WedgeShape.of(masonry.loops[wedge] / size)))
    if resting:
        left, right = open_sides(masonry.loops[wedge], masonry.polygons)
        faults += ["nothing beside it to the left"] * left
        faults += ["nothing beside it to the right"] * right
    if not faults:
        return []
    words = f"no mason would cut the wedge (in stone sizes): {'; '.join(faults)}"
    return [Case((wedge, *resting), float(len(faults)), words, _frame(masonry, wedge))]


def least_wedge_loads(
    model: RigidBlockModel, wedge_ids: frozenset[int]
) -> Mapping[int, float] | LimitStatus:
    """Return the least load that each wedge passes on while the wall stands by its own weight.

    For each wedge that state of equilibrium within friction counts in which it carries least; so 0
    means that the wall would stand without leaning on it.
    """
    if all(block.fixed for block in model.blocks):
        return dict.fromkeys(sorted(wedge_ids), 0.0)
    # From the forces of one wedge to those of the next it is not far.
    program, loads = assemble(model), {}
    session = HighsSession(program)
    _ = session.highs.changeColBounds(0, 0.0, 0.0)  # alpha: no more than dead load
    found = session.minimise(np.zeros(program.column_count))
    if found.status is not LimitStatus.OPTIMAL:
        return found.status
    forces = found.optimum[0]
    pressed, weights = _vertical(model)
    for wedge in sorted(wedge_ids):
        costs = np.append(0.0, np.where(pressed == wedge, weights, 0.0))
        # It cannot carry less than nothing.  Friction between steep faces may pull it down as hard
        # as one likes, so there need not be a least value.
        load = float(costs @ forces)
        if load > 0.0:
            found = session.minimise(costs)
            if found.status is LimitStatus.OPTIMAL:
                forces = found.optimum[0]
            elif found.status is not LimitStatus.UNBOUNDED:
                return LimitStatus.FAILED
            load = float(costs @ forces) if found.status is LimitStatus.OPTIMAL else 0.0
        loads[wedge] = max(0.0, load) * program.weight
    return loads


def _vertical(model: RigidBlockModel) -> tuple[NDArray[np.int64], Floats]:
    """Return of each edge of a friction cone what it presses onto, and how hard.

    It is 0 where it presses onto the ground, or sideways.
    """
    pressed, weights = [], []
    for face in model.interfaces:
        normal, tangent = face.normal[1], -face.normal[0] * model.friction(face)
        # The force on what lies above is `block`'s.
        lower, sign = (face.other, 1.0) if normal > 0 else (face.block, -1.0)
        on_it = sign if normal and GROUND not in (face.block, face.other) else 0.0
        edges = [on_it * (normal + tangent), on_it * (normal - tangent)]
        weights += edges * len(face.points)
        pressed += [lower] * 2 * len(face.points)
    return np.array(pressed, np.int64), np.array(weights)
