"""The formats that there are; each is a module that is imported when it is asked for."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Protocol, cast

if TYPE_CHECKING:
    from pathlib import Path

    from drystone.drawing.assembly.parts import Assembly
    from drystone.drawing.export.settings import ExportSettings


class Exporter(Protocol):
    """What a module of a format has."""

    def files(self, assembly: "Assembly", settings: "ExportSettings", /) -> tuple[str, ...]:
        """Return the names that will be written, relative to a folder, ``/`` between folders.

        Raises what would keep :meth:`write` from writing them, so that nothing is written when
        one of several formats cannot be.
        """
        ...

    def write(
        self, assembly: "Assembly", folder: "Path", settings: "ExportSettings", /
    ) -> "tuple[Path, ...]":
        """Write them into a folder; return where they are."""
        ...


@dataclass(frozen=True)
class Format:
    """A format.

    Parameters
    ----------
    module : str
        Of :mod:`drystone.drawing.export`.
    writes : tuple of str
        The names of its files; a folder of its own ends in ``/``.
    text : str
        What they are, for people.
    metric : bool
        Whether it means nothing without a scale (E131).
    """

    module: str
    writes: tuple[str, ...]
    text: str
    metric: bool = False

    def exporter(self) -> Exporter:
        """Import the module."""
        return cast(Exporter, import_module(f"drystone.drawing.export.{self.module}"))


FORMATS: Mapping[str, Format] = {
    "poses": Format("poses", ("poses.json",), "pick and place poses, grasps, masses", metric=True),
    "compas": Format("compas", ("assembly.compas.json",), "COMPAS frames and meshes", metric=True),
    "moveit": Format(
        "moveit",
        ("scene.yaml", "wall.scene"),
        "collision objects for MoveIt, in order",
        metric=True,
    ),
    "urdf": Format("urdf", ("urdf/",), "a URDF with mesh and inertia of every part", metric=True),
    "obj": Format(
        "meshes", ("wall.obj", "wall.mtl"), "extruded stones, named objects", metric=True
    ),
    "glb": Format("meshes_glb", ("wall.glb",), "the same as glTF", metric=True),
    "stl": Format("meshes_stl", ("stl/",), "one file a part", metric=True),
    "csv": Format("csv_table", ("steps.csv",), "the build list"),
    "parquet": Format("parquet_table", ("steps.parquet",), "the build list"),
    "geojson": Format("geojson", ("wall.geojson",), "polygons with their steps"),
    "dxf": Format("dxf", ("wall.dxf",), "R2010, layers STONES WEDGES CONTACTS FORCES MECHANISM"),
    "svg": Format("svg", ("wall.svg",), "every stone defined once and placed by a transform"),
    "png": Format("png", ("wall-numbered.png",), "the wall with step numbers"),
    "gif": Format("gif", ("build.gif",), "the construction"),
    "mp4": Format("mp4", ("build.mp4",), "the construction"),
    "pdf": Format(
        "pdf", ("build-sheet.pdf",), "drawing to scale, every stone in order, fetch list"
    ),
    "projector": Format(
        "projector", ("projector/",), "a frame a step, 1:1 on the wall", metric=True
    ),
}
