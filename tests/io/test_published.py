"""Published sets arrive whole or not at all, and what is there is never replaced."""

import sys
from hashlib import sha256
from pathlib import Path

import numpy as np
import pooch
import pytest
from PIL import Image

from drystone.errors import InputError
from drystone.io import published as module
from drystone.io.published import (
    LICENCE,
    NOTICE,
    SETS,
    destination,
    fetch_set,
    published_file,
    published_folder,
)
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.pictures import codes
from tests.io.served import CONTENTS, lay_down, lay_open, nobody, serving, toy_set


@pytest.fixture(autouse=True)
def _no_cache(monkeypatch, tmp_path):
    monkeypatch.setattr(pooch, "os_cache", lambda project: tmp_path / "cache" / project)


def test_the_published_files_hash_as_they_should(data_dir):
    for published in SETS.values():
        for file in published.files:
            assert sha256((data_dir / file.name).read_bytes()).hexdigest() == file.sha256
    assert (data_dir / NOTICE).read_text(encoding="utf-8") == LICENCE
    assert not any(f.downloaded for s in SETS.values() for f in fetch_set(s, data_dir))


def test_what_is_missing_is_downloaded_once_and_with_its_licence(tmp_path):
    served, folder = lay_open(tmp_path / "served"), lay_down(tmp_path / "here", "toy/R.png")
    with serving(served) as address:
        first = fetch_set(toy_set(), folder, address=address)
        (served / toy_set().files[1].address).unlink()
        with pytest.raises(InputError, match=r"E161 .*404"):
            fetch_set(toy_set(), tmp_path / "half", address=address)
    assert [(file.path, file.downloaded) for file in first] == [
        (folder / "toy" / "R.png", False), (folder / "toy" / "IR.png", True),
    ]  # fmt: skip
    assert {name: (folder / name).read_bytes() for name in CONTENTS} == CONTENTS
    assert not any(f.downloaded for f in fetch_set(toy_set(), folder, address=nobody()))
    # What arrived before a failure has its licence too.
    assert (tmp_path / "half" / "toy" / "R.png").exists()
    for place in (folder, tmp_path / "half"):
        assert (place / NOTICE).read_text(encoding="utf-8") == LICENCE


def test_neither_is_another_file_of_the_name_replaced_nor_other_contents_kept(tmp_path):
    mine = lay_down(tmp_path, "toy/R.png") / "toy" / "R.png"
    mine.write_bytes(b"my own")
    with pytest.raises(InputError, match=r"E160 .*R\.png.*Move it away"):
        fetch_set(toy_set(), tmp_path, address=nobody())
    assert mine.read_bytes() == b"my own"
    served = lay_open(tmp_path / "served")
    (served / toy_set().files[0].address).write_bytes(b"something else")
    said = r"E160 .*another network, or save http"
    with serving(served) as address, pytest.raises(InputError, match=said):
        fetch_set(toy_set(), tmp_path / "here", address=address)
    assert list((tmp_path / "here").rglob("*.*")) == []


def test_no_network_says_what_to_do_by_hand_but_a_full_disk_is_no_fault_of_it(
    tmp_path, monkeypatch
):
    address, file = nobody(), toy_set().files[0]
    with pytest.raises(InputError, match=r"E161 .*refused.*DRYSTONE_DATA") as caught:
        fetch_set(toy_set(), tmp_path, address=address)
    assert f"save {address}/{file.address} as {tmp_path / file.name}" in caught.value.cure

    def full(*_, **__):
        raise OSError(28, "No space left on device", str(tmp_path))

    monkeypatch.setattr(pooch, "retrieve", full)
    with pytest.raises(OSError, match="No space left") as caught:
        fetch_set(toy_set(), tmp_path, address=address)
    assert caught.value.errno == 28


def test_without_pooch_files_that_are_there_are_still_checked(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pooch", None)
    lay_down(tmp_path, *CONTENTS)
    assert len(fetch_set(toy_set(), tmp_path)) == 2
    (tmp_path / "toy" / "IR.png").unlink()
    with pytest.raises(InputError, match=r"E162 .*drystone\[fetch\].*By hand: save"):
        fetch_set(toy_set(), tmp_path)
    with pytest.raises(InputError, match=r"E162 .*-o DIR"):
        destination(None)
    assert published_folder(None) is None


def test_the_option_wins_over_the_variable_and_that_over_the_cache(tmp_path, monkeypatch):
    cache = tmp_path / "cache" / "drystone"
    assert published_folder(None) is None
    assert destination(None) == cache
    cache.mkdir(parents=True)
    assert published_folder(None) is None
    (cache / "almeida").mkdir()
    assert published_folder(None) == cache
    monkeypatch.setenv("DRYSTONE_DATA", str(tmp_path / "named"))
    assert published_folder(None) == destination(None) == tmp_path / "named"
    assert published_folder("given") == destination("given") == Path("given")


def test_a_published_file_is_opened_only_with_its_contents(monkeypatch, tmp_path):
    monkeypatch.setattr(module, "SETS", {"toy": toy_set()})
    toys = lay_down(tmp_path, *CONTENTS)
    (toys / "mine.png").write_bytes(b"mine")
    for name in (*CONTENTS, "mine.png"):  # which is in no set
        assert published_file(toys, name) == toys / name
    (toys / "toy" / "R.png").write_bytes(CONTENTS["toy/IR.png"])
    with pytest.raises(InputError) as caught:
        published_file(toys, "toy/R.png")
    assert (caught.value.code, caught.value.where) == ("E160", str(toys / "toy" / "R.png"))
    assert f"drystone fetch toy -o {toys}" in caught.value.cure
    assert toy_set().files[0].address in caught.value.cure
    # Files of the cache are fetched again without naming it, and what is missing is not checked.
    monkeypatch.setattr(pooch, "os_cache", lambda _: toys)
    with pytest.raises(InputError, match=r"\(`drystone fetch toy`\)"):
        published_file(toys, "toy/R.png")
    (toys / "toy" / "R.png").unlink()
    assert not published_file(toys, "toy/R.png").exists()


NOISES = dict(zip(range(10, 90, 10), (28, 23, 22, 26, 27, 23, 25, 18), strict=True))
COUNTS = {
    **{f"almeida/{name}.png": count for name, count in (("IR", 61), ("PR", 32), ("R", 34))},
    **{f"thangavelu/noise_{noise}.png": count for noise, count in NOISES.items()},
    "rubble/rubble.png": 91,
}
SAID = {
    "rubble/rubble.png": "W114",
    "thangavelu/noise_20.png": "W111",
    "thangavelu/noise_30.png": "W136",
    "thangavelu/noise_80.png": "W111",
}


@pytest.mark.parametrize("name", COUNTS)
def test_published_pictures_have_the_stones_that_their_authors_count(data_dir, name):
    """Regions of 50 px and more, by default and by that rule."""
    for least_px in (None, 50):
        stones = read_stones(data_dir / name, settings=ReadSettings(min_area_px=least_px))
        assert len(stones) == COUNTS[name]
        assert min(stone.area_px for stone in stones) >= 50
    if name in SAID:
        assert codes(stones)[0] == SAID[name]
        return
    assert codes(stones) == []
    with Image.open(data_dir / name) as image:
        grey = np.asarray(image if image.mode == "L" else image.getchannel("R"))
    assert stones.total_area_px == np.count_nonzero(grey)
