"""Photographs: `drystone segment`, and sheets of `drystone markers` that give them a scale."""

import json
import re
from dataclasses import replace

import numpy as np
import pypdfium2
import pytest
from PIL import Image

from drystone.cli.commands.segment import WRITTEN, scale_from
from drystone.cli.parser import build_parser
from drystone.photo.layout import parse_layout
from drystone.photo.markers import find_markers
from drystone.photo.scale import scale_and_view
from drystone_lab.photographs.rendered import PhotoLevel, photograph
from drystone_lab.photos import overlaps
from tests.photo.test_segment import sand

SHEET = PhotoLevel(
    name="sheet", count=5, width_px=720, height_px=540, px_per_m=800.0, gap_px=10, tilt_deg=12.0,
    shadow=0.35, ground="plywood", rocks=("granite", "basalt"), turn_deg=5.0,
)  # fmt: skip
BARE = replace(
    SHEET, markers="none", count=4, width_px=420, height_px=320, tilt_deg=0.0, turn_deg=0.0,
    shadow=0.0,
)  # fmt: skip


@pytest.fixture(scope="module")
def bare(tmp_path_factory):
    """A photograph without markers."""
    path = tmp_path_factory.mktemp("bare") / "photo-1.jpg"
    path.write_bytes(photograph(BARE).jpeg)
    return path


def opened(path):
    with Image.open(path) as picture:
        return np.array(picture)


def test_markers_give_scale_and_view_and_are_no_stones_of_a_plan(run, tmp_path):
    sheet, out, wall = photograph(SHEET), tmp_path / "out", tmp_path / "wall"
    photo = tmp_path / "photo-1.jpg"
    photo.write_bytes(sheet.jpeg)
    ran = run("segment", photo, "--aruco", "A4:75mm", "-o", out, "--json")
    assert ran.code == 0
    said, beside = ran.json(), json.loads((out / "stones.json").read_text())
    labels = opened(out / "stones.png")
    assert labels.dtype == np.uint16
    assert (beside["width_px"], beside["height_px"]) == labels.shape[::-1]
    assert opened(out / "photo.jpg").shape == (*labels.shape, 3)
    assert opened(out / "preview.png").shape[1] > 600
    assert [marker["id"] for marker in beside["markers"]] == [0, 1, 2, 3]
    for name in ("markers", "px_per_m"):
        assert said[name] == beside[name]
    for marker in beside["markers"]:
        sides = np.hypot(*np.diff(marker["corners_m"] + marker["corners_m"][:1], axis=0).T)
        assert sides == pytest.approx(0.075, rel=0.01)
    true = np.sort(np.bincount(sheet.truth.ravel())[1:]) / SHEET.px_per_m**2
    found = np.sort([stone["area_px"] for stone in said["sizes"]]) / said["px_per_m"] ** 2
    assert found == pytest.approx(true, rel=0.06)
    truth = sheet.truth_in(np.linalg.inv(np.array(beside["from_photo"])), labels.shape)
    assert overlaps(truth, labels).max(axis=1).min() > 0.9
    ran = quickly_planned(run, out / "stones.png", wall)
    assert ran.code in (0, 4), ran.err
    assert (wall / "photo.jpg").read_bytes() == (out / "photo.jpg").read_bytes()
    plan = json.loads((wall / "plan.json").read_text())
    assert plan["steps"]
    # What a robot must know of the photograph goes along, to the poses too.
    of_photo = plan["source"]["photograph"]
    assert of_photo["name"] == "photo-1.jpg"
    assert run("export", wall, "--to", "poses").code == 0
    poses = json.loads((wall / "poses.json").read_text())
    for name in ("markers", "P_from_marker"):
        assert poses[name] == of_photo[name] == beside[name]
    assert "photo-1.jpg" in (wall / "report.html").read_text("utf-8").split("<h1>")[1]


def quickly_planned(run, stones, out, *more):
    size = ("--wall", "0.8mx0.4m", "--method", "paper", "--scale", ".15")
    return run("plan", stones, *size, "-o", out, *more)


