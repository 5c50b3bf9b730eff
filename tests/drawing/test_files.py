import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

from drystone.contacts.settled import model_of_outlines
from drystone.drawing import files, plot_mechanism, plot_wall, save, write_pictures
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from tests.drawing import examples
from tests.drawing.pictures.test_stones import patches
from tests.verify.exact_examples import exact_example


@pytest.mark.parametrize("name", ["wall.png", "wall.pdf", "wall.svg"])
def test_same_picture_same_bytes(tmp_path, name):
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        ax = plot_wall(examples.wall(), examples.CLUSTERS, title="twice")
        save(ax.figure, tmp_path / folder / name, dpi=50)
    first, second = ((tmp_path / folder / name).read_bytes() for folder in ("one", "two"))
    assert first == second
    # Two files of the same second would agree in spite of a date.
    assert not any(date in first for date in (b"CreationDate", b"dc:date", b"tIME"))
    if name == "wall.png":
        with Image.open(tmp_path / "one" / name) as image:
            assert set(image.info) <= {"dpi"}


def test_other_endings_are_refused(tmp_path):
    with pytest.raises(ValueError, match=r"pictures end in \.png, \.pdf, \.svg"):
        save(plot_wall(examples.wall()).figure, tmp_path / "wall.bmp")


def test_pictures_are_written_where_a_mechanism_exists(tmp_path):
    stale = tmp_path / "mechanism_right.png"
    stale.write_bytes(b"of another wall")
    written = write_pictures(
        tmp_path, examples.wall(), examples.CLUSTERS, resistance=examples.resistance(), dpi=50
    )
    assert [path.name for path in written] == ["picture.png", "mechanism_left.png"]
    assert {path.name for path in tmp_path.iterdir()} == {"picture.png", "mechanism_left.png"}


def test_the_fall_of_a_wall_is_not_drawn_as_a_live_load(tmp_path, monkeypatch):
    drawn = []

    def noted(labels, mechanism, direction, alpha):
        drawn.append((direction, alpha))
        return plot_mechanism(labels, mechanism, direction, alpha)

    monkeypatch.setattr(files, "plot_mechanism", noted)
    falls = LimitResult(LimitStatus.UNSTABLE, "right", mechanism=examples.mechanism())
    both = LateralResistance(examples.resistance().left, falls, 0.58)
    write_pictures(tmp_path, examples.wall(), resistance=both, dpi=20)
    assert drawn == [("left", 0.41), (None, None)]


def test_nothing_global_changes(tmp_path):
    before = dict(mpl.rcParams)
    save(plot_wall(examples.wall(), examples.CLUSTERS).figure, tmp_path / "wall.svg")
    plot_mechanism(examples.wall().labels, examples.mechanism(), "left", 0.4)
    assert dict(mpl.rcParams) == before
    code = "import sys, drystone.drawing; print('matplotlib.pyplot' in sys.modules)"
    done = subprocess.run(  # noqa: S603 - our own interpreter and text
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"


def test_mechanisms_of_a_wall_of_outlines_are_drawn_of_its_outlines(tmp_path, monkeypatch):
    drawn = []

    def noted(shown, mechanism, direction, alpha):
        drawn.append((shown, plot_mechanism(shown, mechanism, direction, alpha)))
        return drawn[-1][1]

    monkeypatch.setattr(files, "plot_mechanism", noted)
    wall = exact_example(0.5, 50.0).wall
    model = model_of_outlines(wall.outlines, 0.58, 0.1)
    both = lateral_resistance(model, mechanism=True)
    written = write_pictures(tmp_path, wall, resistance=both, dpi=20)
    assert [path.name for path in written] == [files.PICTURE, *files.MECHANISMS.values()]
    for shown, ax in drawn:
        assert set(shown) == {block.id for block in model.blocks}
        for block, corners in wall.outlines.blocks:
            np.testing.assert_array_equal(shown[block], corners)
        assert "ground" in patches(ax)
    # Those of a wall of outlines do not stay beside one that has none.
    written = write_pictures(tmp_path, examples.wall(), dpi=20)
    assert [path.name for path in tmp_path.iterdir()] == [files.PICTURE]
