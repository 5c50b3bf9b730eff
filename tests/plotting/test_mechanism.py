from itertools import pairwise

import numpy as np
import pytest
from matplotlib.colors import to_hex

from drystone.plotting import plot_mechanism
from drystone.plotting.mechanism import COLOURS, LARGEST_SHARE
from drystone.plotting.palette import relative_luminance
from drystone.statics.result import Mechanism
from tests.plotting import examples
from tests.plotting.test_stones import patches

L_CORNERS = np.array([[0, 8], [12, 8], [12, 12], [6, 12], [6, 16], [0, 16], [0, 8]], float)


def labels():
    return examples.wall().labels


def vertices(ax, gid):
    return patches(ax)[gid].get_path().vertices


def slide(velocity):
    """Let only the L-shaped stone 12 move."""
    return Mechanism((12,), np.array([velocity], float))


def test_a_sliding_block_moves_by_the_largest_share_of_the_height():
    ax = plot_mechanism(labels(), slide((-1, 0, 0)), "left", 0.4)
    # The wall of the example is 16 px high.
    np.testing.assert_allclose(vertices(ax, "moved-12"), L_CORNERS - [16 * LARGEST_SHARE, 0])
    np.testing.assert_allclose(vertices(ax, "before-12"), L_CORNERS)
    np.testing.assert_allclose(vertices(ax, "moved-3"), vertices(ax, "before-3"))


def test_turning_is_linearised_about_the_centroid_and_counter_clockwise():
    # A block that only turns: a point right of the centroid goes up, one above goes left.
    ax = plot_mechanism(labels(), slide((0, 0, 1)), "left", 0.4)
    arms = L_CORNERS - (5.0, 34 / 3)
    factor = 16 * LARGEST_SHARE / np.hypot(*arms.T).max()
    expected = L_CORNERS + factor * np.column_stack([-arms[:, 1], arms[:, 0]])
    np.testing.assert_allclose(vertices(ax, "moved-12"), expected)


def test_no_point_moves_further_than_the_largest_share():
    ax = plot_mechanism(labels(), examples.mechanism(), "left", 0.4)
    ids = [3, 5, 8, 12, 300, examples.WEDGE]
    moves = [vertices(ax, f"moved-{i}") - vertices(ax, f"before-{i}") for i in ids]
    lengths = np.concatenate([np.hypot(*move.T) for move in moves])
    assert lengths.max() == pytest.approx(16 * LARGEST_SHARE)
    assert 0.10 <= LARGEST_SHARE <= 0.15


def test_colour_is_the_share_of_the_largest_displacement():
    drawn = patches(plot_mechanism(labels(), examples.mechanism(), "left", 0.4))
    colour = {i: to_hex(drawn[f"moved-{i}"].get_facecolor()) for i in (3, 12, 300)}
    assert colour == {3: to_hex(COLOURS(0.0)), 12: to_hex(COLOURS(1.0)), 300: to_hex(COLOURS(0.5))}


def test_colours_darken_steadily():
    tones = [relative_luminance(to_hex(COLOURS(share))) for share in np.linspace(0, 1, 20)]
    assert all(before > after for before, after in pairwise(tones))


@pytest.mark.parametrize(("direction", "sign"), [("left", -1), ("right", 1)])
def test_the_arrow_points_where_the_load_goes(direction, sign):
    ax = plot_mechanism(labels(), examples.mechanism(), direction, 0.4321)
    (arrow,) = [text for text in ax.texts if text.get_gid() == "live-load"]
    assert np.sign(arrow.xy[0] - arrow.get_position()[0]) == sign
    assert any(f"to the {direction}" in t.get_text() and "0.432" in t.get_text() for t in ax.texts)


def test_an_unknown_alpha_is_left_out():
    ax = plot_mechanism(labels(), examples.mechanism(), "left")
    assert not any("None" in t.get_text() or "=" in t.get_text() for t in ax.texts)


def test_everything_drawn_is_in_view():
    ax = plot_mechanism(labels(), slide((-1, 0.5, 0.2)), "left", 0.4)
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    points = np.concatenate([patch.get_path().vertices for patch in ax.patches[1:]])
    assert x0 < points[:, 0].min()
    assert points[:, 0].max() < x1
    assert y0 < 0
    assert points[:, 1].max() < y1


def test_a_mechanism_without_motion_is_drawn_at_rest():
    ax = plot_mechanism(labels(), slide((0, 0, 0)), "left", 0.4)
    np.testing.assert_allclose(vertices(ax, "moved-12"), L_CORNERS)


def test_a_mechanism_of_another_wall_is_refused():
    stranger = Mechanism((12, 99), np.zeros((2, 3)))
    with pytest.raises(ValueError, match=r"lacks: \[99\]"):
        plot_mechanism(labels(), stranger, "left")


def test_there_is_a_colour_bar_from_zero_to_one():
    figure = plot_mechanism(labels(), examples.mechanism(), "left", 0.4).figure
    _, bar = figure.axes
    assert bar.get_ylim() == (0, 1)
    assert "displacement" in bar.get_ylabel()
