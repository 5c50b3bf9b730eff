"""steps.csv, steps.parquet and wall.geojson: the build list, one row a step."""

import csv as csv_writer
import io
from typing import Any

import shapely

from drystone.drawing.assembly import Assembly
from drystone.drawing.export.formats import ExportSettings, Files, load_extra
from drystone.drawing.sheet.words import step_words
from drystone.io.json_text import json_text
from drystone.model.plan import StoneStep


def columns(assembly: Assembly) -> list[tuple[str, type, list[Any]]]:
    """Return the build list by columns: name, type of values apart from None, a value a step.

    x and y are the plan's: x along the wall, y up. Width and height are those of the bounding
    box as a stone lies in the source image.  Lists are of ids.
    """
    unit, parts = assembly.unit, assembly.parts
    stones = [part.plan_step if isinstance(part.plan_step, StoneStep) else None for part in parts]
    metric = unit == "m"
    return [
        ("step", int, [part.step for part in parts]),
        ("kind", str, [part.kind for part in parts]),
        ("id", int, [part.id for part in parts]),
        ("name", str, [part.name for part in parts]),
        ("under", int, [part.under for part in parts]),
        ("side", str, [stone and stone.side for stone in stones]),
        ("cluster", int, [part.cluster for part in parts]),
        ("angle_deg", float, [part.angle_deg for part in parts]),
        (f"x_{unit}", float, [part.centroid[0] for part in parts]),
        (f"y_{unit}", float, [part.centroid[1] for part in parts]),
        ("source_x_px", float, [stone and stone.source_centroid[0] for stone in stones]),
        ("source_y_px", float, [stone and stone.source_centroid[1] for stone in stones]),
        (f"width_{unit}", float, [part.size[0] for part in parts]),
        (f"height_{unit}", float, [part.size[1] for part in parts]),
        (f"area_{unit}2", float, [part.area for part in parts]),
        ("mass_kg", float, [assembly.mass_kg(part) if metric else None for part in parts]),
        ("neighbours", list, [assembly.touched_when_placed(part) for part in parts]),
        ("alpha_left", float, [part.plan_step.alpha_left for part in parts]),
        ("alpha_right", float, [part.plan_step.alpha_right for part in parts]),
        ("instruction", str, [step_words(assembly, part) for part in parts]),
    ]


def csv(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return steps.csv: UTF-8, nothing where there is no value, blanks between ids."""

    def cell(value: Any) -> Any:
        if isinstance(value, tuple):
            return " ".join(map(str, value))
        return value + 0.0 if isinstance(value, float) else value

    table, text = columns(assembly), io.StringIO()
    writer = csv_writer.writer(text, lineterminator="\n")
    writer.writerow([name for name, _, _ in table])
    writer.writerows(zip(*(map(cell, values) for _, _, values in table), strict=True))
    return {"steps.csv": text.getvalue()}


def parquet(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return steps.parquet, units and scale in its metadata; E181 without pyarrow."""
    arrow = load_extra("pyarrow", "io", "E181", "steps.parquet")
    writer = load_extra("pyarrow.parquet", "io", "E181", "steps.parquet")
    plan = assembly.plan
    about = {
        "drystone": plan.version,
        "source": str(plan.source.get("path") or ""),
        "sha256": str(plan.source.get("sha256") or ""),
        "unit": assembly.unit,
        "px_per_m": str(assembly.px_per_m or ""),
        "thickness": repr(assembly.thickness),
        "density_kg_m3": repr(assembly.density_kg_m3),
    }
    types = {int: arrow.int64(), float: arrow.float64(), str: arrow.string(),
             list: arrow.list_(arrow.int64())}  # fmt: skip
    table, data = columns(assembly), io.BytesIO()
    arrays = [arrow.array(values, types[kind]) for _, kind, values in table]
    schema = arrow.schema([(name, types[kind]) for name, kind, _ in table], metadata=about)
    writer.write_table(arrow.Table.from_arrays(arrays, schema=schema), data)
    return {"steps.parquet": data.getvalue()}


def geojson(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return the outlines in the wall frame; properties are the columns of the build list.

    Rings are closed and counter-clockwise, as RFC 7946 wants them.  Its coordinates are those of
    the earth; these are lengths in the wall, which foreign members say.
    """
    names, _, values = zip(*columns(assembly), strict=True)
    width, height = assembly.size
    made = {
        "type": "FeatureCollection",
        "unit": assembly.unit,
        "frame": "wall: x to the right from its left end, y up from the ground; not longitude "
        "and latitude",
        "wall": {"width": width, "height": height},
        "px_per_m": assembly.px_per_m,
        "features": [
            {
                "type": "Feature",
                "id": part.name,
                "properties": dict(zip(names, row, strict=True)),
                "geometry": shapely.geometry.mapping(shapely.Polygon(part.corners)),
            }
            for part, *row in zip(assembly.parts, *values, strict=True)
        ],
    }
    return {"wall.geojson": json_text(made) + "\n"}
