import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.drawing import plot_forces
from drystone.drawing.pictures.forces import LONGEST_SHARE, WIDEST_PT, resultants
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Interface, RigidBlockModel
from tests.drawing.pictures.test_contacts import dots, lines
from tests.statics.walls import coursed, irregular, stacked
from tests.strategies import repeatable


def solved(labels, direction="right"):
    model = model_from_labels(labels).model
    return model, getattr(lateral_resistance(model, mechanism=True), direction).forces


def widths(ax, gid):
    (found,) = [collection for collection in ax.collections if collection.get_gid() == gid]
    return np.array(found.get_linewidths())


@pytest.mark.parametrize("direction", ["left", "right"])
def test_the_thrust_of_a_tall_block_passes_its_toe(direction):
    """Rocking at alpha = .5: weight 800 down and 400 sideways through the toe."""
    model, forces = solved(stacked((20, 40, 0)), direction)
    (one,) = resultants(model, forces)
    sign = 1 if direction == "right" else -1
    assert one.point == pytest.approx([20 if sign > 0 else 0, 0], abs=1e-9)
    assert one.force == pytest.approx([-sign * 400, 800])


@given(seed=st.integers(0, 10**6), count=st.integers(2, 12), coursing=st.booleans())
@repeatable(15)
def test_resultants_hold_every_block_in_equilibrium(seed, count, coursing):
    """Forces at their points of action, not only at the contact points they come from."""
    labels = coursed(seed, 3, 60) if coursing else irregular(seed, count, 90, 50)
    model = model_from_labels(labels).model
    result = lateral_resistance(model, mechanism=True).right
    if result.forces is None:
        return
    load = {b.id: b.weight * np.array([result.alpha, -1.0, 0.0]) for b in model.blocks}
    centroid = {block.id: np.array(block.centroid) for block in model.blocks}
    for one in resultants(model, result.forces):
        for block, sign in ((one.interface.block, 1.0), (one.interface.other, -1.0)):
            if block != GROUND:
                arm, force = one.point - centroid[block], sign * one.force
                load[block] += (*force, arm[0] * force[1] - arm[1] * force[0])
    total = sum(block.weight for block in model.blocks)
    assert max(np.abs(left).max() for left in load.values()) < 1e-4 * total


def test_a_force_along_its_interface_acts_in_the_middle():
    ends = np.array([[0.0, 0.0], [4.0, 0.0]])
    block = model_from_labels(stacked((4, 4, 0))).model.blocks
    model = RigidBlockModel(block, (Interface(1, GROUND, ends, (0.0, 1.0)),))
    (one,) = resultants(model, np.array([[1.0, 2.0], [-1.0, 3.0]]))
    assert one.point == pytest.approx([2, 0])
    assert one.force == pytest.approx([5, 0])


def test_a_contact_at_a_point_carries_its_force_there():
    ends = np.array([[3.0, 0.0]])
    block = model_from_labels(stacked((4, 4, 0))).model.blocks
    model = RigidBlockModel(block, (Interface(1, GROUND, ends, (0.6, 0.8)),))
    (one,) = resultants(model, np.array([[10.0, 5.0]]))
    assert one.point == pytest.approx([3, 0])
    assert one.force == pytest.approx([6 + 4, 8 - 3])  # the tangent of (.6, .8) is (.8, -.6)


def test_idle_interfaces_are_left_out():
    rows = {"blocks_xywh": [[0, 0, 2, 1], [2, 0, 2, 1]]}
    model = model_from_json(rows)
    forces = np.zeros((model.contact_count, 2))
    forces[:2, 0] = 1.0
    assert [one.interface.block for one in resultants(model, forces)] == [1]
    assert resultants(model, np.zeros_like(forces)) == ()


def test_forces_of_another_model_are_refused():
    model, forces = solved(stacked((20, 40, 0)))
    with pytest.raises(ValueError, match="1 forces for 2 contact points"):
        resultants(model, forces[:1])


@pytest.mark.parametrize("empty_rows", [0, 5])
def test_resultants_are_drawn_to_scale_through_their_points(empty_rows):
    labels = np.pad(stacked((40, 20, 0), (10, 20, 15)), ((0, empty_rows), (0, 0)))
    model, forces = solved(labels)
    ax = plot_forces(labels, model, forces)
    acting = resultants(model, forces)
    largest = max(one.size for one in acting)
    drawn = lines(ax, "resultants")
    np.testing.assert_allclose(drawn.mean(axis=1), [one.point for one in acting])
    spans = drawn[:, 1] - drawn[:, 0]
    scale = LONGEST_SHARE * 40 / largest  # the wall is 40 px high
    np.testing.assert_allclose(spans, [scale * one.force for one in acting])
    np.testing.assert_allclose(
        widths(ax, "thrust"), [WIDEST_PT * one.size / largest for one in acting]
    )
    np.testing.assert_allclose(dots(ax, "points-of-action")[:, 1], [0, 20])

    (found,) = [c for c in ax.collections if c.get_gid() == "thrust"]
    ground, joint = found.get_segments()
    np.testing.assert_allclose(ground, [(20, 10), acting[0].point])
    np.testing.assert_allclose(joint, [(20, 30), acting[1].point, (20, 10)])


def test_the_bar_is_a_round_number_of_mean_weights():
    labels = stacked((20, 20, 0), (20, 20, 0), (20, 20, 0))
    model, forces = solved(labels)
    ax = plot_forces(labels, model, forces)
    (bar,) = [line for line in ax.lines if line.get_gid() == "scale-length"]
    (text,) = [t.get_text() for t in ax.texts]
    assert text == "1 \u00d7 the mean weight of a block = 33 % of the wall's weight"
    (largest,) = [one.size for one in resultants(model, forces) if one.interface.other == GROUND]
    length = np.ptp(bar.get_xdata())
    assert length == pytest.approx(LONGEST_SHARE * 60 * 400 / largest)
    (wide,) = [line for line in ax.lines if line.get_gid() == "scale-width"]
    assert wide.get_linewidth() == pytest.approx(WIDEST_PT * 400 / largest)


def test_everything_drawn_is_in_view():
    labels = stacked((10, 40, 0))
    model, forces = solved(labels)
    ax = plot_forces(labels, model, forces)
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    points = np.concatenate([*lines(ax, "resultants"), [[0, 40], [10, 0]]])
    assert x0 < points[:, 0].min()
    assert y0 < points[:, 1].min() < 0
    assert x1 > points[:, 0].max()
    assert y1 > points[:, 1].max()


def test_a_wall_without_forces_is_drawn_pale():
    labels = stacked((10, 40, 0))
    model = model_from_labels(labels).model
    ax = plot_forces(labels, model, np.zeros((2, 2)))
    assert [lines.get_gid() for lines in ax.collections] == ["ground-line"]
    assert len(ax.patches) == 2
