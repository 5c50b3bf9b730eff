import numpy as np
import pytest
from matplotlib.colors import to_hex

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.drawing import plot_contacts
from drystone.drawing.palette import FIXED_COLOUR, PALE
from drystone.drawing.pictures.forces import KIND_COLOURS, NORMAL_SHARE
from tests.drawing.pictures.test_stones import patches
from tests.statics.walls import coursed, irregular, stacked

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
    drawn = patches(ax)
    for block, corner, opposite in ((1, (0, 0), (20, 10)), (2, (5, 10), (25, 20))):
        corners = drawn[f"block-{block}"].get_path().vertices
        np.testing.assert_allclose(corners.min(axis=0), corner)
        np.testing.assert_allclose(corners.max(axis=0), opposite)
    assert drawn["ground"].get_path().get_extents().y1 == 0
    ends = dots(ax, "end of an interface")
    np.testing.assert_allclose(ends, [[0, 0], [20, 0], [5, 10], [20, 10]])


def test_normals_of_short_interfaces_are_shorter():
    model = model_from_labels(irregular(3, 40, 200, 100)).model
    spans = np.diff(lines(plot_contacts(irregular(3, 40, 200, 100), model), "normals"), axis=1)
    length = np.hypot(*spans[:, 0].T)
    assert length.max() == pytest.approx(NORMAL_SHARE * 100)
    assert length.min() == pytest.approx(NORMAL_SHARE * 100 / 3)
    assert length.max() > length.min()


def test_contacts_at_a_point_are_dots_of_their_own():
    ax = plot_contacts(CORNERED, model_from_labels(CORNERED).model)
    np.testing.assert_allclose(dots(ax, "contact at a point"), [[4, 4]])
    np.testing.assert_allclose(dots(ax, "end of an interface"), [[0, 0], [4, 0]])


def test_the_kinds_of_a_mechanism_colour_the_points():
    model = model_from_labels(CORNERED).model
    ax = plot_contacts(CORNERED, model, kinds=("closed", "sliding", "opening"))
    np.testing.assert_allclose(dots(ax, "sliding"), [[4, 0]])
    np.testing.assert_allclose(dots(ax, "opening"), [[4, 4]])
    colours = {line.get_gid(): line.get_color() for line in ax.lines}
    assert colours["sliding"] == KIND_COLOURS["sliding"] != KIND_COLOURS["closed"]
    assert [text.get_text() for text in ax.get_legend().get_texts()][2:] == list(KIND_COLOURS)
    with pytest.raises(ValueError, match="2 kinds for 3 contact points"):
        plot_contacts(CORNERED, model, kinds=("closed", "closed"))


def test_polygons_and_fixed_blocks():
    ax = plot_contacts(polygons_from_json(ABUTMENT), model_from_json(ABUTMENT))
    drawn = patches(ax)
    assert to_hex(drawn["block-4"].get_facecolor()) == FIXED_COLOUR
    assert to_hex(drawn["block-9"].get_facecolor()) == PALE
    assert [[1, 0], [1, 2]] in np.sort(lines(ax, "interfaces"), axis=1).tolist()


def test_everything_is_in_view():
    labels = coursed(3, 4, 90)
    ax = plot_contacts(labels, model_from_labels(labels).model)
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    assert x0 < 0
    assert y0 < 0
    assert x1 > 90
    assert y1 > labels.shape[0]


def test_a_model_of_another_wall_is_refused():
    with pytest.raises(ValueError, match=r"lacks: \[2\]"):
        plot_contacts(stacked((5, 5, 0)), model_from_labels(CORNERED).model)


def test_nothing_to_draw():
    empty = np.zeros((4, 4), np.uint32)
    ax = plot_contacts(empty, model_from_labels(empty).model)
    assert len(dots(ax, "end of an interface")) == 0
