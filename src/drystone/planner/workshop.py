"""Everything that is prepared once for a stone set and a site (Algorithm 1, line 2)."""

from dataclasses import asdict, dataclass, field
from statistics import fmean

from drystone.clusters import cluster_stones
from drystone.errors import UsageError
from drystone.kernels.raster import wrap_deg
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.wedge_shape import WedgeRule
from drystone.planner.build import Build
from drystone.planner.craft import PoseCosts
from drystone.planner.seats import Seats
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Rest, Stock
from drystone.planner.views import Views
from drystone.poses import PoseBook
from drystone.settle.book import OutlineBook
from drystone.settle.wedge import WedgeLimits
from drystone.stabilise.memory import StabiliseMemory


@dataclass(frozen=True, eq=False)
class Workshop:
    """Stones clustered and measured; their poses are made when they are asked for."""

    stones: StoneSet
    site: Site
    book: PoseBook  # turned stones
    clusters: dict[int, int]  # cluster of each stone (§3.4)
    orientations: str  # which poses of a stone are candidates (DESIGN 4.2)
    # ids of the stones that fit into the wall in a candidate pose and are not banned, ascending
    fitting: tuple[int, ...]
    stock: Stock  # sizes of the set
    memory: StabiliseMemory  # stabilises stones that are pixels
    outlines: OutlineBook  # turned outlines, for stones that settle on them
    costs: PoseCosts  # of their poses, wherever they go
    views: Views  # of walls of outlines
    seats: Seats  # tries places on them
    limits: WedgeLimits  # what their wedges may be, source px
    # ids of wedges that were in the wall when it was measured: no other wedge gets one of them
    wedge_ids: frozenset[int] = frozenset()
    _angles: dict[int, tuple[float, ...]] = field(default_factory=dict, init=False, repr=False)

    @classmethod
    def prepare(cls, stones: StoneSet, site: Site, settings: PlannerSettings) -> "Workshop":
        """Prepare stones for a site; UsageErrors are those of :func:`fitting_stones`."""
        book = PoseBook(site.scale)
        fitting = fitting_stones(stones, site, settings, book)
        # A banned boulder is no measure of what may be laid.
        usable = [stones.by_id(i) for i in fitting] or list(stones)
        stock = Stock.of(book.pose(s, book.initial_angle(s)) for s in usable)
        clusters = cluster_stones(stones, book, settings.clusters)
        memory = StabiliseMemory(book, stock.mean_height_px, settings.stabilise)
        outlines = OutlineBook(settings.settle.outline_px, 1.0 / site.scale)
        mean_size = fmean(stone.area_px**0.5 for stone in usable)
        return cls(
            stones, site, book, clusters, settings.orientations, fitting, stock, memory, outlines,
            PoseCosts(stock, frozenset(settings.pin)), Views(site.extent_px[0]),
            Seats(mean_size, settings.settle, settings.mu, settings.pin, len(usable)),
            wedge_limits(settings, stock, site),
        )  # fmt: skip

    def poses(self, stone_id: int) -> tuple[PosedStone, ...]:
        """Return the candidate poses of a stone that fit into the wall."""
        stone, angles = self.stones.by_id(stone_id), self._angles.get(stone_id)
        if angles is not None:
            return tuple(self.book.pose(stone, angle) for angle in angles)
        posed = self.book.orientations(stone, self.orientations)
        fitting = tuple(p for p in posed if _has_room(self.site, p))
        # Poses may be forgotten, and made again; which ones differ and fit is known from now on.
        known = {p.angle_deg for p in fitting}
        asked = self.book.angles(stone, self.orientations)
        self._angles[stone_id] = tuple(angle for angle in asked if wrap_deg(angle) in known)
        return fitting

    def remaining(self, build: Build) -> tuple[int, ...]:
        """Return the ids of the stones that are left and fit into the wall, Omega_i."""
        placed = {action.stone_id for action in build.actions}
        return tuple(i for i in self.fitting if i not in placed)

    def next_wedge(self, build: Build) -> int:
        """Return the id of the next wedge: after the largest of a stone and those of wedges."""
        ids = (wedge.id for wedge in build.wall.wedges)
        return max((self.stones.stones[-1].id, *self.wedge_ids, *ids)) + 1

    def rest(self, build: Build) -> Rest:
        """Return what the stones that are left could still fill."""
        return Rest.of([self.stock.sides[i] for i in self.remaining(build)], self.site)


