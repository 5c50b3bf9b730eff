"""wall.geojson, read back with shapely."""

import json
from pathlib import Path
from typing import Any

import pytest
import shapely

from drystone.drawing.export.formats import FORMATS, ExportSettings
from tests.drawing.export.robot_plans import METRIC, PX_PER_M, assembly

SETTINGS = ExportSettings()


def written(name: str, folder: Path, px_per_m: float | None = PX_PER_M) -> dict[str, Any]:
    wall = assembly(name, px_per_m)
    (path,) = FORMATS["geojson"].write(wall, folder, SETTINGS)
    read: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return read


@pytest.mark.parametrize("name", METRIC)
@pytest.mark.parametrize("px_per_m", [PX_PER_M, None])
def test_polygons_are_closed_counter_clockwise_and_of_the_right_area(
    name: str, px_per_m: float | None, tmp_path: Path
) -> None:
    wall, read = assembly(name, px_per_m), written(name, tmp_path, px_per_m)
    shapes = shapely.get_parts(shapely.from_geojson(json.dumps(read)))
    areas = {block.id: block.area for block in wall.model.blocks}
    assert len(shapes) == len(read["features"]) == len(wall.parts)
    for shape, feature, part in zip(shapes, read["features"], wall.parts, strict=True):
        (ring,) = feature["geometry"]["coordinates"]
        assert ring[0] == ring[-1]
        assert shape.is_valid
        assert shape.exterior.is_ccw
        assert shape.area == pytest.approx(areas[part.id], rel=1e-9)
        assert shape.area == pytest.approx(feature["properties"][f"area_{wall.unit}2"], rel=1e-9)
        assert feature["id"] == feature["properties"]["name"] == part.name


def test_unit_and_frame_are_said(tmp_path: Path) -> None:
    read = written("exact", tmp_path)
    assert (read["type"], read["unit"], read["px_per_m"]) == ("FeatureCollection", "m", PX_PER_M)
    assert "not longitude" in read["frame"]
    assert read["wall"]["width"] == pytest.approx(110 / PX_PER_M)
    read = written("exact", tmp_path, None)
    assert (read["unit"], read["px_per_m"]) == ("px", None)
    assert read["wall"] == {"width": 110.0, "height": 40.0}


def test_properties_are_the_row_of_the_build_list(tmp_path: Path) -> None:
    read, wall = written("exact", tmp_path), assembly("exact")
    for feature, part in zip(read["features"], wall.parts, strict=True):
        row = feature["properties"]
        assert (row["step"], row["kind"], row["under"]) == (part.step, part.kind, part.under)
        assert row["mass_kg"] == pytest.approx(wall.mass_kg(part))
        assert set(row["neighbours"]) <= set(wall.neighbours(part.id))
