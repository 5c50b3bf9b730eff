"""Calls into other people's decoders: what they raise becomes a coded error, and none prints."""

import logging
import os
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from drystone.errors import DrystoneError, InputError

_LONGEST = 200

for _package in ("PIL", "ezdxf", "tifffile", "trimesh"):
    # Without any handler logging prints to stderr; those of the user's own program still hear.
    logging.getLogger(_package).addHandler(logging.NullHandler())


@contextmanager
def foreign(failed: Callable[[str], DrystoneError]) -> Iterator[None]:
    """Turn whatever another package raises into a coded error, and silence its warnings.

    Parsers of other people raise anything on damaged bytes, so there is no list of what to expect.
    Only the call into them belongs inside: a fault of ours must stay one.  `failed` makes the error
    from a reason; E110 says where the memory is not large enough.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except DrystoneError:
        raise
    except MemoryError as error:
        what = "there is not enough memory for what is in this file."
        where = failed("").where
        raise InputError("E110", what, where=where, cure="Reduce it or crop it.") from error
    except Exception as error:
        # Where an object lies in memory is another place in every run.
        reason = " ".join(re.sub(r" at 0x[0-9a-f]+", "", str(error)).split())
        raise failed(reason[:_LONGEST] or type(error).__name__) from error


@contextmanager
def silent_stderr() -> Iterator[None]:
    """Throw away what a library in C writes to stderr by itself, as libtiff does."""
    try:
        kept = os.dup(2)
    except OSError:  # there is none
        yield
        return
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 2)
        os.close(nowhere)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
