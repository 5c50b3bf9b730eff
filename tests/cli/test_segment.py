import json
import re
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from drystone.cli import main
from drystone_lab.photographs.layout import PhotoLevel
from drystone_lab.photographs.scene import photograph
from drystone_lab.photos import overlaps

SHEET = PhotoLevel(
    name="sheet", count=5, width_px=720, height_px=540, px_per_m=800.0, gap_px=10, tilt_deg=12.0,
    shadow=0.35, ground="plywood", rocks=("granite", "basalt"), turn_deg=5.0,
)  # fmt: skip
BARE = replace(
    SHEET,
    markers="none",
    count=4,
    width_px=420,
    height_px=320,
    tilt_deg=0.0,
    turn_deg=0.0,
    shadow=0.0,
)


@pytest.fixture(scope="module")
def sheet():
    return photograph(SHEET)


@pytest.fixture(scope="module")
def bare():
    return photograph(BARE)


@pytest.fixture(scope="module")
def found(bare, tmp_path_factory):
    """The folder of the stones of the bare photograph; not to be changed."""
    folder = tmp_path_factory.mktemp("found")
    asked = ["--px-per-m", "800", "-o", str(folder / "out")]
    assert main(["segment", str(saved(bare, folder)), *asked]) == 0
    return folder / "out"


def saved(made, tmp_path, name="photo-1.jpg"):
    path = tmp_path / name
    path.write_bytes(made.jpeg)
    return path


def opened(path):
    with Image.open(path) as picture:
        return np.array(picture)


def test_markers_give_scale_and_view_and_are_no_stones_of_a_plan(run, tmp_path, sheet):
    out = tmp_path / "out"
    ran = run("segment", saved(sheet, tmp_path), "--aruco", "A4:75mm", "-o", out, "--json")
    assert ran.code == 0
    said = ran.json()
    beside = json.loads((out / "stones.json").read_text())
    labels = opened(out / "stones.png")
    assert labels.dtype == np.uint16
    assert (beside["width_px"], beside["height_px"]) == labels.shape[::-1]
    assert opened(out / "photo.jpg").shape == (*labels.shape, 3)
    assert opened(out / "preview.png").shape[1] > 600
    assert [marker["id"] for marker in beside["markers"]] == [0, 1, 2, 3]
    assert said["markers"] == beside["markers"]
    for marker in beside["markers"]:
        sides = np.hypot(*np.diff(marker["corners_m"] + marker["corners_m"][:1], axis=0).T)
        assert sides == pytest.approx(0.075, rel=0.01)
    assert beside["px_per_m"] == said["px_per_m"]
    true = np.sort(np.bincount(sheet.truth.ravel())[1:]) / SHEET.px_per_m**2
    found = np.sort([stone["area_px"] for stone in said["sizes"]]) / said["px_per_m"] ** 2
    assert found == pytest.approx(true, rel=0.06)
    truth = sheet.truth_in(np.linalg.inv(np.array(beside["from_photo"])), labels.shape)
    assert overlaps(truth, labels).max(axis=1).min() > 0.9
    wall = tmp_path / "wall"
    ran = quickly_planned(run, out / "stones.png", wall)
    assert ran.code in (0, 4), ran.err
    assert (wall / "photo.jpg").read_bytes() == (out / "photo.jpg").read_bytes()
    plan = json.loads((wall / "plan.json").read_text())
    assert plan["steps"]
    # What a robot must know of the photograph goes along, to the poses too.
    assert plan["source"]["photograph"]["name"] == "photo-1.jpg"
    assert run("export", wall, "--to", "poses").code == 0
    poses = json.loads((wall / "poses.json").read_text())
    for name in ("markers", "P_from_marker"):
        assert poses[name] == plan["source"]["photograph"][name] == beside[name]
    assert "photo-1.jpg" in (wall / "report.html").read_text("utf-8").split("<h1>")[1]


def quickly_planned(run, stones, out, *more):
    return run(
        "plan", stones, "--wall", "0.8mx0.4m", "-o", out, "--method", "paper", "--scale", "0.15",
        "--quiet", *more,
    )  # fmt: skip


def test_a_plan_knows_its_copy_and_refuses_before_it_replaces_another(run, tmp_path, found):
    wall, mine = tmp_path / "wall", tmp_path / "mine"
    for _ in range(2):
        assert quickly_planned(run, found, wall, "--overwrite").code in (0, 4)
    assert json.loads((wall / "plan.json").read_text())["source"]["photo"]["name"] == "photo.jpg"
    mine.mkdir()
    (mine / "photo.jpg").write_bytes(b"mine")
    quickly_planned(run, found, mine, "--overwrite").refused("E129")
    assert [path.name for path in mine.iterdir()] == ["photo.jpg"]
    assert (mine / "photo.jpg").read_bytes() == b"mine"


