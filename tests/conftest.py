"""Fixtures that every room of tests may use."""

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Folder of the published stone sets; tests that need it skip when it is absent."""
    default = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("DRYSTONE_DATA", default))
    if not folder.is_dir():
        pytest.skip("published stone sets are absent (set DRYSTONE_DATA to their folder)")
    return folder
