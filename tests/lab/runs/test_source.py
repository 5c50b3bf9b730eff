from pathlib import Path

import pytest

from drystone.errors import DrystoneError, InputError
from drystone_lab.runs.spec import GENERATORS, from_file, generated, published
from tests.lab.runs.bricks import picture


@pytest.mark.parametrize("kind", GENERATORS)
def test_a_generator_makes_the_same_stones_of_a_seed(kind: str) -> None:
    first, again, other = (generated(kind, seed, count=5).stones(None) for seed in (3, 3, 4))
    assert len(first) == 5
    assert [stone.mask.tobytes() for stone in first] == [stone.mask.tobytes() for stone in again]
    if kind != "brick":  # all alike
        assert [stone.mask.tobytes() for stone in first] != [
            stone.mask.tobytes() for stone in other
        ]


def test_published_stones_are_read_from_their_folder(tmp_path: Path) -> None:
    source = published("set/bricks.png")
    assert not source.is_there(None)
    assert not source.is_there(tmp_path)
    picture(tmp_path / "set" / "bricks.png")
    assert source.is_there(tmp_path)
    assert len(source.stones(tmp_path)) == 6


def test_other_stones_in_the_place_of_published_ones(tmp_path: Path) -> None:
    source = published("almeida/PR.png")
    source.check(None)
    source.check(tmp_path)  # a file that is missing is another matter
    picture(tmp_path / "almeida" / "PR.png")
    for refused in (source.check, source.stones):
        with pytest.raises(InputError, match="E160"):
            refused(tmp_path)


def test_a_file_that_was_changed_is_another_source(tmp_path: Path) -> None:
    before = from_file(picture(tmp_path / "own.png", count=6))
    after = from_file(picture(tmp_path / "own.png", count=7))
    assert before != after
    assert len(after.stones(None)) == 7
    with pytest.raises(DrystoneError) as caught:
        before.stones(None)
    assert (caught.value.code, caught.value.where) == ("E100", str(tmp_path / "own.png"))