def wedge_limits(settings: PlannerSettings, stock: Stock, site: Site) -> WedgeLimits:
    """Return what wedges may be, in source px; the stock is in working px."""
    settle, size_px = settings.settle, stock.median_area_px**0.5 / site.scale
    rule = WedgeRule.of(settings.wedge, settings.mu, size_px, site.px_per_m)
    return WedgeLimits(
        **asdict(rule),
        margin=settings.stabilise.margin,
        clearance_px=settle.clearance_px,
        contact_px=0.5 * settle.contact_px,
        setback=settle.setback,
        # Where there is less room than the shortest side of a stone, none comes.
        room_px=min((shorter for shorter, _ in stock.sides.values()), default=0) / site.scale,
        rest=settle.margin,
        steep=settle.steep,
    )


def fitting_stones(
    stones: StoneSet, site: Site, settings: PlannerSettings, book: PoseBook | None = None
) -> tuple[int, ...]:
    """Return the ids of the stones that can be built with: not banned, and the wall has room.

    `book`, at the resolution of the site, keeps the poses that are looked at.  UsageError: E120: a
    stone fits into the wall in no orientation, and is not to be skipped; E126: there are no
    stones; E137: no ids are left for wedges; E145: a stone is banned or pinned that does not exist.
    """
    if not len(stones):
        what = "there are no stones to build with."
        cure = "See what was left out when the stones were read."
        raise UsageError("E126", what, where=stones.source.path, cure=cure)
    book = book or PoseBook(site.scale)
    banned = _known(stones, settings)
    usable = [s for s in stones if s.id not in banned]
    # Most stones fit in the first pose; the other poses are then not made.
    fitting = tuple(
        s.id
        for s in usable
        if any(_has_room(site, book.pose(s, a)) for a in book.angles(s, settings.orientations))
    )
    too_large = sorted({s.id for s in usable}.difference(fitting))
    if too_large and not settings.skip_too_large:
        raise UsageError(
            "E120",
            f"no orientation of stone{'s' * (len(too_large) > 1)} "
            f"{', '.join(map(str, too_large))} fits into the wall of "
            f"{site.width_px} x {site.height_px} working px.",
            where="--wall",
            cure="Leave them out with --skip-too-large, or build a larger wall."
            if fitting
            else "Build a larger wall: no stone fits into this one.",
        )
    largest = stones.stones[-1].id
    if largest + 2 * len(stones) >= 2**32 - 1:  # each stone may get two wedges
        what = f"stone {largest} leaves no ids for wedges, which are numbered after the largest id."
        cure = "Renumber the stones with smaller ids."
        raise UsageError("E137", what, where=stones.source.path, cure=cure)
    return fitting


def _has_room(site: Site, posed: PosedStone) -> bool:
    return posed.width_px <= site.width_px and posed.height_px <= site.height_px


def _known(stones: StoneSet, settings: PlannerSettings) -> frozenset[int]:
    """Return which stones are banned; those that are named must exist (E145)."""
    ids = {stone.id for stone in stones}
    for name, asked in (("ban", settings.ban), ("pin", settings.pin)):
        unknown = sorted(set(asked) - ids)
        if unknown:
            what = f"there is no stone {', '.join(map(str, unknown))}."
            cure = "`drystone stones` lists the ids."
            raise UsageError("E145", what, where=f"--{name}", cure=cure)
    return frozenset(settings.ban)
