"""Readers with defects, for ``python -m tests.fuzz.planted`` to find: options as of the fuzzer."""

import faulthandler
import logging
import os
import pickle
import re
import socket
import subprocess
import sys
import time
import warnings
from pathlib import Path

from fuzz.cli import main
from fuzz.driver import Format

from drystone.errors import InputError

OUTSIDE = Path(__file__).with_name("written.txt")


def fine(_):
    """Nothing is wrong."""


def refuses(path):
    raise InputError("E106", f"{len(path.read_bytes())} bytes are damaged.")


def raises(_):
    raise LookupError("a foreign error")


def leaves(_):
    sys.exit(1)


def backtracks(_):
    re.match(r"(a+)+$", 40 * "a" + "b")  # one call into C, which Python cannot end


def waits(_):
    time.sleep(3600)


def eats(_):
    bytearray(1 << 33)


def eats_quietly(_):
    try:
        bytearray(1 << 33)
    except MemoryError:
        raise InputError("E110", "there is not enough memory.") from None


def dies(_):
    faulthandler._sigsegv()


def prints(_):
    os.write(2, b"TIFFReadDirectory: as libraries in C do\n")


def warns(_):
    warnings.warn("corrupt EXIF data", UserWarning, stacklevel=1)


def logs(_):
    logging.getLogger("tifffile").error("invalid page offset")


def starts(_):
    try:
        subprocess.run(["true"], check=False)  # noqa: S607
    except BaseException as error:
        raise InputError("E106", "the file is damaged.") from error


def writes(_):
    OUTSIDE.write_text("a")


def removes(_):
    Path(__file__).unlink()


def writes_within(path):
    path.with_name("out").mkdir()
    path.with_name("out").joinpath("a").write_text("a")


def unpickles(_):
    pickle.loads(pickle.dumps(Path))  # noqa: S301


def connects(_):
    socket.create_connection(("127.0.0.1", 9))


def sometimes(read):
    """Return a format of which one in five executions meets the defect."""
    return Format(
        read.__name__,
        lambda: [{"a.txt": b"some text of 3 words"}],
        lambda path, rng: read(path) if rng.random() < 0.2 else path.exists(),
        weight=1,
    )


PLANTED = [
    sometimes(read)
    for read in (
        fine, refuses, raises, leaves, backtracks, waits, eats, eats_quietly, dies, prints, warns,
        logs, starts, writes, removes, writes_within, unpickles, connects,
    )
]  # fmt: skip

if __name__ == "__main__":
    sys.exit(main(PLANTED))
