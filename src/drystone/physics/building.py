"""A wall built up stone by stone in a rigid-body engine: what moves, and what falls."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from drystone.kernels.polygons import Points
from drystone.physics.scatter import TiltResult, Variation, tilt_test
from drystone.physics.scene import EngineScene, EngineSettings
from drystone.physics.table import TiltingTable
from drystone.physics.tilt import TiltSettings

Group = Sequence[tuple[int, Points]]
"""A stone and its wedges, which come together: ids and corners in the wall frame, source px."""

ROUNDED = EngineSettings(slop=3e-3, corner_radius=3e-3)
"""Corners of stones are rounded, and stones may sink into each other, by .003 L.

The engine finds rounded polygons by the distance of their cores, sharp ones by their overlap, and
that fails where two faces touch exactly (measured: a contact said to be 2 L deep, which throws a
stone by .1 L).  For stones of 50 px it is .15 px, about the contact tolerance.
"""


@dataclass(frozen=True)
class BuildSettings:
    """How a wall is built up; lengths in mean block sizes L, times in sqrt(L / g)."""

    engine: EngineSettings = ROUNDED  # how the engine is driven
    # A block has fallen when a point of it has moved by more than this share of its size, the
    # square root of its area; a wedge, when by more than this share of its stone's size.
    moved_share: float = 0.1
    turned_deg: float = 10.0  # or when it has turned by more than this
    # The blocks rest when no point of any has moved by more than this for so long.
    resting_move: float = 3e-4
    resting_time: float = 1.0
    # A block is brought apart from what it overlaps by so much of its size at most; what is left
    # the engine pushes apart.
    apart_share: float = 0.2
    # Time after every stone.  When blocks still move then the next one comes.
    longest_rest: float = 10.0
    look_every: float = 0.25  # time between two looks at the blocks


@dataclass(frozen=True)
class BlockMove:
    """What became of one block."""

    id: int
    # Largest distance of any point of it from where it was planned, over its whole life.
    move_px: float
    share: float  # the same over the size (square root of the area) of the stone of its group
    turn_deg: float  # largest turn over its whole life, either way
    # How deep it lay in others, or in the ground, when it was put where it was planned.
    overlap_px: float
    fell: bool  # it moved or turned by more than the settings allow


@dataclass(frozen=True, eq=False)
class BuildUp:
    """A wall as it stands, or lies, when its last stone has come to rest."""

    moves: tuple[BlockMove, ...]  # in the order of placement
    # (n, 2), corners of every block where it ended, source px, wall frame, counter-clockwise,
    # not closed.
    outlines: dict[int, Points]
    # By group: how far a block at most was from its planned place when the group came.
    found_moved_px: tuple[float, ...]
    restless: tuple[int, ...]  # numbers of the groups after which the engine did not come to rest
    first_fall: int | None  # number of the group after which the first block had fallen
    mu: float

    @property
    def fallen(self) -> tuple[int, ...]:
        """Ids of the blocks that fell, in the order of placement."""
        return tuple(move.id for move in self.moves if move.fell)

    @property
    def stands(self) -> bool:
        """Nothing fell."""
        return not self.fallen

    @property
    def rests(self) -> bool:
        """The engine came to rest after the last stone."""
        return len(self.found_moved_px) not in self.restless


def build_up(
    groups: Sequence[Group],
    mu: float = 0.58,
    settings: BuildSettings | None = None,
    *,
    on_group: Callable[[int], None] | None = None,
) -> BuildUp:
    """Put stones on a level ground one after the other and let each come to rest.

    Every block comes where it was planned, whatever those before it have done since, and is brought
    apart from what it overlaps there.  Groups come in the order of placement, the stone of each
    first; `on_group` is told the number of those that stand.
    """
    settings = settings or BuildSettings()
    if not any(groups):
        return BuildUp((), {}, (0.0,) * len(groups), (), None, mu)
    scene = EngineScene({block: corners for group in groups for block, corners in group}, mu)
    table = TiltingTable(scene, settings.engine, placed=())
    table.tilt(0.0)
    watch = Watch(scene)
    found_moved, restless, first_fall = [], [], None
    overlaps = dict.fromkeys(scene.shapes, 0.0)
    for number, group in enumerate(groups, 1):
        found_moved.append(watch.look(table))
        for block, _ in (*group[1:], *group[:1]):  # wedges come before their stone
            deep = table.put_down(scene, block, settings.apart_share)
            overlaps[block] = deep * scene.length
        if not _rest(table, watch, settings):
            restless.append(number)
        if first_fall is None:
            moves = _moves(groups, watch, scene, overlaps, settings)
            first_fall = number if any(move.fell for move in moves) else None
        if on_group is not None:
            on_group(number)
    return BuildUp(
        moves=tuple(_moves(groups, watch, scene, overlaps, settings)),
        outlines=watch.outlines(table),
        found_moved_px=tuple(found_moved),
        restless=tuple(restless),
        first_fall=first_fall,
        mu=mu,
    )


class Watch:
    """Keeps the largest movement and turn of every block on a table from where it was planned.

    Its free blocks may come onto the table in any order.
    """

    def __init__(self, scene: EngineScene) -> None:
        self._length = scene.length
        self._arms: dict[int, Points] = {}
        self._centres: dict[int, Points] = {}
        for block, shape in scene.shapes.items():
            self._centres[block] = np.array(shape.centroid.coords[0])
            self._arms[block] = shapely.get_coordinates(shape)[:-1] - self._centres[block]
        self.moves = dict.fromkeys(scene.shapes, 0.0)  # of any point, in the unit of the scene
        self.turns_deg = dict.fromkeys(scene.shapes, 0.0)

    def look(self, table: TiltingTable) -> float:
        """Take note of where the blocks are; return how far any is from its place at most."""
        furthest = 0.0
        for block, corners, turn in self._now(table):
            way = corners - self._arms[block] - self._centres[block]
            # Of all points of a rigid body a corner moves furthest.
            move = float(np.hypot(*way.T).max())
            self.moves[block] = max(self.moves[block], move)
            self.turns_deg[block] = max(self.turns_deg[block], float(abs(np.degrees(turn))))
            furthest = max(furthest, move)
        return furthest

    def outlines(self, table: TiltingTable) -> dict[int, Points]:
        """Return the corners of every block on the table where it is now."""
        return {block: corners for block, corners, _ in self._now(table)}

    def _now(self, table: TiltingTable) -> Iterator[tuple[int, Points, float]]:
        for block, (x, y, turn) in zip(table.ids, table.poses().tolist(), strict=True):
            cos, sin = np.cos(turn), np.sin(turn)
            turned = self._arms[block] @ np.array([[cos, sin], [-sin, cos]])
            yield block, turned + np.array([x, y]) * self._length, turn


QUICK = Variation("quick", ROUNDED, TiltSettings(coarse=0.064, fine=0.004, longest_hold=20.0))
"""One tilt test for a check: within .01 of one with a quarter of the steps and twice the time to
come to rest, in half its time; fewer iterations or shorter holds were off by .1 (measured)."""


def tilt_of(
    built: BuildUp, variations: Sequence[Variation] = (QUICK,)
) -> tuple[TiltResult, TiltResult] | None:
    """Tilt a finished wall from where it came to rest, to the left and to the right.

    None for a wall that fell, moves on, or is empty.
    """
    if not (built.stands and built.rests and built.outlines):
        return None
    scene = EngineScene(built.outlines, built.mu)
    left = tilt_test(scene, "left", np.random.default_rng(0), variations)
    return left, tilt_test(scene, "right", np.random.default_rng(0), variations)


def _rest(table: TiltingTable, watch: Watch, settings: BuildSettings) -> bool:
    """Let time pass until the blocks rest; say whether they do."""
    poses = [table.poses()]
    back = max(1, round(settings.resting_time / settings.look_every))
    for _ in range(round(settings.longest_rest / settings.look_every)):
        table.advance(settings.look_every)
        watch.look(table)
        poses.append(table.poses())
        if len(poses) > back and table.shifts(poses[-1 - back]).max() <= settings.resting_move:
            return True
    return False


def _moves(
    groups: Sequence[Group],
    watch: Watch,
    scene: EngineScene,
    overlaps: Mapping[int, float],
    settings: BuildSettings,
) -> list[BlockMove]:
    """Say what has become of the blocks; those that have not been placed have not moved."""
    moves = []
    for group in groups:
        size = scene.shapes[group[0][0]].area ** 0.5
        for block, _ in group:
            move, turn = watch.moves[block], watch.turns_deg[block]
            fell = move > settings.moved_share * size or turn > settings.turned_deg
            moves.append(BlockMove(block, move, move / size, turn, overlaps[block], fell))
    return moves


def stays(built: Group, group: Group, mu: float = 0.58) -> bool:
    """Say whether a stone and its wedges stay where they are put on blocks that do not move."""
    scene = EngineScene(dict([*built, *group]), mu, fixed=frozenset(block for block, _ in built))
    settings = BuildSettings()
    table, watch = TiltingTable(scene, settings.engine), Watch(scene)
    table.tilt(0.0)
    if not _rest(table, watch, settings):
        return False
    moves = _moves([group], watch, scene, dict.fromkeys(scene.shapes, 0.0), settings)
    return not any(move.fell for move in moves)
