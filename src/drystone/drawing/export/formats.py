"""The formats that there are; what makes them is imported when it is asked for."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

from drystone.errors import UsageError

if TYPE_CHECKING:
    from pathlib import Path

    from drystone.drawing.assembly import Assembly

Files = Mapping[str, str | bytes]
"""What is to be written by name, relative to a folder, ``/`` between folders.

All is made before any of it is written: nothing is when one of several formats cannot be made.
"""


@dataclass(frozen=True, kw_only=True)
class ExportSettings:
    """How drawings and films are made.

    Parameters
    ----------
    paper_scale : float or None
        The build sheet is drawn at 1 to this; the next usual scale where the wall does not fit, and
        None is the largest usual scale.
    title : str
        In the title block; empty for the name of the photograph, or of the stones.
    projector_px : (int, int)
        Width and height of a projector.
    projector_px_per_m : float
        Px of the projector in a metre on the wall.
    seconds_per_step : float
        Of films.
    """

    paper_scale: float | None = None
    title: str = ""
    projector_px: tuple[int, int] = (1920, 1080)
    projector_px_per_m: float = 1000.0
    seconds_per_step: float = 0.6


@dataclass(frozen=True)
class Format:
    """A format: its files, what they are in words, and whether it needs a scale (E131).

    `made_by` names a module of this package and its function from an assembly and settings to
    `Files`, called as the format with `_` for `-`.  In `writes` a folder ends in ``/``.
    """

    made_by: str
    writes: tuple[str, ...]
    text: str
    metric: bool = False

    def files(self, assembly: "Assembly", settings: ExportSettings) -> Files:
        """Return what is to be written."""
        module, _, function = self.made_by.partition(":")
        if self.metric:
            assembly.require_scale(f"the format {function.replace('_', '-')!r}")
        made = import_module(f"drystone.drawing.export.{module}")
        files: Files = getattr(made, function)(assembly, settings)
        return files

    def write(
        self, assembly: "Assembly", folder: "Path", settings: ExportSettings
    ) -> "tuple[Path, ...]":
        """Write its files into a folder; return where they are."""
        return write_files(self.files(assembly, settings), folder)


def write_files(files: Files, folder: "Path") -> "tuple[Path, ...]":
    """Write files with the folders that they lie in; PlanError (E206) when one cannot be."""
    from drystone.whole_files import write_whole  # noqa: PLC0415 - the options need names alone

    for name, data in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        write_whole(folder / name, data.encode() if isinstance(data, str) else data)
    return tuple(folder / name for name in files)


def load_extra(module: str, extra: str, code: str, where: str) -> Any:
    """Return a module that not every installation has; UsageError says what to install."""
    try:
        return import_module(module)
    except ImportError as error:
        what = f"{module.partition('.')[0]} is not installed, and it writes this."
        cure = f'Install it with `pip install "drystone[{extra}]"`, or choose another format.'
        raise UsageError(code, what, where=where, cure=cure) from error


FORMATS: Mapping[str, Format] = {
    "poses": Format("robots:poses", ("poses.json",), "pick and place poses, grasps, masses", True),
    "compas": Format("robots:compas", ("assembly.compas.json",), "COMPAS frames and meshes", True),
    "moveit": Format(
        "robots:moveit", ("scene.yaml", "wall.scene"),
        "collision objects for MoveIt, in order", True,
    ),
    "urdf": Format("robots:urdf", ("urdf/",), "a URDF with mesh and inertia of every part", True),
    "obj": Format("solids:obj", ("wall.obj", "wall.mtl"), "extruded stones, named objects", True),
    "glb": Format("solids:glb", ("wall.glb",), "the same as glTF", True),
    "stl": Format("solids:stl", ("stl/",), "one file a part", True),
    "csv": Format("tables:csv", ("steps.csv",), "the build list"),
    "parquet": Format("tables:parquet", ("steps.parquet",), "the build list"),
    "geojson": Format("tables:geojson", ("wall.geojson",), "polygons with their steps"),
    "dxf": Format(
        "drawings:dxf", ("wall.dxf",), "R2010, layers STONES WEDGES CONTACTS FORCES MECHANISM"
    ),
    "svg": Format(
        "drawings:svg", ("wall.svg",), "every stone defined once and placed by a transform"
    ),
    "png": Format("drawings:png", ("wall-numbered.png",), "the wall with step numbers"),
    "gif": Format("frames:gif", ("build.gif",), "the construction"),
    "mp4": Format("frames:mp4", ("build.mp4",), "the construction"),
    "pdf": Format(
        "drawings:pdf", ("build-sheet.pdf",),
        "drawing to scale, every stone in order, fetch list",
    ),
    "projector": Format(
        "frames:projector", ("projector/",), "a frame a step, 1:1 on the wall", True
    ),
}  # fmt: skip
