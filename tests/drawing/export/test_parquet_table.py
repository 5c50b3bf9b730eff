"""steps.parquet, read back with pyarrow and compared with the CSV."""

import csv
from pathlib import Path

import pyarrow as pa
import pytest
from pyarrow import parquet

from drystone.drawing.export.formats import FORMATS, ExportSettings
from tests.drawing.export.robot_plans import PX_PER_M, assembly

SETTINGS = ExportSettings()


@pytest.mark.parametrize("px_per_m", [PX_PER_M, None])
def test_it_holds_what_the_csv_holds(px_per_m: float | None, tmp_path: Path) -> None:
    wall = assembly("exact", px_per_m)
    (path,) = FORMATS["parquet"].write(wall, tmp_path, SETTINGS)
    found = parquet.read_table(path).to_pylist()
    (other,) = FORMATS["csv"].write(wall, tmp_path, SETTINGS)
    with other.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(found) == len(rows) == len(wall.parts)
    for one, row in zip(found, rows, strict=True):
        assert list(one) == list(row)
        for name, value in one.items():
            if isinstance(value, list):
                assert " ".join(map(str, value)) == row[name]
            else:
                assert ("" if value is None else str(value)) == row[name]


def test_types_and_metadata(tmp_path: Path) -> None:
    (path,) = FORMATS["parquet"].write(assembly("exact"), tmp_path, SETTINGS)
    schema = parquet.read_schema(path)
    types = {name: schema.field(name).type for name in schema.names}
    assert types["step"] == types["under"] == types["cluster"] == pa.int64()
    assert types["x_m"] == types["mass_kg"] == types["alpha_left"] == pa.float64()
    assert types["kind"] == types["side"] == types["instruction"] == pa.string()
    assert types["neighbours"] == pa.list_(pa.int64())
    said = {name.decode(): value.decode() for name, value in schema.metadata.items()}
    assert (said["unit"], said["px_per_m"], said["density_kg_m3"]) == ("m", "137.0", "2450.0")


def test_without_a_scale_the_empty_column_of_masses_keeps_its_type(tmp_path: Path) -> None:
    (path,) = FORMATS["parquet"].write(assembly("raster", None), tmp_path, SETTINGS)
    table = parquet.read_table(path)
    assert table.schema.field("mass_kg").type == pa.float64()
    assert table["mass_kg"].null_count == len(table)
