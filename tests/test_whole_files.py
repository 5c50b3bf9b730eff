"""Files are whole or as they were, whatever stops the writing."""

from pathlib import Path

import pytest

from drystone.errors import PlanError
from drystone.whole_files import write_whole


def test_a_file_is_written_and_replaced(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    for data in (b"one", b"two"):
        write_whole(path, data)
        assert path.read_bytes() == data
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("place", ["write_bytes", "replace"])
def test_an_interrupt_leaves_nothing_behind(
    place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(path: Path, *_: object) -> None:
        with path.open("wb") as file:
            file.write(b"o")
        raise KeyboardInterrupt

    where = "os.replace" if place == "replace" else "pathlib.Path.write_bytes"
    monkeypatch.setattr(where, interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "a.txt", b"one")
    monkeypatch.undo()
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_names_the_file_and_leaves_it_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, data: bytes) -> int:
        with path.open("wb") as file:
            file.write(data[:1])
        raise OSError(28, "No space left on device")

    path = tmp_path / "a.txt"
    path.write_bytes(b"one")
    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(PlanError, match=r"E206.*No space left") as coded:
        write_whole(path, b"two")
    assert coded.value.where == str(path)
    assert [(one.name, one.read_bytes()) for one in tmp_path.iterdir()] == [("a.txt", b"one")]


def test_a_folder_that_is_none_is_an_error_of_the_path(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(PlanError, match=r"a\.txt"):
        write_whole(tmp_path / "file" / "a.txt", b"one")
