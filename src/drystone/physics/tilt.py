"""One tilt test: the table is tilted in small steps until the blocks come down."""

from dataclasses import dataclass

from drystone.kernels.profiles import Floats
from drystone.physics.scene import EngineScene, EngineSettings
from drystone.physics.table import TiltingTable
from drystone.statics.model import Direction


@dataclass(frozen=True)
class TiltSettings:
    """How the table is tilted; lengths in mean block sizes L, times in sqrt(L / g)."""

    # Steps of alpha.  When blocks come down, or first move, they are set back by a step, and it
    # is halved until it is at most the fine one.
    coarse: float = 0.032
    fine: float = 0.002
    greatest: float = 1.5  # largest alpha that is tried
    fallen: float = 0.5  # a block that has come so far since the wall stood at rest has fallen
    noticeable: float = 0.02  # a block that has come so far has moved
    resting_speed: float = 1e-4  # the blocks rest when no point of any is faster
    # Time at every tilt.  Blocks that still move after the longest count as fallen.
    shortest_hold: float = 1.0
    longest_hold: float = 40.0
    # Every tilt is reached at once from the settled wall instead of from the tilt before.
    from_level: bool = False


@dataclass(frozen=True)
class TiltTrial:
    """Outcome of one tilt test."""

    # Tangent of the angle at which blocks come down; None when they fell at rest or never.
    alpha: float | None
    # Alpha at which some block first moved noticeably, even if it came to rest again.
    first_motion: float | None
    # Largest way of any point of a block while the wall settled on the level table, in the unit
    # of the scene.
    settled_shift: float
    # Of `alpha` and `first_motion`: the blocks stood at `alpha` minus it and fell at `alpha`
    # plus it.  Half a fine step or less.
    resolution: float
    fell_at_rest: bool = False  # blocks came down on the level table


def tilt_once(
    scene: EngineScene,
    direction: Direction,
    engine: EngineSettings | None = None,
    settings: TiltSettings | None = None,
) -> TiltTrial:
    """Tilt the table under a wall, step by step, each from the state before.

    The horizontal share of gravity points to -x for "left".
    """
    settings = settings or TiltSettings()
    table = TiltingTable(scene, engine or EngineSettings())
    given = table.poses()
    stands = hold(table, 0.0, given, settings)
    settled_shift = float(table.shifts(given).max()) * scene.length
    if not stands:
        return TiltTrial(None, None, settled_shift, 0.0, fell_at_rest=True)
    level = stood = table
    settled = level.poses()
    sign = -1.0 if direction == "left" else 1.0
    low, step, suspect = 0.0, settings.coarse, 0.0
    first_motion: float | None = None
    while low < settings.greatest:
        table = (level if settings.from_level else stood).copy()
        stands = hold(table, sign * (low + step), settled, settings)
        still = stands and table.shifts(settled).max() <= settings.noticeable
        first = first_motion is None and not still
        if (first or not stands) and step > settings.fine:
            suspect, step = low + step, step / 2
            continue
        if first:
            first_motion = low + step / 2
        if not stands:
            return TiltTrial(low + step / 2, first_motion, settled_shift, step / 2)
        low, stood = low + step, table
        # Smaller steps may have led past what a larger one set off.
        step = settings.coarse if first or low >= suspect else step
    return TiltTrial(None, first_motion, settled_shift, min(step, settings.fine) / 2)


def hold(table: TiltingTable, alpha: float, settled: Floats, settings: TiltSettings) -> bool:
    """Hold a tilt until the blocks rest or have fallen, and say whether they rest.

    `alpha` is the tangent of the tilt, positive when gravity turns towards +x; falling is measured
    from the settled poses, (n, 3).  The table is left in the state reached.
    """
    table.tilt(alpha)
    chunk, held = settings.shortest_hold / 4, 0.0
    while held < settings.longest_hold:
        table.advance(chunk)
        held += chunk
        if table.shifts(settled).max() > settings.fallen:
            return False
        if held >= settings.shortest_hold and table.speeds().max() <= settings.resting_speed:
            return True
    return False
