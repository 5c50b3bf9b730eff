"""Items on small walls: runs are kept in a folder for all of a module."""

import pytest

from tests.lab.reproduce.small_walls import context


@pytest.fixture(scope="module")
def here(tmp_path_factory):
    """The context of items that are made from these runs."""
    return context(tmp_path_factory.mktemp("runs"))
