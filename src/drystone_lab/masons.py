"""The masons' own walls by both definitions of the joints."""

from drystone.io.published import published_file
from drystone.io.wall_image import read_wall_image
from drystone.metrics.measure import measure_labels
from drystone.metrics.reduce import reduce_labels
from drystone.metrics.second import FINER, finer_labels, second_arrangement
from drystone.model.wall import Labels
from drystone_lab.planned_walls import SETS
from drystone_lab.table import BenchSettings, Cell, Table

COLUMNS = (
    "wall", "px", "stones", "F_SF", "F_AV", "F_AH", "2nd F_AV", "2nd F_AH", "2nd F_AV, source",
    "2nd F_AH, source",
)  # fmt: skip


def masons_walls(settings: BenchSettings) -> Table:
    """Measure the walls of Almeida et al. (2021) as they were traced, at the working scales."""
    rows = []
    for wall in SETS:
        if settings.data is not None and wall.source.is_there(settings.data):
            labels = read_wall_image(published_file(settings.data, wall.source.name))
            rows.append(masons_row(wall.name, labels, wall.scale))
    return Table(
        "The masons' own walls, as they were traced",
        COLUMNS,
        tuple(rows),
        (
            "2nd: on the pixels of the working scale, each repeated three times each way, and on "
            "pixels of the source at that finer scale.",
            "Stones do not touch in the tracings, so F_LR is not defined.",
        ),
    )


def masons_row(name: str, labels: Labels, scale: float) -> tuple[Cell, ...]:
    """Measure one of them."""
    reduced = reduce_labels(labels, scale)
    first = measure_labels(reduced)
    repeated = second_arrangement(finer_labels(reduced))
    sampled = second_arrangement(reduce_labels(labels, FINER * scale))
    height, width = reduced.shape
    return (
        name, f"{width}x{height}", first.stones, first.F_SF, first.F_AV, first.F_AH,
        repeated.F_AV, repeated.F_AH, sampled.F_AV, sampled.F_AH,
    )  # fmt: skip
