"""Walls as the simplex kernel sees them, for its tests: what is added, step by step."""

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.kernels import simplex
from drystone.kernels.cones import GROUND_BODY, cone_edges
from drystone.kernels.simplex import OPTIMAL, Added, Cones, Optimum
from drystone.statics.model import GROUND
from tests.naive import simplex as naive

SIGNS = (1, -1)
NOTHING = np.empty(0, np.int32)
LENGTH_PX = 15.0


needs_kernel = pytest.mark.skipif(
    not simplex.AVAILABLE, reason="the simplex kernel is not compiled here; HiGHS answers instead"
)


def assert_right(optimum, added, answer, *, anew=True):
    """As the certificate says, and as the whole program says from the start."""
    assert max(naive.errors(optimum, added, answer).values()) <= 1e-9
    if not anew:
        return
    status, alpha = naive.solved(naive.whole(optimum, added), optimum.sign)
    assert answer.status == status
    if status == OPTIMAL:
        assert answer.alpha == pytest.approx(alpha, abs=1e-9)


def cones(first, second, entries):
    table = np.ascontiguousarray(np.array(entries, float).reshape(-1, 6).T)
    return Cones(np.array(first, np.int32), np.array(second, np.int32), table)


def edges_of(interfaces, blocks, mu):
    """The two edges of the cone of every contact point."""

    def body(number):
        if number == GROUND:
            return GROUND_BODY
        place, block = blocks[number]
        return place, *block.centroid

    return Cones(
        *cone_edges(
            [(body(interface.block), body(interface.other)) for interface in interfaces],
            [interface.normal for interface in interfaces],
            [mu] * len(interfaces),
            [interface.points for interface in interfaces],
            LENGTH_PX,
        )
    )


def added_blocks(model, placed, new):
    """Some blocks of a model on top of others, with all contacts to those and to each other."""
    blocks = {block.id: (i, block) for i, block in enumerate([*placed, *new])}
    ids = {block.id for block in new}
    there = {GROUND, *blocks}
    touching = [
        i for i in model.interfaces if ids & {i.block, i.other} and {i.block, i.other} <= there
    ]
    weights = np.array([block.weight for block in new]) / LENGTH_PX**2
    return Added(weights, edges_of(touching, blocks, model.mu), NOTHING)


def steps(labels, candidates, at_once=1):
    """What may be added, step by step, from the lowest block up; the first one is chosen."""
    model = model_from_labels(labels).model
    rest = sorted(model.blocks, key=lambda block: block.centroid[1])
    placed = []
    while len(rest) >= at_once:
        groups = [rest[:at_once], *([block] for block in rest[at_once : at_once + candidates - 1])]
        yield [added_blocks(model, placed, group) for group in groups]
        placed += rest[:at_once]
        rest = rest[at_once:]


def grown(labels, candidates=1, at_once=1):
    """The optima of a wall that grows, and what may be added to it; ends when it falls."""
    optima = {sign: Optimum.of_nothing(sign) for sign in SIGNS}
    for choices in steps(labels, candidates, at_once):
        yield optima, choices
        answers = {sign: optima[sign].solved_with(choices[0]) for sign in SIGNS}
        if any(answer.status != simplex.OPTIMAL for answer in answers.values()):
            return
        optima = {sign: optima[sign].extended(choices[0], answers[sign]) for sign in SIGNS}


def with_columns(added, more):
    """The same with more columns."""
    old = added.cones
    return Added(
        added.weights,
        Cones(
            np.concatenate((old.first, more.first)),
            np.concatenate((old.second, more.second)),
            np.ascontiguousarray(np.concatenate((old.entries, more.entries), axis=1)),
        ),
        added.closed,
    )


def some_columns(some, places):
    """Some of the columns."""
    entries = np.ascontiguousarray(some.entries[:, places])
    return Cones(some.first[places], some.second[places], entries)


def variants(optimum, added, seed):
    """What else could be added: degenerate, near to it, with contacts that go."""
    rng = np.random.default_rng(seed)
    new, old = added.cones, optimum.cones
    found = {
        "twice": with_columns(added, new),
        "nothing": Added(added.weights, some_columns(new, np.arange(0)), NOTHING),
        "a point": Added(added.weights, some_columns(new, np.arange(len(new.first))[:2]), NOTHING),
        "heavy": Added(added.weights * 40.0, new, NOTHING),
        "light": Added(added.weights / 1000.0, new, NOTHING),
    }  # fmt: skip
    for amount in (1e-6, 1e-9):
        noise = 1.0 + amount * rng.standard_normal(new.entries.shape)
        found[f"nearly twice, {amount}"] = with_columns(
            added, Cones(new.first, new.second, new.entries * noise)
        )
    if len(old.first):
        columns = np.sort(rng.choice(len(old.first), min(4, len(old.first)), replace=False))
        basic = np.sort(optimum.basis.basic[optimum.basis.basic >= 0])[:3]
        moved = some_columns(old, columns)
        bent = moved.entries * (1.0 + 0.05 * rng.standard_normal(moved.entries.shape))
        between = Cones(moved.first, moved.second, bent)
        none = np.empty(0)
        found["closed"] = Added(added.weights, new, columns.astype(np.int32))
        found["closed, basic"] = Added(added.weights, new, basic.astype(np.int32))
        found["only closed"] = Added(none, some_columns(new, np.arange(0)), basic.astype(np.int32))
        found["only columns"] = Added(none, between, NOTHING)
        found["columns below"] = with_columns(added, between)
        found["nothing, columns below"] = Added(added.weights, between, NOTHING)
    return found


def identical(one, other):
    """Equal, number by number."""
    same = (one.status, one.pivots, one.restarts) == (other.status, other.pivots, other.restarts)
    alpha = one.alpha == other.alpha or (np.isnan(one.alpha) and np.isnan(other.alpha))
    forces = np.array_equal(one.forces, other.forces)
    return bool(same and alpha and forces and np.array_equal(one.velocity, other.velocity))


def differing(one, other):
    """Names of what is not equal in two optima."""
    parts = (
        (one.basis, other.basis, vars(one.basis)),
        (one, other, ("sign", "alpha", "weights", "forces", "velocity")),
        (one.cones, other.cones, ("first", "second", "entries")),
    )
    return [
        name
        for mine, others, names in parts
        for name in names
        if not np.array_equal(getattr(mine, name), getattr(others, name))
    ]
