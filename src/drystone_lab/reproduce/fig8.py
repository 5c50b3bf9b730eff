"""Fig. 8: the feasible positions of a stone by two convolutions, and the best (§3.6)."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import ndimage, signal

from drystone.kernels.lowering import Positions
from drystone.kernels.merits import eq12_merits
from drystone.kernels.raster import Mask
from drystone.model.pose import PosedStone
from drystone_lab.pictures.positions import Layer, plot_position_layers, plot_position_values
from drystone_lab.reproduce.cells import Finding
from drystone_lab.reproduce.construction import Moment, construction
from drystone_lab.reproduce.item import Context, Item, Picture
from drystone_lab.reproduce.places import amid_course
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Cell, Table
from drystone_lab.walls import PR, Target

FREE, FLOATING, TOUCHING = "#d55e00", "#0072b2", "#cc79a7"
"""The paper's red, blue and pink in Okabe and Ito's colours, apart for colour-blind readers."""

PANEL_IN = (7.2, 2.35)


@dataclass(frozen=True, eq=False)
class PositionMaps:
    """All positions of a stone on a landscape, by row and column of its mask's top-left corner.

    Parameters
    ----------
    free : (h - h' + 1, w - w' + 1) bool array
        No pixel overlaps.
    floating : bool array of the same shape
        None would overlap the landscape, with the bounds of the wall, dilated by one pixel.
    """

    free: Mask
    floating: Mask

    @classmethod
    def of(cls, occupied: Mask, mask: Mask) -> "PositionMaps":
        """Find them as the paper does, by convolution.

        Parameters
        ----------
        occupied : (h, w) bool array
            The landscape; L_0 of the paper has bounds on all four sides (Fig. 4b).
        mask : (h', w') bool array
            The stone.
        """
        bounded = np.pad(occupied, 1, constant_values=True)
        dilated = ndimage.binary_dilation(bounded)[1:-1, 1:-1]
        return cls(_overlap(occupied, mask) == 0, _overlap(dilated, mask) == 0)

    @property
    def touching(self) -> Mask:
        """The paper's feasible positions: the difference of both."""
        return self.free & ~self.floating


def _overlap(picture: Mask, mask: Mask) -> NDArray[np.int64]:
    """Return how many pixels overlap at each position."""
    counts = signal.correlate(picture.astype(float), mask.astype(float), "valid", "fft")
    return np.asarray(np.rint(counts), np.int64)


@dataclass(frozen=True, eq=False)
class Trial:
    """A stone of a run on what was built before it: its positions, and the one that is tried."""

    wall: Target
    moment: Moment
    posed: PosedStone
    chosen: tuple[int, int]
    runs: tuple[RunSpec, ...]

    @cached_property
    def maps(self) -> PositionMaps:
        """The paper's positions."""
        return PositionMaps.of(self.moment.wall.occupied, self.posed.mask)

    @cached_property
    def resting(self) -> Positions:
        """Where it rests on something from below."""
        return self.moment.positions(self.posed)

    def values(self, positions: Positions) -> NDArray[np.float64]:
        """Return Eq. 12 at some positions."""
        landscape, posed = self.moment.landscape, self.posed
        built, beta = landscape.built_height_px, self.moment.settings.placement.beta
        return eq12_merits(
            positions, posed.silhouette, landscape.rays, built, posed.anchor[0], beta
        )

    @cached_property
    def touching(self) -> Positions:
        """Where it touches something."""
        return np.argwhere(self.maps.touching).astype(np.int64)


def trial(context: Context, wall: Target = PR) -> Trial:
    """Find the positions of a stone of the run on what was built before it."""
    spec = wall.run(context.seed)
    moment, place = amid_course(construction(context, spec))
    found = moment.trial(place.posed.stone.id)
    if found is None:
        raise RuntimeError("a stone of the run fits nowhere where it was placed")
    return Trial(wall, moment, found[0], found[1:], (spec,))


