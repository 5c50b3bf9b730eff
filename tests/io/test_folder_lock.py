"""One run at a time works in a folder, and nothing stays locked."""

import errno
import subprocess
import sys

import pytest

from drystone.errors import PlanError, UsageError
from drystone.io import folder_lock
from drystone.io.folder_lock import LOCK, has_files, locked

HOLDING = """
import sys, time
from pathlib import Path
from drystone.io.folder_lock import locked

with locked(Path(sys.argv[1])):
    print("locked", flush=True)
    time.sleep(1000)
"""


def enter(folder):
    with locked(folder):
        assert (folder / LOCK).exists()


def test_a_second_run_is_refused_until_the_first_has_ended(tmp_path):
    with locked(tmp_path):
        with pytest.raises(UsageError, match="E149") as caught:
            enter(tmp_path)
        assert caught.value.where == str(tmp_path)
        with pytest.raises(UsageError, match="E149"):
            enter(tmp_path)
    assert list(tmp_path.iterdir()) == []
    enter(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_lock_ends_with_its_process(tmp_path):
    command = [sys.executable, "-c", HOLDING, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as other:  # noqa: S603
        assert other.stdout.readline() == "locked\n"
        with pytest.raises(UsageError, match="E149"):
            enter(tmp_path)
        other.kill()
        other.wait()
    assert (tmp_path / LOCK).exists()
    assert not has_files(tmp_path)
    enter(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_what_a_killed_run_was_writing_goes(tmp_path):
    part = f".plan.json.{32 * 'a'}.part"
    ours, other = tmp_path / "pareto" / "01", tmp_path / "another run"
    for place in (tmp_path, ours, other):
        place.mkdir(parents=True, exist_ok=True)
        (place / part).write_bytes(b"half")
        (place / "mine.part").write_bytes(b"whole")
    with locked(tmp_path, "pareto/*/"):
        left = {path.parent for path in tmp_path.rglob(part)}
    assert left == {other}
    assert len(list(tmp_path.rglob("mine.part"))) == 3


def test_a_lock_that_is_removed_while_it_is_taken_is_taken_again(tmp_path, monkeypatch):
    """As by a run that ends just then."""
    taken, calls = folder_lock._lock, []

    def late(file):
        if not calls:
            (tmp_path / LOCK).unlink()
        elif len(calls) == 1:
            (tmp_path / LOCK).unlink()
            (tmp_path / LOCK).write_bytes(b"")
        calls.append(file)
        taken(file)

    monkeypatch.setattr(folder_lock, "_lock", late)
    with locked(tmp_path):
        assert len(calls) == 3
        monkeypatch.undo()
        with pytest.raises(UsageError, match="E149"):
            enter(tmp_path)


def test_where_there_are_no_locks_there_is_none(tmp_path, monkeypatch):
    def unknown(_):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(folder_lock, "_lock", unknown)
    with locked(tmp_path):
        enter(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_into_has_a_code(tmp_path):
    (tmp_path / LOCK).mkdir()
    with pytest.raises(PlanError, match="E206"):
        enter(tmp_path)
