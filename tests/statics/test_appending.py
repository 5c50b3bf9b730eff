from dataclasses import replace

import numpy as np
import pytest

from drystone.statics.appending import OpenProgram, Units, units_of
from drystone.statics.contacts.blocks import model_from_labels
from drystone.statics.model import Block, RigidBlockModel
from drystone.statics.program import assemble
from tests.statics.walls import coursed, irregular, stacked


def varied(labels):
    """A wall with fixed, guided and heavier blocks, and with other frictions here and there."""
    model = model_from_labels(labels).model
    changes = ({"fixed": True}, {"held": ("x", "turn")}, {"held": ("y",)}, {"density": 2.5}, {})
    blocks = [replace(b, **changes[k % len(changes)]) for k, b in enumerate(model.blocks)]
    frictions = (None, 0.3, 0.0)
    interfaces = [replace(i, mu=frictions[k % 3]) for k, i in enumerate(model.interfaces)]
    return RigidBlockModel(tuple(blocks), tuple(interfaces), 0.7)


def grown(model, units, sizes=(1, 2)):
    """Append blocks in groups, each with the interfaces that it brings.

    Returns the program and the model with its interfaces in that order.
    """
    program, built = OpenProgram.empty(units), RigidBlockModel((), (), model.mu)
    while len(built.blocks) < len(model.blocks):
        count = len(built.blocks)
        blocks = model.blocks[count : count + sizes[count % len(sizes)]]
        there = {0, *(block.id for block in (*built.blocks, *blocks))}
        new = tuple(
            i for i in model.interfaces if i not in built.interfaces and {i.block, i.other} <= there
        )
        built = RigidBlockModel((*built.blocks, *blocks), (*built.interfaces, *new), model.mu)
        program = program.appended(built, blocks, new)
    return program, built


def assert_same(program, expected):
    assert program.block_ids == expected.block_ids
    assert program.rows.tolist() == expected.rows.tolist()
    assert program.start.tolist() == expected.start.tolist()
    assert program.start.dtype == program.index.dtype == np.int32
    assert program.index.tolist() == expected.index.tolist()
    assert program.value == pytest.approx(expected.value, abs=1e-12)
    assert program.rhs == pytest.approx(expected.rhs, abs=1e-12)
    assert program.friction.tolist() == expected.friction.tolist()
    assert program.length == pytest.approx(expected.length)
    assert program.weight == pytest.approx(expected.weight)


@pytest.mark.parametrize("labels", [coursed(5, 4, 90, 3), irregular(6, 14, 90, 60)])
@pytest.mark.parametrize("change", [lambda labels: model_from_labels(labels).model, varied])
def test_appending_gives_the_program_of_the_whole(labels, change):
    model = change(labels)
    program, built = grown(model, units_of(model))
    assert_same(program.program, assemble(built))


def test_what_was_there_does_not_change():
    model = model_from_labels(stacked((20, 20, 0), (10, 10, 4))).model
    first = RigidBlockModel(model.blocks[:1], model.interfaces[:1], model.mu)
    before = OpenProgram.empty(Units(10.0, 100.0)).appended(first, first.blocks, first.interfaces)
    value = before.program.value.copy()
    after = before.appended(model, model.blocks[1:], model.interfaces[1:])
    assert before.program.value.tolist() == value.tolist()
    assert list(before.seats) == [1]
    assert list(after.seats) == [1, 2]


def test_units_scale_forces_and_moments():
    model = model_from_labels(stacked((20, 20, 0))).model
    program = grown(model, Units(10.0, 100.0))[0].program
    assert program.rhs == pytest.approx([0.0, 4.0, 0.0])
    matrix = program.matrix.toarray()
    assert matrix[:, 0] == pytest.approx([4.0, 0.0, 0.0])
    assert np.abs(matrix[2, 1:]) == pytest.approx([0.42, 1.58, 1.58, 0.42])


def test_contact_points_can_be_left_out():
    model = varied(coursed(7, 3, 80))
    program, built = grown(model, units_of(model))
    gone = built.interfaces[2::3]
    stay = np.repeat(
        [i not in gone for i in built.interfaces], [len(i.points) for i in built.interfaces]
    )
    kept = tuple(i for i in built.interfaces if i not in gone)
    expected = assemble(RigidBlockModel(built.blocks, kept, built.mu))
    assert_same(program.with_points(stay).program, expected)


def test_units_are_those_of_a_mean_free_block():
    blocks = (
        Block(1, 4.0, (0.0, 0.0)),
        Block(2, 12.0, (0.0, 0.0), density=3.0),
        Block(3, 99.0, (0.0, 0.0), fixed=True),
    )
    units = units_of(RigidBlockModel(blocks, ()))
    assert (units.length, units.weight) == (pytest.approx(8**0.5), 20.0)
