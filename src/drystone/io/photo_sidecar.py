"""What stands beside the label image of a photograph: its scale, and where it came from."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from drystone.errors import InputError
from drystone.io.file_bytes import file_bytes
from drystone.io.json_text import json_of
from drystone.io.listed import short
from drystone.io.read_settings import MOST_PX_PER_M
from drystone.whole_files import write_whole

SCHEMA = "drystone-photo/1"
SIDECAR = "stones.json"
"""Name of the file beside `LABELS`."""
LABELS = "stones.png"


@dataclass(frozen=True)
class PhotoSidecar:
    """Beside a label image that was found in a photograph."""

    width_px: int  # size of the label image, so that a scale does not go to another picture
    height_px: int  # size of the label image, so that a scale does not go to another picture
    px_per_m: float | None = None  # px of the label image in a metre
    # base name of the photograph in the frame of the label image, beside it; empty for none
    photo: str = ""
    # what else was found out: markers, residuals, doubts.  For people
    details: Mapping[str, Any] = field(default_factory=dict)


def write_sidecar(sidecar: PhotoSidecar, folder: Path) -> Path:
    """Write it into the folder of the label image."""
    data = {
        "schema": SCHEMA,
        "labels": LABELS,
        "width_px": sidecar.width_px,
        "height_px": sidecar.height_px,
        "px_per_m": sidecar.px_per_m,
        "photo": sidecar.photo,
        **sidecar.details,
    }
    path = folder / SIDECAR
    write_whole(path, (json.dumps(data, indent=1, ensure_ascii=False) + "\n").encode())
    return path


def read_sidecar(labels: Path) -> PhotoSidecar | None:
    """Read what stands beside a label image; None when there is nothing of this kind."""
    if labels.name != LABELS:  # a folder such as "." has no name to replace
        return None
    path = labels.with_name(SIDECAR)
    if not path.is_file():
        return None
    try:
        data = json_of(file_bytes(path).decode("utf-8-sig"))
        if not isinstance(data, dict) or data.get("schema") != SCHEMA:
            return None
        scale = data["px_per_m"]
        if scale is not None and not 0.0 < float(scale) <= MOST_PX_PER_M:
            raise ValueError(f"px_per_m is {scale}")
        return PhotoSidecar(
            int(data["width_px"]),
            int(data["height_px"]),
            None if scale is None else float(scale),
            str(data.get("photo", "")),
        )
    except (OSError, ValueError, KeyError, TypeError, OverflowError) as error:
        raise InputError(
            "E112",
            f"what it says of the photograph cannot be used ({short(error)}).",
            where=str(path),
            cure="Find the stones again with `drystone segment`, or remove the file.",
        ) from error
