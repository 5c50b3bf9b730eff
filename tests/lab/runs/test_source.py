from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from drystone.errors import InputError
from drystone_lab.runs.spec import GENERATORS, generated, published
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


def test_published_pictures_may_be_read_otherwise(tmp_path: Path) -> None:
    path = tmp_path / "one.png"
    Image.fromarray(np.full((12, 24, 4), 255, np.uint8)).save(path)
    bricks = published("one.png", copies=3).stones(tmp_path)
    assert [(stone.id, stone.mask.shape) for stone in bricks] == [(n, (12, 24)) for n in (1, 2, 3)]
    grey = np.zeros((30, 40), np.uint8)
    grey[5:15, 5:15], grey[20:28, 20:38], grey[2, 2] = 7, 9, 8
    Image.fromarray(np.dstack([grey] * 3)).save(path)
    source = published("one.png", least_px=10)
    assert [stone.id for stone in source.stones(tmp_path)] == [7, 9]
    np.testing.assert_array_equal(source.labels(tmp_path), np.where(grey == 8, 0, grey))
