import numpy as np
import pytest

from drystone.statics.asking import answered
from drystone.statics.contacts.blocks import model_from_labels
from drystone.statics.limit import limit_load
from drystone.statics.loads import growing_with_height
from drystone.statics.program import assemble
from drystone.statics.saved_program import load_program, save_program
from drystone.statics.solvers.highs import HighsSession
from tests.statics.walls import coursed


@pytest.mark.parametrize("growing", [False, True])
def test_a_saved_program_is_the_program(tmp_path, growing):
    model = model_from_labels(coursed(3, 4, 90)).model
    loads = growing_with_height(model) if growing else None
    save_program(model, loads, tmp_path / "failed.npz")
    program, expected = load_program(tmp_path / "failed.npz"), assemble(model, loads)
    assert program.block_ids == expected.block_ids
    for name in ("rows", "start", "index", "value", "rhs", "friction"):
        assert np.array_equal(getattr(program, name), getattr(expected, name)), name
    assert (program.length, program.weight) == (expected.length, expected.weight)
    again = answered(program, HighsSession(program), 1.0)
    assert again.alpha == limit_load(model, "right", loads).alpha
