"""Entry point: parse, dispatch, and turn errors into exit codes."""

import gc
import os
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from io import TextIOWrapper
from pathlib import Path

from drystone.cli.parser import build_parser
from drystone.errors import (
    NO_ROOM,
    DrystoneError,
    ExitCode,
    InputError,
    OwnFaultError,
    UsageError,
    not_written,
)
from drystone.kernels.backend import VARIABLE, fault
from drystone.search.interrupts import Terminated, terminable
from drystone.search.processes import RARELY

_SMALLER = {
    "plan": "--scale or wall",
    "demo": "--scale",
    "measure": "--scale or picture",
    "generate": "--count or number in --set",
}
"""What takes less memory when it is smaller, by command."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code (DESIGN 2).

    0 done, 2 usage, 3 bad input, 4 wall incomplete, 5 a check failed, 70 a fault of drystone
    itself, 130 interrupted, 143 terminated.  With ``--debug`` errors are raised.
    """
    words = sys.argv[1:] if argv is None else argv
    gc.set_threshold(RARELY)
    with terminable() as came:
        try:
            code = _called(words)
            stopped = code == ExitCode.INTERRUPTED and came() == signal.SIGTERM
            return int(ExitCode.TERMINATED) if stopped else code
        except BrokenPipeError:
            # The reader is gone, as in `drystone stones X | head`: the rest is thrown away.
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, sys.stdout.fileno())
            os.close(nowhere)
            return int(ExitCode.DONE)
        except (Exception, KeyboardInterrupt) as error:
            # A module that is being imported may turn an interrupt into an error of its own.
            if isinstance(error, KeyboardInterrupt) or came():
                terminated = isinstance(error, Terminated) or came() == signal.SIGTERM
                print(f"drystone: {'terminated' if terminated else 'interrupted'}", file=sys.stderr)
                return int(ExitCode.TERMINATED if terminated else ExitCode.INTERRUPTED)
            if "--debug" in words:
                raise
            coded = _coded(error, next((word for word in words if word[:1] != "-"), ""))
            print(f"drystone: {coded}", file=sys.stderr)
            return int(coded.exit_code)


def _called(words: Sequence[str]) -> int:
    # What is printed where the shell closed it, as in `drystone stones X >&-`, is thrown away, and
    # the next file that is opened does not take its number.
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))  # noqa: SIM115
    if isinstance(sys.stdout, TextIOWrapper):
        # Names of stones are in any script, terminals and files on some systems are not.
        sys.stdout.reconfigure(errors="backslashreplace")
    if os.environ.get(VARIABLE) and (wrong := fault()) is not None:
        what = f"the kernels asked for are not there: {wrong}."
        cure = "Set it to auto or python; compiled needs an installation with a compiler."
        raise UsageError("E143", what, where=VARIABLE, cure=cure)
    arguments = build_parser(words).parse_args(words)
    named = [Path(one) for one in vars(arguments).values() if isinstance(one, str)]
    new = {one for path in named for one in (path, *path.parents) if not os.path.exists(one)}  # noqa: PTH110 - raises nothing
    try:
        code = int(arguments.run(arguments) or ExitCode.DONE)
    except BaseException:
        # What was made for files that were not written goes again.
        for folder in (folder for place in new for folder, *_ in os.walk(place, topdown=False)):
            with suppress(OSError):
                Path(folder).rmdir()
        raise
    # A reader that went away is noticed here and not when the interpreter ends.
    sys.stdout.flush()
    return code


def _coded(error: Exception, command: str) -> DrystoneError:
    """Return an error with a code; what the system refuses has none of its own."""
    if isinstance(error, DrystoneError):
        return error
    if isinstance(error, MemoryError):
        less = _SMALLER.get(command, "wall or picture")
        return InputError("E142", "the memory is not large enough.", cure=f"Use a smaller {less}.")
    if isinstance(error, OSError) and error.errno in NO_ROOM:
        return not_written(error)
    if isinstance(error, OSError):
        what = f"the system refuses this: {error.strerror or error}."
        cure = "Check the path, your right to write there, and the space that is left."
        return InputError("E141", what, where=str(error.filename or ""), cure=cure)
    said = " ".join(str(error).split())
    what = f"this is a fault of drystone ({type(error).__name__}{said and f': {said}'})."
    cure = "Please report it with the input; --debug shows the traceback."
    return OwnFaultError("E155", what, where=command, cure=cure)
