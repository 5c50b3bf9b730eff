"""Any damage to a file of outlines ends in stones or in a coded error, never in anything else."""

import contextlib
import io
import json

import ezdxf
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from drystone.errors import DrystoneError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.known_stones import masks
from tests.io.test_annotations import coco, geojson, labelme, runs
from tests.io.test_drawings import paths, svg

TOLERANT = ReadSettings(pieces="keep-largest", max_image_mpx=1.0)
SMALL_OBJ = "o stone_1\nv 0 0 0\nv 2 0 0\nv 2 0 1\nv 0 0 1\nf 1 2 3\nf 1 3 4\n"


def small_dxf():
    document, text = ezdxf.new("R2000", units=4), io.StringIO()
    document.modelspace().add_lwpolyline([(0, 0), (40, 0), (40, 30), (0, 30)], close=True)
    document.write(text)
    return text.getvalue()


FILES = {
    "labelme.json": json.dumps(labelme()),
    "coco.json": json.dumps(coco({i: runs(mask) for i, mask in masks().items()})),
    "sam.json": json.dumps([{"segmentation": runs(mask)} for mask in masks().values()]),
    "stones.geojson": json.dumps(geojson()),
    "stones.svg": svg(paths()),
    "stones.obj": SMALL_OBJ,
    "stones.dxf": small_dxf(),
}


@pytest.mark.parametrize("name", list(FILES))
@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_damage(tmp_path, name, data):
    content = bytearray(FILES[name].encode())
    for _ in range(data.draw(st.integers(1, 3))):
        place = data.draw(st.integers(0, len(content) - 1))
        end = place + data.draw(st.integers(0, 6))
        content[place:end] = data.draw(st.text('0123456789-.eE,[]{}":<>/ a\n', max_size=6)).encode()
    (tmp_path / name).write_bytes(content)
    with contextlib.suppress(DrystoneError):  # anything else is an error of ours
        assert len(read_stones(tmp_path / name, settings=TOLERANT)) >= 1
