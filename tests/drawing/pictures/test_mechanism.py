"""The failure mechanism of a wall, still and in motion."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_hex
from PIL import Image

from drystone.contacts.blocks import model_from_labels
from drystone.drawing import mechanism_frames, plot_mechanism, save_mechanism_animation
from drystone.drawing.pictures.mechanism import (
    COLOURS,
    FRAME_MS,
    LARGEST_SHARE,
    LARGEST_TURN,
    LONGER_SIDE_PX,
    motion_of,
)
from drystone.statics.result import Mechanism
from tests.drawing import examples
from tests.drawing.pictures.test_stones import numbers, patches
from tests.polygons import box
from tests.statics.walls import limit_load, stacked
from tests.strategies import repeatable

L_CORNERS = np.array([[64, 0], [72, 0], [72, 12], [68, 12], [68, 6], [64, 6], [64, 0]], float)
HIGH = 26
"""The wall of the example, px."""

LABELS = examples.wall().labels


def vertices(ax, gid):
    return patches(ax)[gid].get_path().vertices


def slide(velocity, stone=12):
    """Let only the L-shaped stone 12 move, or another one."""
    return Mechanism((stone,), np.array([velocity], float))


def test_a_sliding_block_moves_with_its_number_by_the_largest_share_of_the_height():
    largest = HIGH * LARGEST_SHARE
    for asked, said in ((True, "12"), ({12: 7}, "7")):
        ax = plot_mechanism(LABELS, slide((-1, 0, 0)), "left", 0.4, numbers=asked)
        assert numbers(ax)[said].get_position() == pytest.approx((206 / 3 - largest, 5.0))
    np.testing.assert_allclose(vertices(ax, "moved-12"), L_CORNERS - [largest, 0])
    np.testing.assert_allclose(vertices(ax, "before-12"), L_CORNERS)
    np.testing.assert_allclose(vertices(ax, "moved-3"), vertices(ax, "before-3"))
    # What moves out of the wall is in view.
    assert plot_mechanism(LABELS, slide((-1, 0, 0), 3), "left").get_xlim()[0] < -largest
    # What stays has no multiplier.
    still = plot_mechanism(LABELS, slide((0, 0, 0)), "left")
    assert not any("None" in t.get_text() or "=" in t.get_text() for t in still.texts)
    np.testing.assert_allclose(vertices(still, "moved-12"), L_CORNERS)
    # Colour is the share of the largest displacement.
    drawn = patches(plot_mechanism(LABELS, examples.mechanism(), "left", 0.4))
    colour = {i: to_hex(drawn[f"moved-{i}"].get_facecolor()) for i in (3, 12, 7)}
    assert colour == {3: to_hex(COLOURS(0.0)), 12: to_hex(COLOURS(1.0)), 7: to_hex(COLOURS(0.5))}


def test_low_walls_move_by_a_share_of_their_length_and_those_in_the_air_have_no_ground():
    row, moved = {1: box(0, 3, 50, 4), 2: box(50, 3, 99, 4)}, np.array([[1.0, 0.0, 0.0]])
    motion = motion_of(row, Mechanism((2,), moved))
    assert motion.displacement[1] == pytest.approx([99 * 0.2 * LARGEST_SHARE, 0, 0])
    assert "ground" in patches(plot_mechanism(LABELS, slide((0, 0, 0)), "left"))
    assert "ground" not in patches(plot_mechanism(row, Mechanism((1,), moved), "right"))


@pytest.mark.parametrize(("direction", "load", "way", "said"), [
    ("left", "", (-1, 0), r"live load, $\alpha$ times the weight, to the left, $\alpha$ = 0.432"),
    ("right", "", (1, 0), r"live load, $\alpha$ times the weight, to the right, $\alpha$ = 0.432"),
    (None, "", (0, -1), "falls under its own weight"),
    ("left", "point load on 7", None, r"point load on 7, $\alpha$ = 0.432"),
])  # fmt: skip
def test_the_arrow_points_where_the_load_goes(direction, load, way, said):
    ax = plot_mechanism(LABELS, examples.mechanism(), direction, 0.4321, load=load)
    arrows = [text for text in ax.texts if text.get_gid() in ("live-load", "own-weight")]
    ways = [tuple(np.sign(np.subtract(one.xy, one.get_position()))) for one in arrows]
    assert ways == ([] if way is None else [way])
    assert [text.get_text() for text in ax.texts if text.get_text()] == [said]


@given(twist=st.tuples(*[st.integers(-9, 9)] * 3), amplitude=st.floats(0, 1))
@repeatable(30)
def test_a_motion_keeps_every_block_rigid_and_starts_with_its_velocity(twist, amplitude):
    motion = motion_of(LABELS, slide(twist))
    place = [region.id for region in motion.regions].index(12)
    before, moved = motion.regions[place].loops[0], motion.at(amplitude)[place]
    (after,) = moved.loops
    spans = [np.hypot(*(loop[:, None] - loop[None]).transpose(2, 0, 1)) for loop in (before, after)]
    np.testing.assert_allclose(*spans, atol=1e-9)
    early = (motion.at(1e-6)[place].loops[0] - before) / 1e-6
    x, y, angle = motion.displacement[place]
    # The displacement has the direction of the velocity.
    np.testing.assert_allclose(np.cross((x, y, angle), twist), 0.0, atol=1e-9)
    assert np.dot((x, y, angle), twist) >= 0.0
    arms = before - motion.regions[place].centroid
    linear = np.column_stack([x - angle * arms[:, 1], y + angle * arms[:, 0]])
    np.testing.assert_allclose(early, linear, atol=1e-4)
    # A small block that turns alone does not spin.
    reach = np.hypot(*linear.T).max() / (HIGH * LARGEST_SHARE)
    assert max(reach, abs(angle) / LARGEST_TURN) == pytest.approx(float(any(twist)))
    np.testing.assert_allclose(motion.at(0.0)[place].loops[0], before)
    gap = np.hypot(*(after - moved.centroid).T) - np.hypot(*arms.T)
    np.testing.assert_allclose(gap, 0, atol=1e-9)


TALL = stacked((20, 40, 0))
ROCKING = limit_load(model_from_labels(TALL).model, "right", mechanism=True).mechanism


def frames_of(direction, alpha=None, **more):
    made = mechanism_frames(TALL, ROCKING, direction, alpha, **more)
    return [np.asarray(frame, int) for frame in made]


def red(frame):
    """Pixels of the one moving block, coloured by the largest displacement."""
    return np.nonzero((frame[..., 0] > 150) & (frame[..., 1] < 60) & (frame[..., 2] < 90))


def test_it_goes_from_rest_to_the_largest_displacement_and_back_and_nothing_is_cut_off():
    frames = frames_of("right", 0.5, frames=8)
    assert len(frames) == 8
    assert len({frame.shape for frame in frames}) == 1
    for step in range(1, 4):
        np.testing.assert_array_equal(frames[step], frames[8 - step])
    centre = [red(frame)[1].mean() for frame in frames[:5]]
    # It starts and ends gently.
    first, second, third, last = np.diff(centre)
    assert 0 < first < 0.6 * second
    assert 0 < last < 0.6 * third
    # Numbers move along, and the outermost pixels are white in all frames.
    places = []
    for plain, frame in zip(frames[::2], frames_of("right", 0.5, frames=4, numbers=1), strict=True):
        for edge in (frame[0], frame[-1], frame[:, 0], frame[:, -1]):
            assert (edge == 255).all()
        assert abs(max(frame.shape) - LONGER_SIDE_PX) <= 1
        places.append(np.nonzero((plain != frame).any(axis=2))[1].mean())
    assert places[0] + 5 < places[1] < places[2] - 5


def test_a_gif_loops_repeats_to_the_byte_and_is_close_to_the_picture(tmp_path):
    frames = frames_of(None, frames=6)
    one, two = tmp_path / "one.gif", tmp_path / "two.gif"
    for path in (one, two):
        save_mechanism_animation(path, TALL, ROCKING, None, frames=6)
    assert one.read_bytes() == two.read_bytes()
    with Image.open(one) as image:
        assert (image.info["loop"], image.info["duration"], image.n_frames) == (0, FRAME_MS, 6)
        for step, frame in enumerate(frames):
            image.seek(step)
            assert np.abs(np.asarray(image.convert("RGB"), int) - frame).mean() < 3
    with pytest.raises(ValueError, match="at least 2 frames, not 1"):
        frames_of("right", frames=1)
    with pytest.raises(ValueError, match=r"end in \.gif"):
        save_mechanism_animation(tmp_path / "a.mp4", TALL, ROCKING, "right")
    with pytest.raises(ValueError, match=r"lacks: \[99\]"):
        mechanism_frames(TALL, Mechanism((99,), np.zeros((1, 3))), "right")
