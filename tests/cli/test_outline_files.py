"""Plans of stones from annotations, drawings and photographs; `check` reads them again."""

import json

import ezdxf
import numpy as np
import pytest
from PIL import Image

from drystone.io.photo_beside import PhotoSidecar, write_sidecar
from drystone.io.plan_json import read_plan

SIZES = [(90, 40), (70, 42), (84, 38), (60, 44), (96, 36), (72, 40)]
"""Of six blocks, px or mm."""
QUICK = ["--method", "paper", "--quiet"]


def boxes():
    found = []
    for number, (width, height) in enumerate(SIZES):
        x, y = 10 + 110 * (number % 3), 10 + 60 * (number // 3)
        found.append([(x, y), (x + width, y), (x + width, y + height), (x, y + height)])
    return found


def dxf(folder, unit=4):
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = unit
    for corners in boxes():
        document.modelspace().add_lwpolyline(corners, close=True)
    document.saveas(folder / "stones.dxf")
    return folder / "stones.dxf"


def coco(folder):
    images = [{"id": i, "file_name": f"{i}.jpg", "width": 340, "height": 130} for i in (1, 2)]
    found = [
        {"id": 10 * i + n, "image_id": i, "segmentation": [list(np.ravel(corners).tolist())]}
        for i in (1, 2)
        for n, corners in enumerate(boxes()[i:])
    ]
    path = folder / "coco.json"
    path.write_text(json.dumps({"images": images, "annotations": found}))
    return path


@pytest.mark.parametrize(
    "reading", [{}, {"px_per_m": 800.0, "unit": "mm", "up": "z-back"}], ids=["plain", "told"]
)
def test_a_drawing_has_a_scale_and_its_plan_holds(tmp_path, run, reading):
    path = dxf(tmp_path)
    said = run("stones", path).out
    assert "2100 px a metre" in said
    assert "W119 the longer side of the median stone is 0.078 m" in said
    out = tmp_path / "out"
    options = [word for n, value in reading.items() for word in (f"--{n.replace('_', '-')}", value)]
    ran = run("plan", path, "--wall", "0.25mx0.12m", *options, *QUICK, "-o", out)
    assert ran.code in (0, 4), ran.err
    plan = read_plan(out)
    assert (plan.length_unit, plan.px_per_m) == ("m", reading.get("px_per_m", 2100.0))
    assert plan.source.get("reading", {}) == reading
    assert run("check", out, "--json").json()["ok"]
    path.rename(tmp_path / "moved.dxf")
    assert run("check", out, "--stones", tmp_path / "moved.dxf", "--json").json()["ok"]


def test_px_of_an_image_are_not_drawn_again(tmp_path, run):
    path, out = coco(tmp_path), tmp_path / "out"
    ran = run(
        "plan", path, "--image", "2.jpg", "--px-per-m", "1000", "--wall", "0.25mx0.12m", *QUICK,
        "-o", out,
    )  # fmt: skip
    assert ran.code in (0, 4), ran.err
    plan = read_plan(out)
    assert plan.px_per_m == 1000.0
    assert plan.source["reading"] == {"image": "2.jpg"}
    assert (plan.source["width_px"], plan.source["stones"]) == (340, 4)
    assert {step.stone for step in plan.stone_steps} <= {20, 21, 22, 23}
    assert run("check", out, "--json").json()["ok"]


def test_classes_and_frames_are_chosen_and_kept_in_the_plan(tmp_path, run):
    corners = [*boxes(), [(2, 2), (338, 2), (338, 128), (2, 128)]]
    labels = [*["granite"] * 4, *["slate"] * 2, "granite"]
    both = zip(labels, corners, strict=True)
    shapes = [{"label": label, "points": np.array(ring).tolist()} for label, ring in both]
    path, out = tmp_path / "a.json", tmp_path / "out"
    path.write_text(json.dumps({"shapes": shapes, "imageWidth": 340, "imageHeight": 130}))
    assert run("stones", path, "--json").json()["stones"] == 6
    assert run("stones", path, "--label", "slate", "--json").json()["stones"] == 2
    assert run("stones", path, "--label", "slate", "Granite", "--json").json()["stones"] == 6
    kept = run("stones", path, "--label", "granite", "--keep", 5, "--skip", 1, "--json")
    assert kept.json()["stones"] == 1
    refused = run("stones", path, "--label", "marble")
    assert refused.code == 2
    assert "granite, slate" in refused.err
    ran = run("plan", path, "--label", "granite", "--wall", "300x120", *QUICK, "-o", out)
    assert ran.code in (0, 4), ran.err
    assert read_plan(out).source["reading"] == {"label": ["granite"]}
    assert run("check", out, "--stones", path, "--json").json()["ok"]


def test_a_photograph_has_its_scale_beside_it(tmp_path, run):
    folder, out = tmp_path / "photo", tmp_path / "out"
    folder.mkdir()
    labels = np.zeros((130, 340), np.uint8)
    for number, corners in enumerate(np.array(boxes()), start=1):
        (left, top), (right, bottom) = corners.min(axis=0), corners.max(axis=0)
        labels[top:bottom, left:right] = number
    Image.fromarray(labels).save(folder / "stones.png")
    write_sidecar(PhotoSidecar(340, 130, 1000.0), folder)
    ran = run("plan", folder, "--wall", "0.25mx0.12m", *QUICK, "-o", out)
    assert ran.code in (0, 4), ran.err
    assert read_plan(out).px_per_m == 1000.0
    assert run("check", out, "--stones", folder, "--json").json()["ok"]
    shown = run("stones", folder, "--json").json()
    assert (shown["stones"], shown["px_per_m"]) == (6, 1000.0)
    refused = run("plan", folder, "--wall", "0.25mx0.12m", "--px-per-m", "900", *QUICK, "-o", out)
    assert (refused.code, "E131" in refused.err) == (2, True)
