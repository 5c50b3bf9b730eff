import io
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from drystone_lab.photographs.layout import PhotoLevel
from drystone_lab.photographs.scene import photograph
from drystone_lab.photos import overlaps

SHEET = PhotoLevel(
    name="sheet", count=7, width_px=900, height_px=675, px_per_m=800.0, gap_px=10, tilt_deg=12.0,
    shadow=0.35, ground="plywood", rocks=("granite", "basalt"), turn_deg=5.0,
)  # fmt: skip
BARE = replace(
    SHEET, markers="none", width_px=600, height_px=450, tilt_deg=0.0, turn_deg=0.0, shadow=0.0
)


@pytest.fixture(scope="module")
def sheet():
    return photograph(SHEET)


@pytest.fixture(scope="module")
def bare():
    return photograph(BARE)


def saved(made, tmp_path, name="photo-1.jpg"):
    path = tmp_path / name
    path.write_bytes(made.jpeg)
    return path


def opened(path):
    with Image.open(path) as picture:
        return np.array(picture)


def test_markers_give_scale_and_view_and_are_no_stones(run, tmp_path, sheet):
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
    assert beside["markers"]["ids"] == [0, 1, 2, 3]
    assert beside["px_per_m"] == said["px_per_m"]
    true = np.sort(np.bincount(sheet.truth.ravel())[1:]) / SHEET.px_per_m**2
    found = np.sort([stone["area_px"] for stone in said["sizes"]]) / said["px_per_m"] ** 2
    assert found == pytest.approx(true, rel=0.06)
    truth = sheet.truth_in(np.linalg.inv(np.array(beside["from_photo"])), labels.shape)
    assert overlaps(truth, labels).max(axis=1).min() > 0.9


def test_a_plan_is_made_of_what_was_written(run, tmp_path, sheet):
    out, wall = tmp_path / "out", tmp_path / "wall"
    assert run("segment", saved(sheet, tmp_path), "--aruco", "A4:75mm", "-o", out).code == 0
    ran = run(
        "plan", out / "stones.png", "--wall", "0.8mx0.4m", "-o", wall, "--budget", "1",
        "--scale", "0.15", "--geometry", "raster", "--quiet",
    )  # fmt: skip
    assert ran.code in (0, 4), ran.err
    assert (wall / "photo.jpg").read_bytes() == (out / "photo.jpg").read_bytes()
    assert json.loads((wall / "plan.json").read_text())["steps"]


def quickly_planned(run, stones, out, *more):
    return run(
        "plan", stones, "--wall", "0.8mx0.4m", "-o", out, "--method", "paper", "--scale", "0.15",
        "--quiet", *more,
    )  # fmt: skip


def test_a_plan_in_the_folder_of_the_stones_keeps_their_photograph(run, tmp_path, bare):
    out = tmp_path / "out"
    assert run("segment", saved(bare, tmp_path), "--px-per-m", 800, "-o", out).code == 0
    photo = (out / "photo.jpg").read_bytes()
    ran = quickly_planned(run, out, out, "--overwrite")
    assert ran.code in (0, 4), ran.err
    assert (out / "photo.jpg").read_bytes() == photo
    assert "data:image/jpeg" in (out / "report.html").read_text(encoding="utf-8")
    assert "photo" not in json.loads((out / "plan.json").read_text())["source"]


def test_a_plan_knows_its_copy_and_refuses_before_it_replaces_another(run, tmp_path, bare):
    out, wall, mine = tmp_path / "out", tmp_path / "wall", tmp_path / "mine"
    assert run("segment", saved(bare, tmp_path), "--px-per-m", 800, "-o", out).code == 0
    for _ in range(2):
        assert quickly_planned(run, out, wall, "--overwrite").code in (0, 4)
        source = json.loads((wall / "plan.json").read_text())["source"]
        assert source["photo"]["name"] == "photo.jpg"
    mine.mkdir()
    (mine / "photo.jpg").write_bytes(b"mine")
    ran = quickly_planned(run, out, mine, "--overwrite")
    assert ran.code == 2
    assert "E129" in ran.err
    assert [path.name for path in mine.iterdir()] == ["photo.jpg"]
    assert (mine / "photo.jpg").read_bytes() == b"mine"


def test_a_damaged_photograph_is_refused_before_the_search(run, tmp_path, bare):
    out, wall = tmp_path / "out", tmp_path / "wall"
    assert run("segment", saved(bare, tmp_path), "--px-per-m", 800, "-o", out).code == 0
    (out / "photo.jpg").write_bytes(b"no picture")
    ran = quickly_planned(run, out, wall)
    assert ran.code == 3
    assert "E189" in ran.err
    assert not wall.exists()


def test_a_turned_photograph_gives_the_same_stones(run, tmp_path, bare):
    picture = Image.open(io.BytesIO(bare.jpeg))
    upright, turned = tmp_path / "upright.png", tmp_path / "turned.png"
    picture.save(upright)
    exif = Image.Exif()
    exif[0x0112] = 6
    picture.transpose(Image.Transpose.ROTATE_90).save(turned, exif=exif)
    for path in (upright, turned):
        out = tmp_path / path.stem
        assert run("segment", path, "--px-per-m", "800", "-o", out).code == 0
    one, other = (opened(tmp_path / k / "stones.png") for k in ("upright", "turned"))
    assert np.array_equal(one, other)


