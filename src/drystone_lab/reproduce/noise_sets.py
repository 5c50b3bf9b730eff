"""The stones of Thangavelu et al. (2018), and our own of the noise levels between (§5.3)."""

import math
from dataclasses import dataclass
from pathlib import Path

from drystone.contacts.gaps import model_with_closed_gaps
from drystone.io.published import published_file
from drystone.io.wall_image import read_wall_image
from drystone.metrics.measure import measure_labels
from drystone.metrics.reduce import reduce_labels
from drystone.model.wall import Labels
from drystone.statics.limit import lateral_resistance
from drystone_lab.runs.spec import generated, published
from drystone_lab.walls import Target

NOISES = tuple(range(10, 90, 10))
"""Levels of the paper, %."""

PUBLISHED = (10, 20, 40, 50, 70)
"""Levels whose stones are public; the others are generated."""

SCALE = 0.3

COUNT = 26
"""Stones of a generated set: the published ones have 28, 23, 26, 27 and 25."""

AREA_SHARE = 0.696
"""Area of all stones over that of the wall: .790, .659, .702, .649 and .680 in the published."""

ASPECT = 1.80
"""Width over height of the wall: 1.71, 1.98, 1.76, 1.73 and 1.82 there."""

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


def noise_set(noise: int, scale: float = SCALE) -> Target:
    """Return the stones of a noise level, %, and their wall; published ones where there are any."""
    if noise in PUBLISHED:
        source = published(f"thangavelu/noise_{noise}.png")
        return Target(f"noise {noise} %", source, 0.0, 0.0, scale, noise)
    return generated_set(noise, COUNT, scale)


def generated_set(noise: int, count: int, scale: float) -> Target:
    """Return generated stones, with a wall of which they are the same share as published ones.

    The noise is the deviation of the corners over the shorter side of the brick, %.

    >>> wall = generated_set(30, 26, 0.3)
    >>> round(wall.source.stones(None).total_area_px / (wall.width * wall.height), 3)
    0.696
    >>> round(wall.width / wall.height, 2)
    1.8
    """
    source = generated("polygon", 2018_00 + noise, count=count, noise=noise / 100)
    wall_px = source.stones(None).total_area_px / AREA_SHARE
    height = round(math.sqrt(wall_px / ASPECT))
    width = round(wall_px / height)
    name = f"noise {noise} % (generated)"
    return Target(name, source, width, height, scale, noise, stand_in=True)


def reference_of(wall: Target, data: Path | None) -> ReferenceWall | None:
    """Measure the published wall of some stones; None of generated ones, which were never built."""
    if wall.stand_in or data is None:
        return None
    return measured(read_wall_image(published_file(data, wall.source.name)), wall.scale)


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
