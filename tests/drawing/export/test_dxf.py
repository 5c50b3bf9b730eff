"""wall.dxf, read back with ezdxf."""

import ezdxf
import numpy as np
import pytest
import shapely

from drystone.drawing.export.formats import FORMATS, ExportSettings
from tests.drawing.export.drawn_walls import assembly

SETTINGS = ExportSettings(title="A wall")


@pytest.fixture(scope="module")
def wall():
    return assembly()


@pytest.fixture(scope="module")
def doc(wall, tmp_path_factory):
    (path,) = FORMATS["dxf"].write(wall, tmp_path_factory.mktemp("dxf"), SETTINGS)
    return ezdxf.readfile(path)


def on_layer(doc, name, kind="LWPOLYLINE"):
    return list(doc.modelspace().query(f'{kind}[layer=="{name}"]'))


def told(entity):
    return [value for code, value in entity.get_xdata("DRYSTONE") if code != 1001]


def polygon(outline):
    return shapely.Polygon([(x, y) for x, y, *_ in outline.get_points()])


def test_the_audit_finds_nothing(doc) -> None:
    audit = doc.audit()
    assert not audit.errors
    assert not audit.fixes
    assert doc.dxfversion == "AC1024"  # R2010


def test_the_unit_is_the_metre_or_none(doc, tmp_path) -> None:
    assert doc.header["$INSUNITS"] == 6
    assert doc.header["$MEASUREMENT"] == 1
    (path,) = FORMATS["dxf"].write(assembly(px_per_m=None), tmp_path, SETTINGS)
    without = ezdxf.readfile(path)
    assert without.header["$INSUNITS"] == 0
    words = " ".join(text.dxf.text for text in on_layer(without, "SITE", "TEXT"))
    assert "px" in words
    assert "Not to scale" in words


def test_outlines_are_closed_and_those_of_the_plan(doc, wall) -> None:
    drawn = {told(e)[0]: e for layer in ("STONES", "WEDGES") for e in on_layer(doc, layer)}
    assert set(drawn) == {part.name for part in wall.parts}
    for part in wall.parts:
        outline = drawn[part.name]
        assert outline.closed
        assert outline.dxf.layer == ("STONES" if part.kind == "stone" else "WEDGES")
        assert told(outline) == [part.name, part.step, part.angle_deg]
        points = np.array([(x, y) for x, y, *_ in outline.get_points()])
        assert np.abs(points - part.corners).max() < 1e-9
    total = sum(polygon(e).area for e in drawn.values())
    # Bricks of .3 m x .15 m with two bevels each of 5, 10 or 15 mm: half their squares.
    bevels = sum((0.005 * (1 + place % 3)) ** 2 / 2 for place in range(6))
    assert total == pytest.approx(6 * 0.3 * 0.15 - bevels, rel=1e-9)


def test_layers_and_what_is_shown(doc) -> None:
    shown = {layer.dxf.name for layer in doc.layers if layer.is_on()}
    layers = {layer.dxf.name for layer in doc.layers}
    assert {"STONES", "WEDGES", "NUMBERS", "SITE"} <= shown
    assert layers - shown == {
        "CONTACTS", "FORCES", "FORCES-LEFT", "FORCES-RIGHT", "MECHANISM", "MECHANISM-LEFT",
        "MECHANISM-RIGHT",
    }  # fmt: skip


def test_contacts_are_lines_as_long_as_the_interfaces(doc, wall) -> None:
    lines = on_layer(doc, "CONTACTS", "LINE")
    drawn = sum((line.dxf.end - line.dxf.start).magnitude for line in lines)
    assert drawn == pytest.approx(sum(one.length for one in wall.model.interfaces))
    assert len(lines) + len(on_layer(doc, "CONTACTS", "POINT")) == len(wall.model.interfaces)


def test_forces_on_the_ground_carry_the_wall(doc, wall) -> None:
    """Upright, the arrows from the ground add up to the weight, to the scale that is said."""
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


def test_the_mechanism_is_on_layers_of_its_own(doc, wall) -> None:
    areas = {part.name: shapely.Polygon(part.corners).area for part in wall.parts}
    for direction in ("LEFT", "RIGHT"):
        moved = on_layer(doc, f"MECHANISM-{direction}")
        assert moved
        for outline in moved:
            assert outline.closed
            assert polygon(outline).area == pytest.approx(areas[told(outline)[0]], rel=1e-9)


def test_numbers_are_the_steps_at_the_centroids(doc, wall) -> None:
    texts = {text.dxf.text: text for text in on_layer(doc, "NUMBERS", "TEXT")}
    assert set(texts) == {str(part.step) for part in wall.parts}
    for part in wall.parts:
        _, place, _ = texts[str(part.step)].get_placement()
        assert (place.x, place.y) == pytest.approx(part.centroid)


def test_ezdxf_stays_as_it_was(wall, tmp_path) -> None:
    ezdxf.options.write_fixed_meta_data_for_testing = False
    FORMATS["dxf"].write(wall, tmp_path, SETTINGS)
    assert not ezdxf.options.write_fixed_meta_data_for_testing
