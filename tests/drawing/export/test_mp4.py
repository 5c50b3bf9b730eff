"""build.mp4, read back with PyAV."""

import numpy as np
import pytest

from drystone.drawing.export.film import PLACING_COLOUR, Film
from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.palette import rgb
from tests.drawing.export.drawn_walls import assembly

SETTINGS = ExportSettings(seconds_per_step=0.2, film_px=320)


def test_the_film_has_every_step_for_its_time(tmp_path) -> None:
    av = pytest.importorskip("av")
    wall = assembly()
    (path,) = FORMATS["mp4"].write(wall, tmp_path, SETTINGS)
    with av.open(path) as film:
        rate = film.streams.video[0].average_rate
        found = [frame.to_ndarray(format="rgb24").astype(int) for frame in film.decode(video=0)]
    assert rate == 10
    assert len(found) == 2 * len(wall.parts) + 30
    film = Film(wall, SETTINGS.film_px)
    assert found[0].shape[1::-1] == film.size_px
    for frame, drawn in enumerate(film.frames()):
        # The code is lossy, mostly along the edges.
        difference = np.abs(found[min(2 * frame, len(found) - 1)] - np.asarray(drawn))
        assert np.median(difference) < 6, frame
        assert difference.mean() < 9, frame
    for frame, seen in ((0, True), (-1, False)):
        placing = np.abs(found[frame] / 255 - np.array(rgb(PLACING_COLOUR))).max(axis=2) < 0.12
        assert (placing.sum() > 500) == seen