def test_the_scale_may_be_a_ruler_or_not_known(run, tmp_path, bare):
    path = saved(bare, tmp_path)
    ruled = run("segment", path, "--ruler", "0,0,400,0=50cm", "-o", tmp_path / "ruled")
    assert ruled.code == 0
    assert "800.0 px a metre" in ruled.out
    assert " cm" in ruled.out
    assert json.loads((tmp_path / "ruled" / "stones.json").read_text())["px_per_m"] == 800.0
    without = run("segment", path, "-o", tmp_path / "without")
    assert "not known" in without.out
    assert "no scale" in without.err
    assert json.loads((tmp_path / "without" / "stones.json").read_text())["px_per_m"] is None


def test_one_file_has_one_median_stone(run, tmp_path, bare):
    out = tmp_path / "out"
    found = run("segment", saved(bare, tmp_path), "--px-per-m", 800, "-o", out).out
    (median,) = re.findall(r"median stone +(\S+ x \S+) cm", found)
    assert f" {median} cm (" in run("stones", out / "stones.png").out
    planned = run(
        "plan", out / "stones.png", "--wall", "0.8mx0.4m", "-o", tmp_path / "wall", "--budget", "1",
        "--scale", "0.15", "--geometry", "raster",
    )  # fmt: skip
    assert f"median {median} cm)" in planned.err


def test_markers_are_no_stones_without_their_option(run, tmp_path, sheet):
    out = tmp_path / "out"
    ran = run("segment", saved(sheet, tmp_path), "--px-per-m", 800, "-o", out, "--json")
    assert ran.code == 0
    assert any(notice.startswith("W170") for notice in ran.json()["notices"])
    whole = np.unique(sheet.truth_in(np.eye(3), (SHEET.height_px, SHEET.width_px)))[1:]
    assert ran.json()["stones"] <= len(whole)


def test_a_stone_along_the_ruler_is_in_doubt(run, tmp_path):
    picture = np.full((300, 400, 3), (60, 90, 150), np.uint8)
    picture[50:62, 50:350] = (230, 220, 120)
    picture[120:200, 60:160] = picture[130:210, 220:330] = (160, 150, 140)
    Image.fromarray(picture).save(tmp_path / "photo.png")
    out = tmp_path / "out"
    ruled = ("--ruler", "55,49,345,49=290mm")
    ran = run("segment", tmp_path / "photo.png", *ruled, "-o", out)
    assert "W179 unusual: stone 1 lies along --ruler and may be the ruler" in ran.out
    beside = ("--ruler", "55,80,345,80=290mm")
    ran = run("segment", tmp_path / "photo.png", *beside, "-o", out, "--overwrite")
    assert "W179" not in ran.out


@pytest.mark.parametrize("command", ["segment", "stones", "plan"])
def test_a_ruler_outside_the_picture_is_refused(run, tmp_path, command):
    picture = np.zeros((120, 213), np.uint8)
    picture[20:50, 20:80] = picture[60:100, 100:160] = 255
    Image.fromarray(picture).save(tmp_path / "pile.png")
    wall = ("--wall", "1.4mx0.4m") if command == "plan" else ()
    out = tmp_path / "out"
    output = () if command == "stones" else ("-o", out)
    ran = run(command, tmp_path / "pile.png", *wall, *output, "--ruler", "20,30,2000,30=1.0m")
    assert ran.code == 2
    assert "E138 --ruler: the point 2000,30 is outside the picture" in ran.err
    assert not list(out.glob("*"))


@pytest.mark.parametrize(
    ("options", "code", "exit_code"),
    [
        (["--aruco", "A4:75mm"], "E170", 3),
        (["--aruco", "50mm", "--px-per-m", "100"], "E138", 2),
        (["--aruco", "A9:50mm"], "E174", 2),
        (["--marker-ids", "1"], "E138", 2),
        (["--check-line", "97mm"], "E138", 2),
        (["--min-area", "5cm2"], "E131", 2),
        (["--min-area", "much"], "E138", 2),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_is_written(
    run, tmp_path, bare, options, code, exit_code
):
    ran = run("segment", saved(bare, tmp_path), "-o", tmp_path / "out", *options)
    assert ran.code == exit_code
    assert f"drystone: {code}" in ran.err
    assert not list((tmp_path / "out").glob("*"))


def test_no_stones_and_noise_are_errors(run, tmp_path):
    rng = np.random.default_rng(0)
    Image.fromarray(np.full((300, 400, 3), 180, np.uint8)).save(tmp_path / "plain.png")
    Image.fromarray(rng.integers(0, 256, (300, 400, 3), np.uint8)).save(tmp_path / "noise.png")
    for name in ("plain", "noise"):
        for ground in ("auto", "light", "dark"):
            out = tmp_path / name / ground
            ran = run("segment", tmp_path / f"{name}.png", "-o", out, "--ground", ground)
            assert ran.code == 3
            assert "drystone: E17" in ran.err


def test_a_folder_with_files_is_not_touched(run, tmp_path, bare):
    out = tmp_path / "out"
    out.mkdir()
    (out / "note.txt").write_text("mine")
    path = saved(bare, tmp_path)
    assert run("segment", path, "-o", out).code == 2
    assert run("segment", path, "-o", out, "--overwrite").code == 0
    assert (out / "note.txt").read_text() == "mine"
