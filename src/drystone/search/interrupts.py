"""Interrupts (Ctrl-C) and termination (SIGTERM), and what they must not take away."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Terminated(KeyboardInterrupt):
    """The system wants an end: whatever catches an interrupt catches this too."""


@contextmanager
def terminable() -> Iterator[Callable[[], int | None]]:
    """Let SIGTERM raise :class:`Terminated`, as Ctrl-C raises an interrupt, and note both.

    Only the main thread may set handlers; in others nothing changes.
    """
    came: list[int] = []

    def end(number: int, _: FrameType | None) -> None:
        came.append(number)
        raise Terminated if number == signal.SIGTERM else KeyboardInterrupt

    if not _may_set():
        yield lambda: None
        return
    before = {one: signal.getsignal(one) for one in SIGNALS}
    for one, handler in before.items():
        # What runs in the background of a shell does not hear Ctrl-C.
        if one != signal.SIGINT or handler != signal.SIG_IGN:
            signal.signal(one, end)
    try:
        yield lambda: came[-1] if came else None
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)


@contextmanager
def held() -> Iterator[None]:
    """Put interrupts and termination off until the block has ended; the first is raised then.

    For the end of a work: a second signal must not take away what the first one has left.
    """
    if not _may_set():
        yield
        return
    came: list[int] = []
    before = {one: signal.getsignal(one) for one in SIGNALS}
    for one in SIGNALS:
        signal.signal(one, lambda number, _: came.append(number))
    try:
        yield
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)
        if came:
            signal.raise_signal(came[0])


@contextmanager
def blocked() -> Iterator[None]:
    """Have the system keep interrupts and termination back, from what is started meanwhile too.

    Where it can: elsewhere nothing changes.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _may_set() -> bool:
    """Say whether handlers may be set here, and those that are there can be put back."""
    return threading.current_thread() is threading.main_thread() and not any(
        signal.getsignal(one) is None for one in SIGNALS
    )
