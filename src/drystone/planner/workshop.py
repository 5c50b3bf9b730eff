"""Everything that is prepared once for a stone set and a site (Algorithm 1, line 2)."""

from dataclasses import dataclass

from drystone.clusters import cluster_stones
from drystone.errors import UsageError
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone, StoneSet
from drystone.planner.build import Build
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Rest, Stock
from drystone.poses import PoseBook
from drystone.stabilise.memory import StabiliseMemory


@dataclass(frozen=True, eq=False)
class Workshop:
    """Stones turned, rasterised, clustered and measured.

    Parameters
    ----------
    stones : StoneSet
        To build with.
    site : Site
        Where.
    book : PoseBook
        Turned stones.
    clusters : dict of int to int
        Cluster of each stone (§3.4).
    poses : dict of int to tuple of PosedStone
        Candidate poses of each stone that fit into the wall; none for a stone that is too large.
    initial : dict of int to PosedStone
        Pose of largest SF of each stone (Eq. 12d).
    stock : Stock
        Sizes of the set.
    memory : StabiliseMemory
        Stabilises stones.
    """

    stones: StoneSet
    site: Site
    book: PoseBook
    clusters: dict[int, int]
    poses: dict[int, tuple[PosedStone, ...]]
    initial: dict[int, PosedStone]
    stock: Stock
    memory: StabiliseMemory

    @classmethod
    def prepare(cls, stones: StoneSet, site: Site, settings: PlannerSettings) -> "Workshop":
        """Prepare stones for a site.

        Raises
        ------
        UsageError
            E120: a stone fits into the wall in no orientation, and is not to be skipped; E126:
            there are no stones.
        """
        if not len(stones):
            raise UsageError("E126", "there are no stones to build with.", where=stones.source.path)
        book = PoseBook(site.scale)
        poses = {s.id: _fitting_poses(s, site, book, settings.orientations) for s in stones}
        if not settings.skip_too_large:
            _refuse_too_large(poses, site)
        _leave_ids_for_wedges(stones)
        initial = {s.id: book.pose(s, book.initial_angle(s)) for s in stones}
        stock = Stock.of(tuple(initial.values()))
        clusters = cluster_stones(stones, book, settings.clusters)
        memory = StabiliseMemory(book, stock.mean_height_px, settings.stabilise)
        return cls(stones, site, book, clusters, poses, initial, stock, memory)

    def remaining(self, build: Build) -> tuple[int, ...]:
        """Return the ids of the stones that are left and fit into the wall, Omega_i."""
        placed = {action.stone_id for action in build.actions}
        return tuple(i for i, poses in self.poses.items() if poses and i not in placed)

    def rest(self, build: Build) -> Rest:
        """Return what the stones that are left could still fill."""
        return Rest.of((self.initial[i] for i in self.remaining(build)), self.site)


def _fitting_poses(
    stone: Stone, site: Site, book: PoseBook, orientations: str
) -> tuple[PosedStone, ...]:
    return tuple(
        posed
        for posed in book.orientations(stone, orientations)
        if posed.width_px <= site.width_px and posed.height_px <= site.height_px
    )


def _leave_ids_for_wedges(stones: StoneSet) -> None:
    """Raise UsageError (E137) when ids of 32 bits would run out: each stone may get two wedges."""
    largest = max(stone.id for stone in stones)
    if largest + 2 * len(stones) >= 2**32 - 1:
        raise UsageError(
            "E137",
            f"stone {largest} leaves no ids for wedges, which are numbered after the largest id.",
            where=stones.source.path,
            cure="Renumber the stones with smaller ids.",
        )


def _refuse_too_large(poses: dict[int, tuple[PosedStone, ...]], site: Site) -> None:
    too_large = [stone_id for stone_id, fitting in poses.items() if not fitting]
    if too_large:
        raise UsageError(
            "E120",
            f"stones {', '.join(map(str, too_large))} fit into the wall of "
            f"{site.width_px} x {site.height_px} working px in no orientation.",
            where="--wall",
            cure="Leave them out with --skip-too-large, or build a larger wall.",
        )
