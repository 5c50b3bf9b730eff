"""GeoJSON: polygons with holes, in px of an image or in a unit that the file names."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

from drystone.errors import InputError, Notice
from drystone.io.file_errors import entry, short
from drystone.io.outlines_in.model import (
    METRES,
    Area,
    OutlinedStone,
    OutlineFile,
    left_aside,
    number_in,
    ring,
)
from drystone.io.read_settings import ReadSettings

KINDS = frozenset(
    {
        "FeatureCollection", "Feature", "GeometryCollection", "Polygon", "MultiPolygon", "Point",
        "MultiPoint", "LineString", "MultiLineString",
    }
)  # fmt: skip
_DEGREES = ("CRS84", "4326", "WGS84")


def read_geojson(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read polygons and multi-polygons, a stone a feature.

    A foreign member ``unit`` of the file ("m", "mm" …), or the setting, makes it a drawing with y
    up; without one, or with "px", coordinates are px of an image with y down, as image tools
    write them, unless its ``frame`` is that of a wall of drystone, or all y are negative.  The id
    of a stone is the ``id`` of its feature or of its properties, its name their ``name``.
    """
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
    stones: list[OutlinedStone] = []
    aside = Counter[str]()
    for number, feature in enumerate(_features(content)):
        with entry(f"feature {number} (from 0)"):
            stones += _stones(feature, aside)
    unit_m = METRES.get(unit if "unit" in content else settings.unit or "px")
    upwards = unit_m is not None or str(content.get("frame")).startswith("wall")
    notices = left_aside(aside)
    if not upwards and _below(stones):
        upwards = True
        text = "all y are negative: y runs up, as GIS programs have it over a picture."
        notices.append(Notice("W119", text))
    return OutlineFile(stones, unit_m, upwards, notices=notices)


def _no_unit(what: str, cure: str) -> InputError:
    return InputError("E116", what, cure=cure)


def _below(stones: list[OutlinedStone]) -> bool:
    """Tell whether all is below a picture's upper edge with y up, where y down has no pixel."""
    rings = [ring for stone in stones for area in stone.areas for ring in area.rings]
    return bool(rings) and all(ring[:, 1].max() <= 0.0 for ring in rings)


def _features(content: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    with entry("the list of features"):
        if content["type"] == "FeatureCollection":
            yield from content["features"]
        elif content["type"] == "Feature":
            yield content
        else:
            yield {"geometry": content}


def _stones(feature: Mapping[str, Any], aside: Counter[str]) -> Iterator[OutlinedStone]:
    geometry = feature["geometry"]
    if geometry is None:
        aside["features without a geometry"] += 1
        return
    said = {**(feature.get("properties") or {})}
    own = number_in(feature.get("id"))
    if own is None:
        own = number_in(said.get("id", said.get("stone")))
    name = str(said.get("name") or (feature["id"] if isinstance(feature.get("id"), str) else ""))
    kind = geometry["type"]
    if kind == "GeometryCollection":
        for part in geometry["geometries"]:
            yield from _stones({**feature, "geometry": part}, aside)
    elif said.get("kind", "stone") != "stone":
        aside[f"features of the kind {said['kind']!r}"] += 1
    elif kind in {"Polygon", "MultiPolygon"}:
        polygons = [geometry["coordinates"]] if kind == "Polygon" else geometry["coordinates"]
        areas = tuple(Area(tuple(ring(points) for points in rings)) for rings in polygons)
        if not areas or not all(area.rings for area in areas):
            raise ValueError("a polygon has no ring")
        yield OutlinedStone(own, name, areas)
    else:
        aside[f"{kind}s"] += 1
