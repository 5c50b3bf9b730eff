"""Pictures of stones, walls, contacts, forces and joints: ``plot_x(thing, ax=None) -> Axes``.

Only this room knows how anything looks.  Figures are made without
pyplot, so nothing global changes and no window opens.
"""

from drystone.drawing.files import save, write_pictures
from drystone.drawing.outlines import wall_outlines
from drystone.drawing.pictures.animation import mechanism_frames, save_mechanism_animation
from drystone.drawing.pictures.contacts import plot_contacts
from drystone.drawing.pictures.forces import plot_forces
from drystone.drawing.pictures.mechanism import plot_mechanism
from drystone.drawing.pictures.scatter import plot_scatter
from drystone.drawing.pictures.stones import plot_joint_paths, plot_labels, plot_stones
from drystone.drawing.pictures.wall import plot_choice, plot_wall

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
