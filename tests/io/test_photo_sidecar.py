"""What stands beside the label image of a photograph, and the photograph itself."""

from pathlib import Path

import pytest

from drystone.errors import InputError
from drystone.io.photo_beside import photo_beside, photo_of, place_photo
from drystone.io.photo_sidecar import SIDECAR, PhotoSidecar, read_sidecar, write_sidecar


def test_it_comes_back(tmp_path: Path) -> None:
    sidecar = PhotoSidecar(640, 480, 512.5, "photo.jpg", {"markers": [1, 2]})
    write_sidecar(sidecar, tmp_path)
    assert read_sidecar(tmp_path / "stones.png") == PhotoSidecar(640, 480, 512.5, "photo.jpg")


def test_another_picture_has_none(tmp_path: Path) -> None:
    write_sidecar(PhotoSidecar(640, 480), tmp_path)
    assert read_sidecar(tmp_path / "other.png") is None
    assert read_sidecar(tmp_path / "deeper" / "stones.png") is None


def test_a_folder_without_a_name_has_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert read_sidecar(Path()) is None
    assert photo_of(Path()) is None


def test_json_of_another_kind_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / SIDECAR).write_text('{"schema": "drystone-plan/1"}', encoding="utf-8")
    assert read_sidecar(tmp_path / "stones.png") is None


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[" * 100_000,
        '{"schema": "drystone-photo/1"}',
        '{"schema": "drystone-photo/1", "px_per_m": -1, "width_px": 1, "height_px": 1}',
        '{"schema": "drystone-photo/1", "px_per_m": "x", "width_px": 1, "height_px": 1}',
    ],
)
def test_damage_is_said(tmp_path: Path, text: str) -> None:
    (tmp_path / SIDECAR).write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="E112"):
        read_sidecar(tmp_path / "stones.png")


def test_the_photograph_goes_beside_the_plan(tmp_path: Path) -> None:
    found, plan = tmp_path / "found", tmp_path / "plan"
    found.mkdir()
    plan.mkdir()
    (found / "photo.jpg").write_bytes(b"a picture")
    (found / "stones.png").write_bytes(b"labels")
    write_sidecar(PhotoSidecar(640, 480, photo="photo.jpg"), found)
    for stones in (found, found / "stones.png"):
        assert photo_of(stones) == found / "photo.jpg"
    assert place_photo(photo_of(found), plan) == plan / "photo.jpg"
    assert photo_beside(plan) == plan / "photo.jpg"
    place_photo(None, plan)  # the next plan has none
    assert photo_beside(plan) is None


def test_the_name_of_a_photograph_leads_nowhere_else(tmp_path: Path) -> None:
    folder = tmp_path / "found"
    folder.mkdir()
    (tmp_path / "photo.jpg").write_bytes(b"not yours")
    write_sidecar(PhotoSidecar(640, 480, photo="../photo.jpg"), folder)
    assert photo_of(folder / "stones.png") is None
