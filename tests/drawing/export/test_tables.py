"""steps.csv, steps.parquet and wall.geojson, read back with csv, pyarrow and shapely."""

import csv
import json

import numpy as np
import pyarrow as pa
import pytest
import shapely
from pyarrow import parquet

from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.model.plan import StoneStep
from tests.drawing.plans import PX_PER_M, THICKNESS_M, assembly

SETTINGS = ExportSettings()


def rows(folder, px_per_m=PX_PER_M):
    (path,) = FORMATS["csv"].write(assembly("exact", px_per_m), folder, SETTINGS)
    assert b"\r" not in path.read_bytes()
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_a_row_a_step_in_metres(tmp_path):
    wall, found = assembly("exact"), rows(tmp_path)
    assert [row["name"] for row in found] == [part.name for part in wall.parts]
    for row, part in zip(found, wall.parts, strict=True):
        step = part.plan_step
        assert (int(row["step"]), row["kind"], int(row["id"])) == (part.step, part.kind, part.id)
        assert (float(row["x_m"]), float(row["y_m"])) == part.centroid
        mass = shapely.Polygon(part.corners).area * THICKNESS_M * 2450.0
        assert float(row["mass_kg"]) == pytest.approx(mass, rel=1e-9)
        assert set(map(int, row["neighbours"].split())) <= set(wall.neighbours(part.id))
        if isinstance(step, StoneStep):
            assert (float(row["source_x_px"]), float(row["source_y_px"])) == step.source_centroid
            assert float(row["angle_deg"]) == step.angle_deg
            assert (row["side"], int(row["cluster"])) == (step.side, step.cluster)
            assert row["under"] == ""
        else:
            assert int(row["under"]) == step.under
            assert row["source_x_px"] == row["source_y_px"] == row["side"] == row["cluster"] == ""
        alpha = step.alpha_left
        assert row["alpha_left"] == ("" if alpha is None else repr(alpha))
    said = {row["name"]: row["instruction"] for row in rows(tmp_path, None)}
    for name, words in (("stone_004", "Set stone 4 (half turn), its middle "),
                        ("stone_002", "Set stone 2 (as it lies)"),
                        ("wedge_010", "Push wedge 10 in "),
                        ("stone_007", "Set stone 7 (turn left 174°), ")):  # fmt: skip
        assert said[name].startswith(words)


@pytest.mark.parametrize("px_per_m", [PX_PER_M, None])
def test_all_hold_what_the_csv_holds_and_polygons_are_those_of_the_parts(px_per_m, tmp_path):
    wall = assembly("exact", px_per_m)
    (path,) = FORMATS["parquet"].write(wall, tmp_path, SETTINGS)
    (geojson,) = FORMATS["geojson"].write(wall, tmp_path, SETTINGS)
    found, read = parquet.read_table(path).to_pylist(), json.loads(geojson.read_text("utf-8"))
    for one, shape, row in zip(found, read["features"], rows(tmp_path, px_per_m), strict=True):
        assert shape["properties"] == one
        assert list(one) == list(row)
        for name, value in one.items():
            if isinstance(value, list):
                assert " ".join(map(str, value)) == row[name]
            else:
                assert ("" if value is None else str(value)) == row[name]
    # An empty column of masses keeps its type.
    schema, unit = parquet.read_schema(path), wall.unit
    types = {name: schema.field(name).type for name in schema.names}
    assert (found[0]["mass_kg"] is None) == (px_per_m is None)
    own = wall.parts[0].own_corners
    assert [found[0][f"{side}_{unit}"] for side in ("width", "height")] == pytest.approx(
        np.ptp(own, axis=0)
    )
    assert types["step"] == types["under"] == types["cluster"] == pa.int64()
    assert types[f"x_{unit}"] == types["mass_kg"] == types["alpha_left"] == pa.float64()
    assert types["kind"] == types["side"] == types["instruction"] == pa.string()
    assert types["neighbours"] == pa.list_(pa.int64())
    said = {name.decode(): value.decode() for name, value in schema.metadata.items()}
    told = (unit, str(px_per_m or ""), "2450.0")
    assert (said["unit"], said["px_per_m"], said["density_kg_m3"]) == told

    shapes = shapely.get_parts(shapely.from_geojson(json.dumps(read)))
    for shape, feature, part in zip(shapes, read["features"], wall.parts, strict=True):
        (ring,) = feature["geometry"]["coordinates"]
        assert ring[0] == ring[-1]
        assert shape.is_valid
        assert shape.exterior.is_ccw
        assert shape.area == pytest.approx(feature["properties"][f"area_{unit}2"], rel=1e-9)
        assert feature["id"] == feature["properties"]["name"] == part.name
    assert (read["type"], read["unit"], read["px_per_m"]) == ("FeatureCollection", unit, px_per_m)
    assert "not longitude" in read["frame"]
    assert read["wall"] == pytest.approx(dict(zip(("width", "height"), wall.size, strict=True)))
