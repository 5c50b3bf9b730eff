"""steps.csv, read back with the csv module."""

import csv
from pathlib import Path

import pytest
import shapely

from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.model.plan import StoneStep
from tests.drawing.export.robot_plans import METRIC, PX_PER_M, THICKNESS_M, assembly

SETTINGS = ExportSettings()


def rows(name: str, folder: Path, px_per_m: float | None = PX_PER_M) -> list[dict[str, str]]:
    wall = assembly(name, px_per_m)
    (path,) = FORMATS["csv"].write(wall, folder, SETTINGS)
    assert b"\r" not in path.read_bytes()
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("name", METRIC)
def test_a_row_a_step_in_metres(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    found = rows(name, tmp_path)
    assert [row["name"] for row in found] == [part.name for part in wall.parts]
    for row, part in zip(found, wall.parts, strict=True):
        step = part.plan_step
        polygon = shapely.Polygon(part.corners)
        assert (int(row["step"]), row["kind"], int(row["id"])) == (part.step, part.kind, part.id)
        assert (float(row["x_m"]), float(row["y_m"])) == part.centroid
        assert float(row["area_m2"]) == pytest.approx(polygon.area, rel=1e-9)
        mass = polygon.area * THICKNESS_M * 2450.0
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


def test_without_a_scale_lengths_are_px_and_masses_are_missing(tmp_path: Path) -> None:
    found = rows("exact", tmp_path, None)
    metric = rows("exact", tmp_path)
    assert {"x_px", "y_px", "width_px", "height_px", "area_px2"} <= set(found[0])
    assert not any(name.endswith(("_m", "_m2")) for name in found[0])
    for row, other in zip(found, metric, strict=True):
        assert row["mass_kg"] == ""
        for name in ("x", "y", "width", "height"):
            px, metres = float(row[f"{name}_px"]), float(other[f"{name}_m"])
            assert px == pytest.approx(metres * PX_PER_M, rel=1e-9)


def test_instructions_say_what_to_do(tmp_path: Path) -> None:
    found = {row["name"]: row["instruction"] for row in rows("exact", tmp_path, None)}
    assert found["stone_004"].startswith("Stone 4, turned 180 degrees clockwise, middle ")
    assert found["stone_001"].startswith("Stone 1, turned 166 degrees counter-clockwise, middle ")
    assert found["stone_005"].startswith("Stone 5, not turned, middle ")
    assert found["wedge_010"].startswith("Push wedge 10 in under stone 8, ")
