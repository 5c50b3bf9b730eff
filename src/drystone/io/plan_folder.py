"""The folder of a plan: what every command that reads plans needs beside plan.json."""

from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

import tomli_w

from drystone.errors import PlanError, UsageError
from drystone.io.blocks_json import BLOCKS, write_blocks
from drystone.io.photo_beside import RECORD, place_photo
from drystone.io.plan_json import write_plan
from drystone.io.plan_names import WRITTEN
from drystone.io.wall_image import write_wall_image
from drystone.search.plan_result import PlanResult
from drystone.whole_files import write_whole


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
        raise PlanError(
            "E206",
            f"the folder cannot be made ({error.strerror}).",
            where=str(folder),
            cure="Give a folder that exists, has room and may be written to.",
        ) from error
    if RECORD not in result.plan.source:
        place_photo(None, folder)  # that of an earlier plan shows other stones
    replaces = (folder / "plan.json").exists()
    write_plan(result.plan, folder / "plan.json")
    settings = tomli_w.dumps(dict(result.plan.settings))
    write_whole(folder / "settings.toml", settings.encode())
    written = {write_wall_image(result.wall.labels, folder)}
    if (blocks := write_blocks(result.wall, result.model, folder)) is not None:
        written.add(blocks)
    for name in ("wall.png", "wall.tif", BLOCKS) if replaces else ():
        if folder / name not in written:
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
            raise UsageError(
                "E129",
                "the stones of this plan were read from it, and what is read is never replaced.",
                where=str(path),
                cure="Write the plan into another folder.",
            )
