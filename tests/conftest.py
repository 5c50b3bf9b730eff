"""Fixtures that every room of tests may use."""

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# No clock anywhere: a loaded machine must not fail correct code.  The same examples in every run.
settings.register_profile(
    "repeatable",
    max_examples=60,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("repeatable")


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Folder of the published stone sets; tests that need it skip when it is absent."""
    default = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("DRYSTONE_DATA", default))
    if not folder.is_dir():
        pytest.skip("published stone sets are absent (set DRYSTONE_DATA to their folder)")
    return folder


@pytest.fixture(scope="session")
def trust_dir() -> Path:
    """Folder of files that once hung, ran or crashed the readers; skip when it is absent."""
    default = Path(__file__).resolve().parents[2] / "shared" / "cases"
    folder = Path(os.environ.get("DRYSTONE_CASES", default)) / "trust"
    if not folder.is_dir():
        pytest.skip("failing inputs are absent (set DRYSTONE_CASES to their folder)")
    return folder
