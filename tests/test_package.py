"""The package as a whole: its names, its examples, its list of errors."""

import doctest
import importlib
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import drystone
import drystone_lab
from drystone.errors import CODES

ROOT = Path(__file__).resolve().parents[1]
CODE = re.compile(r'(?<!`)"([EW]\d{3})"')
"""As it is written where it is raised; examples in docstrings stand in backticks."""

ROW = re.compile(r"^\| ([EW]\d{3}) \| (.+) \| (.+) \|$", re.MULTILINE)
MODULES = sorted(
    module.name
    for package in (drystone, drystone_lab)
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    if module.name != "drystone.__main__"
)


def test_importing_loads_nothing_heavy():
    code = "import sys, drystone; sys.exit(bool({'numpy', 'scipy', 'matplotlib'} & {*sys.modules}))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0  # noqa: S603


def test_every_public_name_is_there():
    for name in drystone.__all__:
        assert getattr(drystone, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'wonder'"):
        drystone.wonder  # noqa: B018


@pytest.mark.parametrize("package", ["drystone", "drystone_lab"])
def test_the_examples_of_the_docstrings_run(package):
    names = [package, *(name for name in MODULES if name.startswith(f"{package}."))]
    found = {name: doctest.testmod(importlib.import_module(name)) for name in names}
    assert [name for name, one in found.items() if one.failed] == []
    assert sum(one.attempted for one in found.values()) > 9


def test_no_two_classes_have_one_name():
    places = {}
    for path in sorted((ROOT / "src").rglob("*.py")):
        for name in re.findall(r"^ *class (\w+)[:(]", path.read_text("utf-8"), re.MULTILINE):
            places.setdefault(name, []).append(str(path.relative_to(ROOT)))
    assert len(places) > 99
    assert {name: found for name, found in places.items() if len(found) > 1} == {}


def test_every_error_code_is_explained():
    text = (ROOT / "docs" / "errors.md").read_text(encoding="utf-8")
    rows = ROW.findall(text)
    codes = [code for code, _, _ in rows]
    assert len(set(codes)) == len(codes), "a code has two rows"
    assert sorted(codes) == list(CODES), "docs/errors.md and drystone.errors.CODES differ"
    sources = [path.read_text(encoding="utf-8") for path in (ROOT / "src").rglob("*.py")]
    raised = [text.partition("\nCODES = {")[0] for text in sources]
    used = {code for text in raised for code in CODE.findall(text)}
    assert sorted(used - set(codes)) == [], "without a meaning in drystone.errors.CODES"
    assert sorted(set(codes) - used) == [], "with a meaning, but nowhere raised"
    assert all(meaning.strip() and cure.strip() for _, meaning, cure in rows)
    for section in text.split("\n## ")[1:]:
        codes = [code for code, _, _ in ROW.findall(section)]
        assert codes == sorted(codes)
