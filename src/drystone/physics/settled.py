"""Blocks as they stand once the engine has let them settle."""

from dataclasses import replace

import numpy as np

from drystone.physics.scene import EngineSettings, Scene
from drystone.physics.table import TiltingTable
from drystone.physics.tilt import TiltSettings, hold


def settled(
    scene: Scene,
    alpha: float = 0.0,
    *,
    engine: EngineSettings | None = None,
    settings: TiltSettings | None = None,
) -> Scene | None:
    """Let blocks settle under their weight, and return them where they come to rest.

    The limit analysis of the settled blocks sees the contacts that the engine sees.  That of
    blocks which have moved on a tilted table and come to rest again says why they stand.
    """
    settings = settings or TiltSettings()
    table = TiltingTable(scene, engine or EngineSettings())
    given = table.poses()
    for tilt in (0.0, alpha) if alpha else (0.0,):
        if not hold(table, tilt, given, settings):
            return None
    outlines = dict(scene.outlines)
    for block, before, after in zip(table.ids, given, table.poses(), strict=True):
        cos, sin = np.cos(after[2] - before[2]), np.sin(after[2] - before[2])
        shape = scene.shapes[block]
        centre = np.array(shape.centroid.coords[0])
        arms = np.asarray(shape.exterior.coords) - centre
        turned = arms @ np.array([[cos, sin], [-sin, cos]])
        outlines[block] = centre + turned + (after[:2] - before[:2]) * scene.length
    return replace(scene, outlines=outlines)
