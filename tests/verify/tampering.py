"""Ways to change what a plan claims."""

from dataclasses import replace

import numpy as np

from drystone.model.plan import WedgeStep
from tests.verify.examples import WEDGE


def codes(report):
    return {problem.code for problem in report.problems}


def step_of(plan, piece):
    return next(s for s in plan.steps if piece == (s.id if isinstance(s, WedgeStep) else s.stone))


def changed(plan, piece, **values):
    step = step_of(plan, piece)
    steps = tuple(replace(s, **values) if s is step else s for s in plan.steps)
    return replace(plan, steps=steps)


def moved(plan, piece, dx, dy):
    x, y = step_of(plan, piece).centroid
    return changed(plan, piece, centroid=(x + dx, y + dy))


def reshaped(plan, change):
    polygon = change(np.array(step_of(plan, WEDGE).polygon))
    return changed(plan, WEDGE, polygon=tuple((float(x), float(y)) for x, y in polygon))


def without(plan, piece):
    steps = [s for s in plan.steps if s is not step_of(plan, piece)]
    return replace(plan, steps=tuple(replace(s, step=n) for n, s in enumerate(steps, 1)))


def swapped(plan, first, second):
    plan = changed(changed(plan, first, stone=999), second, stone=first)
    return changed(plan, 999, stone=second)
