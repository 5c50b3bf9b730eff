"""build.gif, build.mp4 and pictures for a projector, read with Pillow, PyAV and NumPy."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from PIL import Image, ImageSequence

from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.export.frames import DIM, LONGEST_S, PLACING_COLOUR, Film
from drystone.drawing.palette import PLAIN_COLOUR, WEDGE_COLOUR, rgb
from drystone.errors import UsageError
from tests.drawing.export.drawn_walls import assembly, runs


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


def test_every_part_is_white_then_bright_and_then_stays_for_steps_that_a_gif_can_have(tmp_path):
    wall = assembly()
    (path,) = FORMATS["gif"].write(wall, tmp_path, ExportSettings(seconds_per_step=0.3))
    assert path.stat().st_size < 200_000
    film, read = Film(wall), frames(path)
    # A frame a step, and one of the wall that stays.
    assert [duration for _, duration in read] == [300] * len(wall.parts) + [3000]
    assert read[0][0].shape[1::-1] == film.size_px
    for place, part in enumerate(wall.parts):
        row, column = spot(part, film)
        after = PLAIN_COLOUR if part.kind == "stone" else WEDGE_COLOUR
        for frame, (picture, _) in enumerate(read):
            fresh = PLACING_COLOUR if part.kind == "stone" else after
            seen = "#ffffff" if frame < place else fresh if frame == place else after
            away = np.abs(picture[row, column] / 255 - np.array(rgb(seen)))
            assert away.max() < 0.03, (part.name, frame)
    # Steps that are too long for a GIF are refused.
    longest = ExportSettings(seconds_per_step=LONGEST_S)
    (path,) = FORMATS["gif"].write(wall, tmp_path, longest)
    assert (path.name, {shown for _, shown in frames(path)}) == ("build.gif", {655_000})
    for seconds in (656.0, 1e308):
        with pytest.raises(UsageError, match="E138"):
            FORMATS["gif"].files(wall, ExportSettings(seconds_per_step=seconds))
    # Tall walls keep their shape.
    film = Film(assembly(columns=1, rows=8), 400)
    width, height = film.size_px
    assert height <= 0.75 * 400 + 60
    assert width % 2 == height % 2 == 0
    corners = np.array(film.view.pixels(np.concatenate([p.corners for p in film.assembly.parts])))
    assert np.ptp(corners[:, 1]) / np.ptp(corners[:, 0]) == 4.0


def test_the_film_has_every_step_for_its_time(tmp_path):
    av = pytest.importorskip("av")
    wall, settings = assembly(columns=2, rows=1), ExportSettings(seconds_per_step=0.2)
    (path,) = FORMATS["mp4"].write(wall, tmp_path, settings)
    with av.open(path) as film:
        rate = film.streams.video[0].average_rate
        found = [frame.to_ndarray(format="rgb24").astype(int) for frame in film.decode(video=0)]
    assert (rate, len(found)) == (10, 2 * len(wall.parts) + 30)
    assert found[0].shape[1::-1] == Film(wall).size_px
    for frame, drawn in enumerate(Film(wall).frames()):
        # The code is lossy, mostly along the edges.
        difference = np.abs(found[min(2 * frame, len(found) - 1)] - np.asarray(drawn))
        assert np.median(difference) < 6, frame
        assert difference.mean() < 9, frame
    for frame, seen in ((0, True), (-1, False)):
        placing = np.abs(found[frame] / 255 - np.array(rgb(PLACING_COLOUR))).max(axis=2) < 0.12
        assert (placing.sum() > 500) == seen


PROJECTOR = ExportSettings(projector_px=(800, 600), projector_px_per_m=500.0)
"""The wall is .9 m x .3 m: 450 px x 150 px."""


def test_the_stone_to_be_placed_is_drawn_one_to_one_and_what_stands_is_dim(tmp_path):
    wall, images = assembly(), []
    for path in FORMATS["projector"].write(wall, tmp_path, PROJECTOR):
        with Image.open(path) as image:
            images.append(np.asarray(image).astype(int))
    assert len(images) == len(wall.parts) + 1
    assert {image.shape for image in images} == {(600, 800)}
    assert min((image == 0).mean() for image in images) > 0.9
    left, bottom = (800 - 450) / 2, 84
    for part, image in zip(wall.parts, images[1:], strict=True):
        low, high = part.corners.min(axis=0) * 500, part.corners.max(axis=0) * 500
        expected = (left + low[0], bottom + low[1], left + high[0], bottom + high[1])
        # The brightest px above the strip of words, to half a line's width of 4 px.
        rows, columns = np.nonzero(image[: 600 - 70] == 255)
        box = columns.min(), 599 - rows.max(), columns.max(), 599 - rows.min()
        assert box == pytest.approx(expected, abs=3)
    # The lower edge of a stone lies on the ground, which is drawn always; its right edge does not.
    stone = wall.parts[2]
    x, y = (stone.corners[1] + stone.corners[2]) / 2 * 500
    row, column = round(600 - 84 - y), round(175 + x)
    around = [int(image[row, column - 2 : column + 3].max()) for image in images]
    assert around[:4] == [0, 0, 0, 255]
    assert around[5:] == [int(DIM[1:3], 16)] * 3
    # The bar is as long as it says.
    longest = max(int(run) for row in images[1][600 - 30 :, 400:] for run in runs(row > 0))
    assert longest == pytest.approx(0.1 * 500, abs=2)


def test_a_wall_that_is_not_in_the_picture_is_refused_with_the_cure(tmp_path):
    with pytest.raises(UsageError, match="E187") as caught:
        FORMATS["projector"].write(assembly(), tmp_path, replace(PROJECTOR, projector_px_per_m=900))
    assert list(tmp_path.iterdir()) == []
    most = float(caught.value.cure.split("@")[1].split()[0])
    FORMATS["projector"].files(assembly(), replace(PROJECTOR, projector_px_per_m=most))
    with pytest.raises(UsageError):
        FORMATS["projector"].files(assembly(), replace(PROJECTOR, projector_px_per_m=most + 1))
    with pytest.raises(UsageError, match="Take a projector of more px"):
        FORMATS["projector"].files(assembly(), replace(PROJECTOR, projector_px=(90, 90)))
