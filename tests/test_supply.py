"""What is installed: checksums of all of it, and licences that were looked at."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PINNED = re.compile(
    r"^([a-z0-9-]+)==([^ ;\\]+)(?: ;[^\\]+)? ?\\\n((?:    --hash=sha256:[0-9a-f]{64}(?: \\)?\n)+)",
    re.MULTILINE,
)


def pinned(name):
    """Return names, versions and hashes of a lock, in which there is nothing else."""
    text = (ROOT / name).read_text(encoding="utf-8")
    found = set(PINNED.findall(text))
    rest = PINNED.sub("", text).splitlines()
    assert [line for line in rest if not line.lstrip().startswith("#")] == []
    return found


def test_locks_agree_and_have_a_checksum_for_everything():
    user, everything = pinned("requirements.lock"), pinned("requirements-dev.lock")
    assert user < everything
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    needed = [*project["build-system"]["requires"], *project["project"]["dependencies"]]
    names = {re.split(r"[<>=]", one)[0] for one in needed}
    assert names <= {name for name, *_ in user}
    extras = project["project"]["optional-dependencies"].values()
    more = {re.split(r"[<>=\[]", one)[0] for extra in extras for one in extra} - {"drystone"}
    assert more <= {name for name, *_ in everything}


LICENCES = {
    "gpl": "License-Expression: MIT AND GPL-3.0-only",
    "named": "Classifier: License :: OSI Approved :: GNU General Public License (GPL)",
    "commercial": "License: BSD, commercial",
    "silent": "Summary: says nothing of it",
    "lgpl": "License-Expression: MIT AND LGPL-2.1-only",
    "bsd": "Classifier: License :: OSI Approved :: BSD License",
}
FREE = {"lgpl", "bsd"}


@pytest.mark.parametrize("names", [set(LICENCES), FREE], ids=["all", "free"])
def test_licences_that_bind_are_refused(tmp_path, names):
    for name in names:
        folder = tmp_path / f"{name}-1.dist-info"
        folder.mkdir()
        text = f"Metadata-Version: 2.4\nName: made-up-{name}\nVersion: 1\n{LICENCES[name]}\n"
        (folder / "METADATA").write_text(text)
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, ROOT / "tools" / "licences.py"],
        check=False, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
    )  # fmt: skip
    assert "numpy" in ran.stdout
    assert set(re.findall("made-up-([a-z]+)", ran.stderr)) == names - FREE
    assert ran.returncode == bool(names - FREE), ran.stderr
