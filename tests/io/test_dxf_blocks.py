"""Blocks of DXF: layers, what is hidden, and where their outlines are drawn."""

import io
import math

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf import units, xref

from drystone.errors import InputError
from drystone.io.outlines_in.dxf import read_dxf
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.test_drawings import saved


def outlines(document):
    """What is read of a drawing: the polygon of every stone by its name."""
    text = io.StringIO()
    document.write(text)
    found = read_dxf(text.getvalue().encode(), ReadSettings())
    shapes = {s.name: shapely.Polygon(s.areas[0].rings[0]) for s in found.stones}
    assert len(shapes) == len(found.stones)
    return shapes, " ".join(notice.message for notice in found.notices)


def with_blocks():
    """A box on layer 0 and one on a layer of its own, in a block of its own each."""
    document = ezdxf.new("R2010", units=units.MM)
    for name, layer in (("BOX", "0"), ("OWN", "own")):
        block = document.blocks.new(name)
        block.add_lwpolyline([(0, 0), (4, 0), (4, 3), (0, 3)], close=True,
                             dxfattribs={"layer": layer})  # fmt: skip
    return document, document.modelspace()


def test_dxf_layer_0_in_a_block_is_the_layer_of_its_insert(tmp_path):
    document, space = with_blocks()
    for number in (7, 3):
        space.add_blockref("BOX", (10 * number, 0), dxfattribs={"layer": f"stone {number}"})
    group = document.blocks.new("GROUP")
    group.add_blockref("BOX", (0, 20))  # on layer 0, so on that of what inserts the group
    group.add_blockref("BOX", (0, 30), dxfattribs={"layer": "stone 9"})
    space.add_blockref("GROUP", (0, 0), dxfattribs={"layer": "stone 5"})
    stones = read_stones(saved(document, tmp_path))
    assert [stone.id for stone in stones] == [3, 5, 7, 9]
    assert outlines(document)[0]["stone 5"].bounds == (0, 20, 4, 23)


def test_dxf_inserts_on_hidden_layers_do_not_count():
    """Frozen hides all of a block; off only what has its layer from the insert."""
    document, space = with_blocks()
    document.layers.add("off").off()
    document.layers.add("frozen").freeze()
    for i, layer in enumerate(("off", "frozen")):
        space.add_blockref("BOX", (0, 10 * i), dxfattribs={"layer": layer})
        space.add_blockref("OWN", (10, 10 * i), dxfattribs={"layer": layer})
    space.add_blockref("BOX", (20, 0), dxfattribs={"layer": "seen", "invisible": 1})
    for style in ({"layer": "off"}, {"layer": "frozen"}, {"layer": "seen", "invisible": 1}):
        space.add_circle((60, 0), 3, dxfattribs=style)
    document.blocks.new("GROUP").add_blockref("BOX", (30, 0))
    space.add_blockref("GROUP", (0, 0), dxfattribs={"layer": "off"})
    space.add_blockref("BOX", (40, 0), dxfattribs={"layer": "seen"})
    space.add_blockref("NONE", (50, 0))
    shapes, said = outlines(document)
    assert {name: shape.bounds[0] for name, shape in shapes.items()} == {"own": 10, "seen": 40}
    assert "8 entities that are hidden" in said
    assert "1 INSERT of a block that is not there" in said


def test_dxf_blocks_in_rows_mirrored_and_stretched():
    document, space = with_blocks()
    space.add_blockref("BOX", (0, 0), dxfattribs={"layer": "mirrored", "xscale": -2})
    grid = {"row_count": 2, "column_count": 3, "row_spacing": 10, "column_spacing": 20}
    inner = document.blocks.new("GRID", base_point=(1, 1))
    inner.add_blockref("BOX", (1, 1), dxfattribs=grid)
    turned = {"layer": "grid", "rotation": 90, "yscale": -1}
    text = io.StringIO()
    space.add_blockref("GRID", (100, 0), dxfattribs=turned)
    # Half a disk, turned and stretched in a block that is stretched another way.
    disk = document.blocks.new("DISK")
    disk.add_lwpolyline([(-1, 0, 1), (1, 0, 0)], "xyb", close=True)
    lens = document.blocks.new("LENS")
    lens.add_blockref("DISK", (3, 0), dxfattribs={"rotation": 30, "xscale": 2})
    space.add_blockref("LENS", (10, 50), dxfattribs={"layer": "lens", "rotation": 90, "yscale": -3})
    document.write(text)
    found = read_dxf(text.getvalue().encode(), ReadSettings()).stones
    shapes = [(s.name, shapely.Polygon(s.areas[0].rings[0])) for s in found]
    assert [shape.bounds for name, shape in shapes if name == "mirrored"] == [(-8, 0, 0, 3)]
    # Mirrored in x axis of the block, then turned: x and y change places.
    boxes = {tuple(np.round(shape.bounds, 9)) for name, shape in shapes if name == "grid"}
    assert boxes == {
        (100 + y, x, 103 + y, x + 4) for x in (0, 20, 40) for y in (0, 10)
    }  # fmt: skip
    (half,) = (shape for name, shape in shapes if name == "lens")
    assert half.area == pytest.approx(math.pi / 2 * 2 * 3, rel=2e-3)
    angle = np.radians(180 + np.linspace(0, 180, 500))
    x, y = 2 * np.cos(angle), np.sin(angle)
    cos, sin = math.cos(math.radians(30)), math.sin(math.radians(30))
    x, y = 3 + x * cos - y * sin, -3 * (x * sin + y * cos)
    known = shapely.Polygon(np.column_stack([10 - y, 50 + x]))
    assert half.symmetric_difference(known).area < 2e-3 * known.area


def test_dxf_external_references_are_named():
    """Attached or laid over, with or without what some program kept of the other drawing."""
    document, space = with_blocks()
    space.add_blockref("BOX", (40, 0))
    for name, overlay in (("plan", False), ("sheet", True)):
        flags = xref.const.BLK_XREF_OVERLAY if overlay else xref.const.BLK_XREF
        document.add_xref_def(f"{name}.dxf", name, flags | xref.const.BLK_EXTERNAL)
        space.add_blockref(name, (0, 0), dxfattribs={"row_count": 2, "row_spacing": 9})
    document.blocks.get("sheet").add_circle((9, 9), 5)
    shapes, said = outlines(document)
    assert [shape.bounds for shape in shapes.values()] == [(40, 0, 44, 3)]
    assert "left aside: 2 INSERT of an external reference." in said


def test_dxf_blocks_in_each_other_are_refused():
    document, space = with_blocks()
    document.blocks.get("BOX").add_blockref("BOX", (1, 1))
    space.add_blockref("BOX", (0, 0))
    with pytest.raises(InputError, match=r"E114 .*blocks are in each other"):
        outlines(document)
