"""Plan a wall course by course: anneal the order of its stones on height profiles."""

import math
from typing import Final

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
    poses: Poses, plan: Arrangement, ground: Ground, rules: Rules, cooling: Cooling
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
        return anneal_python(poses, plan, ground, rules, cooling)
    *parts, cost = _fast.anneal(
        poses, plan, ground, rules, floats(rules), cooling, cooling.seed % 2**64, _LUCK
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
    if plan.gaps.size != courses or (plan.gaps < 1).any() or (plan.gaps > plan.sizes).any():
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


def anneal_python(
    poses: Poses, plan: Arrangement, ground: Ground, rules: Rules, cooling: Cooling
) -> tuple[Arrangement, float]:
    """Return what :func:`anneal` returns, by Python."""
    dice = Dice(cooling.seed)
    draft = Draft.of(plan)
    laid: list[LaidCourse] = []
    cost, laid = laid_again(poses, draft, laid, 0, ground, rules, math.inf)
    best, least = draft.copy(), cost
    temperature = cooling.temperature
    for _ in range(cooling.evaluations):
        temperature *= cooling.factor
        trial = draft.copy()
        lowest = change(trial, dice, rules.courses)
        if lowest == NOTHING:
            continue
        limit = cost + temperature * float(_LUCK[dice.below(LOGS)])
        trial_cost, trial_laid = laid_again(poses, trial, laid, lowest, ground, rules, limit)
        if trial_cost <= limit:
            draft, cost, laid = trial, trial_cost, trial_laid
            if cost < least:
                best, least = draft.copy(), cost
    return best.done(), least


def laid_again(
    poses: Poses,
    draft: Draft,
    laid: list[LaidCourse],
    lowest: int,
    ground: Ground,
    rules: Rules,
    limit: float,
) -> tuple[float, list[LaidCourse]]:
    """Lay the courses of a draft from the lowest that changed, until it costs more than a limit."""
    cost = weighted(outer_terms(poses, draft.order[draft.placed :]), rules)
    kept = laid[:lowest]
    for known in kept:
        cost += known.cost
    below = kept[-1].above if kept else on_ground(ground)
    for course in range(lowest, len(draft.sizes)):
        if cost > limit:
            return cost, kept
        start = draft.start(course)
        stones = draft.order[start : start + draft.sizes[course]]
        posed = [4 * stone + draft.turns[stone] for stone in stones]
        last = course == len(draft.sizes) - 1
        kept.append(lay_course(poses, posed, draft.gaps[course], below, ground, rules, last=last))
        below = kept[-1].above
        cost += kept[-1].cost
    return cost + weighted(path_terms(kept, ground, rules), rules), kept
