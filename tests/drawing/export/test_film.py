"""build.gif, read back with Pillow and checked with Shapely, and build.mp4, read with PyAV."""

import numpy as np
import pytest
import shapely
from PIL import Image, ImageSequence

from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.export.frames import LONGEST_S, PLACING_COLOUR, Film
from drystone.drawing.palette import PLAIN_COLOUR, WEDGE_COLOUR, rgb
from drystone.errors import UsageError
from tests.drawing.export.drawn_walls import assembly

SETTINGS = ExportSettings(seconds_per_step=0.3)


def frames(path):
    with Image.open(path) as film:
        return [
            (np.asarray(frame.convert("RGB")).astype(int), frame.info["duration"])
            for frame in ImageSequence.Iterator(film)
        ]


def spot(part, film):
    """Return row and column of a point well inside a part, away from its number."""
    shape = shapely.Polygon(part.corners)
    inner = shape.buffer(-0.25 * np.sqrt(shape.area) if part.kind == "stone" else -1e-6)
    x, y = inner.exterior.coords[0] if part.kind == "stone" else shape.centroid.coords[0]
    ((column, row),) = film.view.pixels((x, y))
    return round(row - 0.5), round(column - 0.5)


def near(colour, name):
    return np.abs(colour / 255 - np.array(rgb(name))).max() < 0.03


def test_there_is_a_frame_a_step_and_one_of_the_wall_that_stays(tmp_path) -> None:
    wall = assembly()
    (path,) = FORMATS["gif"].write(wall, tmp_path, SETTINGS)
    assert path.stat().st_size < 200_000
    read = frames(path)
    assert len(read) == len(wall.parts) + 1
    assert [duration for _, duration in read] == [300] * 7 + [3000]


def test_every_part_is_white_then_bright_and_then_stays(tmp_path) -> None:
    wall = assembly()
    (path,) = FORMATS["gif"].write(wall, tmp_path, SETTINGS)
    film, read = Film(wall, SETTINGS.film_px), frames(path)
    for place, part in enumerate(wall.parts):
        row, column = spot(part, film)
        after = PLAIN_COLOUR if part.kind == "stone" else WEDGE_COLOUR
        for frame, (picture, _) in enumerate(read):
            colour = picture[row, column]
            if frame < place:
                assert near(colour, "#ffffff"), (part.name, frame, colour)
            elif frame == place and part.kind == "stone":
                assert near(colour, PLACING_COLOUR), (part.name, frame, colour)
            else:
                assert near(colour, after), (part.name, frame, colour)


def test_the_last_frame_is_the_finished_wall(tmp_path) -> None:
    wall = assembly(px_per_m=None)
    (path,) = FORMATS["gif"].write(wall, tmp_path, SETTINGS)
    *_, last = Film(wall, SETTINGS.film_px).frames()
    picture = frames(path)[-1][0]
    assert picture.shape[1::-1] == last.size == Film(wall, SETTINGS.film_px).size_px
    # Smoothed edges are reduced to few tints.
    assert np.abs(picture - np.asarray(last)).mean() < 1.0


def test_tall_walls_keep_their_shape() -> None:
    film = Film(assembly(columns=1, rows=8), 400)
    width, height = film.size_px
    assert height <= 0.75 * 400 + 60
    assert width % 2 == height % 2 == 0
    corners = np.array(film.view.pixels(np.concatenate([p.corners for p in film.assembly.parts])))
    assert np.ptp(corners[:, 1]) / np.ptp(corners[:, 0]) == np.float64(4.0).item()


def test_steps_that_are_too_long_for_a_gif_are_refused(tmp_path) -> None:
    wall = assembly()
    longest = ExportSettings(seconds_per_step=LONGEST_S, film_px=200)
    assert tuple(FORMATS["gif"].files(wall, longest)) == ("build.gif",)
    (path,) = FORMATS["gif"].write(wall, tmp_path, longest)
    assert {duration for _, duration in frames(path)} == {655_000}
    for seconds in (656.0, 1e308):
        with pytest.raises(UsageError, match="E138"):
            FORMATS["gif"].files(wall, ExportSettings(seconds_per_step=seconds))


def test_the_film_has_every_step_for_its_time(tmp_path) -> None:
    av = pytest.importorskip("av")
    wall, settings = assembly(), ExportSettings(seconds_per_step=0.2, film_px=320)
    (path,) = FORMATS["mp4"].write(wall, tmp_path, settings)
    with av.open(path) as film:
        rate = film.streams.video[0].average_rate
        found = [frame.to_ndarray(format="rgb24").astype(int) for frame in film.decode(video=0)]
    assert rate == 10
    assert len(found) == 2 * len(wall.parts) + 30
    film = Film(wall, settings.film_px)
    assert found[0].shape[1::-1] == film.size_px
    for frame, drawn in enumerate(film.frames()):
        # The code is lossy, mostly along the edges.
        difference = np.abs(found[min(2 * frame, len(found) - 1)] - np.asarray(drawn))
        assert np.median(difference) < 6, frame
        assert difference.mean() < 9, frame
    for frame, seen in ((0, True), (-1, False)):
        placing = np.abs(found[frame] / 255 - np.array(rgb(PLACING_COLOUR))).max(axis=2) < 0.12
        assert (placing.sum() > 500) == seen
