"""wall.svg, wall.dxf and wall-numbered.png, read back by other programs."""

import math
import re
from xml.etree import ElementTree as ET

import ezdxf
import numpy as np
import pytest
from PIL import Image

from drystone.drawing.canvas import draw
from drystone.drawing.drawing import drawing_of_assembly
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
def test_placed_stones_are_where_the_plan_has_them(tmp_path, px_per_m):
    wall = assembly(columns=4, rows=3, px_per_m=px_per_m)
    root = drawing(wall, tmp_path)
    unit = 1000.0 if px_per_m else 1.0
    height = wall.size[1] * unit
    uses = {use.get("id"): use for use in layer(root, "STONES").iter(f"{SVG}use")}
    assert len(uses) == 12
    for part in wall.stones:
        use = uses[f"placed-{part.name}"]
        (path,) = (p for p in root.iter(f"{SVG}path") if p.get("id") == part.name)
        lying = wall.source_corners(part) - np.array(part.plan_step.source_centroid)
        px_per_unit = 0.2 if px_per_m else 1.0  # 5 mm are a px
        assert np.abs(corners(path) * (1, -1) * px_per_unit - lying).max() < 1e-6
        here = np.array([(x / unit, (height - y) / unit) for x, y in placed(root, use)])
        assert np.abs(here - part.corners).max() < 1e-6
        assert use.get("data-step") == str(part.step)
        assert f"step {part.step}" in use.find(f"{SVG}title").text
    assert root.get("width").endswith("mm" if px_per_m else "px")
    assert ("no scale" in root.find(f"{SVG}desc").text) == (px_per_m is None)
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(ids) == len(set(ids))
    (wedge,) = layer(root, "WEDGES").iter(f"{SVG}path")
    here = corners(wedge) * (1, -1) + (0, height)
    assert np.abs(here / unit - next(wall.wedges).corners).max() < 1e-6


def test_layers_are_there_and_statics_are_not_shown_at_first(tmp_path):
    wall = assembly()
    root = drawing(wall, tmp_path, title="Wall <A> & B")
    left, _, width, height = (float(number) for number in root.get("viewBox").split())
    assert (root.get("width"), root.get("height")) == (f"{width:g}mm", f"{height:g}mm")
    assert left < 0.0
    assert left + width > 900.0
    (frame,) = (path for path in layer(root, "SITE") if path.get("id") == "frame")
    assert np.ptp(corners(frame), axis=0) == pytest.approx((900.0, 300.0))
    groups = root.findall(f"{SVG}g")
    assert [group.get("id") for group in groups] == LAYERS
    hidden = {group.get("id") for group in groups if group.get("display") == "none"}
    assert hidden == {"CONTACTS", *LAYERS[4:8]}
    assert root.find(f"{SVG}title").text == "Wall <A> & B"
    assert len(layer(root, "CONTACTS")) == len(wall.model.interfaces)
    moved = [path.get("id") for path in layer(root, "MECHANISM-LEFT").iter(f"{SVG}path")]
    assert moved
    assert set(moved) <= {f"{part.name}-left" for part in wall.parts}
    assert f"{wall.resistance.left.alpha:.4f}" in layer(root, "FORCES-LEFT")[0].text


SETTINGS = ExportSettings(title="A wall")


def on_layer(doc, name, kind="LWPOLYLINE"):
    return list(doc.modelspace().query(f'{kind}[layer=="{name}"]'))


def told(entity):
    return [value for code, value in entity.get_xdata("DRYSTONE") if code != 1001]


