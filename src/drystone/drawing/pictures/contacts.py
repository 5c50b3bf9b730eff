"""The contacts of a rigid block model: interfaces, their ends and normals (Pic-to-Ri)."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from drystone.drawing.canvas import draw
from drystone.drawing.drawing import Area, Dots, Drawing, Lines
from drystone.drawing.outlines import Loop, wall_regions
from drystone.drawing.wall import pale_wall, size_of
from drystone.model.wall import Labels
from drystone.statics.failing.kinematics import ContactKind
from drystone.statics.model import RigidBlockModel

JOINT, NORMAL, POINT = "#0072b2", "#d55e00", "#8b0000"

KIND_COLOURS: dict[ContactKind, str] = {
    "closed": JOINT,
    "opening": "#e69f00",
    "sliding": "#cc79a7",
    "opening and sliding": "#000000",
}
"""Okabe and Ito's colours, apart for colour-blind readers."""

NORMAL_SHARE = 0.03
"""Length of a normal over the height of the wall, at most; that of a short interface is half as
long as the interface, but no less than a third of this."""


def plot_contacts(
    wall: Labels | Mapping[int, Loop],
    model: RigidBlockModel,
    ax: Axes | None = None,
    *,
    kinds: Sequence[ContactKind] | None = None,
) -> Axes:
    """Draw where blocks touch: interfaces as lines with their end points and normals."""
    if kinds is not None and len(kinds) != model.contact_count:
        raise ValueError(f"{len(kinds)} kinds for {model.contact_count} contact points")
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
    if kinds is None:
        dots = [
            Dots("end of an interface", points[~alone], JOINT, 2.4),
            Dots("contact at a point", points[alone], POINT, 4.0),
        ]
    else:
        told = np.array(kinds, str)
        dots = [Dots(kind, points[told == kind], c, 3.6) for kind, c in KIND_COLOURS.items()]
    faces, inward = Lines("interfaces", lines, JOINT, 1.3), Lines("normals", normals, NORMAL, 0.8)
    legend: dict[str, Area | Lines | Dots]
    legend = {"interface": faces, "normal": inward, **{one.name: one for one in dots}}
    return draw(Drawing((*pale.items, faces, inward, *dots), pale.box, legend=legend), ax)
