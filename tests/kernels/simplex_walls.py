"""Walls as the simplex kernel sees them, for its tests: what is added, step by step."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.kernels import simplex
from drystone.kernels.simplex import Added, Cones, Optimum
from drystone.statics.lp.cone_program import ConeProgram
from drystone.statics.lp.program import Units
from tests.naive import simplex as naive
from tests.statics.walls import empty, with_block

SIGNS = (1, -1)
NOTHING = np.empty(0, np.int32)
UNITS = Units(15.0, 225.0)


needs_kernel = pytest.mark.skipif(
    not simplex.AVAILABLE, reason="the simplex kernel is not compiled here; HiGHS answers instead"
)


def assert_right(optimum, added, answer):
    """As the certificate says: by duality it leaves nothing to be solved again."""
    assert max(naive.errors(optimum, added, answer).values()) <= 1e-9


def cones(first, second, entries):
    table = np.ascontiguousarray(np.array(entries, float).reshape(-1, 6).T)
    return Cones(np.array(first, np.int32), np.array(second, np.int32), table)


def grown(labels, candidates=1, at_once=1):
    """The optima of a wall that grows from the lowest block up, and what may be added to it.

    The first of these is added; ends when the wall falls.
    """
    optima = {sign: Optimum.of_nothing(sign) for sign in SIGNS}
    whole, built, program = model_from_labels(labels).model, empty(), ConeProgram.empty(UNITS)
    rest = sorted(whole.blocks, key=lambda block: block.centroid[1])
    for placed in range(0, len(rest) - at_once + 1, at_once):
        left = rest[placed:]
        groups = [left[:at_once], *([block] for block in left[at_once : at_once + candidates - 1])]
        models = [with_block(built, *group, whole=whole) for group in groups]
        choices = [program.columns_of(model.added) for model in models]
        yield optima, choices
        answers = {sign: optima[sign].solved_with(choices[0]) for sign in SIGNS}
        if any(answer.status != simplex.OPTIMAL for answer in answers.values()):
            return
        optima = {sign: optima[sign].extended(choices[0], answers[sign]) for sign in SIGNS}
        built, program = models[0], program.appended(models[0].added, choices[0])


def with_columns(added, more):
    return replace(added, cones=Added(added.weights, more, NOTHING).joined(added.cones))


def some_columns(some, places):
    entries = np.ascontiguousarray(some.entries[:, places])
    return Cones(some.first[places], some.second[places], entries)


def noisy(some, amount, rng):
    """The columns with other entries, near to what they were."""
    noise = 1.0 + amount * rng.standard_normal(some.entries.shape)
    return replace(some, entries=some.entries * noise)


def variants(optimum, added, seed):
    """What else could be added: degenerate, near to it, with contacts that go."""
    rng = np.random.default_rng(seed)
    new, old = added.cones, optimum.cones
    none = some_columns(new, np.arange(0))
    found = {
        "twice": with_columns(added, new),
        "nothing": replace(added, cones=none),
        "a point": replace(added, cones=some_columns(new, np.arange(len(new.first))[:2])),
        "heavy": replace(added, weights=added.weights * 40.0),
        "light": replace(added, weights=added.weights / 1000.0),
    }
    for amount in (1e-6, 1e-9):
        found[f"nearly twice, {amount}"] = with_columns(added, noisy(new, amount, rng))
    if len(old.first):
        columns = np.sort(rng.choice(len(old.first), min(4, len(old.first)), replace=False))
        basic = np.sort(optimum.basis.basic[optimum.basis.basic >= 0])[:3].astype(np.int32)
        between = noisy(some_columns(old, columns), 0.05, rng)
        found["closed"] = replace(added, closed=columns.astype(np.int32))
        found["closed, basic"] = replace(added, closed=basic)
        found["only closed"] = Added(np.empty(0), none, basic)
        found["only columns"] = Added(np.empty(0), between, NOTHING)
        found["columns below"] = with_columns(added, between)
        found["nothing, columns below"] = replace(added, cones=between)
    return found
