"""Pictures, sheets, reports and exports of stones and walls.

Only this room knows how anything looks.  Pictures are ``plot_x(thing, ax=None) -> Axes``.
"""

from importlib import import_module
from typing import Any

# Names are loaded on first use: the command line knows the formats, and must not wait for
# Matplotlib.
_NAMES = {
    "canvas": ("save",),
    "outlines": ("wall_outlines",),
    "pictures.curves": ("plot_scatter",),
    "pictures.forces": ("plot_contacts", "plot_forces"),
    "pictures.mechanism": ("mechanism_frames", "plot_mechanism", "save_mechanism_animation"),
    "pictures.stones": ("plot_joint_paths", "plot_labels", "plot_stones"),
    "pictures.wall": ("plot_choice", "plot_wall", "write_pictures"),
    "report.html": ("write_report",),
    "report.viewer_data": ("view_of_assembly", "view_of_result", "view_of_wall"),
}
_HOMES = {name: module for module, names in _NAMES.items() for name in names}

__all__ = [*_HOMES]  # noqa: PLE0604 - the keys are strings


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"drystone.drawing.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'drystone.drawing' has no attribute {name!r}")
