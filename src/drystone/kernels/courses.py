"""Plan a wall course by course: anneal the order of its stones on height profiles."""

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from drystone.kernels.backend import compiled
from drystone.kernels.course_cost import (
    LaidCourse,
    evaluate_python,
    floats,
    lay_course,
    on_ground,
    outer_terms,
    path_terms,
    weighted,
)
from drystone.kernels.course_moves import NOTHING, Dice, Draft, change
from drystone.kernels.course_paths import STARTS
from drystone.kernels.course_types import (
    Arrangement,
    Cooling,
    Floats,
    Ground,
    Layout,
    Poses,
    Rules,
)

LOGS: Final = 4096
"""Numbers that are drawn to accept a costlier plan are rounded to one of so many."""

ROUND: Final = 1024
"""Evaluations after which a look is taken at whether to go on."""

_LUCK: Floats = np.array([-math.log((i + 0.5) / LOGS) for i in range(LOGS)])
_LUCK.flags.writeable = False

_cost = compiled("course_cost")
_fast = compiled("courses")


def evaluate(poses: Poses, plan: Arrangement, ground: Ground, rules: Rules) -> Layout:
    """Return where the stones of an arrangement lie, and what that costs.

    Parameters
    ----------
    poses : Poses
        Of all stones.
    plan : Arrangement
        Stones in courses.
    ground : Ground
        What they are laid on.
    rules : Rules
        How, and what counts.

    Raises
    ------
    ValueError
        When the arrays do not fit each other.
    """
    check(poses, plan, ground, rules)
    if _cost is None:
        return evaluate_python(poses, plan, ground, rules)
    return Layout(*_cost.evaluate(poses, plan, ground, rules, floats(rules)))


def anneal(
    poses: Poses,
    plan: Arrangement,
    ground: Ground,
    rules: Rules,
    cooling: Cooling,
    look: Callable[[], None] = lambda: None,
) -> tuple[Arrangement, float]:
    """Change an arrangement at random, at a falling temperature.

    Parameters
    ----------
    poses : Poses
        Of all stones.
    plan : Arrangement
        Where to start.
    ground : Ground
        What the courses are laid on.
    rules : Rules
        How, and what counts.
    cooling : Cooling
        How long, and from which temperature.
    look : callable
        Called before the first evaluation and after every :data:`ROUND` of them; what it raises
        ends the annealing.

    Returns
    -------
    plan : Arrangement
        The cheapest one that was met.
    cost : float
        As :func:`evaluate` says.

    Raises
    ------
    ValueError
        When the arrays do not fit each other.
    """
    check(poses, plan, ground, rules)
    if _fast is None:
        return anneal_python(poses, plan, ground, rules, cooling, look)
    luck, seed = _LUCK, cooling.seed % 2**64
    *parts, cost = _fast.anneal(
        poses, plan, ground, rules, floats(rules), cooling, seed, luck, look, ROUND
    )
    return Arrangement(*parts), cost


def check(poses: Poses, plan: Arrangement, ground: Ground, rules: Rules) -> None:
    """Refuse arrays that do not fit each other."""
    stones = poses.area.size
    courses = plan.sizes.size
    placed = int(plan.sizes.sum())
    if not np.array_equal(np.sort(plan.order), np.arange(stones)) or plan.turns.size != stones:
        raise ValueError("an arrangement has every stone once")
    if not 1 <= courses <= rules.courses or plan.sizes.min() < 1 or placed > stones:
        raise ValueError("courses must not be empty, nor too many")
    if plan.gaps.size != courses or not (abs(plan.gaps + 0.5) < plan.sizes + 1).all():
        raise ValueError("a gap must be in its course")
    if ((plan.turns < 0) | (plan.turns > 3)).any():
        raise ValueError("turns are quarters, 0 to 3")
    if np.diff(poses.first).max() > ground.tops.size or poses.width.max() > ground.width:
        raise ValueError("a stone is wider than the wall")
    joints = ground.joints.shape[0]
    if ground.joints.shape != (joints, 2) or ground.ways.shape != (joints, STARTS):
        raise ValueError("there is a way from each start to each joint")
    if min(rules.weights) < 0.0 or rules.reach < 1 or rules.joint < 0 or rules.steepest < 0:
        raise ValueError("weights and lengths must not be negative")


