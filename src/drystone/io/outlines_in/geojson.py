"""GeoJSON: polygons of image tools in px, of GIS programs, and of drawings in metres."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from drystone.errors import InputError, Notice
from drystone.io.file_errors import entry, short
from drystone.io.outlines_in.classes import class_of
from drystone.io.outlines_in.gathered import Gathered
from drystone.io.outlines_in.model import METRES, OutlineFile, number_in
from drystone.io.read_settings import ReadSettings

_KINDS = frozenset(
    {
        "FeatureCollection", "Feature", "GeometryCollection", "Polygon", "MultiPolygon", "Point",
        "MultiPoint", "LineString", "MultiLineString",
    }
)  # fmt: skip
_CLASSES = ("classification", "class", "label", "category", "type")
_DEGREES = ("CRS84", "4326", "WGS84")


def is_geojson(content: Any) -> bool:
    """Tell GeoJSON, or a list of its features, which is what QuPath exports."""
    if isinstance(content, list):
        return all(isinstance(one, Mapping) and one.get("type") == "Feature" for one in content)
    kind = content.get("type") if isinstance(content, Mapping) else None
    return isinstance(kind, str) and kind in _KINDS


def read_geojson(content: Any, settings: ReadSettings) -> OutlineFile:
    """Read polygons and multi-polygons, a stone a feature.

    A foreign member ``unit`` of the file ("m", "mm" …), or the setting, makes it a drawing with y
    up; without one, or with "px", coordinates are px of an image with y down, as image tools
    write them, unless its ``frame`` is that of a wall of drystone, or all y are negative.  The id
    of a stone is the ``id`` of its feature or of its properties, its name their ``name``.
    """
    if isinstance(content, list):
        content = {"type": "FeatureCollection", "features": content}
    if any(name in str(content.get("crs", "")) for name in _DEGREES):
        what = "its coordinates are degrees of latitude and longitude."
        raise _no_unit(what, 'Project it to metres, and give the file a member "unit": "m".')
    if content.get("crs") and not settings.unit and "unit" not in content:
        raise _no_unit(
            "its coordinates are those of a map, and it does not say their unit.",
            "Say it with --unit m (or ft; ReadSettings.unit), or px if they are px of an image "
            "after all.",
        )
    unit = content.get("unit", "px")
    if unit not in (*METRES, "px"):
        what = f"its unit {short(repr(unit))} is not known."
        raise _no_unit(what, f"Use one of px, {', '.join(METRES)}.")
    gathered = Gathered()
    with entry("the list of features"):
        kind = content["type"]
        alone = content if kind == "Feature" else {"geometry": content}
        features = list(content["features"]) if kind == "FeatureCollection" else [alone]
    for number, feature in enumerate(features):
        with entry(f"feature {number} (from 0)"):
            _add_feature(feature, f"feature {number}", gathered)
    unit_m = METRES.get(unit if "unit" in content else settings.unit or "px")
    upwards = unit_m is not None or str(content.get("frame")).startswith("wall")
    notices = gathered.notices()
    rings = [one for stone in gathered.stones for one in stone.rings]
    # Below a picture's upper edge with y up, where y down has no pixel: nearly all, as an outline
    # may reach over the edge.
    if not upwards and rings and float(np.median(np.concatenate(rings)[:, 1])) < 0.0:
        upwards = True
        text = "most y are negative: y runs up, as GIS programs have it over a picture."
        notices.append(Notice("W119", text))
    return gathered.file(unit_m=unit_m, y_up=upwards, notices=notices, names_images=False)


def _no_unit(what: str, cure: str) -> InputError:
    return InputError("E116", what, cure=cure)


def _add_feature(feature: Mapping[str, Any], where: str, gathered: Gathered) -> None:
    geometry = feature["geometry"]
    if geometry is None:
        gathered.aside["features without a geometry"] += 1
        return
    said = {**(feature.get("properties") or {})}
    own = number_in(feature.get("id"))
    if own is None:
        own = number_in(said.get("id", said.get("stone")))
    name = str(said.get("name") or (feature["id"] if isinstance(feature.get("id"), str) else ""))
    kind = geometry["type"]
    if kind == "GeometryCollection":
        for part in geometry["geometries"]:
            _add_feature({**feature, "geometry": part}, where, gathered)
    elif said.get("kind", "stone") != "stone":
        gathered.aside[f"features of the kind {said['kind']!r}"] += 1
    elif kind in {"Polygon", "MultiPolygon"}:
        polygons = [geometry["coordinates"]] if kind == "Polygon" else geometry["coordinates"]
        if not polygons or not all(polygons):
            raise ValueError("a polygon has no ring")
        gathered.add(where, polygons, own, name, _class_in(said))
    else:
        gathered.aside[f"{kind}s"] += 1


def _class_in(said: Mapping[str, Any]) -> str:
    """Return the class of a feature, as QuPath and GIS programs write it."""
    for key in _CLASSES:
        found = said.get(key)
        if isinstance(found, Mapping):
            found = found.get("name")
        if isinstance(found, str):
            return class_of(found)
    return ""
