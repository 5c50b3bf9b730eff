"""wall.geojson: the outlines in the wall frame with their steps.

Outer rings are closed and counter-clockwise, as RFC 7946 wants them.  Its coordinates are those
of the earth; these are lengths in the wall, which foreign members say.
"""

from pathlib import Path
from typing import Any

import numpy as np

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.out import json_text, put
from drystone.drawing.export.rows import columns
from drystone.drawing.export.settings import ExportSettings

FILE = "wall.geojson"


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written."""
    return (FILE,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:  # noqa: ARG001
    """Write the file."""
    return (put(folder, FILE, json_text(to_json(assembly)) + "\n"),)


def to_json(assembly: Assembly) -> dict[str, Any]:
    """Return a FeatureCollection; properties are the columns of the build list."""
    table = columns(assembly)
    rows = zip(*(column.values for column in table), strict=True)
    names = [column.name for column in table]
    width, height = assembly.size
    return {
        "type": "FeatureCollection",
        "unit": assembly.unit,
        "frame": "wall: x to the right from its left end, y up from the ground; not longitude "
        "and latitude",
        "wall": {"width": width, "height": height},
        "px_per_m": assembly.px_per_m,
        "features": [
            _feature(part, dict(zip(names, row, strict=True)))
            for part, row in zip(assembly.parts, rows, strict=True)
        ],
    }


def _feature(part: Part, properties: dict[str, Any]) -> dict[str, Any]:
    ring = np.concatenate([part.corners, part.corners[:1]])
    return {
        "type": "Feature",
        "id": part.name,
        "properties": properties,
        "geometry": {"type": "Polygon", "coordinates": [ring.tolist()]},
    }
