"""wall.svg, read back with the XML parser and transforms of our own."""

import math
import re
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import shapely

from drystone.drawing.export.formats import FORMATS, ExportSettings
from tests.drawing.export.drawn_walls import assembly

SVG = "{http://www.w3.org/2000/svg}"
NUMBER = r"-?\d+(?:\.\d+)?"
LAYERS = [
    "SITE", "STONES", "WEDGES", "CONTACTS", "FORCES-LEFT", "MECHANISM-LEFT", "FORCES-RIGHT",
    "MECHANISM-RIGHT", "NUMBERS",
]  # fmt: skip


def drawing(wall, folder, title=""):
    (path,) = FORMATS["svg"].write(wall, folder, ExportSettings(title=title))
    return ET.fromstring(path.read_bytes())  # noqa: S314 - our own file


def layer(root, name):
    (found,) = (group for group in root.iter(f"{SVG}g") if group.get("id") == name)
    return found


def corners(path):
    assert path.get("d")[0] == "M"
    assert path.get("d")[-1] == "Z"
    return np.array(re.findall(NUMBER, path.get("d")), float).reshape(-1, 2)


def placed(root, use):
    """Return the corners of a stone in the file's frame: turned about the origin, then moved."""
    (defined,) = (p for p in root.iter(f"{SVG}path") if "#" + p.get("id", "") == use.get("href"))
    found = re.fullmatch(
        rf"translate\(({NUMBER}) ({NUMBER})\) rotate\(({NUMBER})\)", use.get("transform")
    )
    x, y, degrees = (float(number) for number in found.groups())
    # In SVG a positive angle turns x towards y, which runs down.
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [(x + cos * u - sin * v, y + sin * u + cos * v) for u, v in corners(defined)]


@pytest.mark.parametrize("px_per_m", [200.0, None])
def test_placed_stones_are_where_the_plan_has_them(tmp_path, px_per_m) -> None:
    wall = assembly(columns=4, rows=3, px_per_m=px_per_m)
    root = drawing(wall, tmp_path)
    unit = 1000.0 if px_per_m else 1.0
    height = wall.size[1] * unit
    uses = {use.get("id"): use for use in layer(root, "STONES").iter(f"{SVG}use")}
    assert len(uses) == 12
    for part in wall.stones:
        use = uses[f"placed-{part.name}"]
        here = np.array([(x / unit, (height - y) / unit) for x, y in placed(root, use)])
        assert np.abs(here - part.corners).max() < 1e-6
        assert use.get("data-step") == str(part.step)
        assert f"step {part.step}" in use.find(f"{SVG}title").text
    (wedge,) = layer(root, "WEDGES").iter(f"{SVG}path")
    here = corners(wedge) * (1, -1) + (0, height)
    assert np.abs(here / unit - next(wall.wedges).corners).max() < 1e-6


def test_stones_are_defined_as_they_lie_in_the_source_image(tmp_path) -> None:
    wall = assembly()
    root = drawing(wall, tmp_path)
    for part in wall.stones:
        (path,) = (p for p in root.iter(f"{SVG}path") if p.get("id") == part.name)
        lying = wall.source_corners(part) - np.array(part.plan_step.source_centroid)
        assert np.abs(corners(path) * (1, -1) / 5.0 - lying).max() < 1e-6  # 5 mm are a px


def test_sizes_are_millimetres_and_the_view_box_has_the_same(tmp_path) -> None:
    root = drawing(assembly(), tmp_path)
    box = [float(number) for number in root.get("viewBox").split()]
    assert root.get("width") == f"{box[2]:g}mm"
    assert root.get("height") == f"{box[3]:g}mm"
    (frame,) = (path for path in layer(root, "SITE") if path.get("id") == "frame")
    assert np.ptp(corners(frame), axis=0) == pytest.approx((900.0, 300.0))
    assert box[0] < 0
    assert box[0] + box[2] > 900


def test_without_a_scale_it_is_in_px_and_says_so(tmp_path) -> None:
    root = drawing(assembly(px_per_m=None), tmp_path)
    assert root.get("width").endswith("px")
    assert "no scale" in root.find(f"{SVG}desc").text


def test_layers_are_there_and_statics_are_not_shown_at_first(tmp_path) -> None:
    wall = assembly()
    root = drawing(wall, tmp_path, title="Wall <A> & B")
    groups = root.findall(f"{SVG}g")
    assert [group.get("id") for group in groups] == LAYERS
    hidden = {group.get("id") for group in groups if group.get("display") == "none"}
    assert hidden == {"CONTACTS", *LAYERS[4:8]}
    assert root.find(f"{SVG}title").text == "Wall <A> & B"
    lines = layer(root, "CONTACTS")
    assert len(lines) == len(wall.model.interfaces)
    assert f"{wall.resistance.left.alpha:.4f}" in layer(root, "FORCES-LEFT")[0].text


def test_the_mechanism_keeps_the_areas_of_what_it_moves(tmp_path) -> None:
    wall = assembly()
    root = drawing(wall, tmp_path)
    for side in ("left", "right"):
        moved = layer(root, f"MECHANISM-{side.upper()}").findall(f"{SVG}path")
        assert moved
        for path in moved:
            name = path.get("id").removesuffix(f"-{side}")
            (part,) = (part for part in wall.parts if part.name == name)
            area = shapely.Polygon(corners(path)).area
            assert area == pytest.approx(1e6 * shapely.Polygon(part.corners).area, rel=1e-6)
            assert np.abs(corners(path) * (1, -1) + (0, 300) - 1000 * part.corners).max() > 0.09


def test_all_ids_are_different(tmp_path) -> None:
    ids = [e.get("id") for e in drawing(assembly(), tmp_path).iter() if e.get("id")]
    assert len(ids) == len(set(ids))
