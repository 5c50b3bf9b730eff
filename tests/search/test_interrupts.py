"""Signals come when they may."""

import signal
from threading import Thread

import pytest

from drystone.search.interrupts import SIGNALS, Terminated, held, terminable

pytestmark = pytest.mark.usefixtures("interruptible")


def handlers():
    return [signal.getsignal(one) for one in SIGNALS]


def test_termination_is_an_interrupt_and_leaves_no_handler_behind():
    before = handlers()
    with terminable() as came:
        assert came() is None
        with pytest.raises(KeyboardInterrupt) as caught:
            signal.raise_signal(signal.SIGTERM)
        assert isinstance(caught.value, Terminated)
        assert came() == signal.SIGTERM
        with pytest.raises(KeyboardInterrupt) as caught:
            signal.raise_signal(signal.SIGINT)
        assert not isinstance(caught.value, Terminated)
        assert came() == signal.SIGINT
    assert handlers() == before


def test_an_interrupt_that_is_ignored_stays_ignored():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with terminable() as came:
            signal.raise_signal(signal.SIGINT)
            assert came() is None
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("first", SIGNALS)
def test_what_comes_while_they_are_held_comes_after_it_once(first):
    done = []

    def raise_all():
        for one in (first, *SIGNALS):
            signal.raise_signal(one)
            done.append(one)

    with terminable() as came:
        before = handlers()
        with pytest.raises(KeyboardInterrupt) as caught, held():
            raise_all()
        assert len(done) == 3
        assert isinstance(caught.value, Terminated) == (first == signal.SIGTERM)
        assert came() == first
        assert handlers() == before


def test_nothing_comes_where_nothing_came_and_errors_pass():
    before = handlers()
    with held():
        pass
    with pytest.raises(ZeroDivisionError), held():
        raise ZeroDivisionError
    assert handlers() == before


def test_other_threads_set_no_handlers():
    seen = []

    def look():
        with terminable() as came, held():
            seen.append([*handlers(), came()])

    thread = Thread(target=look)
    thread.start()
    thread.join()
    assert seen == [[*handlers(), None]]