def test_one_file_has_one_median_stone_and_its_photograph_which_may_not_be_damaged(
    run, tmp_path, bare
):
    out, wall, mine, none = (tmp_path / name for name in ("out", "wall", "mine", "none"))
    for folder, name in ((out, "note.txt"), (mine, "photo.jpg")):
        folder.mkdir()
        (folder / name).write_text("mine")
    asked = ("segment", bare, "--px-per-m", 800, "-o", out)
    assert "E129" in run(*asked).err
    found = run(*asked, "--overwrite").out
    (median,) = re.findall(r"median stone +(\S+ x \S+) cm", found)
    assert f" {median} cm (" in run("stones", out / "stones.png").out
    # A plan knows its copy, and refuses before it replaces another.
    for _ in range(2):
        assert quickly_planned(run, out, wall, "--overwrite").code in (0, 4)
    assert json.loads((wall / "plan.json").read_text())["source"]["photo"]["name"] == "photo.jpg"
    quickly_planned(run, out, mine, "--overwrite").refused("E129")
    quickly_planned(run, out, mine, "--overwrite", "--px-per-m", 900).refused("E131")
    assert [(path.name, path.read_text()) for path in mine.iterdir()] == [("photo.jpg", "mine")]
    # In the folder of the stones it keeps their photograph.
    photo = (out / "photo.jpg").read_bytes()
    ran = quickly_planned(run, out, out, "--overwrite")
    assert f"median {median} cm)" in ran.err
    assert ((out / "photo.jpg").read_bytes(), (out / "note.txt").read_text()) == (photo, "mine")
    assert "data:image/jpeg" in (out / "report.html").read_text(encoding="utf-8")
    assert "photo" not in json.loads((out / "plan.json").read_text())["source"]
    # A damaged one is refused before the search, here of stones without a scale.
    ran = run("segment", bare, "-o", out, "--overwrite")
    assert ("not known" in ran.out, "No scale given" in ran.err) == (True, True)
    assert json.loads((out / "stones.json").read_text())["px_per_m"] is None
    (out / "photo.jpg").write_bytes(b"no picture")
    quickly_planned(run, out, none, "--wall", "640x320").refused("E189", exit_code=3)
    assert not none.exists()


def test_what_is_no_photograph_of_stones_is_doubtful_first_and_by_its_exit_code(run, tmp_path):
    bed, out = tmp_path / "bed.png", tmp_path / "out"
    Image.fromarray(sand(np.random.default_rng(1))[60:340, 140:460]).save(bed)
    ran = run("segment", bed, "-o", out)
    assert ran.code == 5
    assert ran.out.startswith("doubtful: the ground is not plain")
    assert {path.name for path in out.iterdir()} == set(WRITTEN)
    (reason, *_) = json.loads((out / "stones.json").read_text())["doubtful"]
    assert reason in ran.out
    said = run("segment", bed, "-o", tmp_path / "json", "--json")
    assert (said.code, said.json()["doubtful"][0]) == (5, reason)
    # Stones that were cut out need no search.
    clear = np.zeros((100, 100, 4), np.uint8)
    clear[:, :, 3] = np.eye(100) * 255
    Image.fromarray(clear).save(bed)
    ran = run("segment", bed, "-o", tmp_path / "clear")
    ran.refused("E175", exit_code=3)
    assert "give the picture itself to `drystone plan`" in ran.err


def test_what_is_in_doubt_or_left_out_has_a_place_and_a_reason(run, tmp_path):
    """Two stones on blue cloth, a ruler, a speck, and a stone that is cut by the edge."""
    photo, out = tmp_path / "photo.png", tmp_path / "out"
    picture = np.full((300, 400, 3), (60, 90, 150), np.uint8)
    for window in (np.s_[120:200, 60:160], np.s_[130:210, 220:330], np.s_[20:26, 100:106]):
        picture[window] = picture[100:180, 380:400] = (160, 150, 140)
    picture[50:62, 50:350] = (230, 220, 120)
    Image.fromarray(picture).save(photo)
    said = "W179 unusual: stone 1 lies along --ruler and may be the ruler"
    ran = run("segment", photo, "--ruler", "55,49,345,49=290mm", "-o", out)
    assert ran.code == 0
    assert all(words in ran.out for words in (said, "3 stones", "1000.0 px a metre"))
    left_out = json.loads((out / "stones.json").read_text())["left_out"]
    assert [(one["why"], one["x_px"]) for one in left_out] == [
        ("at the edge of the photograph or cut by it", pytest.approx(390, abs=1)),
        ("too small (--min-area)", pytest.approx(103, abs=1)),
    ]


PX_PER_MM = 300 / 25.4
LIGHT = np.arange(256) / 255.0
# PDFium mixes black and white by area in values, a lens in light.
SEEN = np.where(LIGHT > 0.0031308, 1.055 * LIGHT ** (1 / 2.4) - 0.055, 12.92 * LIGHT)
SEEN = np.rint(255.0 * SEEN).astype(np.uint8)


