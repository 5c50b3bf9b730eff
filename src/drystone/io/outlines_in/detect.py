"""Which format a file of outlines is in, by its content and its ending."""

import json
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import PurePath
from typing import Any

from drystone.errors import InputError
from drystone.io.foreign import foreign
from drystone.io.json_text import json_of
from drystone.io.listed import listed, short
from drystone.io.npy import BEGINNING
from drystone.io.outlines_in.coco import is_coco, read_coco
from drystone.io.outlines_in.dxf import is_dxf, read_dxf
from drystone.io.outlines_in.geojson import is_geojson, read_geojson
from drystone.io.outlines_in.labelme import is_labelme, read_labelme
from drystone.io.outlines_in.meshes import mesh_kind, read_mesh
from drystone.io.outlines_in.model import OutlineFile
from drystone.io.outlines_in.sam import is_sam, read_sam
from drystone.io.outlines_in.svg import is_svg, read_svg
from drystone.io.photo_sidecar import LABELS, SCHEMA
from drystone.io.pictures import format_of
from drystone.io.read_settings import ReadSettings

Reader = Callable[[bytes, str, ReadSettings], OutlineFile]

_JSON: tuple[tuple[Callable[[object], bool], Callable[..., OutlineFile]], ...] = (
    (is_labelme, read_labelme),
    (is_coco, read_coco),
    (is_sam, read_sam),
    (is_geojson, read_geojson),
)
_EXPECTED = (
    "labelme (shapes), COCO (annotations, images), masks of SAM (a list with segmentation each) "
    "or GeoJSON (type, features)"
)


def outline_reader(data: bytes, name: str) -> Reader | None:
    """Return what reads a file of outlines; None when it is none, so perhaps a picture."""
    suffix = PurePath(name).suffix.lower()
    # The two letters of a BMP may begin a text, too.
    if not data or data.startswith(BEGINNING) or format_of(data) not in ("", "BMP"):
        return None
    if suffix in {".json", ".geojson"} or _begins_json(data):
        return _read_json
    # A drawing names itself; the text of an OBJ is told by its lines, so it comes last.
    if is_svg(data, suffix):
        return read_svg
    if suffix == ".bmp":
        return None
    if is_dxf(data, suffix):
        return read_dxf
    kind = mesh_kind(data, suffix)
    return None if kind is None else partial(read_mesh, kind)


def _begins_json(data: bytes) -> bool:
    return data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")[:1] in (b"{", b"[")


def _read_json(data: bytes, where: str, settings: ReadSettings) -> OutlineFile:
    with foreign(lambda why: _no_stones(f"cannot be read, it may be cut short ({why})", "", where)):
        content = json_of(data.decode(json.detect_encoding(data), "surrogatepass"))
    for is_format, read in _JSON:
        if is_format(content):
            return read(content, where, settings)
    raise _no_stones(*_what_else(content), where=where)


def _what_else(content: Any) -> tuple[str, str]:
    """Say what JSON that holds no outlines is, and what to give instead."""
    if isinstance(content, Mapping):
        if content.get("schema") == SCHEMA:
            return f"stands beside the label image {LABELS}", f"Give {LABELS}, or their folder."
        if "steps" in content and "source" in content:
            return "is a plan, made of stones already", "Give the stones, or use it with --from."
        if "blocks" in content or "blocks_xywh" in content:
            return "is a block model of a wall", "Give the stones; `drystone analyse` reads it."
        keys = listed(short(repr(key)) for key in content) or "nothing"
        return f"has none of the known forms (its keys are {keys})", ""
    return "has none of the known forms", ""


def _no_stones(what: str, cure: str = "", where: str = "") -> InputError:
    return InputError(
        "E113", f"this JSON {what}.", where=where,
        cure=cure or f"Stones are read from {_EXPECTED}.",
    )  # fmt: skip
