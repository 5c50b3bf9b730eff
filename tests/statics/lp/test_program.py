"""The linear program as arrays: its units, and its way through a file."""

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.statics.loads import growing_with_height
from drystone.statics.lp.extremes import certified_extreme
from drystone.statics.lp.highs import HighsSession
from drystone.statics.lp.program import EquilibriumProgram, Units, assemble, units_of
from drystone.statics.model import Block, RigidBlockModel
from tests.statics.walls import coursed, limit_load, stacked


def test_units_are_those_of_a_mean_free_block():
    blocks = (
        Block(1, 4.0, (0.0, 0.0)),
        Block(2, 12.0, (0.0, 0.0), density=3.0),
        Block(3, 99.0, (0.0, 0.0), fixed=True),
    )
    units = units_of(RigidBlockModel(blocks, ()))
    assert (units.length, units.weight) == (pytest.approx(8**0.5), 20.0)


def test_units_scale_forces_and_moments():
    model = model_from_labels(stacked((20, 20, 0))).model
    program = assemble(model, units=Units(10.0, 100.0))
    assert program.rhs == pytest.approx([0.0, 4.0, 0.0])
    matrix = program.matrix.toarray()
    assert matrix[:, 0] == pytest.approx([4.0, 0.0, 0.0])
    assert np.abs(matrix[2, 1:]) == pytest.approx([0.42, 1.58, 1.58, 0.42])


@pytest.mark.parametrize("growing", [False, True])
def test_a_saved_program_is_the_program(tmp_path, growing):
    model = model_from_labels(coursed(3, 4, 90)).model
    loads = growing_with_height(model) if growing else None
    expected = assemble(model, loads)
    expected.save(tmp_path / "failed.npz")
    program = EquilibriumProgram.load(tmp_path / "failed.npz")
    assert program.block_ids == expected.block_ids
    for name in ("rows", "start", "index", "value", "rhs", "friction"):
        assert np.array_equal(getattr(program, name), getattr(expected, name)), name
    assert (program.length, program.weight) == (expected.length, expected.weight)
    again = certified_extreme(program, HighsSession(program), 1.0)
    assert again.alpha == limit_load(model, "right", loads).alpha
