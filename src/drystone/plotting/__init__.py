"""Pictures of stones, walls, contacts, forces and joints: ``plot_x(thing, ax=None) -> Axes``.

Only this room and :mod:`drystone.report` know how anything looks.  Figures are made without
pyplot, so nothing global changes and no window opens.
"""

from drystone.plotting.animation import mechanism_frames, save_mechanism_animation
from drystone.plotting.choice import plot_choice
from drystone.plotting.contacts import plot_contacts
from drystone.plotting.files import save, write_pictures
from drystone.plotting.forces import plot_forces
from drystone.plotting.joints import plot_joint_paths
from drystone.plotting.mechanism import plot_mechanism
from drystone.plotting.outlines import wall_outlines
from drystone.plotting.scatter import plot_scatter
from drystone.plotting.stones import plot_labels, plot_stones
from drystone.plotting.wall import plot_wall

__all__ = [
    "mechanism_frames",
    "plot_choice",
    "plot_contacts",
    "plot_forces",
    "plot_joint_paths",
    "plot_labels",
    "plot_mechanism",
    "plot_scatter",
    "plot_stones",
    "plot_wall",
    "save",
    "save_mechanism_animation",
    "wall_outlines",
    "write_pictures",
]
