"""Archives of arrays."""

import numpy as np
import pytest

from drystone.errors import InputError
from drystone.io.read_stones import read_stones
from tests.io.known_stones import PIECES, compare, label_image, masks


def saved(tmp_path, **arrays):
    np.savez_compressed(tmp_path / "stones.npz", **arrays)
    return tmp_path / "stones.npz"


def test_an_array_of_labels_is_enough(tmp_path):
    path = saved(tmp_path, image=np.zeros((40, 60, 3)), labels=label_image(), x=np.arange(3))
    assert compare(read_stones(path, settings=PIECES)) == (1.0, 0.0, 0.0)


def test_a_mask_a_stone(tmp_path):
    given = {f"stone_{i}": mask.astype(np.uint8) * 255 for i, mask in masks().items()}
    stones = read_stones(saved(tmp_path, **given), settings=PIECES)
    assert compare(stones) == (1.0, 0.0, 0.0)
    assert stones.by_id(300).name == "stone_300"
    by_name = {f"m{i}": mask for i, mask in masks().items()}
    assert {stone.id for stone in read_stones(saved(tmp_path, **by_name), settings=PIECES)} == {
        *range(1, 8)
    }


@pytest.mark.parametrize(
    ("arrays", "text"),
    [
        ({"a": np.zeros((4, 4)), "b": np.zeros((5, 4))}, "not masks of one picture"),
        ({"a": np.zeros(4), "b": np.zeros(4)}, "not masks of one picture"),
        ({"a": np.eye(4), "b": np.arange(16).reshape(4, 4)}, "'b' is not a mask"),
    ],
)
def test_arrays_that_are_no_masks(tmp_path, arrays, text):
    with pytest.raises(InputError, match=rf"E114.*{text}"):
        read_stones(saved(tmp_path, **arrays))


def test_damaged_archives(tmp_path):
    path = saved(tmp_path, a=label_image())
    data = path.read_bytes()
    path.write_bytes(data[:-40])
    with pytest.raises(InputError, match=r"E106"):
        read_stones(path)
    np.savez(path, a=np.array([{}], dtype=object), b=np.zeros(3))
    with pytest.raises(InputError, match=r"E107.*pickle"):
        read_stones(path)
