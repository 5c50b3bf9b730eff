"""Items on small walls, made once a module: `MADE` of the module, its runs kept in a folder."""

from pathlib import Path

import pytest

from drystone_lab.reproduce.item import Output
from tests.lab.reproduce.small_walls import context


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("runs")


@pytest.fixture(scope="module")
def output(request: pytest.FixtureRequest, folder: Path) -> Output:
    made: Output = request.module.MADE.make(context(folder))
    return made
