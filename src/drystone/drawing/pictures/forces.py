"""The contacts of a rigid block model (Pic-to-Ri), and the thrust that carries a wall."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import floor, log10

import numpy as np
from matplotlib.axes import Axes
from matplotlib.transforms import ScaledTranslation

from drystone.drawing.canvas import draw, draw_legend
from drystone.drawing.drawing import Dots, Drawing, Lines, Surface, pale_wall, size_of
from drystone.drawing.outlines import Loop, wall_regions
from drystone.kernels.raster import Floats
from drystone.model.wall import Labels
from drystone.statics.model import GROUND, Interface, RigidBlockModel

JOINT, NORMAL, POINT = "#0072b2", "#d55e00", "#8b0000"

NORMAL_SHARE = 0.03
"""Length of a normal over the height of the wall, at most; that of a short interface is half as
long as the interface, but no less than a third of this."""


def plot_contacts(
    wall: Labels | Mapping[int, Loop], model: RigidBlockModel, ax: Axes | None = None
) -> Axes:
    """Draw where blocks touch: interfaces as lines with their end points and normals.

    The wall is a label image, row 0 at the top, or polygons by id, and the model is of it; the axes
    are in px of the image or the unit of the polygons, y up from the ground.  ValueError when the
    model has a block that the wall does not have.
    """
    regions = wall_regions(wall)
    pale = pale_wall(regions, model)
    lines = [interface.points for interface in model.interfaces if len(interface.points) > 1]
    longest, normals = NORMAL_SHARE * size_of(regions), []
    for face in model.interfaces:
        middle, length = face.points.mean(axis=0), max(0.5 * face.length, longest / 3.0)
        normals.append(np.array([middle, middle + min(longest, length) * np.array(face.normal)]))
    points = np.concatenate([np.empty((0, 2)), *(i.points for i in model.interfaces)])
    counts = np.array([len(interface.points) for interface in model.interfaces], np.int64)
    alone = np.repeat(counts == 1, counts)
    dots = [
        Dots("end of an interface", points[~alone], JOINT, 2.4),
        Dots("contact at a point", points[alone], POINT, 4.0),
    ]
    faces, inward = Lines("interfaces", lines, JOINT, 1.3), Lines("normals", normals, NORMAL, 0.8)
    legend: dict[str, Surface | Lines | Dots]
    legend = {"interface": faces, "normal": inward, **{one.name: one for one in dots}}
    return draw(Drawing((*pale.items, faces, inward, *dots), pale.box, legend=legend), ax)


RESULTANT, NETWORK = "#8b0000", "#56b4e9"

LONGEST_SHARE = 0.22  # length of the largest resultant over the height of the wall
WIDEST_PT = 9.0  # width of the line of thrust that carries the largest resultant
RESULTANT_PT = 1.2

LEAST_SHARE = 1e-6  # smaller resultants over the largest one are none
VISIBLE_SHARE = 0.01
"""The points of action of smaller resultants are not marked: dots would look like forces."""


@dataclass(frozen=True, eq=False)
class Resultant:
    """What an interface carries: the force on the block that its normal points into.

    The line of the force crosses that of the interface at `point`.
    """

    interface: Interface
    point: Floats
    force: Floats

    @property
    def size(self) -> float:
        """Length of the force."""
        return float(np.hypot(*self.force))

    def line(self, per_weight: float) -> Loop:
        """Return both ends of the force, drawn to a scale with its middle at the point."""
        half = 0.5 * per_weight * self.force
        return np.array([self.point - half, self.point + half])


def resultants(model: RigidBlockModel, forces: Floats) -> tuple[Resultant, ...]:
    """Add up the forces at the contact points of every interface that carries anything.

    `forces` are normal and tangential, (m, 2), as in
    :attr:`drystone.statics.result.LimitResult.forces`.
    """
    if len(forces) != model.contact_count:
        raise ValueError(f"{len(forces)} forces for {model.contact_count} contact points")
    ends = np.cumsum([0, *(len(interface.points) for interface in model.interfaces)])
    found = [
        _resultant(interface, forces[start:end])
        for interface, start, end in zip(model.interfaces, ends[:-1], ends[1:], strict=True)
    ]
    least = LEAST_SHARE * max((one.size for one in found), default=0.0)
    return tuple(one for one in found if one.size > least)


def _resultant(interface: Interface, forces: Floats) -> Resultant:
    x, y = interface.normal
    vectors = forces @ np.array([[x, y], [y, -x]])
    total = vectors.sum(axis=0)
    first, along = interface.points[0], interface.points[-1] - interface.points[0]
    arms = interface.points - first
    moment = float((arms[:, 0] * vectors[:, 1] - arms[:, 1] * vectors[:, 0]).sum())
    across = float(along[0] * total[1] - along[1] * total[0])
    # A force along its interface acts at no one point of it; the middle is as good as any.
    share = moment / across if across else 0.5
    return Resultant(interface, first + share * along, total)


def plot_forces(
    wall: Labels | Mapping[int, Loop],
    model: RigidBlockModel,
    forces: Floats,
    ax: Axes | None = None,
    *,
    weight: float | None = None,
) -> Axes:
    """Draw the thrust: the resultant of every interface, and how it runs from block to block.

    A dark red line through the point of action of each resultant has its direction and, to scale,
    its length; half of it lies on either side of the joint.  A blue line joins the points of action
    with the centroids of the two blocks, as wide as the force is large, also to scale.  Wall and
    axes are as in :func:`plot_contacts`, the (m, 2) forces as in :func:`resultants`; ValueError
    when they are not those of the model.  `weight` is that of the wall where the model has more, as
    of a support that settles (:func:`drystone.statics.loads.support_settlement`).
    """
    acting, regions = resultants(model, forces), wall_regions(wall)
    largest = max((one.size for one in acting), default=0.0)
    if largest == 0.0:
        return draw(pale_wall(regions, model), ax)
    per_weight = LONGEST_SHARE * size_of(regions) / largest
    lines = [one.line(per_weight) for one in acting]
    pale = pale_wall(regions, model, lines)
    # From centroid to point of action to centroid.
    middle = {block.id: np.array(block.centroid) for block in model.blocks}
    paths = [
        np.array([middle[one.interface.block], one.point,
                  *([middle[one.interface.other]] if one.interface.other != GROUND else [])])
        for one in acting
    ]  # fmt: skip
    widths = [WIDEST_PT * one.size / largest for one in acting]
    seen = np.array([one.point for one in acting if one.size >= VISIBLE_SHARE * largest])
    items = (
        *pale.items,
        Lines("thrust", paths, NETWORK, widths),
        Lines("resultants", lines, RESULTANT, RESULTANT_PT),
        Dots("points-of-action", seen, RESULTANT, 1.8),
    )
    ax = draw(Drawing(items, pale.box), ax)
    _draw_scale(ax, model, per_weight, largest, weight)
    return ax


def _draw_scale(
    ax: Axes, model: RigidBlockModel, per_weight: float, largest: float, weight: float | None
) -> None:
    """Draw a bar for a round number of mean block weights, as long and as wide as its force."""
    weights = [block.weight for block in model.blocks if not block.fixed]
    mean = sum(weights) / len(weights)
    count = round_number(0.6 * largest / mean)
    force = count * mean
    left = ax.get_xlim()[0]
    right = left + per_weight * force
    below = ax.get_xaxis_transform() + ScaledTranslation(0.0, -0.125, ax.figure.dpi_scale_trans)
    for colour, width, gid in (
        (NETWORK, WIDEST_PT * force / largest, "scale-width"),
        (RESULTANT, RESULTANT_PT, "scale-length"),
    ):
        ax.plot(
            [left, right], [0, 0], color=colour, linewidth=width, transform=below, clip_on=False,
            solid_capstyle="butt", gid=gid,
        )  # fmt: skip
    share = 100.0 * force / (weight or sum(weights))
    text = f"{count:g} \u00d7 the mean weight of a block = {share:.2g} % of the wall's weight"
    ax.annotate(
        text, (right, 0.0), (6, 0), xycoords=below, textcoords="offset points", size=7, va="center"
    )
    legend = {
        "thrust, as wide as the force": Lines("", [], NETWORK, 4.0),
        "resultant, as long": Lines("", [], RESULTANT, RESULTANT_PT),
    }
    draw_legend(ax, legend)


def round_number(most: float) -> float:
    """Return the largest of 1, 2, 5, 10, 20 ... (and .5, .2 ...) that is not above `most`.

    >>> round_number(7.3), round_number(0.3), round_number(20.0)
    (5.0, 0.2, 20.0)
    """
    power = 10.0 ** floor(log10(most))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= most * (1 + 1e-12))
