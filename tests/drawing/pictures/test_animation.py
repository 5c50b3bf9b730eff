import numpy as np
import pytest
from PIL import Image

from drystone.contacts.blocks import model_from_labels
from drystone.drawing import mechanism_frames, save_mechanism_animation
from drystone.drawing.pictures.mechanism import FRAME_MS, LONGER_SIDE_PX
from drystone.statics.limit import limit_load
from drystone.statics.result import Mechanism
from tests.drawing import examples
from tests.statics.walls import stacked

TALL = stacked((20, 40, 0))


def rocking(labels=TALL):
    return limit_load(model_from_labels(labels).model, "right", mechanism=True).mechanism


def arrays(frames):
    return [np.asarray(frame, int) for frame in frames]


def red(frame):
    """Pixels of the one moving block, coloured by the largest displacement, without the bar."""
    rows, cols = np.nonzero((frame[..., 0] > 150) & (frame[..., 1] < 60) & (frame[..., 2] < 90))
    block = cols < 0.8 * frame.shape[1]
    return rows[block], cols[block]


def test_it_goes_from_rest_to_the_largest_displacement_and_back():
    frames = arrays(mechanism_frames(TALL, rocking(), "right", 0.5, frames=8))
    assert len(frames) == 8
    assert len({frame.shape for frame in frames}) == 1
    for step in range(1, 4):
        np.testing.assert_array_equal(frames[step], frames[8 - step])
    centre = [red(frame)[1].mean() for frame in frames[:5]]
    steps = np.diff(centre)
    assert (steps > 0).all()
    # It starts and ends gently.
    assert steps[0] < 0.6 * steps[1]
    assert steps[3] < 0.6 * steps[2]
    areas = [red(frame)[0].size for frame in frames[:5]]
    assert max(areas) < 1.02 * min(areas)


def test_the_last_picture_is_that_of_the_mechanism():
    """Nothing is cut off: the outermost pixels are white in all frames."""
    frames = arrays(mechanism_frames(TALL, rocking(), "right", 0.5, frames=4, numbers=True))
    for frame in frames:
        edges = (frame[0], frame[-1], frame[:, 0], frame[:, -1])
        assert all((edge == 255).all() for edge in edges)
        assert abs(max(frame.shape) - LONGER_SIDE_PX) <= 1


def test_numbers_move_along():
    drawn = [
        arrays(mechanism_frames(TALL, rocking(), "right", frames=4, numbers=n)) for n in (0, 1)
    ]
    plain, numbered = (np.array(frames[:3]) for frames in drawn)
    places = [
        np.nonzero((a != b).any(axis=2))[1].mean() for a, b in zip(plain, numbered, strict=True)
    ]
    assert places[0] + 5 < places[1] < places[2] - 5


def test_a_gif_loops_and_repeats_to_the_byte(tmp_path):
    for name in ("one.gif", "two.gif"):
        save_mechanism_animation(
            tmp_path / name, examples.wall().labels, examples.mechanism(), "left", 0.41, frames=6
        )
    content = (tmp_path / "one.gif").read_bytes()
    assert content == (tmp_path / "two.gif").read_bytes()
    with Image.open(tmp_path / "one.gif") as image:
        assert image.n_frames == 6
        assert image.info["loop"] == 0
        assert image.info["duration"] == FRAME_MS


def test_few_colours_are_close_to_the_picture(tmp_path):
    frames = arrays(mechanism_frames(TALL, rocking(), None, frames=2))
    save_mechanism_animation(tmp_path / "fall.gif", TALL, rocking(), None, frames=2)
    with Image.open(tmp_path / "fall.gif") as image:
        for step, frame in enumerate(frames):
            image.seek(step)
            shown = np.asarray(image.convert("RGB"), int)
            assert np.abs(shown - frame).mean() < 3


def test_what_is_no_animation_is_refused(tmp_path):
    with pytest.raises(ValueError, match="at least 2 frames, not 1"):
        mechanism_frames(TALL, rocking(), "right", frames=1)
    with pytest.raises(ValueError, match=r"end in \.gif"):
        save_mechanism_animation(tmp_path / "a.mp4", TALL, rocking(), "right")
    with pytest.raises(ValueError, match=r"lacks: \[99\]"):
        mechanism_frames(TALL, Mechanism((99,), np.zeros((1, 3))), "right")