class Built(NamedTuple):
    """A draft whose courses are laid.

    Parameters
    ----------
    draft : Draft
        Which is not changed any more.
    laid : list of LaidCourse
        Its courses.
    outer : float
        What the stones that are left out cost.
    cost : float
        Of all.
    """

    draft: Draft
    laid: list[LaidCourse]
    outer: float
    cost: float


def anneal_python(
    poses: Poses,
    plan: Arrangement,
    ground: Ground,
    rules: Rules,
    cooling: Cooling,
    look: Callable[[], None] = lambda: None,
) -> tuple[Arrangement, float]:
    """Return what :func:`anneal` returns, by Python."""
    dice = Dice(cooling.seed)
    nothing = Built(Draft([], [], [], []), [], 0.0, 0.0)
    now = laid_again(poses, Draft.of(plan), nothing, 0, ground, rules)
    assert now is not None  # noqa: S101 - there was no limit
    best = now
    temperature = cooling.temperature
    for step in range(cooling.evaluations):
        if step % ROUND == 0:
            look()
        temperature *= cooling.factor
        draft = now.draft.copy()
        lowest = change(draft, dice, rules.courses)
        if lowest == NOTHING:
            continue
        limit = now.cost + temperature * float(_LUCK[dice.below(LOGS)])
        trial = laid_again(
            poses, draft, now, lowest, ground, rules, limit=limit, doubt=cooling.doubt
        )
        if trial is not None:
            now = trial
            best = now if now.cost < best.cost else best
    return best.draft.done(), best.cost


def laid_again(
    poses: Poses,
    draft: Draft,
    now: Built,
    lowest: int,
    ground: Ground,
    rules: Rules,
    *,
    limit: float = math.inf,
    doubt: float = math.inf,
) -> Built | None:
    """Lay the courses of a draft from the lowest that changed; None when it costs too much.

    Parameters
    ----------
    poses, ground, rules
        As for :func:`anneal`.
    draft : Draft
        Changed.
    now : Built
        What it was before.
    lowest : int
        Below this course nothing changed.
    limit : float
        What the draft may cost.
    doubt : float
        See :class:`Cooling`.
    """
    outer = weighted(outer_terms(poses, draft.order[draft.placed :]), rules)
    cost, was = outer, now.outer
    laid = now.laid[:lowest]
    for known in laid:
        cost += known.cost
        was += known.cost
    courses = len(draft.sizes)
    highest = highest_changed(draft, now.draft)
    below = laid[-1].above if laid else on_ground(ground)
    for course in range(lowest, courses):
        posed, gap = draft.posed(course), draft.gaps[course]
        laid.append(lay_course(poses, posed, gap, below, ground, rules, last=course == courses - 1))
        below = laid[-1].above
        cost += laid[-1].cost
        if cost > limit:
            return None
        if courses == len(now.laid):
            was += now.laid[course].cost
            if highest <= course < courses - 1 and cost - was > limit - now.cost + doubt:
                return None
    cost += weighted(path_terms(laid, ground, rules), rules)
    return Built(draft, laid, outer, cost) if cost <= limit else None


def highest_changed(draft: Draft, old: Draft) -> int:
    """Return the highest course of a draft that an old one with as many courses has otherwise."""
    courses = range(min(len(draft.sizes), len(old.sizes)))
    changed = [
        course
        for course in courses
        if draft.posed(course) != old.posed(course) or draft.gaps[course] != old.gaps[course]
    ]
    return max(changed, default=0)
