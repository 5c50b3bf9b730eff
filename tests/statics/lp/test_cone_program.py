"""The program for the simplex kernel has the numbers of the one for HiGHS."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.statics.lp.cone_program import ConeProgram
from drystone.statics.lp.program import Units, assemble
from drystone.statics.model import RigidBlockModel
from tests.naive import columns as naive
from tests.statics.growth import empty, with_block
from tests.statics.walls import coursed, irregular

UNITS = Units(13.0, 170.0)


def varied(labels):
    """Heavier blocks, and other frictions here and there."""
    model = model_from_labels(labels).model
    blocks = [replace(b, density=(1.0, 2.5)[k % 2]) for k, b in enumerate(model.blocks)]
    interfaces = [replace(i, mu=(None, 0.3, 0.0)[k % 3]) for k, i in enumerate(model.interfaces)]
    return RigidBlockModel(tuple(blocks), tuple(interfaces), 0.7)


def grown(whole, sizes=(1, 2)):
    """Both programs and the model, block by block or two at once, an interface lost at times."""
    cones, model = ConeProgram.empty(UNITS), empty(whole.mu)
    rest = list(whole.blocks)
    while rest:
        size = sizes[len(rest) % len(sizes)]
        blocks, rest = rest[:size], rest[size:]
        step = with_block(model, *blocks, whole=whole).added
        closed = (2, 5) if len(rest) % 7 == 4 and len(model.interfaces) > 5 else ()
        model = model.with_added(step.blocks, step.interfaces, closed)
        cones = cones.appended(model.added, cones.columns_of(model.added, model.mu))
        yield cones, assemble(model, units=UNITS), model


@pytest.mark.parametrize("labels", [coursed(5, 4, 90, 3), irregular(6, 14, 90, 60)])
def test_it_grows_as_the_other_program_does(labels):
    whole = varied(labels)
    for cones, program, model in grown(whole):
        count = len(model.blocks)
        matrix = program.matrix.toarray()
        assert np.array_equal(naive.dense(cones.cones, count), matrix[:, 1:])
        assert np.array_equal(np.repeat(cones.weights, 3) * np.tile([1, 0, 0], count), matrix[:, 0])
        assert np.array_equal(cones.weights, program.rhs[1::3])
        places = [place for place, _, _ in cones.bodies.values() if place >= 0]
        assert places == list(range(count))
        assert list(cones.bodies)[1:] == list(program.block_ids)
        assert cones.centroid_x.tolist() == [block.centroid[0] for block in model.blocks]
        repeats = [2 * len(interface.points) for interface in model.interfaces]
        expected = np.repeat(np.arange(len(repeats)), repeats)
        assert cones.interfaces.tolist() == expected.tolist()
