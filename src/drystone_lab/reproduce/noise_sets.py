"""The published walls of Thangavelu et al. (2018), measured (§5.3)."""

from dataclasses import dataclass
from pathlib import Path

from drystone.contacts.gaps import model_with_closed_gaps
from drystone.metrics.measure import measure_labels
from drystone.metrics.reduce import reduce_labels
from drystone.model.wall import Labels
from drystone.statics.limit import lateral_resistance
from drystone_lab.walls import Target

GAP_SOURCE_PX = 20 / 3
"""Widest gap of a published wall that counts as a contact: 2 px at the working scale."""

GAP_RANGE = (0.5, 1.0, 1.5)
"""The resistance is also told for gaps of as many times this width."""


@dataclass(frozen=True)
class ReferenceWall:
    """A published wall, measured as a label image."""

    stones: int
    F_SF: float  # Of the whole image, which is also the wall that our method is to fill
    F_AV: float | None
    F_AH: float | None
    # With no gap closed, then with those of :data:`GAP_RANGE`; None where it does not stand
    F_LR: tuple[float | None, ...]

    @property
    def resistance(self) -> float | None:
        """F_LR with gaps of :data:`GAP_SOURCE_PX` closed."""
        return self.F_LR[1 + GAP_RANGE.index(1.0)]

    def metric(self, name: str) -> float | None:
        """Return F_SF, F_AV, F_AH or F_LR by its name."""
        named = {"F_SF": self.F_SF, "F_AV": self.F_AV, "F_AH": self.F_AH, "F_LR": self.resistance}
        return named[name]


def reference_of(wall: Target, data: Path | None) -> ReferenceWall | None:
    """Measure the published wall of some stones; None of generated ones, which were never built."""
    if wall.stand_in or data is None:
        return None
    return measured(wall.source.labels(data), wall.scale)


def measured(labels: Labels, scale: float) -> ReferenceWall:
    """Measure a label image as a wall that fills all of it, reduced by a scale."""
    reduced = reduce_labels(labels, scale)
    height, width = reduced.shape
    # As in plans: stones have their area at the resolution of the source.
    share = (labels > 0).mean()
    metrics = measure_labels(
        reduced, wall_px=(width, height), stone_area_px=float(share * width * height)
    )
    reaches = (0.0, *(factor * GAP_SOURCE_PX * scale for factor in GAP_RANGE))
    resistances = tuple(
        lateral_resistance(model_with_closed_gaps(reduced, reach).model).value for reach in reaches
    )
    return ReferenceWall(metrics.stones, metrics.F_SF, metrics.F_AV, metrics.F_AH, resistances)
