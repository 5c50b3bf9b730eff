"""What stands beside the label image of a photograph, and the photograph itself."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from drystone.errors import InputError, UsageError
from drystone.io.photo_beside import (
    SIDECAR,
    PhotoSidecar,
    check_place,
    photo_beside,
    photo_of,
    place_photo,
    read_sidecar,
    write_sidecar,
)
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.pictures import areas, two_stones


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_it_comes_back_beside_its_label_image_only(tmp_path, encoding):
    path = write_sidecar(PhotoSidecar(640, 480, 512.5, "photo.jpg", {"markers": [1]}), tmp_path)
    path.write_text(path.read_text("utf-8"), encoding=encoding)
    assert read_sidecar(tmp_path / "stones.png") == PhotoSidecar(640, 480, 512.5, "photo.jpg")
    assert read_sidecar(tmp_path / "other.png") is None
    assert read_sidecar(Path()) is None


@pytest.mark.parametrize("more", [None, "", ', "px_per_m": -1', ', "px_per_m": "x"'])
def test_damage_is_said(tmp_path, more):
    sides = ', "width_px": 1, "height_px": 1' if more else ""
    text = "[" * 100_000 if more is None else f'{{"schema": "drystone-photo/1"{more}{sides}}}'
    (tmp_path / SIDECAR).write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="E112"):
        read_sidecar(tmp_path / "stones.png")
    (tmp_path / SIDECAR).write_text('{"schema": "drystone-plan/1"}', encoding="utf-8")
    assert read_sidecar(tmp_path / "stones.png") is None


MARKER = {"id": 0, "corners_m": [[0, 1], [1, 1], [1, 0], [0, 0]]}
FRAME = {"id": 0, "matrix": np.eye(4).tolist()}


def test_what_a_plan_keeps_of_the_photograph_comes_back(tmp_path):
    markers = {"markers": [MARKER], "P_from_marker": FRAME}
    details = {"source": {"name": "pile.jpg"}, **markers}
    write_sidecar(PhotoSidecar(640, 480, details=details), tmp_path)
    photograph = read_sidecar(tmp_path / "stones.png").photograph
    assert dict(photograph) == {"name": "pile.jpg", **markers}


@pytest.mark.parametrize(("markers", "frame"), [
    ([{**MARKER, "corners_m": [[0, 1]]}], FRAME), ([{**MARKER, "corners_m": "x"}], FRAME),
    ([{"corners_m": MARKER["corners_m"]}], FRAME), ("markers", FRAME), (7, FRAME),
    ([MARKER], [1]), ([MARKER], {**FRAME, "matrix": [[float("nan")] * 4] * 4}),
    ([{**MARKER, "id": "one"}], FRAME),
])  # fmt: skip
def test_damaged_markers_are_said(tmp_path, markers, frame):
    details = {"markers": markers, "P_from_marker": frame}
    write_sidecar(PhotoSidecar(640, 480, details=details), tmp_path)
    with pytest.raises(InputError, match="E112"):
        read_sidecar(tmp_path / "stones.png")


def test_a_pile_in_doubt_is_said_again(tmp_path):
    labels = np.zeros((40, 60), np.uint8)
    labels[5:30, 5:40] = 1
    Image.fromarray(labels).save(tmp_path / "stones.png")
    for doubtful in ([], ["little was found", "the light is uneven"]):
        write_sidecar(PhotoSidecar(60, 40, details={"doubtful": doubtful}), tmp_path)
        said = [str(one) for one in read_stones(tmp_path).notices if one.code == "W183"]
        assert len(said) == bool(doubtful)
    assert "little was found; the light is uneven" in said[0]
    assert "outlines.html" in said[0]


def segmented(folder, picture=b"a picture"):
    """What `drystone segment` leaves, as far as it matters here."""
    folder.mkdir()
    (folder / "photo.jpg").write_bytes(picture)
    (folder / "stones.png").write_bytes(b"labels")
    write_sidecar(PhotoSidecar(640, 480, photo="photo.jpg"), folder)
    return folder


def planned(stones, folder):
    """Place the photograph and write down what the plan must say of it."""
    folder.mkdir(exist_ok=True)
    beside, record = place_photo(None if stones is None else photo_of(stones), folder)
    (folder / "plan.json").write_text(json.dumps({"source": dict(record)}), encoding="utf-8")
    return beside


def test_the_photograph_goes_beside_the_plan(tmp_path):
    found, plan = segmented(tmp_path / "found"), tmp_path / "plan"
    for stones in (found, found / "stones.png"):
        assert photo_of(stones) == found / "photo.jpg"
    assert planned(found, plan) == photo_beside(plan) == plan / "photo.jpg"
    other = segmented(tmp_path / "other", b"another")
    assert planned(other, plan) == plan / "photo.jpg"
    assert (plan / "photo.jpg").read_bytes() == b"another"
    assert planned(None, plan) is None  # the next plan has none
    assert photo_beside(plan) is None
    planned(found, plan)
    (plan / "photo.jpg").write_bytes(b"painted over")
    planned(None, plan)
    assert (plan / "photo.jpg").read_bytes() == b"painted over"


def test_a_photograph_that_no_plan_put_there_stays(tmp_path):
    mine = tmp_path / "photo.jpg"
    mine.write_bytes(b"mine")
    for _ in range(2):  # the second time beside a plan
        assert planned(None, tmp_path) is None
        assert mine.read_bytes() == b"mine"
    found = segmented(tmp_path / "found")
    for placed in (check_place, place_photo):
        with pytest.raises(UsageError, match=r"E129 .*photo\.jpg: no plan put this.*-o"):
            placed(photo_of(found), tmp_path)
    assert mine.read_bytes() == b"mine"


def test_the_photograph_of_the_label_image_stays_beside_it(tmp_path):
    found = segmented(tmp_path / "found")
    for _ in range(2):
        assert planned(found, found) == found / "photo.jpg"
        assert (found / "photo.jpg").read_bytes() == b"a picture"
    # It is of that label image even when the plan beside it was given a copy of the same bytes.
    (found / "stones.json").unlink()
    moved = segmented(tmp_path / "moved")
    (found / "photo.jpg").unlink()
    planned(moved, found)
    write_sidecar(PhotoSidecar(640, 480, photo="photo.jpg"), found)
    planned(None, found)
    assert (found / "photo.jpg").read_bytes() == b"a picture"


@pytest.mark.parametrize("text", ["{", "[]", '{"source": 1}', '{"source": {"photo": "x"}}'])
def test_a_damaged_plan_owns_no_photograph(tmp_path, text):
    (tmp_path / "photo.png").write_bytes(b"mine")
    (tmp_path / "plan.json").write_text(text, encoding="utf-8")
    place_photo(None, tmp_path)
    assert (tmp_path / "photo.png").read_bytes() == b"mine"


def test_the_name_of_a_photograph_leads_nowhere_else(tmp_path):
    folder = tmp_path / "found"
    folder.mkdir()
    (tmp_path / "photo.jpg").write_bytes(b"not yours")
    for name in ("../photo.jpg", "x" * 300 + ".jpg", "\0.jpg", "", "/", "\ud800.jpg"):
        write_sidecar(PhotoSidecar(640, 480, photo="?"), folder)
        path = folder / "stones.json"
        path.write_text(path.read_text("utf-8").replace('"?"', json.dumps(name)), encoding="utf-8")
        assert photo_of(folder / "stones.png") is None


def measured(folder, width=60, height=40, px_per_m=250.0):
    Image.fromarray(two_stones(7, 300, np.uint16)).save(folder / "stones.png")
    Image.new("RGB", (60, 40)).save(folder / "photo.jpg")
    Image.new("RGB", (60, 40)).save(folder / "preview.png")
    write_sidecar(PhotoSidecar(width, height, px_per_m, "photo.jpg"), folder)
    return folder


@pytest.mark.parametrize("name", [".", "stones.png"])
def test_scale_of_a_photograph(tmp_path, name):
    stones = read_stones(measured(tmp_path) / name, settings=ReadSettings(px_per_m=99.0))
    assert areas(stones) == {7: 375, 300: 600}
    assert stones.source.px_per_m == 250.0
    assert (stones.source.path, stones.source.files) == ("stones.png", ())
    assert stones.source.reading == ()
    measured(tmp_path, width=600, height=400)
    with pytest.raises(InputError, match=r"E117 .*60 x 40 px.*600 x 400.*drystone segment"):
        read_stones(tmp_path)
