"""Pins and wedges: they fill, they do not carry, and a mason would cut them so."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from drystone.craft.finding import VERDICTS, Case, Finding, Limit, Line, Rule
from drystone.craft.masonry import Masonry
from drystone.craft.wedge_loads import least_wedge_loads
from drystone.model.wedge_shape import WedgeRule, WedgeSettings, WedgeShape, open_sides
from drystone.statics.joints import is_head_joint, loose_blocks
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus

EASE = 0.2
"""Wedges may miss their sizes by so much: a planner's go by all stones, not by those placed."""

UNKNOWN = "What the wedges carry is not known"

RULE = Rule(
    "pins",
    "pins and wedges",
    "Wedges fill gaps and stop rocking; the load goes beside them, none sticks out, and each is a "
    "flat piece that one can cut and that stays in its place.",
    "The paper, section 2 (shards fill openings or prevent rocking); rockinwalls.com, Pinning & "
    "Chinks, 2011 (pins that lift a large stone fall out or are crushed); Delaware Quarries, "
    "rule 10 (fill cracks after the wall is complete). The number: own definition",
    "greatest load that a wedge cannot help carrying under the wall's own weight, "
    "with open upright joints, over the weight of the stones that lie on it",
    higher_is_better=False,
    limit=Limit(0.1, 0.5),
)


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Find wedges that carry, that stick out, and that no mason would cut.

    Wedges are known in plans; in a label image or block model they have to be named.  The verdict
    is that of the number, or "broken" when a wedge sticks out, or is none that a mason would cut
    where wedges shall be cut to their outlines.

    Parameters
    ----------
    masonry : Masonry
        Any wall.
    limit : Limit
        Of the number.
    """
    wedges = frozenset(masonry.wedge_ids)
    if not wedges:
        return Finding(RULE, limit, None, "not judged", note="No wedges are known.")
    resting = {wedge: _resting(masonry, wedge) for wedge in wedges}
    outside = [case for wedge in sorted(wedges) for case in _outside(masonry, wedge, resting)]
    unfit = [case for wedge in sorted(wedges) for case in _unfit(masonry, wedge, resting)]
    loads, note = _loads(masonry, wedges)
    figures: dict[str, float | None] = {
        "wedges": float(len(wedges)),
        "wedges that stick out": float(len(outside)),
        "wedges that no mason would cut": float(len(unfit)),
    }
    bad = (*outside, *unfit)
    if loads is None:
        verdict = VERDICTS[2] if bad else "not judged"
        return Finding(RULE, limit, None, verdict, bad, figures, note)
    shares = {wedge: _share(masonry, loads[wedge], resting[wedge]) for wedge in sorted(wedges)}
    number = round(max(shares.values()), 9)
    carrying = [
        Case((wedge, *resting[wedge]), round(share, 6), _words(share), _frame(masonry, wedge))
        for wedge, share in shares.items()
        if share > limit.good + 1e-9
    ]
    carrying.sort(key=lambda case: -case.value)
    verdict = VERDICTS[2] if bad else RULE.verdict(number, limit)
    figures["wedges that carry"] = float(len(carrying))
    figures["mean load"] = float(np.mean(list(shares.values())))
    return Finding(RULE, limit, number, verdict, (*bad, *carrying), figures, note)


def _loads(masonry: Masonry, wedges: frozenset[int]) -> tuple[Mapping[int, float] | None, str]:
    """Return what wedges cannot help carrying, and a remark.

    Stones squeezed between their neighbours could hang on the upright joints, in theory with any
    force; a mason does not count on it.
    """
    model, fallen = masonry.model, "the wall does not stand as it is drawn."
    if model is None or loose_blocks(model):
        return None, f"{UNKNOWN}: {fallen}"
    loads = least_wedge_loads(_open_heads(model), wedges)
    if not isinstance(loads, LimitStatus):
        return loads, ""
    if loads is LimitStatus.UNSTABLE:
        loads = least_wedge_loads(model, wedges)
    if not isinstance(loads, LimitStatus):
        return loads, "The wall stands only by pressure in upright joints, which was counted on."
    gave_up = loads is LimitStatus.FAILED
    return None, f"{UNKNOWN}: {'the solver gave up.' if gave_up else fallen}"


def _open_heads(model: RigidBlockModel) -> RigidBlockModel:
    return replace(model, interfaces=tuple(i for i in model.interfaces if not is_head_joint(i)))


def _words(share: float) -> str:
    return f"the wedge carries at least {share:.2f} of the weight of the stone on it"


def _frame(masonry: Masonry, wedge: int) -> tuple[Line, ...]:
    """Return a frame around a wedge, which may be too small to be seen."""
    room = 0.12 * masonry.mean_height
    x0, y0, x1, y1 = masonry.boxes[wedge]
    low, high = (x0 - room, y0 - room), (x1 + room, y1 + room)
    return (np.array([low, (high[0], low[1]), high, (low[0], high[1]), low]),)


def _share(masonry: Masonry, load: float, resting: tuple[int, ...]) -> float:
    assert masonry.model is not None  # noqa: S101 - loads are those of a model
    weights = {block.id: block.weight for block in masonry.model.blocks}
    on_it = sum(weights[stone] for stone in resting)
    return load / on_it if on_it else 0.0


def _resting(masonry: Masonry, wedge: int) -> tuple[int, ...]:
    """Return the stones that lie on a wedge: next above it in a column, within a joint."""
    found: set[int] = set()
    widest = masonry.settings.joint * masonry.mean_height
    for runs in masonry.columns.runs:
        for one, other in pairwise(runs):
            near = other.begin - one.end <= widest
            if one.id == wedge and other.id in masonry.stones and near:
                found.add(other.id)
    return tuple(sorted(found))


def _outside(masonry: Masonry, wedge: int, resting: dict[int, tuple[int, ...]]) -> list[Case]:
    """Say whether a wedge reaches out sideways beyond what lies on it, into the open."""
    if not resting[wedge]:
        return []
    x0, y0, x1, y1 = masonry.boxes[wedge]
    left = min(masonry.boxes[i][0] for i in resting[wedge]) - x0
    right = x1 - max(masonry.boxes[i][2] for i in resting[wedge])
    out = max(left, right) / masonry.mean_height
    opened = open_sides(masonry.loops[wedge], masonry.polygons)[0 if left > right else 1]
    if out <= masonry.settings.stick_out + 1e-9 or not opened:
        return []
    y = 0.5 * (y0 + y1)
    line = np.array([[x0, y], [x0 + left, y]] if left > right else [[x1 - right, y], [x1, y]])
    words = f"the wedge sticks out by {out:.2f} mean stone heights"
    return [Case((wedge, *resting[wedge]), round(out, 6), words, (line,))]


def _unfit(masonry: Masonry, wedge: int, resting: dict[int, tuple[int, ...]]) -> list[Case]:
    """Say what is wrong with a wedge that no mason would cut; lengths in sizes of the stones."""
    if not (masonry.cut and masonry.stones):
        return []
    size = masonry.median_size
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
    if resting[wedge]:
        left, right = open_sides(masonry.loops[wedge], masonry.polygons)
        faults += ["nothing beside it to the left"] * left
        faults += ["nothing beside it to the right"] * right
    if not faults:
        return []
    words = f"no mason would cut the wedge (in stone sizes): {'; '.join(faults)}"
    return [Case((wedge, *resting[wedge]), float(len(faults)), words, _frame(masonry, wedge))]
