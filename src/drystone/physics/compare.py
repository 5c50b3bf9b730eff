"""Simulated tilt angles beside predicted load multipliers of the same blocks."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from drystone.physics.scatter import Event, TiltResult, Variation, tilt_test
from drystone.physics.scene import Scene
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import Direction, RigidBlockModel

Predict = Callable[[RigidBlockModel, Direction], float | None]


@dataclass(frozen=True)
class TiltComparison:
    """One direction of one wall."""

    simulated: TiltResult  # The tilt tests
    associative: float | None  # Predicted load multipliers; None when there is none
    nonassociative: float | None

    @property
    def direction(self) -> Direction:
        """Where gravity turns to."""
        return self.simulated.direction

    def inside(self, predicted: float | None, event: Event = "fall") -> bool | None:
        """Whether a prediction lies within the simulation's own scatter.

        Limit analysis is about the first motion of the blocks as they lie.  A block that has moved
        may find a better rest, so that the wall falls later than any analysis of it says.
        """
        interval = self.simulated.interval(event)
        if predicted is None or interval is None or self.simulated.fell_at_rest:
            return None
        return interval[0] <= predicted <= interval[1]


def compare_with_tilt(
    scene: Scene,
    model: RigidBlockModel,
    rng: np.random.Generator,
    *,
    nonassociative: Predict | Mapping[Direction, float | None] | None = None,
    variations: Sequence[Variation] | None = None,
    directions: Sequence[Direction] = ("left", "right"),
) -> tuple[TiltComparison, ...]:
    """Tilt a wall in the engine and predict its load multipliers."""
    predicted = lateral_resistance(model)
    found = []
    for direction in directions:
        simulated = tilt_test(scene, direction, rng, variations)
        associative = (predicted.left if direction == "left" else predicted.right).alpha
        other = nonassociative
        if callable(other):
            without_dilatancy = other(model, direction)
        else:
            without_dilatancy = None if other is None else other.get(direction)
        found.append(TiltComparison(simulated, associative, without_dilatancy))
    return tuple(found)
