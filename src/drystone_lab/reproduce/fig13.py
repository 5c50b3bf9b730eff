"""Fig. 13: the masons' walls, and with their gaps closed (§5.1)."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from drystone_lab.pictures.masonry import masonry_panel
from drystone_lab.pictures.sheet import sheet_of
from drystone_lab.reproduce.base import MASONS
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.masons_wall import (
    PAPERS_WAY,
    MasonsWall,
    Treatment,
    masons_wall,
    measured,
    treatments,
)
from drystone_lab.reproduce.published_table import REFERENCES
from drystone_lab.reproduce.summary import METRICS, rounded
from drystone_lab.table import Cell, Table


def make(context: Context) -> Output:
    """Measure the masons' walls."""
    return closed([masons_wall(wall, context.data) for wall in MASONS])


def closed(walls: Sequence[MasonsWall]) -> Output:
    """Measure walls as traced and with their gaps treated in all ways.

    Parameters
    ----------
    walls : sequence of MasonsWall
        Of sets that Table 2 has.
    """
    treated = [treatments(each) for each in walls]
    return Output(
        paper=(
            "§5.1: the walls are annotated from photographs and have gaps. For the load multiplier "
            "stones are moved towards the bottom left corner one after the other, those nearest to "
            "it first, and dilated by one pixel. Fig. 13 shows PR before and after; Table 2 has "
            f"F_LR {_published()} of the walls so treated, and says that they depend on the "
            "annotation.",
        ),
        ours=(
            *(_said(each, ways) for each, ways in zip(walls, treated, strict=True)),
            _altogether(treated),
        ),
        tables=(
            ("fig13", _metrics(walls)),
            ("fig13_resistance", _resistance(walls, treated)),
        ),
        pictures=(
            Picture(
                "fig13", _picture(walls),
                "Left as traced, right with the stones drawn to the bottom left corner and "
                "dilated by one working px; stones of a colour are of one cluster of their set.",
            ),
        ),
    )  # fmt: skip


def _published() -> str:
    values = [f"{REFERENCES[wall.number].F_LR:g} ({wall.name})" for wall in MASONS]
    return ", ".join(values)


def _said(wall: MasonsWall, ways: Sequence[Treatment]) -> str:
    found = {way.name: way.F_LR for way in ways if way.F_LR is not None}
    papers = next(way for way in ways if way.name == PAPERS_WAY)
    spread = f"{min(found.values()):.2f} to {max(found.values()):.2f}" if found else "-"
    theirs = f"no F_LR ({papers.status})" if papers.F_LR is None else f"F_LR {papers.F_LR:.2f}"
    return (
        f"{wall.wall.name}: {papers.name}, the wall has {theirs}; the paper's is "
        f"{REFERENCES[wall.wall.number].F_LR:g}. {len(ways) - len(found)} of {len(ways)} "
        f"treatments leave a wall without a load multiplier; with the others F_LR is {spread}."
    )


def _altogether(treated: Sequence[Sequence[Treatment]]) -> str:
    ways = [way for each in treated for way in each]
    falls = sum(way.F_LR is None for way in ways)
    return (
        f"In all, {falls} of {len(ways)} walls have no load multiplier: dilation by one px closes "
        "gaps of at most two, what stones drawn to the corner leave open stays open, and one stone "
        "without support is enough for that. The figure is one of the treatment and "
        "of the tracing as much as of the wall; no F_LR of a masons' wall is a target here."
    )


def _metrics(walls: Sequence[MasonsWall]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for each in walls:
        theirs = REFERENCES[each.wall.number]
        for name, labels in (("as traced", each.labels), (PAPERS_WAY, each.papers_way)):
            ours = measured(labels)
            size = f"{ours.width:.0f} x {ours.height:.0f}"
            found = [rounded(getattr(ours, metric)) for metric in METRICS]
            rows.append((each.wall.name, name, size, ours.stones, *found))
        published = [getattr(theirs, metric) for metric in METRICS]
        rows.append((each.wall.name, "paper, Table 2", None, None, *published))
    return Table(
        "The masons' walls by our definition of the metrics",
        ("wall", "gaps", "px", "stones", *METRICS),
        tuple(rows),
        (
            "F_SF is over the bounding box of the stones; dilation enlarges the stones, so F_SF "
            "after it is not that of the wall. Table 2 refers to the walls of Fig. 18, which are "
            "the treated ones, so that its other figures may be of these too; §5.1 says so of the "
            "load multiplier alone.",
        ),
    )


def _resistance(walls: Sequence[MasonsWall], treated: Sequence[Sequence[Treatment]]) -> Table:
    rows = tuple(
        (wall.wall.name, way.name, rounded(way.F_LR), way.status)
        for wall, ways in zip(walls, treated, strict=True)
        for way in ways
    )
    return Table(
        "F_LR of the masons' walls by the treatment of their gaps",
        ("wall", "gaps", "F_LR", "status"),
        rows,
        (
            "Widths of gaps in working px. `drystone analyse --close-gaps PX` and `--close-gaps "
            "settle` do the same, but for the paper's way.",
        ),
    )


def _picture(walls: Sequence[MasonsWall]) -> Figure:
    panels = []
    for each in walls:
        views = {"as traced": each.labels, "drawn together, dilated": each.papers_way}
        for name, labels in views.items():
            title = f"{each.wall.name}, {name}"
            panels.append(masonry_panel(title, labels, each.clusters, 1 / each.wall.scale))
    return sheet_of(panels, 2)


ITEM = Item(
    "The masons' walls, and with their gaps closed", "§5.1, Fig. 13", make,
    needs=tuple(wall.source.name for wall in MASONS),
)  # fmt: skip
