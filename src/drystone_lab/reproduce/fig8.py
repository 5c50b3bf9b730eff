"""Fig. 8: the feasible positions of a stone by two convolutions, and the best (§3.6)."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import ndimage, signal

from drystone.kernels.lowering import Positions
from drystone.kernels.merits import eq12_merits
from drystone.kernels.raster import Mask
from drystone.model.pose import PosedStone
from drystone_lab.pictures.positions import Layer, plot_position_layers, plot_position_values
from drystone_lab.reproduce.base import PR, PaperWall
from drystone_lab.reproduce.construction import Moment, construction
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.places import amid_course
from drystone_lab.table import Cell, Table

FREE, FLOATING, TOUCHING = "#d55e00", "#0072b2", "#cc79a7"
"""The paper's red, blue and pink in Okabe and Ito's colours, apart for colour-blind readers."""

PANEL_IN = (7.2, 2.35)

PAPER = (
    "Fig. 8 shows a landscape and a stone. The convolution of the landscape with the stone gives "
    "the positions without overlap (red); the convolution of the landscape dilated by one pixel "
    "those at which the stone would not touch it either (blue); 'the difference of the two "
    "convolution results (red and blue in Fig. 8) produce the feasible solutions' (pink, §3.6). "
    "The stone goes where Eq. 12 is largest (black). There are no numbers.",
)


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


def make(context: Context, wall: PaperWall = PR) -> Output:
    """Find the positions of a stone of the run on what was built before it.

    Parameters
    ----------
    context : Context
        Does the run.
    wall : PaperWall
        What is built.
    """
    spec = wall.run(context.seed)
    moment, place = amid_course(construction(context, spec))
    trial = moment.trial(place.posed.stone.id)
    if trial is None:
        raise RuntimeError("a stone of the run fits nowhere where it was placed")
    posed, *chosen = trial
    maps = PositionMaps.of(moment.wall.occupied, posed.mask)
    resting = moment.positions(posed)
    values = _values(moment, posed, resting)
    table, sentences = _found(moment, posed, maps, (chosen[0], chosen[1]))
    figure = _drawn(moment, posed, maps, resting, values, (chosen[0], chosen[1]))
    caption = (
        f"Positions of stone {posed.stone.id} on {len(moment.wall.placements)} stones of "
        f"{wall.name}, each drawn where the stone's centroid would be. Top: no overlap, and of "
        "these floating. Middle: the difference, and of it resting on something from below. "
        "Bottom: Eq. 12 at the resting positions, and the stone at the best (cross)."
    )
    return Output(
        paper=PAPER,
        ours=sentences,
        tables=(("positions", table),),
        pictures=(Picture("fig8", figure, caption),),
        runs=(spec,),
    )


def _values(moment: Moment, posed: PosedStone, positions: Positions) -> NDArray[np.float64]:
    """Return Eq. 12 at some positions."""
    landscape = moment.landscape
    built, beta = landscape.built_height_px, moment.settings.placement.beta
    return eq12_merits(positions, posed.silhouette, landscape.rays, built, posed.anchor[0], beta)


def _found(
    moment: Moment, posed: PosedStone, maps: PositionMaps, chosen: tuple[int, int]
) -> tuple[Table, tuple[str, ...]]:
    resting = moment.positions(posed)
    touching = np.argwhere(maps.touching).astype(np.int64)
    best = [_best(moment, posed, positions) for positions in (touching, resting)]
    value = float(_values(moment, posed, np.array([chosen], np.int64))[0])
    inside = int(np.count_nonzero(maps.touching[resting[:, 0], resting[:, 1]]))
    height = moment.landscape.height_px
    sets: list[tuple[str, int, tuple[int, int, float] | None]] = [
        ("all inside the wall", maps.free.size, None),
        ("no overlap (red)", int(maps.free.sum()), None),
        ("floating (blue)", int(maps.floating.sum()), None),
        ("touching: the difference (pink)", len(touching), best[0]),
        ("resting on something from below", len(resting), best[1]),
        ("chosen", 1, (*chosen, value)),
    ]
    rows: list[tuple[Cell, ...]] = []
    for name, count, at in sets:
        told: tuple[Cell, ...] = (None, None, None)
        if at is not None:
            told = (at[1], height - at[0] - posed.height_px, round(at[2], 4))
        rows.append((name, count, *told))
    table = Table(
        f"Positions of stone {posed.stone.id}, {posed.width_px} x {posed.height_px} working px",
        ("positions", "count", "best: left px", "best: bottom px", "best: Eq. 12"),
        tuple(rows),
    )
    share = len(touching) / maps.free.size
    first = (
        f"Of {maps.free.size} positions {int(maps.free.sum())} overlap nothing; "
        f"{int(maps.floating.sum())} of these float, which leaves {len(touching)} "
        f"({100 * share:.1f} %) that touch something. The planner is stricter: a touch at a side "
        f"or at the bounds carries nothing, so it takes the {len(resting)} at which the stone "
        f"rests on something from below; {inside} of these are among the paper's."
    )
    same = best[0][:2] == best[1][:2]
    there = (
        "where the planner tries the stone" if best[1][:2] == chosen else "not where it is tried"
    )
    second = (
        f"Of these Eq. 12 is largest, {best[1][2]:.3f}, at {best[1][1]} px from the left, {there}. "
        f"Among the paper's positions the best is "
        + ("the same." if same else f"another, {best[0][2]:.3f}: it rests on nothing.")
    )
    return table, (first, second)


def _best(moment: Moment, posed: PosedStone, positions: Positions) -> tuple[int, int, float]:
    """Return the position of the largest value; of equal ones the lower, then the left one."""
    values = _values(moment, posed, positions)
    order = np.lexsort((positions[:, 1], -positions[:, 0], -np.round(values, 12)))
    row, col = positions[order[0]].tolist()
    return row, col, float(values[order[0]])


def _drawn(
    moment: Moment,
    posed: PosedStone,
    maps: PositionMaps,
    resting: Positions,
    values: NDArray[np.float64],
    chosen: tuple[int, int],
) -> Figure:
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
    plot_position_values(labels, posed, resting, values, chosen, third)
    return figure


ITEM = Item("feasible positions of a stone", "§3.6", make, needs=(PR.source.name,))