def rendered(path, page=0):
    """A page as a camera sees it, its size in mm, and its text."""
    with pypdfium2.PdfDocument(path) as document:
        one = document[page]
        size_mm = np.array(one.get_size()) / 72 * 25.4
        picture = one.render(scale=PX_PER_MM * 25.4 / 72).to_numpy()[..., :3]
        text = one.get_textpage().get_text_range()
    return SEEN[picture], size_mm, text


@pytest.mark.parametrize(
    ("options", "layout", "page_mm"),
    [
        ([], "A4:50mm", (210.0, 297.0)),
        (["--dictionary", "apriltag", "--page", "letter", "--size", "6cm"], "letter:60mm",
         (215.9, 279.4)),
    ],
)  # fmt: skip
def test_a_printed_sheet_measures_what_it_says(run, tmp_path, options, layout, page_mm):
    """In vectors without hairlines, beside a line of 100 mm."""
    path = tmp_path / "sheet.pdf"
    told = run("markers", "-o", path, *options)
    assert told.code == 0
    last = f"Print at 100 %. Then: drystone segment PHOTO --aruco {layout} -o DIR"
    assert told.out.splitlines()[-1] == last
    assert not re.search(rb"/Subtype /Image|CreationDate", path.read_bytes())
    picture, size_mm, text = rendered(path)
    assert size_mm == pytest.approx(page_mm, abs=0.01)
    known, found = parse_layout(layout), find_markers(picture)
    assert [one.id for one in found] == [0, 1, 2, 3]
    # A page is stretched to whole px when it is rendered.
    px_per_mm = np.array(picture.shape[1::-1]) / page_mm
    assert px_per_mm == pytest.approx(PX_PER_MM, rel=1e-3)
    # The black border of the first marker is at least 7.5 mm wide.
    low, deep, far = (round(mm * PX_PER_MM) for mm in (15.5, 22, 64))
    assert picture[low:deep, low:far].max() == 0
    dark = picture[..., 0] < 188  # half the light
    rows = np.flatnonzero(dark[:, dark.shape[1] // 2 - 150 : dark.shape[1] // 2 + 150].all(axis=1))
    columns = np.flatnonzero(dark[rows[0]])
    assert (columns[-1] + 1 - columns[0]) / PX_PER_MM == pytest.approx(100.0, abs=0.4)
    for one in found:
        flat_mm = known.corners_m(one.id) * 1000
        # Where a printer puts it, to a tenth of a millimetre: sizes and distances are then right.
        assert one.corners_px / px_per_mm == pytest.approx(flat_mm, abs=0.03)
        assert f"marker {one.id}" in text
    height, width = picture.shape[:2]
    view = scale_and_view(found, known, (width, height))
    assert view.px_per_m == pytest.approx(px_per_mm.mean() * 1000, rel=3e-4)
    corners = known.corners_m(2)[2] * 1000 - known.corners_m(0)[0] * 1000
    said = f"{corners[0]:.1f} mm across, {corners[1]:.1f} mm down"
    assert all(words in text for words in (said, "100 %", "measure me: 100 mm"))


@pytest.mark.parametrize(
    ("options", "ids", "said"),
    [
        ([], [0, 1, 2, 3], "--aruco A4:50mm"),
        (["--ids", 4, "--size", "60mm"], [4, 5, 6, 7], "--aruco A4:60mm --marker-ids 4 5 6 7"),
        (["--count", 8], [*range(8)], "--aruco A4:50mm --marker-ids 0 1 2 3 4 5 6 7"),
        # Single markers have a page each.
        (["--single", "--ids", 5, "--count", 2], [5, 6], "--aruco 120mm"),
    ],
)
def test_the_options_that_are_said_find_the_markers(run, tmp_path, options, ids, said):
    path = tmp_path / "sheet.pdf"
    told = run("markers", "-o", path, "--json", *options).json()
    assert (told["ids"], told["options"]) == (ids, said.split())
    named = build_parser().parse_args(["segment", "photo.jpg", "-o", "out", *told["options"]])
    layout, pages = scale_from(named), range(len(ids) if "--single" in options else len(ids) // 4)
    shown = [rendered(path, page) for page in pages]
    found = [one for picture, *_ in shown for one in find_markers(picture)]
    assert [one.id for one in found if layout.lists(one.id)] == ids
    for one in found:
        assert any(f"marker {one.id}" in text for *_, text in shown)
        sides = np.hypot(*(one.corners_px - np.roll(one.corners_px, 1, axis=0)).T)
        assert sides / PX_PER_MM == pytest.approx(np.full(4, layout.side_m * 1000), abs=0.08)
