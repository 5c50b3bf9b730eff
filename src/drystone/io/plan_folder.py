"""The folder of a plan: what every command that reads plans needs beside plan.json."""

import json
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

import tomli_w

from drystone.errors import PlanError, UsageError
from drystone.io.photo_beside import RECORD, place_photo
from drystone.io.plan_json import write_plan
from drystone.io.wall_image import write_wall_image
from drystone.model.wall import Wall
from drystone.search.plan_result import PlanResult
from drystone.statics.model import RigidBlockModel
from drystone.whole_files import write_whole

BLOCKS = "blocks.json"
"""Name of the file beside a plan whose geometry is exact."""

WRITTEN = ("plan.json", "settings.toml", BLOCKS, "wall.png", "wall.tif")
"""What is written with a plan, or taken out because it would belong to another wall."""

DRAWN = ("report.html", "picture.png", "mechanism_left.png", "mechanism_right.png")
"""What `drystone plan` draws of it."""


def write_plan_folder(result: PlanResult, folder: str | Path) -> Path:
    """Write plan.json, settings.toml, the wall image and, for outlines, blocks.json.

    `drystone check`, `export`, `analyse`, `measure` and `craft` read such a folder, where stones
    are placed.  Pictures and the report are those of the command line (`drystone plan`).

    Parameters
    ----------
    result : PlanResult
        From :func:`drystone.plan_wall` or :func:`drystone.result_of`.
    folder : str or Path
        Made when it is not there.  Files of these names are replaced; of an earlier plan also what
        would belong to its wall is removed: blocks.json, an image of another kind, its copy of the
        photograph.  All others stay.

    Returns
    -------
    Path
        Of plan.json.

    Raises
    ------
    UsageError
        E129: a file of these names is what the stones were read from.
    PlanError
        E206: the folder is full or not writable.
    """
    folder = Path(folder)
    _refuse_stones(result.plan.source, folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        what = f"the folder cannot be made ({error.strerror})."
        cure = "Give a folder that exists, has room and may be written to."
        raise PlanError("E206", what, where=str(folder), cure=cure) from error
    if RECORD not in result.plan.source:
        place_photo(None, folder)  # that of an earlier plan shows other stones
    replaces = (folder / "plan.json").exists()
    write_plan(result.plan, folder / "plan.json")
    settings = tomli_w.dumps(dict(result.plan.settings))
    write_whole(folder / "settings.toml", settings.encode())
    written = {write_wall_image(result.wall.labels, folder).name}
    if result.wall.outlines is not None:  # the model of a wall of pixels is its image
        blocks = json.dumps(blocks_to_json(result.wall, result.model), indent=1)
        write_whole(folder / BLOCKS, f"{blocks}\n".encode())
        written.add(BLOCKS)
    for name in {"wall.png", "wall.tif", BLOCKS} - written if replaces else ():
        # One that an earlier run left would belong to another wall.
        (folder / name).unlink(missing_ok=True)
    return folder / "plan.json"


def _refuse_stones(source: Mapping[str, Any], folder: Path) -> None:
    """Refuse to write over what the stones of a plan were read from (E129)."""
    masks = source.get("files", ())
    here = [folder / name for name in WRITTEN if (folder / name).is_file()]
    for path in here:
        if masks:
            # A digest of many files is that of none; their names are, where all of them are here.
            same = path.name in masks and all((folder / name).is_file() for name in masks)
        else:
            same = sha256(path.read_bytes()).hexdigest() == source["sha256"]
        if same:
            what = "the stones of this plan were read from it, and what is read is never replaced."
            cure = "Write the plan into another folder."
            raise UsageError("E129", what, where=str(path), cure=cure)


def blocks_to_json(wall: Wall, model: RigidBlockModel) -> dict[str, Any]:
    """Return the block model (in source px) of a wall of outlines, in the plan's units.

    Its scale and the poses of its stones tell whether a plan is that of the same wall.
    """
    px_per_m = wall.site.px_per_m or 1.0
    polygons = {block: (corners / px_per_m).tolist() for block, corners in wall.exact.blocks}
    poses = {
        placement.stone_id: {
            "angle_deg": placement.posed.angle_deg,
            "source_centroid": list(placement.posed.stone.centroid),
        }
        for placement in wall.placements
    }
    return {
        "mu": model.mu,
        "px_per_m": wall.site.px_per_m,
        "blocks": [
            {"id": block.id, "polygon": polygons[block.id], **poses.get(block.id, {})}
            for block in model.blocks
        ],
        "interfaces": [
            {
                "between": [interface.block, interface.other],
                "points": (interface.points / px_per_m).tolist(),
                "normal": list(interface.normal),
            }
            for interface in model.interfaces
        ],
    }
