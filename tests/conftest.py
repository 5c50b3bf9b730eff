"""Fixtures that every room of tests may use."""

import os
import signal
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# Before NumPy is there: threads that wait for others take most of the time of small matrices.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# No clock anywhere: a loaded machine must not fail correct code.  The same examples in every run.
settings.register_profile(
    "repeatable",
    max_examples=60,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("repeatable")


@pytest.fixture(autouse=True)
def _no_data_named(monkeypatch):
    """Let tests find published stone sets by `data_dir` alone, whatever the machine has set."""
    monkeypatch.delenv("DRYSTONE_DATA", raising=False)


@pytest.fixture(scope="session")
def data_dir():
    """Folder of the published stone sets; tests that need it skip when it is absent."""
    default = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("DRYSTONE_DATA", default))
    if not folder.is_dir():
        pytest.skip("published stone sets are absent (set DRYSTONE_DATA to their folder)")
    return folder


@pytest.fixture
def interruptible():
    """Have interrupts raise KeyboardInterrupt, also where a shell ignores them."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
