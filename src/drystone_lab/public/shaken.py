"""Planned walls on the shaking table (drystone.physics.shake)."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from drystone.contacts.outlines import outlines_of_labels
from drystone.kernels.polygons import Points
from drystone.model.wall import Wall
from drystone.physics.building import ROUNDED
from drystone.physics.scene import Scene
from drystone.physics.shake import shake_once
from drystone_lab.runs.outcome import Outcome
from drystone_lab.runs.spec import RunSpec


def pga_of(spec: RunSpec, outcome: Outcome, data: Path | None) -> float | None:
    """Return the amplitude that a planned wall stands, g.

    Returns
    -------
    float or None
        None when nothing was built, or it does not stand at rest in the engine.

    Raises
    ------
    UsageError
        E305 when pymunk is not installed.
    """
    if not outcome.figures["placed"]:
        return None
    wall = outcome.wall(spec, data)
    # Wedges may fall out: the score is about stones.
    stones = frozenset(placement.stone_id for placement in wall.placements)
    scene = Scene(wall_outlines(wall), spec.settings().mu)
    trial = shake_once(scene, ROUNDED, watched=stones)
    return trial.pga_g


def wall_outlines(wall: Wall) -> Mapping[int, Points]:
    """Return the outlines of stones and wedges; of a wall of pixels, sub-pixel ones."""
    if wall.outlines is not None:
        return {block: np.asarray(corners) for block, corners in wall.outlines.blocks}
    return outlines_of_labels(wall.labels)
