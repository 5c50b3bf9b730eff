"""Pictures as files, whole and with the same bytes; pieces of a photograph."""

import os
import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

from drystone.contacts.settled import model_of_outlines
from drystone.drawing import (
    plot_mechanism,
    plot_wall,
    save,
    save_mechanism_animation,
    write_pictures,
    write_report,
)
from drystone.drawing.photo import CROP_PX, StonePhoto, read_photo
from drystone.drawing.pictures import wall as files
from drystone.drawing.pictures.marker_sheet import MarkerSheets, write_marker_sheets
from drystone.drawing.report.html import Shown
from drystone.errors import PlanError
from drystone.model.steps import piece_id
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from tests.drawing import examples
from tests.drawing.export.drawn_walls import assembly
from tests.drawing.pictures.test_stones import patches
from tests.drawing.report.test_report import example_view
from tests.verify.exact_examples import exact_example


@pytest.mark.parametrize("name", ["wall.png", "wall.pdf", "wall.svg"])
def test_same_picture_same_bytes_and_nothing_global_changes(tmp_path, name):
    made, before = [], dict(mpl.rcParams)
    for _ in range(2):
        ax = plot_wall(examples.wall(), examples.CLUSTERS, title="twice")
        save(ax.figure, tmp_path / name, dpi=50)
        made.append((tmp_path / name).read_bytes())
    first, second = made
    assert first == second
    assert dict(mpl.rcParams) == before
    # Two files of the same second would agree in spite of a date.
    assert not any(date in first for date in (b"CreationDate", b"dc:date", b"tIME"))
    assert b"Software" not in first


def test_endings_of_pictures_are_checked_and_drawing_loads_no_pyplot(tmp_path):
    with pytest.raises(ValueError, match=r"pictures end in \.png, \.pdf, \.svg"):
        save(plot_wall(examples.wall()).figure, tmp_path / "wall.bmp")
    code = "import sys, drystone.drawing; print('matplotlib.pyplot' in sys.modules)"
    done = subprocess.run(  # noqa: S603 - our own interpreter and text
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"


def test_pictures_are_written_where_a_mechanism_exists(tmp_path, monkeypatch):
    drawn = []

    def noted(shown, mechanism, *load, numbers):
        drawn.append((shown, *load, numbers, plot_mechanism(shown, mechanism, *load)))
        return drawn[-1][-1]

    monkeypatch.setattr(files, "plot_mechanism", noted)
    monkeypatch.setattr(save, "__defaults__", (20,))
    (tmp_path / "mechanism_right.png").write_bytes(b"of another wall")
    both = examples.resistance()
    write_pictures(tmp_path, examples.wall(), resistance=both)
    assert {path.name for path in tmp_path.iterdir()} == {"picture.png", "mechanism_left.png"}
    # A fall has no live load.
    falls = LimitResult(LimitStatus.UNSTABLE, "right", mechanism=examples.mechanism())
    both = LateralResistance(both.left, falls, 0.58)
    write_pictures(tmp_path, examples.wall(), resistance=both)
    assert [load for _, *load, _, _ in drawn] == [["left", 0.41], ["left", 0.41], [None, None]]
    # The numbers of picture.png, which are steps.
    assert drawn[0][3] == {piece_id(step): step.step for step in examples.plan().steps}

    # Mechanisms of a wall of outlines are drawn of its outlines.
    drawn.clear()
    wall = exact_example(0.5, 50.0).wall
    model = model_of_outlines(wall.outlines.blocks, 0.58, 0.1)
    write_pictures(tmp_path, wall, resistance=lateral_resistance(model, mechanism=True))
    assert {one.name for one in tmp_path.iterdir()} == {files.PICTURE, *files.MECHANISMS.values()}
    for shown, *_, ax in drawn:
        assert set(shown) == {block.id for block in model.blocks}
        for block, corners in wall.outlines.blocks:
            np.testing.assert_array_equal(shown[block], corners)
        assert "ground" in patches(ax)
    # They do not stay beside a wall that has none.
    write_pictures(tmp_path, examples.wall())
    assert [path.name for path in tmp_path.iterdir()] == [files.PICTURE]


WRITERS = {
    "wall.png": lambda path: save(plot_wall(examples.wall()).figure, path, dpi=20),
    "fall.gif": lambda path: save_mechanism_animation(
        path, examples.wall().labels, examples.mechanism(), None, frames=2
    ),
    "report.html": lambda path: write_report(path, example_view()),
    "view.html": lambda path: Shown(example_view()).write(path),
    "sheets.pdf": lambda path: write_marker_sheets(MarkerSheets((0, 1, 2, 3), 0.05), path),
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_is_whole_or_as_it_was(name, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    path = tmp_path / name
    path.write_bytes(b"good")
    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(PlanError, match=f"^E206 {path}: .*No space left"):
        WRITERS[name](path)
    assert [(one.name, one.read_bytes()) for one in tmp_path.iterdir()] == [(name, b"good")]


def coordinates(width, height):
    """Return a picture whose red is its column and whose green is its row from the top."""
    red, green = np.meshgrid(np.linspace(0, 255, width), np.linspace(0, 255, height))
    return Image.fromarray(np.dstack([red, green, 0 * red]).astype(np.uint8))


@pytest.mark.parametrize("zoom", [0.5, 1, 8])
def test_a_piece_shows_its_box_at_any_resolution_and_beyond_the_photograph_white(zoom):
    photo = StonePhoto(coordinates(round(200 * zoom), round(100 * zoom)), 200.0, 100.0)
    piece = photo.crop((50.0, 20.0, 110.0, 60.0)).astype(float)
    height, width, _ = piece.shape
    assert max(height, width) <= CROP_PX
    assert width / height == pytest.approx(1.5, abs=0.05)
    # Source px of the middles of the first and last px of the piece.
    step = 60.0 / width
    left, right = 50 + step / 2, 110 - step / 2
    top, bottom = 40 + step / 2, 80 - step / 2
    across, down = piece[height // 2, [0, -1], 0], piece[[0, -1], width // 2, 1]
    assert across / 255 * 200 == pytest.approx([left, right], abs=1.8)
    assert down / 255 * 100 == pytest.approx([top, bottom], abs=1.8)
    beyond = photo.crop((-20.0, 40.0, 20.0, 60.0))
    middle = beyond.shape[1] // 2
    assert (beyond[:, : middle - 2] == 255).all()
    assert (beyond[:, middle + 2 :, 2] == 0).all()
    assert read_photo(assembly()) is None
