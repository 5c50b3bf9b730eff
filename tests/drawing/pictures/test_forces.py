"""Contacts and the thrust between blocks."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_hex

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.drawing import plot_contacts, plot_forces
from drystone.drawing.palette import FIXED_COLOUR, PALE
from drystone.drawing.pictures.forces import LONGEST_SHARE, NORMAL_SHARE, WIDEST_PT, resultants
from drystone.statics.model import GROUND, Interface, RigidBlockModel
from tests.drawing.pictures.test_stones import patches
from tests.statics.walls import coursed, irregular, limit_load, stacked
from tests.strategies import repeatable

CORNERED = np.zeros((8, 8), np.uint32)
CORNERED[4:, :4], CORNERED[:4, 4:] = 1, 2
ABUTMENT = {
    "blocks": [
        {"id": 4, "polygon": [[0, 0], [0, 3], [1, 3], [1, 0]], "fixed": True},
        {"id": 9, "polygon": [[1, 0], [3, 0], [3, 2], [1, 2]]},
    ]
}


def lines(ax, gid):
    (found,) = [collection for collection in ax.collections if collection.get_gid() == gid]
    return np.array(found.get_segments())


def dots(ax, gid):
    (found,) = [line for line in ax.lines if line.get_gid() == gid]
    return found.get_xydata()


@pytest.mark.parametrize("empty_rows", [0, 6])
def test_interfaces_lie_where_the_blocks_touch(empty_rows):
    """The ground of the model is the lowest stone pixel, whatever is below it."""
    labels = np.pad(stacked((20, 10, 0), (20, 10, 5)), ((0, empty_rows), (0, 0)))
    ax = plot_contacts(labels, model_from_labels(labels).model)
    np.testing.assert_allclose(lines(ax, "interfaces"), [[[0, 0], [20, 0]], [[5, 10], [20, 10]]])
    length = NORMAL_SHARE * 20  # the wall is 20 px high
    expected = [[[10, 0], [10, length]], [[12.5, 10], [12.5, 10 + length]]]
    np.testing.assert_allclose(lines(ax, "normals"), expected)
    drawn = {gid: patch.get_path().get_extents() for gid, patch in patches(ax).items()}
    np.testing.assert_allclose(drawn["block-1"].get_points(), [(0, 0), (20, 10)])
    np.testing.assert_allclose(drawn["block-2"].get_points(), [(5, 10), (25, 20)])
    assert drawn["ground"].y1 == 0
    ends = dots(ax, "end of an interface")
    np.testing.assert_allclose(ends, [[0, 0], [20, 0], [5, 10], [20, 10]])


def test_points_are_dots_fixed_blocks_have_a_colour_and_next_to_nothing_can_be_drawn():
    ax = plot_contacts(CORNERED, model_from_labels(CORNERED).model)
    np.testing.assert_allclose(dots(ax, "contact at a point"), [[4, 4]])
    np.testing.assert_allclose(dots(ax, "end of an interface"), [[0, 0], [4, 0]])
    ax = plot_contacts(polygons_from_json(ABUTMENT), model_from_json(ABUTMENT))
    drawn = patches(ax)
    assert to_hex(drawn["block-4"].get_facecolor()) == FIXED_COLOUR
    assert to_hex(drawn["block-9"].get_facecolor()) == PALE
    assert [[1, 0], [1, 2]] in np.sort(lines(ax, "interfaces"), axis=1).tolist()
    with pytest.raises(ValueError, match=r"lacks: \[2\]"):
        plot_contacts(stacked((5, 5, 0)), model_from_labels(CORNERED).model)
    empty = np.zeros((4, 4), np.uint32)
    ax = plot_contacts(empty, model_from_labels(empty).model)
    assert len(dots(ax, "end of an interface")) == 0
    labels = stacked((10, 40, 0))
    ax = plot_forces(labels, model_from_labels(labels).model, np.zeros((2, 2)))
    assert [lines.get_gid() for lines in ax.collections] == ["ground-line"]


def solved(labels):
    model = model_from_labels(labels).model
    return model, limit_load(model, "right", mechanism=True).forces


@given(seed=st.integers(0, 10**6), count=st.integers(2, 12), coursing=st.booleans())
@repeatable(15)
def test_resultants_hold_every_block_in_equilibrium(seed, count, coursing):
    """Forces at their points of action, not only at the contact points they come from."""
    labels = coursed(seed, 3, 60) if coursing else irregular(seed, count, 90, 50)
    model = model_from_labels(labels).model
    result = limit_load(model, "right", mechanism=True)
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


@pytest.mark.parametrize(("ends", "normal", "forces", "point", "force"), [
    # Along its interface it acts in the middle.
    ([[0.0, 0.0], [4.0, 0.0]], (0.0, 1.0), [[1.0, 2.0], [-1.0, 3.0]], [2, 0], [5, 0]),
    # The tangent of (.6, .8) is (.8, -.6).
    ([[3.0, 0.0]], (0.6, 0.8), [[10.0, 5.0]], [3, 0], [6 + 4, 8 - 3]),
])  # fmt: skip
def test_a_force_acts_at_the_only_point_or_in_the_middle(ends, normal, forces, point, force):
    block = model_from_labels(stacked((4, 4, 0))).model.blocks
    model = RigidBlockModel(block, (Interface(1, GROUND, np.array(ends), normal),))
    (one,) = resultants(model, np.array(forces))
    assert (one.point, one.force) == (pytest.approx(point), pytest.approx(force))
    # Idle interfaces have none, and forces of another model are refused.
    assert resultants(model, 0 * np.array(forces)) == ()
    twice = RigidBlockModel(block, model.interfaces * 2)
    assert len(resultants(twice, np.concatenate([0 * np.array(forces), forces]))) == 1
    with pytest.raises(ValueError, match=f"{len(forces) + 1} forces for {len(forces)} contact p"):
        resultants(model, np.array([*forces, [1.0, 0.0]]))


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
    np.testing.assert_allclose(dots(ax, "points-of-action")[:, 1], [0, 20])

    (found,) = [c for c in ax.collections if c.get_gid() == "thrust"]
    widths = [WIDEST_PT * one.size / largest for one in acting]
    np.testing.assert_allclose(found.get_linewidths(), widths)
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
    # Everything is in view.
    points = np.concatenate([*lines(ax, "resultants"), [[0, 60], [20, 0]]])
    low, high = np.transpose([ax.get_xlim(), ax.get_ylim()])
    assert ((low < points) & (points < high)).all()
