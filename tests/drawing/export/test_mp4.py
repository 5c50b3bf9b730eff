"""build.mp4, read back with OpenCV."""

import shutil
import stat
import sys

import cv2
import numpy as np
import pytest

from drystone.drawing.export import mp4
from drystone.drawing.export.film import PLACING_COLOUR, Film
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.palette import rgb
from drystone.errors import UsageError
from tests.drawing.export.drawn_walls import assembly

SETTINGS = ExportSettings(seconds_per_step=0.2, film_px=320)


@pytest.fixture
def no_ffmpeg(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda _: None)


def pictures(path):
    film = cv2.VideoCapture(str(path))
    rate = film.get(cv2.CAP_PROP_FPS)
    found = []
    while (read := film.read())[0]:
        found.append(read[1][:, :, ::-1])
    film.release()
    return found, rate


@pytest.mark.usefixtures("no_ffmpeg")
def test_the_film_has_every_step_for_its_time(tmp_path) -> None:
    wall = assembly()
    (path,) = mp4.write(wall, tmp_path, SETTINGS)
    assert mp4.files(wall, SETTINGS) == (path.name,)
    found, rate = pictures(path)
    assert rate == pytest.approx(10.0)
    assert len(found) == 2 * len(wall.parts) + 30
    film = Film(wall, SETTINGS.film_px)
    assert found[0].shape[1::-1] == film.size_px
    for frame, drawn in enumerate(film.frames()):
        # The code is lossy, mostly along the edges.
        difference = np.abs(found[min(2 * frame, len(found) - 1)].astype(int) - np.asarray(drawn))
        assert np.median(difference) < 6, frame
        assert difference.mean() < 9, frame
    placing = np.abs(found[0] / 255 - np.array(rgb(PLACING_COLOUR))).max(axis=2) < 0.12
    assert placing.sum() > 500
    placing = np.abs(found[-1] / 255 - np.array(rgb(PLACING_COLOUR))).max(axis=2) < 0.12
    assert placing.sum() == 0


@pytest.mark.usefixtures("no_ffmpeg")
def test_equal_walls_give_equal_bytes(tmp_path) -> None:
    first = mp4.write(assembly(), tmp_path, SETTINGS)[0].read_bytes()
    assert mp4.write(assembly(), tmp_path, SETTINGS)[0].read_bytes() == first


@pytest.mark.usefixtures("no_ffmpeg")
def test_without_any_writer_the_cures_are_named(tmp_path, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(UsageError) as caught:
        mp4.write(assembly(), tmp_path, SETTINGS)
    assert caught.value.code == "E186"
    assert "drystone[photo]" in caught.value.cure
    assert "ffmpeg" in caught.value.cure
    assert list(tmp_path.iterdir()) == []


def program(path, script):
    path.write_text(f"#!{sys.executable}\n{script}")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


@pytest.mark.skipif(sys.platform == "win32", reason="scripts are no programs there")
def test_ffmpeg_is_given_every_picture(tmp_path, monkeypatch) -> None:
    """By a program that writes down what it is told: sizes, and how many bytes come in."""
    script = (
        "import sys\n"
        "data, told = sys.stdin.buffer.read(), sys.argv[1:]\n"
        "if 'libx264' in told: sys.exit('Unknown encoder')\n"
        "open(told[-1], 'w').write(told[told.index('-s') + 1] + ' ' + str(len(data)))\n"
    )
    fake = program(tmp_path / "ffmpeg", script)
    monkeypatch.setattr(shutil, "which", lambda _: fake)
    wall = assembly(columns=2, rows=1)
    (path,) = mp4.write(wall, tmp_path, SETTINGS)
    width, height = Film(wall, SETTINGS.film_px).size_px
    shown = 2 * len(wall.parts) + 30
    assert path.read_text() == f"{width}x{height} {3 * width * height * shown}"


@pytest.mark.skipif(sys.platform == "win32", reason="scripts are no programs there")
def test_what_ffmpeg_says_when_it_fails_is_told(tmp_path, monkeypatch) -> None:
    script = "import sys\nsys.stdin.buffer.read()\nsys.exit('one\\nno such encoder')\n"
    fake = program(tmp_path / "ffmpeg", script)
    monkeypatch.setattr(shutil, "which", lambda _: fake)
    with pytest.raises(UsageError, match="no such encoder") as caught:
        mp4.write(assembly(columns=2, rows=1), tmp_path, SETTINGS)
    assert caught.value.code == "E186"
