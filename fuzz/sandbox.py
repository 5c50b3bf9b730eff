"""A process in which files of strangers are read: limits, and everything that must not get out."""

import faulthandler
import inspect
import json
import logging
import os
import resource
import signal
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO

import drystone
from drystone.errors import DrystoneError, ExitCode

ROOT = str(Path(drystone.__file__).parent) + os.sep
_HERE = str(Path(__file__).parent) + os.sep
_OF_OTHERS = (
    "site-packages" + os.sep,
    f"python{sys.version_info[0]}.{sys.version_info[1]}" + os.sep,
)

_STARTS = frozenset(
    {"subprocess.Popen", "os.exec", "os.posix_spawn", "os.spawn", "os.system", "os.fork",
     "os.forkpty", "pty.spawn", "os.startfile"}
)  # fmt: skip
_CALLS = frozenset({"socket.connect", "socket.bind", "socket.sendto", "socket.getaddrinfo"})
_PATHS = {
    "os.remove": (0,), "os.rmdir": (0,), "os.mkdir": (0,), "os.chmod": (0,), "os.rename": (0, 1),
    "os.link": (1,), "os.symlink": (1,),
}  # fmt: skip
"""Which of their arguments are paths that are changed; the last is what they are relative to."""
_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_SILENT = (DeprecationWarning, PendingDeprecationWarning, ImportWarning, ResourceWarning)
"""Python shows none of these to users."""
_ENDS = frozenset(ExitCode) - {70}
"""70 is said of a fault of drystone itself."""
_LARGEST_FILE = 10**8
_PROCESS_S = 900
"""Processor time of a whole process, should the limit of an execution not hold."""

Frame = tuple[str, str, int]
"""File, function and line."""


class Forbidden(BaseException):
    """Keeps from happening what must not; no reader may catch it."""


@dataclass(frozen=True)
class Limits:
    """Of one execution.

    Parameters
    ----------
    cpu_s : float
        Processor time.
    cpu_ns_px : float
        More of it for each pixel of a picture: reading is linear in what its header says.
    wall_s : float
        Time in which nothing comes of it, of the clock: far more than a loaded machine takes.
    memory_bytes : int
        Beyond what the process has when it begins.
    """

    cpu_s: float = 2.0
    cpu_ns_px: float = 50.0
    wall_s: float = 60.0
    memory_bytes: int = 1_500_000_000


@dataclass(frozen=True, order=True)
class Fault:
    """What must not be.

    Parameters
    ----------
    kind : str
        Type of an exception that has no code, or time, stuck, memory, crash, output, warning, log,
        process, network, pickle, write.
    where : str
        Innermost place in drystone, and in a foreign module below it.
    said : str
        In words.
    """

    kind: str
    where: str
    said: str = ""


class Sandbox:
    """Limits for this process, from now to its end.

    Parameters
    ----------
    folder : Path
        The only place where files may be written; it is the working directory, too.
    limits : Limits
        Of every execution.
    trace : file
        Where it says what it was doing when it is killed.

    Attributes
    ----------
    read : int
        Executions that came to their end without any error.
    """

    def __init__(self, folder: Path, limits: Limits, trace: BinaryIO) -> None:
        self._folder = os.path.realpath(folder) + os.sep
        self._limits = limits
        self.read = 0
        self._faults: dict[tuple[str, str], str] = {}
        sys.dont_write_bytecode = True
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        faulthandler.enable(trace, all_threads=False)
        for number in (signal.SIGPROF, signal.SIGALRM):
            # It says where it is, also within foreign code that Python has no hold on, and dies.
            signal.signal(number, signal.SIG_DFL)
            faulthandler.register(number, trace, all_threads=False, chain=True)
        self._output = [_caught(stream) for stream in ("stdout", "stderr")]
        warnings.simplefilter("always")
        for category in _SILENT:
            warnings.simplefilter("ignore", category)
        warnings.showwarning = self._on_warning
        logging.lastResort = _Handler(self)  # prints what nobody else takes
        tempfile.tempdir = str(folder)
        os.chdir(folder)
        _limit(limits)
        sys.addaudithook(self._audit)

    def run(self, read: Callable[[], object], pixels: int = 0) -> list[Fault]:
        """Execute once, what has so many pixels; return what must not be."""
        self._faults.clear()
        cpu_s = self._limits.cpu_s + 1e-9 * self._limits.cpu_ns_px * pixels
        signal.setitimer(signal.ITIMER_PROF, cpu_s)
        signal.setitimer(signal.ITIMER_REAL, self._limits.wall_s)
        try:
            read()
            self.read += 1
        except BaseException as error:
            self._on_error(error)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            signal.setitimer(signal.ITIMER_REAL, 0)
        self._look_at_output()
        return [Fault(*place, said) for place, said in self._faults.items()]

    def fault(self, kind: str, frames: Iterator[Frame], said: object) -> None:
        """Note what must not be."""
        words = ascii(str(said)[:300])[1:-1]  # in one line, and safe to show
        self._faults.setdefault((kind, where(frames, lines=kind != "memory")), words)

    def _on_error(self, error: BaseException) -> None:
        frames = _frames_of(error.__traceback__)
        if any(isinstance(cause, MemoryError) for cause in _causes(error)):
            self.fault("memory", frames, error)
        elif isinstance(error, DrystoneError | Forbidden):
            pass  # has a code, or was noted when it was kept from happening
        elif not (isinstance(error, SystemExit) and error.code in _ENDS):
            self.fault(type(error).__name__, frames, error)

    def _on_warning(self, message: Warning | str, category: type[Warning], *_: Any) -> None:
        self.fault("warning", _stack(), f"{category.__name__}: {message}")

    def _audit(self, event: str, arguments: tuple[Any, ...]) -> None:
        if event == "open":
            path, _, flags = arguments
            if flags & _WRITES and path != os.devnull:
                self._within(path)
        elif event in _PATHS:
            for i in _PATHS[event]:
                self._within(arguments[i], arguments[-1], follow=False)
        elif event in _STARTS or event in _CALLS or event == "pickle.find_class":
            kind = "process" if event in _STARTS else "network" if event in _CALLS else "pickle"
            self.fault(kind, _stack(), (event, *arguments))
            raise Forbidden(event)

    def _within(self, path: Any, beneath: int = -1, *, follow: bool = True) -> None:
        """Refuse to change what is not in the folder; `beneath` is what a path is relative to."""
        if isinstance(path, int):
            return  # it is open already
        parent = os.path.realpath(f"/dev/fd/{beneath}") if beneath != -1 else ""
        given = Path(parent, os.fsdecode(path))
        full = os.path.realpath(given if follow else given.parent) + os.sep
        if not full.startswith(self._folder):
            self.fault("write", _stack(), full)
            raise Forbidden(full)

    def _look_at_output(self) -> None:
        """Nothing but JSON on stdout, nothing but lines of drystone on stderr."""
        sys.stdout.flush()
        sys.stderr.flush()
        out, err = map(_taken, self._output)
        if out:
            try:
                json.loads(out)
            except ValueError:
                self._faults["output", "stdout"] = repr(out[:200])
        foreign = [line for line in err.splitlines() if not line.startswith(b"drystone: ")]
        if foreign:
            self._faults["output", "stderr"] = repr(foreign[0][:200])


