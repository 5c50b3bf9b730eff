"""Items on small walls, made once a module: `MADE` of the module, its runs kept in a folder."""

import pytest

from tests.lab.reproduce.small_walls import context


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("runs")


@pytest.fixture(scope="module")
def output(request, here):
    return request.module.MADE.make(here)


@pytest.fixture(scope="module")
def here(folder):
    """The context of items that are made from these runs."""
    return context(folder)
