"""build.gif: the construction."""

from pathlib import Path

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.film import Film, durations_ms, palette
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.gif import gif_bytes
from drystone.errors import UsageError
from drystone.whole_files import write_whole

NAME = "build.gif"

LONGEST_S = 655.0
"""A GIF counts hundredths of a second, in 16 bits."""


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written; E138 for steps that are longer than a GIF has."""
    if settings.seconds_per_step > LONGEST_S:
        raise UsageError(
            "E138",
            f"a step of {settings.seconds_per_step:g} s is too long for {NAME}.",
            where="--seconds-per-step",
            cure=f"Give {LONGEST_S:g} s at most (seconds_per_step in Python), or export an mp4.",
        )
    return (NAME,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:
    """Write a frame a step and one of the finished wall, which stays; the film loops."""
    frames = tuple(Film(assembly, settings.film_px).frames())
    path = folder / NAME
    write_whole(path, gif_bytes(frames, palette(), durations_ms(assembly, settings)))
    return (path,)
