"""A wall as stones, joints and beds."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import shapely

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.outlines import outlines_of_labels
from drystone.craft.joints import Chain, Joint, Scan, StoneSides, joints, profiles, scan
from drystone.craft.settings import CraftSettings
from drystone.errors import InputError, UsageError
from drystone.kernels.polygons import Points, Polygons, area_and_centroid, no_polygons
from drystone.model.wall import Labels
from drystone.statics.model import RigidBlockModel

LONGEST = 4000, 12
"""Mean heights of stones over which a wall and its stones may reach, and more for each stone: the
lines that cut it, and what they cut, take as much memory and time."""


@dataclass(frozen=True, eq=False)
class Masonry:
    """A wall of any origin, as the rules look at it.

    UsageError (E191): a wedge is not in the wall.  InputError (E192), when the rules look at it:
    the wall is too long for the height of its stones.

    Examples
    --------
    >>> brick = np.array([[0, 0], [2, 0], [2, 1], [0, 1]])
    >>> pair = Masonry({1: brick, 2: brick + [2, 0]})
    >>> [(joint.first, joint.second) for joint in pair.heads], pair.mean_height
    ([(1, 2)], 1.0)
    """

    # corners of stones and wedges by id, wall frame, y up, either way round, closed or not
    outlines: Mapping[int, Points]
    model: RigidBlockModel | None = None  # contacts, where they are known; None for a drawn wall
    wedge_ids: Collection[int] = frozenset()  # which of them are wedges
    # step of the plan that places a stone or wedge; empty for what is no plan
    steps: Mapping[int, int] = field(default_factory=dict)
    # what counts as a joint, a bearing and so on
    settings: CraftSettings = field(default_factory=CraftSettings)
    # wedges are the outlines to which they shall be cut, as in plans on outlines; otherwise they
    # are small stones or pixels, and their shape is not judged
    cut: bool = False
    per_m: float | None = None  # units of length in a metre, where that is known

    def __post_init__(self) -> None:
        strangers = sorted(set(self.wedge_ids) - set(self.outlines))
        if strangers:
            what = f"the wall has no {', '.join(map(str, strangers))}, said to be wedges."
            cure = "Name ids of the label image or block model."
            raise UsageError("E191", what, where="wedges", cure=cure)

    @classmethod
    def from_labels(
        cls,
        labels: Labels,
        wedge_ids: Collection[int] = frozenset(),
        *,
        steps: Mapping[int, int] | None = None,
        mu: float = 0.58,
    ) -> "Masonry":
        """Return the wall of a label image, row 0 at the top, along sub-pixel outlines.

        `steps` are those of a plan, by label; `mu` is for what wedges carry.  UsageError (E191): a
        label that is said to be a wedge is not in the image.
        """
        picture = model_from_labels(labels, mu)
        outlines = outlines_of_labels(labels[: picture.ground_row]) if picture.model.blocks else {}
        return cls(outlines, picture.model, wedge_ids, steps or {})

    @cached_property
    def loops(self) -> Mapping[int, Points]:
        """Outlines by ascending id, counter-clockwise, not closed."""
        return {i: _open(np.asarray(self.outlines[i], float)) for i in sorted(self.outlines)}

    @cached_property
    def stones(self) -> Mapping[int, Points]:
        """The loops of stones alone."""
        wedges = set(self.wedge_ids)
        return {i: loop for i, loop in self.loops.items() if i not in wedges}

    @cached_property
    def shapes(self) -> Mapping[int, shapely.Geometry]:
        """The stones as shapes; outlines of pixels may pass a corner twice."""
        return {i: shapely.Polygon(loop).buffer(0) for i, loop in self.stones.items()}

    @cached_property
    def boxes(self) -> Mapping[int, tuple[float, float, float, float]]:
        """x0, y0, x1, y1 of every stone and wedge."""
        return {
            i: (*loop.min(axis=0).tolist(), *loop.max(axis=0).tolist())
            for i, loop in self.loops.items()
        }

    @cached_property
    def areas(self) -> Mapping[int, float]:
        """Of stones and wedges."""
        return {i: area_and_centroid(loop)[0] for i, loop in self.loops.items()}

    @cached_property
    def centroids(self) -> Mapping[int, tuple[float, float]]:
        """Of stones and wedges."""
        return {i: area_and_centroid(loop)[1:] for i, loop in self.loops.items()}

    @cached_property
    def polygons(self) -> Polygons:
        """All stones and wedges in one array."""
        return no_polygons().added(self.loops.values())

    @cached_property
    def box(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1 of the stones; zeros when there are none."""
        if not self.stones:
            return 0.0, 0.0, 0.0, 0.0
        points = np.concatenate(list(self.stones.values()))
        (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
        return x0, y0, x1, y1

    @cached_property
    def mean_height(self) -> float:
        """Of the upright boxes of the stones; 1 when there are none."""
        return self._mean_side(1)

    @cached_property
    def mean_width(self) -> float:
        """Of the upright boxes of the stones; 1 when there are none."""
        return self._mean_side(0)

    def _mean_side(self, axis: int) -> float:
        sides = [self.boxes[i][2 + axis] - self.boxes[i][axis] for i in self.stones]
        return float(np.mean(sides)) if sides else 1.0

    @cached_property
    def rows(self) -> Scan:
        """What lies on level lines."""
        return self._scan(0)

    @cached_property
    def columns(self) -> Scan:
        """What lies on upright lines."""
        return self._scan(1)

    @cached_property
    def profiles(self) -> Mapping[int, StoneSides]:
        """The lower and the upper sides of the stones."""
        return profiles(self.columns, self.stones, self.box[1])

    def _scan(self, axis: int) -> Scan:
        """Cut the wall by lines; refuse a wall of which lines without end would tell nothing."""
        places = [loop[:, 1 - axis] for loop in self.loops.values()]
        if places:
            ways = sum(float(np.abs(one - np.roll(one, 1)).sum()) for one in places) / 2.0
            extent = (float(np.ptp(np.concatenate(places))) + ways) / self.mean_height
            if extent > LONGEST[0] + LONGEST[1] * len(places):
                raise InputError(
                    "E192",
                    f"it reaches over {extent:.2g} mean heights of its {len(places)} stones,"
                    " which is not a wall that rules could judge.",
                    where="wall",
                    cure="Leave out what lies far from the wall, and what is not a stone.",
                )
        return scan(self.loops, axis, self.settings.sample * self.mean_height)

    @cached_property
    def heads(self) -> tuple[Joint, ...]:
        """Head joints: between a stone and the one to the right of it."""
        return joints(self.rows, 0, self.settings.slot * self.mean_height, self.stones)

    @cached_property
    def beds(self) -> tuple[Joint, ...]:
        """Bed joints: between a stone and the one above it."""
        return joints(self.columns, 1, self.settings.joint * self.mean_height, self.stones)

    @cached_property
    def chains(self) -> tuple[Chain, ...]:
        """The head joints, those that go on above each other joined to one.

        A joint goes on when the next one begins no farther to the side than the offset of the
        settings and no farther above than a hole, and no stone lies between them.  Where several
        could go on, the one straight above does.
        """
        above: dict[int, int] = {}
        below: dict[int, int] = {}
        for _, lower, upper in sorted(_links(self)):
            if lower not in above and upper not in below:
                above[lower], below[upper] = upper, lower
        found = []
        for index in range(len(self.heads)):
            if index not in below:
                chain = [index]
                while chain[-1] in above:
                    chain.append(above[chain[-1]])
                found.append(Chain(tuple(self.heads[i] for i in chain)))
        return tuple(found)

    @cached_property
    def supports(self) -> Mapping[int, tuple[tuple[int, float, float], ...]]:
        """Id, left and right end of the beds that each stone rests on, from left to right.

        Beds narrower than the least bearing are left out; the ground is not among them.
        """
        found: dict[int, dict[int, list[Joint]]] = {i: {} for i in self.stones}
        for bed in self.beds:
            found[bed.second].setdefault(bed.first, []).append(bed)
        supports = {}
        for stone, beds in found.items():
            least = self.settings.bearing * (self.boxes[stone][2] - self.boxes[stone][0])
            wide = [
                (lower, float(pieces[0].points[0, 0]), float(pieces[-1].points[-1, 0]))
                for lower, pieces in beds.items()
                if sum(bed.length for bed in pieces) >= least * (1.0 - 1e-9)
            ]
            supports[stone] = tuple(sorted(wide, key=lambda one: one[1] + one[2]))
        return supports

    @cached_property
    def on_ground(self) -> frozenset[int]:
        """Stones of the foot: nothing but a joint is between them and the ground."""
        ground, widest = self.box[1], self.settings.joint * self.mean_height
        counts = dict.fromkeys(self.stones, 0)
        for runs in self.columns.runs:
            first = next((run for run in runs if run.id in counts), None)
            if first is not None and first.begin - ground <= widest:
                counts[first.id] += 1
        return frozenset(
            i
            for i, count in counts.items()
            if count * self.columns.spacing
            >= self.settings.bearing * (self.boxes[i][2] - self.boxes[i][0])
        )

    @cached_property
    def ends(self) -> tuple[frozenset[int], frozenset[int]]:
        """Stones at the left and at the right end: outermost in at least half of their rows."""
        total = dict.fromkeys(self.stones, 0)
        outermost = (dict(total), dict(total))
        for runs in self.rows.runs:
            ids = [run.id for run in runs if run.id in total]
            for i in set(ids):
                total[i] += 1
            if ids:
                outermost[0][ids[0]] += 1
                outermost[1][ids[-1]] += 1
        left, right = (
            frozenset(i for i, count in side.items() if total[i] and 2 * count >= total[i])
            for side in outermost
        )
        return left, right

    def name(self, stone: int) -> str:
        """Return what a stone is called: with its step when there is a plan.

        Examples
        --------
        >>> Masonry({7: np.eye(3, 2)}, steps={7: 3}).name(7)
        '7 (step 3)'
        """
        step = self.steps.get(stone)
        return str(stone) if step is None else f"{stone} (step {step})"


def _open(loop: Points) -> Points:
    if len(loop) > 1 and (loop[0] == loop[-1]).all():
        loop = loop[:-1]
    return loop if area_and_centroid(loop)[0] >= 0 else loop[::-1]


def _links(masonry: Masonry) -> list[tuple[tuple[float, float], int, int]]:
    """Return how far apart two joints are that may be one, and their indices, lower first."""
    heads = masonry.heads
    if not heads:
        return []
    settings, height = masonry.settings, masonry.mean_height
    bottoms = np.array([joint.points[0] for joint in heads])
    tops = np.array([joint.points[-1] for joint in heads])
    aside, up = (1e-9 + settings.offset) * height, (1e-9 + settings.hole) * height
    # The ends of two joints that meet overlap by the rounding of stones to lines of the scan.
    low, high = tops - (aside, 2.5 * masonry.rows.spacing), np.add(tops, (aside, up))
    near = shapely.STRtree(shapely.points(bottoms)).query(shapely.box(*low.T, *high.T))
    stones = shapely.STRtree(list(masonry.shapes.values()))
    ids = list(masonry.shapes)
    found = []
    for lower, upper in near.T.tolist():
        one, other = heads[lower], heads[upper]
        # Else the joints are beside each other with the sides changed over.
        climbs = one.first != other.second and one.second != other.first
        if lower == upper or not climbs:
            continue
        way = shapely.LineString([tops[lower], bottoms[upper]])
        four = {one.first, one.second, other.first, other.second}
        if not _crossed(masonry, way, four, {ids[i] for i in stones.query(way)}):
            across, along = np.abs(bottoms[upper] - tops[lower]).tolist()
            cost = round(across / height, 6), round(along / height, 6)
            found.append((cost, lower, upper))
    return found


def _crossed(masonry: Masonry, way: shapely.LineString, four: set[int], near: set[int]) -> bool:
    """Whether one of the stones near the way from one joint to another lies on it.

    The way may cut corners of the stones of the joints, as far to the side as they may be apart.
    Any other stone on it lies between them, as far as the scan tells it from a touch: each end of
    the way may lie half a line too high or low.
    """
    spacing = masonry.rows.spacing
    of_joints = masonry.settings.offset * masonry.mean_height + 2.5 * spacing
    own = shapely.union_all([masonry.shapes[i] for i in four])
    if shapely.intersection(own, way).length > of_joints:
        return True
    others = [masonry.shapes[i] for i in near - four]
    return bool((shapely.length(shapely.intersection(others, way)) > 0.75 * spacing).any())
