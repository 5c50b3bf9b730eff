"""Fig. 19: the wedges of walls 3 and 5 (§5.2)."""

from collections.abc import Sequence
from functools import partial
from statistics import fmean

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.palette import OUTLINE_COLOUR
from drystone.drawing.pictures.wall import plot_wall
from drystone.model.placement import Wedge
from drystone.model.wall import Wall
from drystone_lab.pictures.sheet import Panel, sheet_of
from drystone_lab.pictures.wall_grid import wall_aspect
from drystone_lab.reproduce.base import IR, LIU_5, PaperWall
from drystone_lab.reproduce.drawn import in_words
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.summary import rounded
from drystone_lab.reproduce.trials import BASE, Trials, all_specs, run_trials
from drystone_lab.table import Cell, Table

SHOWN = 3
"""Wedges that are zoomed in on at most."""

ZOOM = 0.25
"""Width of what a zoom shows, over that of the wall."""

ZOOM_ASPECT = 0.6


def make(context: Context) -> Output:
    """Build walls 3 and 5 from the seed of the context."""
    return show(context, (IR, LIU_5))


def show(context: Context, walls: Sequence[PaperWall]) -> Output:
    """Build walls and show their wedges.

    Parameters
    ----------
    context : Context
        Does the runs; with the seed.
    walls : sequence of PaperWall
        The sets.
    """
    trials = run_trials(context, walls, {"variant": BASE}, (context.seed,))
    built = [(each, each.drawn(context)[0]) for each in trials]
    return Output(
        paper=(
            "§5.2, Fig. 19: walls 3 and 5 need wedges (in red), since their stones differ much in "
            "size and eccentricity and large ones must be kept stable. Their number and sizes are "
            "in the picture only.",
        ),
        ours=tuple(_said(each, wall) for each, wall in built),
        tables=(("fig19", _table(built)),),
        pictures=tuple(
            Picture(
                f"fig19_wall{each.wall.number}",
                _picture(each, wall),
                f"Wall {each.wall.number} ({each.wall.name}): all wedges in dark red, and the "
                "largest ones from near. Numbers on stones are steps of the plan; titles have ids.",
            )
            for each, wall in built
        ),
        runs=all_specs(trials),
    )  # fmt: skip


def _said(trials: Trials, wall: Wall) -> str:
    figures = trials.outcomes[0].figures
    whole = trials.wall.width * trials.wall.height
    share = 100 * float(figures["wedge_area"] or 0.0) / whole
    start = f"Wall {trials.wall.number} ({trials.wall.name}), seed {trials.specs[0].seed}"
    if not wall.wedges:
        return f"{start}: no wedge was needed."
    mean = _mean_height_px(wall)
    tallest = max(wedge.mask.shape[0] for wedge in wall.wedges) / mean
    return (
        f"{start}: {len(wall.wedges)} wedges under {len({w.under for w in wall.wedges})} of "
        f"{figures['placed']} stones, {share:.2f} % of the wall's area; the tallest has "
        f"{tallest:.0%} of the mean height of a stone."
    )


def _mean_height_px(wall: Wall) -> float:
    return fmean(placement.posed.mask.shape[0] for placement in wall.placements)


def _table(built: Sequence[tuple[Trials, Wall]]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for trials, wall in built:
        unit, mean = 1 / wall.site.scale, _mean_height_px(wall)
        for wedge in wall.wedges:
            height, width = wedge.mask.shape
            rows.append(
                (
                    trials.wall.number, wedge.id, wedge.under, rounded(width * unit),
                    rounded(height * unit), rounded(wedge.area_px * unit**2),
                    rounded(height / mean),
                )
            )  # fmt: skip
    return Table(
        "Wedges, in the order of construction",
        (
            "wall", "wedge", "under stone", "width, px", "height, px", "area, px2",
            "height / mean stone height",
        ),
        tuple(rows),
        ("Lengths in px of the source.",),
    )  # fmt: skip


def _picture(trials: Trials, wall: Wall) -> Figure:
    size = wall.site.units_per_px
    width, height = wall.site.width_px * size, wall.site.height_px * size
    boxes = [_box(wall, wedge) for wedge in shown(wall)]
    title = f"Wall {trials.wall.number}, {trials.wall.name}\n{in_words(trials.outcomes[0].figures)}"
    whole = Panel(title, wall_aspect(height / width), partial(_draw_whole, wall, boxes))
    zooms = [
        Panel(f"{letter}: wedge {wedge.id} under stone {wedge.under}", ZOOM_ASPECT,
              partial(_draw_zoom, wall, box))
        for letter, wedge, box in zip("abc", shown(wall), boxes, strict=False)
    ]  # fmt: skip
    return sheet_of([whole, *zooms], 2)


def shown(wall: Wall) -> list[Wedge]:
    """Return the largest wedges, without those that are seen beside a larger one."""
    found: list[Wedge] = []
    for wedge in sorted(wall.wedges, key=lambda each: (-each.area_px, each.id)):
        x, y = _middle(wall, wedge)
        boxes = (_box(wall, other) for other in found)
        if not any(x0 <= x <= x1 and y0 <= y <= y1 for x0, y0, x1, y1 in boxes):
            found.append(wedge)
    return found[:SHOWN]


def _middle(wall: Wall, wedge: Wedge) -> tuple[float, float]:
    """Return the middle of a wedge in source px, y up."""
    height, width = wedge.mask.shape
    unit = wall.site.units_per_px
    return (wedge.col + width / 2) * unit, (wall.site.height_px - wedge.row - height / 2) * unit


def _box(wall: Wall, wedge: Wedge) -> tuple[float, float, float, float]:
    """Return what a zoom shows: x0, y0, x1, y1."""
    x, y = _middle(wall, wedge)
    half = ZOOM * wall.site.width_px * wall.site.units_per_px / 2
    # Little of the ground, which is of no interest.
    y0 = max(y - ZOOM_ASPECT * half, -0.1 * half)
    return x - half, y0, x + half, y0 + 2 * ZOOM_ASPECT * half


def _draw_whole(wall: Wall, boxes: Sequence[tuple[float, float, float, float]], ax: Axes) -> None:
    plot_wall(wall, None, ax)
    for letter, (x0, y0, x1, y1) in zip("abc", boxes, strict=False):
        ax.plot([x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], color=OUTLINE_COLOUR, linewidth=0.9,
                linestyle=":", zorder=6)  # fmt: skip
        ax.text(
            x0, y1, letter, fontsize=8, ha="right", va="top", zorder=7, fontweight="bold",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
        )  # fmt: skip


def _draw_zoom(wall: Wall, box: tuple[float, float, float, float], ax: Axes) -> None:
    plot_wall(wall, None, ax)
    ax.set_xlim(box[0], box[2])
    ax.set_ylim(box[1], box[3])


ITEM = Item(
    "Wedges of walls 3 and 5", "§5.2, Fig. 19", make, needs=(IR.source.name,)
)  # fmt: skip
