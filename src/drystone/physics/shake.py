"""One shaking-table test: the ground moves to and fro, further and further, until stones move.

Thangavelu et al. (2018) and Liu et al. (2018) judge walls so: they are shaken with growing
amplitude until the stones have moved by a given limit (Wang et al. 2024, §1).  Here in 2D, in the
plane of the wall; signal, steps and limit are ours.
"""

from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np

from drystone.kernels.profiles import Floats
from drystone.physics.scene import EngineScene, EngineSettings
from drystone.physics.table import TiltingTable
from drystone.physics.tilt import TiltSettings, hold

LOOKS = 8
"""At the blocks, in every cycle."""


@dataclass(frozen=True)
class ShakeSettings:
    """How the table is shaken; lengths in mean block sizes L, times in sqrt(L / g)."""

    period: float = 7.0  # of the sinusoidal motion: 7 is a second for stones of .2 m
    cycles: int = 2  # at every amplitude
    # Steps of the amplitude, in g.  When blocks move by the limit they are set back by a step,
    # and it is halved until it is at most the fine one.
    coarse: float = 0.1
    fine: float = 0.0125
    greatest: float = 1.5  # largest amplitude that is tried, g
    limit: float = 0.1  # a block that has come so far since the wall stood at rest has moved
    pause: float = 1.0  # time at rest after the cycles of an amplitude
    # How the wall settles before, and when it has fallen then.
    level: TiltSettings = field(default_factory=lambda: TiltSettings(longest_hold=20.0))


def shake_once(
    scene: EngineScene,
    engine: EngineSettings | None = None,
    settings: ShakeSettings | None = None,
    *,
    watched: Collection[int] | None = None,
) -> float | None:
    """Shake the ground under a wall, step by step, each from the state before.

    Returned is the peak acceleration of the ground, in g, that the blocks stood: the largest
    amplitude at which none moved by the limit.  None when they do not stand at rest.  A rigid
    block on the ground slides when the acceleration exceeds mu g and rocks when it exceeds b/h g,
    for its width b and height h.  By how much it must for a movement of the limit depends on the
    period: the shorter, the more.  Only the blocks that are watched count; all unless given.
    """
    settings, engine = settings or ShakeSettings(), engine or EngineSettings()
    table = TiltingTable(scene, engine)
    if not hold(table, 0.0, table.poses(), settings.level):
        return None
    counted = np.array([watched is None or block in watched for block in table.ids])

    def moves(shaken: TiltingTable, amplitude_g: float) -> bool:
        """Shake at an amplitude until a block has moved by the limit; say whether one has."""
        signal = sinusoid(amplitude_g, settings, engine.time_step)
        still = [0.0] * round(settings.pause / engine.time_step)
        parts = np.array_split(signal, LOOKS * settings.cycles)
        for part in (*(part.tolist() for part in parts), still):
            shaken.ride(part)
            if np.where(counted, shaken.shifts(settled), 0.0).max() > settings.limit:
                return True
        return False

    settled, stood = table.poses(), table
    low, step, suspect = 0.0, settings.coarse, 0.0
    while low < settings.greatest:
        table = stood.copy()
        if not moves(table, low + step):
            low, stood = low + step, table
            # Smaller steps may have led past what a larger one set off.
            step = settings.coarse if low >= suspect else step
        elif step > settings.fine:
            suspect, step = low + step, step / 2
        else:
            break
    return low


def sinusoid(amplitude_g: float, settings: ShakeSettings, time_step: float) -> Floats:
    """Return the accelerations of the ground at an amplitude, a time step apart, in g."""
    steps = round(settings.cycles * settings.period / time_step)
    times = (np.arange(steps) + 0.5) * time_step
    return np.asarray(amplitude_g * np.sin(2 * np.pi * times / settings.period))