def test_a_dxf_has_no_faults_and_holds_outlines_steps_contacts_and_forces(tmp_path):
    wall = assembly()
    (path,) = FORMATS["dxf"].write(wall, tmp_path, SETTINGS)
    doc = ezdxf.readfile(path)
    audit = doc.audit()
    assert (len(audit.errors), len(audit.fixes)) == (0, 0)
    assert doc.dxfversion == "AC1024"  # R2010
    assert list(doc.classes.classes) == sorted(doc.classes.classes)  # the same in every process
    assert (doc.header["$INSUNITS"], doc.header["$MEASUREMENT"]) == (6, 1)
    shown = {layer.dxf.name for layer in doc.layers if layer.is_on()}
    layers = {layer.dxf.name for layer in doc.layers}
    assert {"STONES", "WEDGES", "NUMBERS", "SITE"} <= shown
    assert layers - shown == {"FORCES", "MECHANISM", "CONTACTS", *LAYERS[4:8]}
    ezdxf.options.write_fixed_meta_data_for_testing = False
    (path,) = FORMATS["dxf"].write(assembly(px_per_m=None), tmp_path, SETTINGS)
    assert not ezdxf.options.write_fixed_meta_data_for_testing
    without = ezdxf.readfile(path)
    assert without.header["$INSUNITS"] == 0
    words = " ".join(text.dxf.text for text in on_layer(without, "SITE", "TEXT"))
    assert "Not to scale: the unit is 1 px" in words

    texts = {text.dxf.text: text for text in on_layer(doc, "NUMBERS", "TEXT")}
    assert set(texts) == {str(part.step) for part in wall.parts}
    drawn = {told(e)[0]: e for layer in ("STONES", "WEDGES") for e in on_layer(doc, layer)}
    assert set(drawn) == {part.name for part in wall.parts}
    for part in wall.parts:
        outline = drawn[part.name]
        assert outline.closed
        assert outline.dxf.layer == ("STONES" if part.kind == "stone" else "WEDGES")
        assert told(outline) == [part.name, part.step, part.angle_deg]
        points = np.array([(x, y) for x, y, *_ in outline.get_points()])
        assert np.abs(points - part.corners).max() < 1e-9
        _, place, _ = texts[str(part.step)].get_placement()
        assert (place.x, place.y) == pytest.approx(part.centroid)
    lines = on_layer(doc, "CONTACTS", "LINE")
    lengths = sum((line.dxf.end - line.dxf.start).magnitude for line in lines)
    assert lengths == pytest.approx(sum(one.length for one in wall.model.interfaces))
    assert len(lines) + len(on_layer(doc, "CONTACTS", "POINT")) == len(wall.model.interfaces)

    # Upright, the arrows from the ground add up to the weight, to the scale that is said.
    for direction, sign in (("LEFT", -1.0), ("RIGHT", 1.0)):
        (note,) = (t.dxf.text for t in on_layer(doc, f"FORCES-{direction}", "TEXT"))
        per_weight = float(note.split("a line of ")[1].split(" m ")[0])
        total = np.zeros(2)
        for arrow in on_layer(doc, f"FORCES-{direction}"):
            tail, tip, *_ = ((x, y) for x, y, *_ in arrow.get_points())
            if (tail[1] + tip[1]) / 2 < 1e-6:
                total += np.array(tip) - np.array(tail)
        weights = total / per_weight
        # 7 parts; arrows of the smallest forces are left out.
        assert weights[1] == pytest.approx(7.0, rel=0.02)
        result = wall.resistance.left if sign < 0 else wall.resistance.right
        assert weights[0] == pytest.approx(-sign * result.alpha * 7.0, rel=0.04)


def test_a_picture_has_every_step_and_the_shape_of_the_wall_whatever_its_title(tmp_path):
    ax = draw(drawing_of_assembly(assembly(columns=5, rows=3), "A wall"))
    assert sorted(int(text.get_text()) for text in ax.texts) == list(range(1, 17))
    # Those of wedges are above the ground.
    wedge = next(text for text in ax.texts if text.get_text() == "2")
    assert wedge.get_window_extent().transformed(ax.transData.inverted()).y0 > 0.0
    assert ax.get_xlabel() == "m"
    assert draw(drawing_of_assembly(assembly(px_per_m=None))).get_xlabel() == "px"
    sizes = []
    for title in ("A wall", 300 * "W", "$x_1"):
        (path,) = FORMATS["png"].write(assembly(columns=6), tmp_path, ExportSettings(title=title))
        with Image.open(path) as image:
            sizes.append(image.size)
            pixels = np.asarray(image.convert("RGB")).astype(int)
        stone = np.abs(pixels - np.array([0xCF, 0xC8, 0xBB])).max(axis=2) == 0
        rows, columns = np.nonzero(stone)
        assert abs(np.ptp(columns) / np.ptp(rows) - 6.0) < 0.1
    assert sizes[1] == pytest.approx(sizes[0], rel=0.02)
