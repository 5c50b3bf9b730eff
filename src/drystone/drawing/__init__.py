"""Pictures, sheets, reports and exports of stones and walls.

Only this room knows how anything looks.  Pictures are ``plot_x(thing, ax=None) -> Axes``.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from drystone.drawing.files import save as save
    from drystone.drawing.files import write_pictures as write_pictures
    from drystone.drawing.outlines import wall_outlines as wall_outlines
    from drystone.drawing.pictures.animation import mechanism_frames as mechanism_frames
    from drystone.drawing.pictures.animation import (
        save_mechanism_animation as save_mechanism_animation,
    )
    from drystone.drawing.pictures.contacts import plot_contacts as plot_contacts
    from drystone.drawing.pictures.forces import plot_forces as plot_forces
    from drystone.drawing.pictures.mechanism import plot_mechanism as plot_mechanism
    from drystone.drawing.pictures.scatter import plot_scatter as plot_scatter
    from drystone.drawing.pictures.stones import plot_joint_paths as plot_joint_paths
    from drystone.drawing.pictures.stones import plot_labels as plot_labels
    from drystone.drawing.pictures.stones import plot_stones as plot_stones
    from drystone.drawing.pictures.wall import plot_choice as plot_choice
    from drystone.drawing.pictures.wall import plot_wall as plot_wall
    from drystone.drawing.report.html import write_report as write_report
    from drystone.drawing.report.viewer_data import view_of_assembly as view_of_assembly
    from drystone.drawing.report.viewer_data import view_of_result as view_of_result
    from drystone.drawing.report.viewer_data import view_of_wall as view_of_wall

# Names are loaded on first use: the command line knows the formats, and must not wait for
# Matplotlib.
_HOMES = {
    "save": "files",
    "write_pictures": "files",
    "wall_outlines": "outlines",
    "mechanism_frames": "pictures.animation",
    "save_mechanism_animation": "pictures.animation",
    "plot_contacts": "pictures.contacts",
    "plot_forces": "pictures.forces",
    "plot_mechanism": "pictures.mechanism",
    "plot_scatter": "pictures.scatter",
    "plot_joint_paths": "pictures.stones",
    "plot_labels": "pictures.stones",
    "plot_stones": "pictures.stones",
    "plot_choice": "pictures.wall",
    "plot_wall": "pictures.wall",
    "view_of_result": "report.viewer_data",
    "write_report": "report.html",
    "view_of_assembly": "report.viewer_data",
    "view_of_wall": "report.viewer_data",
}

__all__ = [*_HOMES]  # noqa: PLE0604 - the keys are strings


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"drystone.drawing.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'drystone.drawing' has no attribute {name!r}")
