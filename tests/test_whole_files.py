"""Files are whole or as they were, whatever stops the writing."""

import os
from pathlib import Path

import pytest

from drystone.errors import PlanError
from drystone.whole_files import remove_parts, write_whole


def test_a_file_that_cannot_be_written_is_as_it_was_and_a_full_disk_names_it(tmp_path, monkeypatch):
    path, full = tmp_path / "a.txt", OSError(28, "No space left on device")
    path.write_bytes(b"one")
    for place, raised in (
        ("fsync", KeyboardInterrupt),
        ("replace", KeyboardInterrupt),
        ("fsync", full),
    ):

        def stop(*_, error=raised):
            assert len(list(tmp_path.iterdir())) == 2
            raise error

        with monkeypatch.context() as patch:
            patch.setattr(f"os.{place}", stop)
            with pytest.raises((KeyboardInterrupt, PlanError)) as caught:
                write_whole(path, b"two")
        assert [(one.name, one.read_bytes()) for one in tmp_path.iterdir()] == [("a.txt", b"one")]
    assert str(caught.value).startswith(f"E206 {path}: the file cannot be written (No space left")
    with pytest.raises(PlanError, match=r"b\.txt"):
        write_whole(path / "b.txt", b"one")


def test_a_file_is_on_the_disk_before_it_has_its_name(tmp_path, monkeypatch):
    done, path = [], tmp_path / "a.txt"
    synced, replaced = os.fsync, os.replace
    monkeypatch.setattr("os.fsync", lambda file: (done.append("fsync"), synced(file)))
    monkeypatch.setattr("os.replace", lambda a, b: (done.append("replace"), replaced(a, b)))
    for data in (b"one", b"two"):
        write_whole(path, data)
        assert path.read_bytes() == data
    assert done == ["fsync", "replace"] * 2
    assert list(tmp_path.iterdir()) == [path]


def test_what_a_killed_run_was_writing_is_removed_and_nothing_else(tmp_path, monkeypatch):
    for name in ("a.txt", ".b.part", ".c.0123.part", "d.part"):
        (tmp_path / name).write_bytes(b"one")
    before = sorted(tmp_path.iterdir())
    # A process that is killed unlinks nothing.
    with monkeypatch.context() as patch:
        patch.setattr("os.fsync", lambda _: 1 / 0)
        patch.setattr(Path, "unlink", lambda _: None)
        with pytest.raises(ZeroDivisionError):
            write_whole(tmp_path / "a.txt", b"two")
    assert len(list(tmp_path.iterdir())) == len(before) + 1
    remove_parts(tmp_path)
    assert sorted(tmp_path.iterdir()) == before
