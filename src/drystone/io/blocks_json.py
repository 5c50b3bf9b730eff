"""The blocks of a wall of outlines and where they touch, as `drystone analyse` reads them."""

import json
from pathlib import Path
from typing import Any

from drystone.model.wall import Wall
from drystone.statics.model import RigidBlockModel
from drystone.whole_files import write_whole

BLOCKS = "blocks.json"
"""Name of the file beside a plan whose geometry is exact."""


def write_blocks(wall: Wall, model: RigidBlockModel, folder: Path) -> Path | None:
    """Write the block model of a wall of outlines; None for a wall of pixels, whose image it is."""
    path = folder / BLOCKS
    if wall.outlines is None:
        return None
    write_whole(path, (json.dumps(blocks_to_json(wall, model), indent=1) + "\n").encode())
    return path


def blocks_to_json(wall: Wall, model: RigidBlockModel) -> dict[str, Any]:
    """Return the block model of a wall of outlines, in the plan's units."""
    if wall.outlines is None:
        raise ValueError("the stones of this wall are their pixels")
    outlines = wall.outlines
    px_per_m = wall.site.px_per_m or 1.0
    polygons = {
        block: (outlines.polygons.polygon(place) / px_per_m).tolist()
        for place, block in enumerate(outlines.ids)
    }
    return {
        "mu": model.mu,
        "blocks": [{"id": block.id, "polygon": polygons[block.id]} for block in model.blocks],
        "interfaces": [
            {
                "between": [interface.block, interface.other],
                "points": (interface.points / px_per_m).tolist(),
                "normal": list(interface.normal),
            }
            for interface in model.interfaces
        ],
    }
