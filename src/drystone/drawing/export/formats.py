"""The formats that there are; what makes them is imported when it is asked for."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

from drystone.errors import extra

if TYPE_CHECKING:
    from pathlib import Path

    from drystone.drawing.assembly import Assembly

Files = Mapping[str, str | bytes]
"""What is to be written by name, relative to a folder, ``/`` between folders.

All is made before any of it is written: nothing is when one of several formats cannot be made.
"""


@dataclass(frozen=True, kw_only=True)
class ExportSettings:
    """How drawings and films are made."""

    # The build sheet is drawn at 1 to this; the next usual scale where the wall does not fit, and
    # None is the largest usual scale.
    paper_scale: float | None = None
    title: str = ""  # in the title block; empty for the name of the photograph, or of the stones
    projector_px: tuple[int, int] = (1920, 1080)  # width and height
    projector_px_per_m: float = 1000.0  # on the wall
    seconds_per_step: float = 0.6  # of films


@dataclass(frozen=True)
class Format:
    """A format: its files, what they are in words, and whether it needs a scale (E131).

    `module` is one of this package, with a function of the format's name from an assembly and
    settings to `Files`.  In `writes` a folder ends in ``/``.
    """

    name: str
    module: str
    writes: tuple[str, ...]
    text: str
    metric: bool = False

    def files(self, assembly: "Assembly", settings: ExportSettings) -> Files:
        """Return what is to be written."""
        if self.metric:
            assembly.require_scale(f"the format {self.name!r}")
        made = import_module(f"drystone.drawing.export.{self.module}")
        files: Files = getattr(made, self.name)(assembly, settings)
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


def load_extra(module: str, name: str, code: str, where: str) -> Any:
    """Return a module that not every installation has; UsageError says what to install."""
    return extra(module, "writes this", where, name, code, ", or choose another format")


_FORMATS = (
    Format("poses", "robots", ("poses.json",), "pick and place poses, grasps, masses", True),
    Format("compas", "robots", ("assembly.compas.json",), "COMPAS frames and meshes", True),
    Format("moveit", "robots", ("scene.yaml", "wall.scene"),
           "collision objects for MoveIt, in order", True),
    Format("urdf", "robots", ("urdf/",), "a URDF with mesh and inertia of every part", True),
    Format("obj", "solids", ("wall.obj", "wall.mtl"), "extruded stones, named objects", True),
    Format("glb", "solids", ("wall.glb",), "the same as glTF", True),
    Format("stl", "solids", ("stl/",), "one file a part", True),
    Format("csv", "tables", ("steps.csv",), "the build list"),
    Format("parquet", "tables", ("steps.parquet",), "the build list"),
    Format("geojson", "tables", ("wall.geojson",), "polygons with their steps"),
    Format("dxf", "drawings", ("wall.dxf",),
           "R2010, layers STONES WEDGES CONTACTS FORCES MECHANISM"),
    Format("svg", "drawings", ("wall.svg",),
           "every stone defined once and placed by a transform"),
    Format("png", "drawings", ("wall-numbered.png",), "the wall with step numbers"),
    Format("gif", "frames", ("build.gif",), "the construction"),
    Format("mp4", "frames", ("build.mp4",), "the construction"),
    Format("pdf", "drawings", ("build-sheet.pdf",),
           "drawing to scale, every stone in order, fetch list"),
    Format("projector", "frames", ("projector/",), "a frame a step, 1:1 on the wall", True),
)  # fmt: skip
FORMATS: Mapping[str, Format] = {one.name: one for one in _FORMATS}
