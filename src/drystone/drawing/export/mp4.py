"""build.mp4: the construction, by ffmpeg or else by OpenCV."""

import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import IO, Any, cast

import numpy as np
from PIL import Image

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.film import Film, durations_ms
from drystone.drawing.export.settings import ExportSettings
from drystone.errors import UsageError
from drystone.whole_files import write_whole

NAME = "build.mp4"

FRAMES_PER_S = 10
"""Pictures of a step are repeated: players show films of one picture a second badly."""

_ENCODERS = ("libx264", "mpeg4")
"""Of ffmpeg, the better first; builds without the first exist."""


@dataclass(frozen=True, eq=False)
class _Shots:
    """Pictures and how many times each is shown."""

    size_px: tuple[int, int]
    pictures: Sequence[Image.Image]
    repeats: Sequence[int]

    def __iter__(self) -> Iterator[Image.Image]:
        for picture, times in zip(self.pictures, self.repeats, strict=True):
            for _ in range(times):
                yield picture


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written; E186 when there is nothing that writes films."""
    if shutil.which("ffmpeg") is None:
        _load_cv2()
    return (NAME,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:
    """Write the pictures of the GIF as a film.

    Raises
    ------
    UsageError
        E186 when there is neither ffmpeg nor OpenCV, or neither can write it.
    """
    program = shutil.which("ffmpeg")
    writer = None if program else _load_cv2()
    film = Film(assembly, settings.film_px)
    repeats = [max(1, round(ms * FRAMES_PER_S / 1000)) for ms in durations_ms(assembly, settings)]
    shots = _Shots(film.size_px, tuple(film.frames()), repeats)
    # A folder of its own: both programs write where they are told, and may leave half a film.
    with tempfile.TemporaryDirectory() as scratch:
        made = Path(scratch) / NAME
        if program:
            _by_ffmpeg(program, shots, made)
        else:
            _by_opencv(writer, shots, made)
        path = folder / NAME
        write_whole(path, made.read_bytes())
    return (path,)


def _by_ffmpeg(program: str, shots: _Shots, path: Path) -> None:
    width, height = shots.size_px
    said = ""
    for encoder in _ENCODERS:
        command = [
            program, "-y", "-loglevel", "error",
            "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
            "-r", str(FRAMES_PER_S), "-i", "-",
            "-c:v", encoder, "-pix_fmt", "yuv420p", "-threads", "1",
            "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact",
            "-movflags", "+faststart", str(path),
        ]  # fmt: skip
        code, said = _fed(command, shots)
        if code == 0 and path.is_file():
            return
    raise _cannot(f"ffmpeg cannot write it ({said or 'it says nothing'}).")


def _fed(command: Sequence[str], shots: _Shots) -> tuple[int, str]:
    """Run a program that is given the pictures; return its exit code and its last words."""
    # A file, not a pipe: a program with much to say would wait for somebody to read it.
    with tempfile.TemporaryFile() as words:
        process = subprocess.Popen(  # noqa: S603 - the program is found, the arguments are ours
            command, stdin=subprocess.PIPE, stdout=words, stderr=words
        )
        # A program that gives up early closes its end, and says why by its exit code and words.
        with suppress(BrokenPipeError), cast(IO[bytes], process.stdin) as pipe:
            for picture in shots:
                pipe.write(picture.tobytes())
        code = process.wait()
        words.seek(0)
        return code, words.read().decode(errors="replace").strip().rpartition("\n")[2]


def _by_opencv(cv2: Any, shots: _Shots, path: Path) -> None:
    code = cv2.VideoWriter_fourcc(*"mp4v")
    writer = cv2.VideoWriter(str(path), code, float(FRAMES_PER_S), shots.size_px)
    if not writer.isOpened():
        raise _cannot("this OpenCV writes no MP4.")
    for picture in shots:
        writer.write(np.asarray(picture)[:, :, ::-1])
    writer.release()
    if not path.is_file():
        raise _cannot("OpenCV wrote nothing.")


def _load_cv2() -> Any:
    try:
        return import_module("cv2")
    except ImportError as error:
        raise _cannot("there is no ffmpeg, and OpenCV is not installed.") from error


def _cannot(what: str) -> UsageError:
    return UsageError(
        "E186",
        what,
        where=NAME,
        cure="Install ffmpeg, or OpenCV with `pip install drystone[photo]`, or export a gif.",
    )
