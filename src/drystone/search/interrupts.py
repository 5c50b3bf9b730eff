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

    # What runs in the background of a shell does not hear Ctrl-C.
    deaf = signal.getsignal(signal.SIGINT) == signal.SIG_IGN
    with _handled(end, SIGNALS[1:] if deaf else SIGNALS):
        yield lambda: came[-1] if came else None


@contextmanager
def held() -> Iterator[None]:
    """Put interrupts and termination off until the block has ended; the first is raised then.

    For the end of a work: a second signal must not take away what the first one has left.
    """
    came: list[int] = []
    try:
        with _handled(lambda number, _: came.append(number), SIGNALS):
            yield
    finally:
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


@contextmanager
def _handled(
    handler: Callable[[int, FrameType | None], None], signals: tuple[signal.Signals, ...]
) -> Iterator[None]:
    """Have signals handled so, where handlers may be set, and those that are there put back."""
    before = {one: signal.getsignal(one) for one in SIGNALS}
    if threading.current_thread() is not threading.main_thread() or None in before.values():
        yield
        return
    for one in signals:
        signal.signal(one, handler)
    try:
        yield
    finally:
        for one in signals:
            signal.signal(one, before[one])
