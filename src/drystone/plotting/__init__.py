"""Pictures of stones, walls, mechanisms and joints: ``plot_x(thing, ax=None) -> Axes``.

Only this room and :mod:`drystone.report` know how anything looks.  Figures are made without
pyplot, so nothing global changes and no window opens.
"""

from drystone.plotting.files import save, write_pictures
from drystone.plotting.joints import plot_joint_paths
from drystone.plotting.mechanism import plot_mechanism
from drystone.plotting.outlines import wall_outlines
from drystone.plotting.stones import plot_labels, plot_stones
from drystone.plotting.wall import plot_wall

__all__ = [
    "plot_joint_paths",
    "plot_labels",
    "plot_mechanism",
    "plot_stones",
    "plot_wall",
    "save",
    "wall_outlines",
    "write_pictures",
]
