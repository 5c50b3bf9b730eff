"""The folder of a plan: what every command that reads plans needs beside plan.json."""

from pathlib import Path

import tomli_w

from drystone.errors import PlanError
from drystone.io.atomic import write_atomically
from drystone.io.blocks_json import write_blocks
from drystone.io.plan_json import write_plan
from drystone.io.wall_image import write_wall_image
from drystone.search.plan_result import PlanResult

WRITTEN = ("plan.json", "settings.toml", "blocks.json", "wall.png", "wall.tif")
"""What is written, or taken out because it would belong to another wall."""


def write_plan_folder(result: PlanResult, folder: str | Path) -> Path:
    """Write plan.json, settings.toml, the wall image and, for outlines, blocks.json.

    `drystone check`, `export`, `analyse`, `measure` and `craft` read such a folder, where stones
    are placed.  Pictures and the report are those of the command line (`drystone plan`).

    Parameters
    ----------
    result : PlanResult
        From :func:`drystone.plan_wall` or :func:`drystone.result_of`.
    folder : str or Path
        Made when it is not there.  Files of these names are replaced, all others stay.

    Returns
    -------
    Path
        Of plan.json.

    Raises
    ------
    PlanError
        E206: the folder is full or not writable.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise PlanError(
            "E206",
            f"the folder cannot be made ({error.strerror}).",
            where=str(folder),
            cure="Give a folder that exists, has room and may be written to.",
        ) from error
    write_plan(result.plan, folder / "plan.json")
    settings = tomli_w.dumps(dict(result.plan.settings))
    write_atomically(folder / "settings.toml", settings.encode())
    write_blocks(result.wall, result.model, folder)
    written = write_wall_image(result.wall.labels, folder)
    for name in {"wall.png", "wall.tif"} - {written.name}:
        # One that an earlier run left would belong to another wall.
        (folder / name).unlink(missing_ok=True)
    return folder / "plan.json"