class _Handler(logging.Handler):
    """Notes what would be printed of logs."""

    def __init__(self, sandbox: Sandbox) -> None:
        super().__init__(logging.WARNING)
        self._sandbox = sandbox

    def emit(self, record: logging.LogRecord) -> None:
        self._sandbox.fault("log", _stack(), f"{record.name}: {record.msg}")


def where(frames: Iterator[Frame], *, lines: bool = True) -> str:
    """Return the innermost place in drystone, and that in a foreign module below it.

    Parameters
    ----------
    frames : iterator
        The innermost last.
    lines : bool
        Whether the line in drystone tells one fault from another.
    """
    own, last = "", ""
    for file, function, line in frames:
        last = ""
        if file.startswith(ROOT):
            own = file.removeprefix(ROOT) + (f":{line}" if lines else "") + f" {function}"
        elif not own or not file.startswith(_HERE):
            for part in _OF_OTHERS:
                file = file.rpartition(part)[2]  # noqa: PLW2901
            last = f"{Path(file).name if file.startswith(os.sep) else file} {function}"
    return " < ".join(filter(None, (last, own)))


def where_killed(trace: BinaryIO) -> str:
    """Return where a process was when it was killed, of what it wrote then."""
    trace.seek(0)
    frames = []
    for line in trace.read().decode("utf-8", "replace").splitlines():
        if line.startswith('  File "'):
            file, _, rest = line.removeprefix('  File "').partition('", line ')
            number, _, function = rest.partition(" in ")
            frames.append((file, function, int(number)))
    return where(iter(frames[::-1]), lines=False)


def _frames_of(found: TracebackType | None) -> Iterator[Frame]:
    while found is not None:
        code = found.tb_frame.f_code
        yield code.co_filename, code.co_name, found.tb_lineno
        found = found.tb_next


def _stack() -> Iterator[Frame]:
    """Return where we are, but for this file, and Python's own for warnings and logs."""
    frame, found = inspect.currentframe(), []
    passed = (__file__, warnings.__file__, str(Path(logging.__file__).parent))
    while frame is not None:
        if found or not frame.f_code.co_filename.startswith(passed):
            found.append((frame.f_code.co_filename, frame.f_code.co_name, frame.f_lineno))
        frame = frame.f_back
    return reversed(found)


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__


def _caught(stream: str) -> int:
    """Send a stream to a file from now on, also what foreign libraries write to it."""
    number = {"stdout": 1, "stderr": 2}[stream]
    with tempfile.TemporaryFile() as file:
        caught = os.dup(file.fileno())
    os.dup2(caught, number)
    text = open(number, "w", encoding="utf-8", errors="backslashreplace", closefd=False)  # noqa: SIM115
    setattr(sys, stream, text)
    return caught


def _taken(caught: int) -> bytes:
    """Return what was written, and forget it."""
    size = os.fstat(caught).st_size
    if not size:
        return b""
    found = os.pread(caught, min(size, 10**6), 0)
    os.ftruncate(caught, 0)
    os.lseek(caught, 0, os.SEEK_SET)
    return found


def _limit(limits: Limits) -> None:
    for what, size in (
        (resource.RLIMIT_CPU, _PROCESS_S),
        (resource.RLIMIT_FSIZE, _LARGEST_FILE),
        (resource.RLIMIT_CORE, 0),
    ):
        resource.setrlimit(what, (size, resource.getrlimit(what)[1]))
    sizes = Path("/proc/self/statm")
    if sizes.exists():
        begun = int(sizes.read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (begun + limits.memory_bytes,) * 2)
