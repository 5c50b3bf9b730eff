"""Head joints that go on above each other."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely

from drystone.craft.finding import Line
from drystone.craft.joints import Joint

if TYPE_CHECKING:
    from drystone.craft.masonry import Masonry


@dataclass(frozen=True, eq=False)
class Chain:
    """Head joints that form one joint, from the lowest to the highest.

    Parameters
    ----------
    joints : tuple of Joint
        At least one.
    """

    joints: tuple[Joint, ...]

    @property
    def left(self) -> tuple[int, ...]:
        """Stones on its left side, upwards."""
        return tuple(dict.fromkeys(joint.first for joint in self.joints))

    @property
    def right(self) -> tuple[int, ...]:
        """Stones on its right side, upwards."""
        return tuple(dict.fromkeys(joint.second for joint in self.joints))

    @property
    def courses(self) -> int:
        """Through how many courses it goes: the lesser number of stones on a side."""
        return min(len(self.left), len(self.right))

    @property
    def height(self) -> float:
        """From its lower to its upper end."""
        return float(self.joints[-1].top[1] - self.joints[0].bottom[1])

    @property
    def line(self) -> Line:
        """Its middle, upwards."""
        return np.concatenate(
            [np.vstack([joint.bottom, joint.points, joint.top]) for joint in self.joints]
        )


def chains(masonry: "Masonry") -> tuple[Chain, ...]:
    """Join the head joints that go on above each other.

    A joint goes on when the next one begins no farther to the side than the offset of the
    settings and no farther above than a hole, and no stone lies between them.  Where several
    could go on, the one straight above does.

    Parameters
    ----------
    masonry : Masonry
        Any wall.

    Returns
    -------
    tuple of Chain
        Every head joint is in one; from left to right by their lower ends.
    """
    heads = masonry.heads
    above: dict[int, int] = {}
    below: dict[int, int] = {}
    for _, lower, upper in sorted(_links(masonry)):
        if lower not in above and upper not in below:
            above[lower], below[upper] = upper, lower
    found = []
    for index in range(len(heads)):
        if index not in below:
            place, chain = index, [index]
            while place in above:
                place = above[place]
                chain.append(place)
            found.append(Chain(tuple(heads[i] for i in chain)))
    return tuple(found)


def _links(masonry: "Masonry") -> list[tuple[tuple[float, float], int, int]]:
    """Return how far apart two joints are that may be one, and their indices, lower first."""
    heads = masonry.heads
    if not heads:
        return []
    settings, height = masonry.settings, masonry.mean_height
    bottoms = np.array([joint.bottom for joint in heads])
    tops = np.array([joint.top for joint in heads])
    aside, up = (1e-9 + settings.offset) * height, (1e-9 + settings.hole) * height
    # The ends of two joints that meet overlap by the rounding of stones to lines of the scan.
    low, high = tops - (aside, 2.5 * masonry.rows.spacing), np.add(tops, (aside, up))
    near = shapely.STRtree(shapely.points(bottoms)).query(shapely.box(*low.T, *high.T))
    stones = shapely.STRtree(list(masonry.shapes.values()))
    ids = list(masonry.shapes)
    found = []
    for lower, upper in near.T.tolist():
        if lower == upper or not _climbs(heads[lower], heads[upper]):
            continue
        way = shapely.LineString([tops[lower], bottoms[upper]])
        beside = {ids[i] for i in stones.query(way)}
        if not _crossed(masonry, way, heads[lower], heads[upper], beside):
            across, along = np.abs(bottoms[upper] - tops[lower]).tolist()
            cost = round(across / height, 6), round(along / height, 6)
            found.append((cost, lower, upper))
    return found


def _crossed(
    masonry: "Masonry", way: shapely.LineString, lower: Joint, upper: Joint, near: set[int]
) -> bool:
    """Whether one of the stones near the way from one joint to the other lies on it.

    The way may cut corners of the stones of the joints, as far to the side as they may be apart.
    Any other stone on it lies between them, as far as the scan tells it from a touch: each end of
    the way may lie half a line too high or low.
    """
    four = {lower.first, lower.second, upper.first, upper.second}
    spacing = masonry.rows.spacing
    of_joints = masonry.settings.offset * masonry.mean_height + 2.5 * spacing
    own = shapely.union_all([masonry.shapes[i] for i in four])
    if shapely.intersection(own, way).length > of_joints:
        return True
    others = [masonry.shapes[i] for i in near - four]
    return bool((shapely.length(shapely.intersection(others, way)) > 0.75 * spacing).any())


def _climbs(lower: Joint, upper: Joint) -> bool:
    """Whether a joint lies above another, rather than beside it with the sides changed over."""
    return lower.first != upper.second and lower.second != upper.first