def test_a_damaged_photograph_is_refused_before_the_search(run, tmp_path, bare):
    out, wall = tmp_path / "out", tmp_path / "wall"
    ran = run("segment", saved(bare, tmp_path), "-o", out)
    assert "not known" in ran.out
    assert "No scale given" in ran.err
    assert json.loads((out / "stones.json").read_text())["px_per_m"] is None
    (out / "photo.jpg").write_bytes(b"no picture")
    ran = run("plan", out, "--wall", "640x320", "-o", wall, "--method", "paper", "--scale", ".15")
    ran.refused("E189", exit_code=3)
    assert not wall.exists()


def test_one_file_has_one_median_stone_and_its_photograph(run, tmp_path, bare):
    out = tmp_path / "out"
    out.mkdir()
    (out / "note.txt").write_text("mine")
    asked = ("segment", saved(bare, tmp_path), "--px-per-m", 800, "-o", out)
    assert "E129" in run(*asked).err
    found = run(*asked, "--overwrite").out
    (median,) = re.findall(r"median stone +(\S+ x \S+) cm", found)
    assert f" {median} cm (" in run("stones", out / "stones.png").out
    photo = (out / "photo.jpg").read_bytes()
    # A plan in the folder of the stones keeps their photograph.
    ran = run("plan", out, "--wall", "0.8mx0.4m", "-o", out, "--method", "paper", "--scale", ".15",
              "--overwrite")  # fmt: skip
    assert f"median {median} cm)" in ran.err
    assert ((out / "photo.jpg").read_bytes(), (out / "note.txt").read_text()) == (photo, "mine")
    assert "data:image/jpeg" in (out / "report.html").read_text(encoding="utf-8")
    assert "photo" not in json.loads((out / "plan.json").read_text())["source"]


def two_stones(path, colour, *more):
    """Two stones on blue cloth, and something more of a colour, saved as a picture."""
    picture = np.full((300, 400, 3), (60, 90, 150), np.uint8)
    picture[120:200, 60:160] = picture[130:210, 220:330] = (160, 150, 140)
    for window in more:
        picture[window] = colour
    Image.fromarray(picture).save(path)


def test_a_stone_along_the_ruler_is_in_doubt(run, tmp_path):
    two_stones(tmp_path / "photo.png", (230, 220, 120), np.s_[50:62, 50:350])
    said = "W179 unusual: stone 1 lies along --ruler and may be the ruler"
    for row, doubted in ((49, True), (80, False)):
        asked = ("segment", tmp_path / "photo.png", "--ruler", f"55,{row},345,{row}=290mm")
        out = run(*asked, "-o", tmp_path / str(row)).out
        assert (said in out, "1000.0 px a metre" in out) == (doubted, True)


def test_what_is_no_photograph_of_stones_is_doubtful_first_and_by_its_exit_code(run, tmp_path):
    rng = np.random.default_rng(1)
    grains = ndimage.gaussian_filter(rng.standard_normal((300, 400)), 3)
    picture = np.clip(120 + 40 * grains / grains.std(), 0, 255)[..., None].repeat(3, 2)
    rows, cols = np.indices((300, 400))
    picture[np.hypot(rows - 150, cols - 200) < 24] = 170, 70, 50
    Image.fromarray(picture.astype(np.uint8)).save(tmp_path / "bed.png")
    ran = run("segment", tmp_path / "bed.png", "-o", tmp_path / "out")
    assert ran.code == 5
    assert ran.out.startswith("doubtful: the ground is not plain")
    assert {one.name for one in (tmp_path / "out").iterdir()} == {
        "stones.png", "stones.json", "photo.jpg", "preview.png", "outlines.html",
    }  # fmt: skip
    (reason, *_) = json.loads((tmp_path / "out" / "stones.json").read_text())["doubtful"]
    assert reason in ran.out
    said = run("segment", tmp_path / "bed.png", "-o", tmp_path / "json", "--json")
    assert (said.code, said.json()["doubtful"][0]) == (5, reason)


def test_what_was_left_out_has_a_place_and_a_reason(run, tmp_path):
    speck, cut = np.s_[20:26, 100:106], np.s_[100:180, 380:400]
    two_stones(tmp_path / "photo.png", (160, 150, 140), speck, cut)
    ran = run("segment", tmp_path / "photo.png", "-o", tmp_path / "out")
    assert (ran.code, "2 stones" in ran.out) == (0, True)
    left_out = json.loads((tmp_path / "out" / "stones.json").read_text())["left_out"]
    assert [one["why"] for one in left_out] == [
        "at the edge of the photograph or cut by it",
        "too small (--min-area)",
    ]
    assert [one["x_px"] for one in left_out] == pytest.approx([390, 103], abs=1)
