"""The masons' walls of the published sets, as traced and with their gaps closed."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from drystone.clusters import cluster_stones
from drystone.contacts.blocks import model_from_labels
from drystone.contacts.gaps import model_with_closed_gaps, settle_gaps
from drystone.io.published import published_file
from drystone.io.wall_image import read_wall_image
from drystone.metrics.measure import WallMetrics, measure_labels
from drystone.metrics.reduce import reduce_labels
from drystone.model.wall import Labels
from drystone.poses import PoseBook
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone_lab.reproduce.base import PaperWall
from drystone_lab.reproduce.masons_gaps import dilated, drawn_together

REACHES_PX = (1, 2, 3, 4, 6, 8)
"""Widest gap that is closed, working px."""

PAPERS_WAY = "drawn together and dilated (the paper's way)"


@dataclass(frozen=True, eq=False)
class MasonsWall:
    """A wall of masons at the working scale.

    Parameters
    ----------
    wall : PaperWall
        Which.
    labels : (h, w) integer array
        As it was traced.
    clusters : dict of int to int
        Cluster of each stone of the published set, by id.
    """

    wall: PaperWall
    labels: Labels
    clusters: dict[int, int]

    @cached_property
    def papers_way(self) -> Labels:
        """The wall with its stones drawn together and dilated by one pixel."""
        return dilated(drawn_together(self.labels))


@dataclass(frozen=True)
class Treatment:
    """F_LR for one way to treat the gaps.

    Parameters
    ----------
    name : str
        The way.
    F_LR : float or None
        None where the wall does not stand.
    status : str
        Of the limit analysis: "optimal", or what it was in the direction that has no multiplier.
    """

    name: str
    F_LR: float | None
    status: str


def masons_wall(wall: PaperWall, data: Path | None) -> MasonsWall:
    """Read a published wall and bring it to the working scale.

    Raises
    ------
    FileNotFoundError
        There is no folder of published data.
    """
    if data is None:
        raise FileNotFoundError(wall.source.name)
    stones = wall.source.stones(data)
    labels = reduce_labels(read_wall_image(published_file(data, wall.source.name)), wall.scale)
    return MasonsWall(wall, labels, cluster_stones(stones, PoseBook(wall.scale)))


def treatments(wall: MasonsWall) -> tuple[Treatment, ...]:
    """Return F_LR of a wall as it was traced and with its gaps treated in all ways."""
    labels = wall.labels
    models = {
        "as traced": model_from_labels(labels).model,
        **{
            f"gaps up to {reach} px closed": model_with_closed_gaps(labels, reach).model
            for reach in REACHES_PX
        },
        "stones lowered": model_from_labels(settle_gaps(labels)[0]).model,
        "lowered and pushed left": model_from_labels(settle_gaps(labels, "left")[0]).model,
        "lowered and pushed right": model_from_labels(settle_gaps(labels, "right")[0]).model,
        PAPERS_WAY: model_from_labels(wall.papers_way).model,
    }
    return tuple(_treated(name, model) for name, model in models.items())


def measured(labels: Labels) -> WallMetrics:
    """Return the metrics of a wall by our definition (DESIGN 5), F_LR of its pixels among them."""
    resistance = lateral_resistance(model_from_labels(labels).model)
    return measure_labels(labels, lateral_resistance=resistance.value)


def _treated(name: str, model: RigidBlockModel) -> Treatment:
    both = lateral_resistance(model)
    told = next((end for end in (both.left, both.right) if end.alpha is None), both.left)
    return Treatment(name, both.value, str(told.status))
