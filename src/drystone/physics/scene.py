"""What is put on the tilting table: blocks by their outlines, and how the engine is driven."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from drystone.contacts.blocks import check_mu
from drystone.errors import InputError
from drystone.kernels.polygons import Points


@dataclass(frozen=True, eq=False)
class EngineScene:
    """Blocks that stand on a level ground, without gaps or overlaps worth speaking of."""

    # (n, 2), by id: corners in the wall frame, y up, either way round, closed or not; any unit
    # of length.  Concave stones are welcome.
    outlines: Mapping[int, Points]
    mu: float = 0.58  # coefficient of friction of every pair, and of the ground
    fixed: frozenset[int] = frozenset()  # blocks that are part of the ground

    def __post_init__(self) -> None:
        check_mu(self.mu)
        for block, shape in self.shapes.items():
            if shape.is_empty or not shape.is_valid:
                what = "its outline has no area or crosses itself."
                raise InputError("E303", what, where=f"block {block}", cure="Correct its corners.")
        if not set(self.shapes) - self.fixed:
            cure = "Give one to tilt."
            raise InputError("E303", "there is no free block.", where="scene", cure=cure)

    @cached_property
    def shapes(self) -> dict[int, shapely.Polygon]:
        """The outlines as counter-clockwise polygons."""
        return {
            block: shapely.orient_polygons(
                shapely.Polygon(outline) if len(outline) >= 3 else shapely.Polygon()
            )
            for block, outline in self.outlines.items()
        }

    @cached_property
    def length(self) -> float:
        """Mean square root of the areas of the free blocks: the unit of length of the engine."""
        free = [shape.area for block, shape in self.shapes.items() if block not in self.fixed]
        return float(np.sqrt(free).mean())


@dataclass(frozen=True)
class EngineSettings:
    """How the engine is driven; lengths in mean block sizes L, times in sqrt(L / g)."""

    time_step: float = 0.01  # of the engine
    iterations: int = 100  # passes over all contacts in a step
    slop: float = 1e-3  # depth to which blocks may overlap, so that contacts do not flicker
    overlap_left: float = 1.8e-3  # share of deeper overlap that is left after a unit of time
    corner_radius: float = 0.0  # corners of blocks are rounded by this, faces stay where they are
    # Share of the speeds that is left after a unit of time.  Stones that rock lose theirs as they
    # roll and strike; those of the engine roll for nothing, and would rock for ever.
    speed_left: float = 0.5
