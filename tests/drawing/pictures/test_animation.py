import os

import numpy as np
import pytest
from PIL import Image

from drystone.contacts.blocks import model_from_labels
from drystone.drawing import mechanism_frames, save_mechanism_animation
from drystone.drawing.pictures import mechanism as animation
from drystone.drawing.pictures.mechanism import FRAME_MS, LONGER_SIDE_PX
from drystone.errors import PlanError
from drystone.statics.limit import limit_load
from drystone.statics.result import Mechanism
from tests.drawing import examples
from tests.statics.walls import coursed, stacked

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


def test_numbers_move_along(monkeypatch):
    seen = []
    inner = animation._move

    def watched(ax, motion, amplitude):
        inner(ax, motion, amplitude)
        (number,) = [t for t in ax.texts if t.get_gid() == "number-1"]
        seen.append((number.get_position(), motion.centroids(amplitude)[0]))

    monkeypatch.setattr(animation, "_move", watched)
    mechanism_frames(TALL, rocking(), "right", frames=4, numbers=True)
    assert len(seen) == 3
    assert all(at == pytest.approx(expected) for at, expected in seen)
    assert seen[0][0] == pytest.approx((10, 20))


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


def test_an_animation_is_whole_or_as_it_was(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    path = tmp_path / "fall.gif"
    path.write_bytes(b"good")
    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(PlanError, match="No space left") as caught:
        save_mechanism_animation(path, TALL, rocking(), None, frames=2)
    assert caught.value.where == str(path)
    assert [(one.name, one.read_bytes()) for one in tmp_path.iterdir()] == [(path.name, b"good")]


def test_few_colours_are_close_to_the_picture(tmp_path):
    frames = arrays(mechanism_frames(TALL, rocking(), None, frames=2))
    save_mechanism_animation(tmp_path / "fall.gif", TALL, rocking(), None, frames=2)
    with Image.open(tmp_path / "fall.gif") as image:
        for step, frame in enumerate(frames):
            image.seek(step)
            shown = np.asarray(image.convert("RGB"), int)
            assert np.abs(shown - frame).mean() < 3


def test_polygons_move_too():
    corners = {4: np.array([[0, 0], [20, 0], [20, 40], [0, 40]])}
    mechanism = Mechanism((4,), rocking().velocity)
    by_polygon = arrays(mechanism_frames(corners, mechanism, "right", 0.5, frames=2))
    by_pixel = arrays(mechanism_frames(TALL, rocking(), "right", 0.5, frames=2))
    for one, other in zip(by_polygon, by_pixel, strict=True):
        np.testing.assert_array_equal(one, other)


def test_what_is_no_animation_is_refused(tmp_path):
    with pytest.raises(ValueError, match="at least 2 frames, not 1"):
        mechanism_frames(TALL, rocking(), "right", frames=1)
    with pytest.raises(ValueError, match=r"end in \.gif"):
        save_mechanism_animation(tmp_path / "a.mp4", TALL, rocking(), "right")
    with pytest.raises(ValueError, match=r"lacks: \[99\]"):
        mechanism_frames(TALL, Mechanism((99,), np.zeros((1, 3))), "right")


def test_the_file_of_an_ordinary_wall_is_small(tmp_path):
    labels = coursed(13, 5, 120)
    save_mechanism_animation(tmp_path / "a.gif", labels, rocking(labels), "right", 0.378, frames=12)
    assert (tmp_path / "a.gif").stat().st_size < 200_000  # 400 kB for the usual 24 frames
