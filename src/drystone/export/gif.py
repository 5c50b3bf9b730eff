"""build.gif: the construction."""

from pathlib import Path

from drystone.assembly.parts import Assembly
from drystone.export.film import Film, durations_ms, palette
from drystone.export.settings import ExportSettings
from drystone.io.atomic import write_atomically
from drystone.plotting.gif import gif_bytes

NAME = "build.gif"


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written."""
    return (NAME,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:
    """Write a frame a step and one of the finished wall, which stays; the film loops."""
    frames = tuple(Film(assembly, settings.film_px).frames())
    path = folder / NAME
    write_atomically(path, gif_bytes(frames, palette(), durations_ms(assembly, settings)))
    return (path,)
