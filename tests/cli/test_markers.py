import numpy as np
import pypdfium2
import pytest

from drystone.cli.commands.segment import scale_from
from drystone.cli.parser import build_parser
from drystone.photo.layout import parse_layout
from drystone.photo.markers import find_markers
from drystone.photo.scale import scale_and_view

DPI = 200
PX_PER_MM = DPI / 25.4


def rendered(path, page=0, dpi=DPI):
    with pypdfium2.PdfDocument(path) as document:
        one = document[page]
        size = one.get_size()
        picture = one.render(scale=dpi / 72).to_numpy()
        text = one.get_textpage().get_text_range()
    return as_a_camera_sees(picture[..., :3]), size, text


def as_a_camera_sees(picture):
    """PDFium mixes black and white by area in values, a lens in light."""
    light = picture / 255.0
    values = np.where(light > 0.0031308, 1.055 * light ** (1 / 2.4) - 0.055, 12.92 * light)
    return np.ascontiguousarray(np.rint(255.0 * values).astype(np.uint8))


@pytest.mark.parametrize(
    ("options", "layout", "page_mm"),
    [
        ([], "A4:50mm", (210.0, 297.0)),
        (["--dictionary", "apriltag", "--page", "letter", "--size", "6cm"], "letter:60mm",
         (215.9, 279.4)),
    ],
)  # fmt: skip
def test_a_printed_sheet_measures_what_it_says(run, tmp_path, options, layout, page_mm):
    path = tmp_path / "sheet.pdf"
    told = run("markers", "-o", path, *options)
    assert told.code == 0
    last = f"Print at 100 %. Then: drystone segment PHOTO --aruco {layout} -o DIR"
    assert told.out.splitlines()[-1] == last
    picture, size, text = rendered(path, dpi=300)
    assert np.array(size) / 72 * 25.4 == pytest.approx(page_mm, abs=0.01)
    known = parse_layout(layout)
    found = find_markers(picture)
    assert [one.id for one in found] == [0, 1, 2, 3]
    # A page is stretched to whole px when it is rendered.
    px_per_mm = np.array(picture.shape[1::-1]) / page_mm
    assert px_per_mm == pytest.approx(300 / 25.4, rel=1e-3)
    for one in found:
        flat_mm = known.corners_m(one.id) * 1000
        # Where a printer puts it, to a tenth of a millimetre: sizes and distances are then right.
        assert one.corners_px / px_per_mm == pytest.approx(flat_mm, abs=0.03)
        assert f"marker {one.id}" in text
    height, width = picture.shape[:2]
    view = scale_and_view(found, known, (width, height))
    assert view.px_per_m == pytest.approx(px_per_mm.mean() * 1000, rel=3e-4)
    corners = known.corners_m(2)[2] * 1000 - known.corners_m(0)[0] * 1000
    assert f"{corners[0]:.1f} mm across, {corners[1]:.1f} mm down" in text
    assert "100 %" in text


def test_markers_are_vectors_without_hairlines_beside_a_line_of_100_mm(run, tmp_path):
    path = tmp_path / "sheet.pdf"
    assert run("markers", "-o", path, "--count", 8, "--ids", 4).code == 0
    assert [one.id for one in find_markers(rendered(path, 1)[0])] == [8, 9, 10, 11]
    data = path.read_bytes()
    assert not any(word in data for word in (b"/Subtype /Image", b"CreationDate"))
    picture, _, text = rendered(path)
    # The black border of the first marker, five sixths of a square of 50/6 mm wide.
    low, deep = round(15.5 * PX_PER_MM), round(22 * PX_PER_MM)
    assert picture[low:deep, low : round(64 * PX_PER_MM)].max() == 0
    assert "measure me: 100 mm" in text
    dark = picture[..., 0] < 188  # half the light
    rows = np.flatnonzero(dark[:, dark.shape[1] // 2 - 100 : dark.shape[1] // 2 + 100].all(axis=1))
    columns = np.flatnonzero(dark[rows[0]])
    assert (columns[-1] + 1 - columns[0]) / PX_PER_MM == pytest.approx(100.0, abs=0.4)


def test_single_markers_have_a_page_each(run, tmp_path):
    path = tmp_path / "single.pdf"
    ran = run("markers", "-o", path, "--single", "--count", 2, "--ids", 5, "--json")
    told = ran.json()
    assert (told["ids"], told["layout"]) == ([5, 6], "120mm")
    for page, marker_id in enumerate(told["ids"]):
        picture, _, text = rendered(path, page)
        (one,) = find_markers(picture)
        assert one.id == marker_id
        sides = np.hypot(*(one.corners_px - np.roll(one.corners_px, 1, axis=0)).T)
        assert sides / PX_PER_MM == pytest.approx(np.full(4, 120.0), abs=0.08)
        assert f"marker {marker_id}" in text


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ([], "--aruco A4:50mm"),
        (["--ids", 4, "--size", "60mm"], "--aruco A4:60mm --marker-ids 4 5 6 7"),
        (["--count", 8], "--aruco A4:50mm --marker-ids 0 1 2 3 4 5 6 7"),
        (["--single", "--ids", 5], "--aruco 120mm"),
    ],
)
def test_the_options_that_are_said_find_the_markers(run, tmp_path, options, said):
    path = tmp_path / "sheet.pdf"
    told = run("markers", "-o", path, "--json", *options).json()
    assert told["options"] == said.split()
    named = build_parser().parse_args(["segment", "photo.jpg", "-o", "out", *told["options"]])
    layout = scale_from(named)
    assert all(layout.lists(one) for one in told["ids"])
