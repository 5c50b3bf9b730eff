"""Tilt tests repeated with variations that should not matter: the scatter of the simulation."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import median
from typing import Literal

import numpy as np
import shapely

from drystone.kernels.polygons import Points
from drystone.physics.scene import EngineScene, EngineSettings
from drystone.physics.tilt import TiltSettings, TiltTrial, tilt_once
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import Direction, RigidBlockModel

Event = Literal["fall", "first motion"]
"""Blocks come down; or some block moves noticeably, which often finds a new rest."""


@dataclass(frozen=True)
class Variation:
    """One way to run the same test."""

    name: str  # what differs
    engine: EngineSettings  # how the engine is driven
    tilt: TiltSettings  # how the table is tilted
    shuffled: bool = False  # blocks are given to the engine in a random order
    # Greatest shift of every block, and of every corner, along either axis, in mean block sizes.
    placement_noise: float = 0.0
    outline_noise: float = 0.0

    def of(self, scene: EngineScene, rng: np.random.Generator) -> EngineScene:
        """Return the scene with this variation's order and noise."""
        blocks = list(scene.outlines)
        if self.shuffled:
            blocks = [blocks[i] for i in rng.permutation(len(blocks)).tolist()]
        outlines = {}
        for block in blocks:
            corners = np.asarray(scene.shapes[block].exterior.coords)[:-1]
            shift = rng.uniform(-1, 1, 2) * self.placement_noise
            moves = rng.uniform(-1, 1, corners.shape) * self.outline_noise
            outlines[block] = _moved(corners + shift * scene.length, moves * scene.length)
        return replace(scene, outlines=outlines)


def _moved(corners: Points, moves: Points) -> Points:
    """Move corners; by half, a quarter ... as far where an outline would cross itself."""
    for part in (1.0, 0.5, 0.25, 0.125):
        moved = corners + part * moves
        if shapely.Polygon(moved).is_valid:
            return moved
    return corners


def usual_variations() -> tuple[Variation, ...]:
    """Return the variations of a tilt test: none, of the engine, of the scene, of the tilting.

    Noise stays at the depth to which blocks may overlap, far below a contact tolerance.
    """
    engine, tilt = EngineSettings(), TiltSettings()
    thorough = replace(engine, iterations=3 * engine.iterations)
    return (
        Variation("as given", engine, tilt),
        Variation("another order", engine, tilt, shuffled=True),
        Variation("three times the iterations", thorough, tilt),
        Variation("half the time step", replace(engine, time_step=engine.time_step / 2), tilt),
        Variation("half the overlap", replace(engine, slop=engine.slop / 2), tilt),
        Variation("rounded corners", replace(engine, corner_radius=2e-3), tilt),
        Variation("blocks shifted", engine, tilt, placement_noise=engine.slop),
        Variation("corners shifted", engine, tilt, outline_noise=engine.slop),
        Variation("every tilt at once", engine, replace(tilt, from_level=True)),
    )


@dataclass(frozen=True)
class TiltResult:
    """Outcome of repeated tilt tests in one direction."""

    direction: Direction  # where gravity turns to
    trials: tuple[TiltTrial, ...]

    @property
    def alphas(self) -> tuple[float, ...]:
        """Of the trials in which blocks came down on the tilted table."""
        return tuple(trial.alpha for trial in self.trials if trial.alpha is not None)

    @property
    def alpha(self) -> float | None:
        """Median; None when no trial has one."""
        return median(self.alphas) if self.alphas else None

    @property
    def high(self) -> float | None:
        """Least tilt that brought the strongest one with an alpha down; None when none has one."""
        found = self.interval("fall")
        return found[1] if found else None

    def interval(self, event: Event) -> tuple[float, float] | None:
        """Return the scatter of an event, resolution included; None when it never happened."""
        found = (one.alpha if event == "fall" else one.first_motion for one in self.trials)
        alphas = [alpha for alpha in found if alpha is not None]
        if not alphas:
            return None
        resolution = max(trial.resolution for trial in self.trials)
        return min(alphas) - resolution, max(alphas) + resolution

    @property
    def settled_shift(self) -> float:
        """Largest way of any block while a wall settled on the level table, unit of the scene."""
        return max(trial.settled_shift for trial in self.trials)

    @property
    def fell_at_rest(self) -> bool:
        """In some trial blocks came down on the level table."""
        return any(trial.fell_at_rest for trial in self.trials)


def tilt_test(
    scene: EngineScene,
    direction: Direction,
    rng: np.random.Generator,
    variations: Sequence[Variation],
) -> TiltResult:
    """Tilt a wall again and again, with variations that should not matter."""
    trials = tuple(
        tilt_once(variation.of(scene, rng), direction, variation.engine, variation.tilt)
        for variation in variations
    )
    return TiltResult(direction, trials)


@dataclass(frozen=True)
class TiltComparison:
    """One direction of one wall.

    Limit analysis is about the first motion of the blocks as they lie.  A block that has moved may
    find a better rest, so that the wall falls later than any analysis of it says.
    """

    simulated: TiltResult
    associative: float | None  # predicted load multipliers; None when there is none
    nonassociative: float | None


def compare_with_tilt(
    scene: EngineScene,
    model: RigidBlockModel,
    rng: np.random.Generator,
    variations: Sequence[Variation],
) -> tuple[TiltComparison, ...]:
    """Tilt a wall both ways and predict its load multipliers, best by a model of its outlines."""
    expected, without = lateral_resistance(model), nonassociative_resistance(model)
    return tuple(
        TiltComparison(tilt_test(scene, one.direction, rng, variations), one.alpha, other.alpha)
        for one, other in ((expected.left, without.left), (expected.right, without.right))
    )
