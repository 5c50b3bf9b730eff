"""Shear tests of dry-joint stone walls: what was tested and measured, and the walls as models.

Facts of the stone masonry database of Vanin, Zaganelli, Penna and Beyer (2017,
https://github.com/eesd-epfl/StoneMasonryDatabase) on tests of

* P. B. Lourenço, D. V. Oliveira, P. Roca and A. Orduña, Dry joint stone masonry walls subjected
  to in-plane combined loading, Journal of Structural Engineering 131 (2005) 1665-1673;
* G. Vasconcelos, Experimental investigations on the mechanics of stone masonry, thesis,
  University of Minho (2005);
* G. Vasconcelos and P. B. Lourenço, In-plane experimental behavior of stone masonry walls under
  cyclic loading, Journal of Structural Engineering 135 (2009) 1269-1277.

One leaf of sawn blocks in running bond without mortar, a beam on top, N constant on the beam, V on
the beam.  Lengths in m, forces in kN.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from statistics import fmean

import numpy as np

from drystone.contacts.given import model_from_json
from drystone.statics.loads import Loads, point_load, weight
from drystone.statics.model import RigidBlockModel

GRAVITY = 9.81
"""m/s2."""

COURSE_TOLERANCE = 1e-9
"""m; by how much joints at the end of a wall may miss it."""


@dataclass(frozen=True)
class ShearTest:
    """One wall."""

    name: str
    vertical_kn: float  # N
    # Largest V; towards either side for cyclic tests, the first side first
    peaks_kn: tuple[float, ...]

    @property
    def measured_kn(self) -> float:
        """Mean of the peaks: models do not tell the sides apart."""
        return fmean(self.peaks_kn)


@dataclass(frozen=True)
class ShearSeries:
    """Walls of one kind."""

    name: str  # Source, stone, way of loading
    length: float  # length, height, thickness: Of the wall without the beam
    height: float
    thickness: float
    # Height of V above the ground; the beam is modelled from the top of the wall to as far above V
    load_height: float
    block_length: float
    block_height: float
    density_kg_m3: float  # Of the stone; assumed, not measured
    tests: tuple[ShearTest, ...]  # All of the series

    @property
    def course_count(self) -> int:
        """Courses: the height of the wall over that of its blocks."""
        return round(self.height / self.block_height)


SANDSTONE_KG_M3, GRANITE_KG_M3 = 2400.0, 2650.0
"""Usual densities (hard sandstone 2140 to 2650, granite 2640 to 2760)."""

_SANDSTONE = (1.0, 0.9, 0.2, 1.0, 0.2, 0.1, SANDSTONE_KG_M3)
_GRANITE = (1.0, 1.2, 0.2, 1.325, 0.2, 0.15, GRANITE_KG_M3)

SERIES = (
    ShearSeries(
        "Lourenço 2005, sandstone, monotonic",
        *_SANDSTONE,
        (
            ShearTest("SW.30.1", 30.0, (21.9,)),
            ShearTest("SW.30.2", 30.0, (22.9,)),
            ShearTest("SW.100.1", 100.0, (41.5,)),
            ShearTest("SW.100.2", 100.0, (48.2,)),
            ShearTest("SW.200.1", 200.0, (71.6,)),
            ShearTest("SW.200.2", 200.0, (68.6,)),
            ShearTest("SW.250.1", 250.0, (102.7,)),
        ),
    ),
    ShearSeries(
        "Vasconcelos 2005, granite, monotonic",
        *_GRANITE,
        (
            ShearTest("WS.40", 40.0, (16.3,)),
            ShearTest("WS.100", 100.0, (37.0,)),
            ShearTest("WS.175", 175.0, (63.2,)),
            ShearTest("WS.250", 250.0, (85.9,)),
        ),
    ),
    ShearSeries(
        "Vasconcelos 2009, granite, cyclic",
        *_GRANITE,
        (
            ShearTest("WS1.100", 100.0, (39.0, 43.3)),
            ShearTest("WS2.100", 100.0, (37.8, 40.9)),
            ShearTest("WS3.100", 100.0, (38.0, 42.1)),
            ShearTest("WS4.100", 100.0, (36.0, 40.1)),
            ShearTest("WS1.175", 175.0, (61.8, 69.0)),
            ShearTest("WS2.175", 175.0, (64.5, 71.3)),
            ShearTest("WS3.175", 175.0, (64.3, 71.2)),
            ShearTest("WS1.250", 250.0, (88.7, 95.7)),
            ShearTest("WS2.250", 250.0, (87.1, 94.7)),
            ShearTest("WS3.250", 250.0, (86.5, 92.6)),
        ),
    ),
)


def shear_wall(
    series: ShearSeries,
    vertical_kn: float,
    mu: float = 0.62,
    *,
    level: bool = False,
    halves_first: bool = False,
) -> tuple[RigidBlockModel, Loads]:
    """Make a tested wall and its loads.

    Courses of whole blocks alternate with courses that begin and end with half a block.  The beam
    is the last block, as long as the wall, with the friction of the stones below it; its weight
    counts as part of N, which acts down at its middle.

    >>> from drystone.statics.limit import lateral_resistance
    >>> model, loads = shear_wall(SERIES[0], 30.0, level=True)
    >>> len(model.blocks), round(lateral_resistance(model, loads).right.alpha, 6)
    (50, 18.6)
    """
    kn_m2 = series.density_kg_m3 * GRAVITY * series.thickness / 1e3
    boxes = [*_stones(series, halves_first=halves_first)]
    top = 2.0 * series.load_height - series.height
    boxes.append((0.0, series.height, series.length, top))
    beam = len(boxes)
    blocks = [
        {
            "id": number,
            "polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]],
            "density": kn_m2,
            "held": ["turn"] if level and number == beam else [],
        }
        for number, (x0, y0, x1, y1) in enumerate(boxes, start=1)
    ]
    model = model_from_json({"blocks": blocks, "mu": mu})
    middle = (series.length / 2.0, series.load_height)
    dead = weight(model)
    dead[-1] = 0.0
    dead += point_load(model, beam, middle, (0.0, -vertical_kn))
    return model, Loads(dead, point_load(model, beam, middle, (1.0, 0.0)), "shear test")


def _stones(
    series: ShearSeries, *, halves_first: bool
) -> Iterator[tuple[float, float, float, float]]:
    """Yield left, bottom, right and top of the blocks, course by course."""
    for course in range(series.course_count):
        halves = (course % 2 == 0) == halves_first
        first = series.block_length / 2.0 if halves else series.block_length
        inner = np.arange(first, series.length - COURSE_TOLERANCE, series.block_length)
        bottom = course * series.block_height
        for left, right in pairwise([0.0, *inner.tolist(), series.length]):
            yield left, bottom, right, bottom + series.block_height