def _table(found: Trial) -> Table:
    posed, maps, height = found.posed, found.maps, found.moment.landscape.height_px
    value = float(found.values(np.array([found.chosen], np.int64))[0])
    sets: list[tuple[str, int, tuple[int, int, float] | None]] = [
        ("all inside the wall", maps.free.size, None),
        ("no overlap (red)", int(maps.free.sum()), None),
        ("floating (blue)", int(maps.floating.sum()), None),
        ("touching: the difference (pink)", len(found.touching), _best(found, found.touching)),
        ("resting on something from below", len(found.resting), _best(found, found.resting)),
        ("chosen", 1, (*found.chosen, value)),
    ]
    rows: list[tuple[Cell, ...]] = []
    for name, count, at in sets:
        told: tuple[Cell, ...] = (None, None, None)
        if at is not None:
            told = (at[1], height - at[0] - posed.height_px, round(at[2], 4))
        rows.append((name, count, *told))
    return Table(
        f"Positions of stone {posed.stone.id}, {posed.width_px} x {posed.height_px} working px",
        ("positions", "count", "best: left px", "best: bottom px", "best: Eq. 12"),
        tuple(rows),
    )


def _best(found: Trial, positions: Positions) -> tuple[int, int, float]:
    """Return the position of the largest value; of equal ones the lower, then the left one."""
    values = found.values(positions)
    order = np.lexsort((positions[:, 1], -positions[:, 0], -np.round(values, 12)))
    row, col = positions[order[0]].tolist()
    return row, col, float(values[order[0]])


def _drawn(found: Trial) -> Picture:
    moment, posed, maps, resting = found.moment, found.posed, found.maps, found.resting
    figure = Figure(figsize=(PANEL_IN[0], 3 * PANEL_IN[1]), layout="constrained")
    first, second, third = figure.subplots(3, 1)
    labels = moment.wall.labels
    bearing = np.zeros_like(maps.free)
    bearing[resting[:, 0], resting[:, 1]] = True
    free = Layer(maps.free, FREE, "no overlap")
    floating = Layer(maps.floating, FLOATING, "floating: no overlap when dilated")
    plot_position_layers(labels, posed, (free, floating), first)
    touching = Layer(maps.touching, TOUCHING, "touching: the difference")
    rests = Layer(bearing, "#000000", "resting on something from below")
    plot_position_layers(labels, posed, (touching, rests), second)
    plot_position_values(labels, posed, resting, found.values(resting), found.chosen, third)
    return Picture(
        "fig8", figure,
        f"Positions of stone {posed.stone.id} on {len(moment.wall.placements)} stones of "
        f"{found.wall.name}, each drawn where the stone's centroid would be. Top: no overlap, and "
        "of these floating. Middle: the difference, and of it resting on something from below. "
        "Bottom: Eq. 12 at the resting positions, and the stone at the best (cross).",
    )  # fmt: skip


def _claims(found: Trial) -> Iterator[Finding]:
    resting = found.resting
    inside = int(np.count_nonzero(found.maps.touching[resting[:, 0], resting[:, 1]]))
    yield Finding(
        "The difference of both convolutions gives the feasible positions.",
        f"it holds {inside} of the {len(resting)} at which the stone rests on something, and "
        f"{len(found.touching) - inside} more.",
        inside == len(resting) == len(found.touching),
    )


POSITIONS = Item(
    title="feasible positions of a stone",
    section="§3.6",
    paper=(
        "Fig. 8 shows a landscape and a stone. The convolution of the landscape with the stone "
        "gives the positions without overlap (red); the convolution of the landscape dilated by "
        "one pixel those at which the stone would not touch it either (blue); 'the difference of "
        "the two convolution results (red and blue in Fig. 8) produce the feasible solutions' "
        "(pink, §3.6). The stone goes where Eq. 12 is largest (black). There are no numbers.",
    ),
    study=trial,
    notes=(
        "The planner is stricter than the paper: a touch at a side or at the bounds carries "
        "nothing, so that the paper's best position may rest on nothing.",
    ),
    claims=_claims,
    tables={"positions": _table},
    pictures=lambda found: (_drawn(found),),
    needs=(PR.source.name,),
)
