"""The published pictures of stones are read whole."""

import numpy as np
import pytest
from PIL import Image

from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.pictures import codes

COUNTS = {
    "almeida/IR.png": 61,
    "almeida/PR.png": 32,
    "almeida/R.png": 34,
    "thangavelu/noise_10.png": 28,
    "thangavelu/noise_20.png": 23,
    "thangavelu/noise_40.png": 26,
    "thangavelu/noise_50.png": 27,
    "thangavelu/noise_70.png": 25,
}
LEFT_OUT_PX = {"thangavelu/noise_20.png": 12}


@pytest.mark.parametrize("name", COUNTS)
def test_published_picture(data_dir, name):
    stones = read_stones(data_dir / name)
    with Image.open(data_dir / name) as image:
        grey = np.asarray(image if image.mode == "L" else image.getchannel("R"))
    ids = [int(i) for i in np.unique(grey) if i]
    assert len(ids) == COUNTS[name]
    assert [stone.id for stone in stones] == ids
    left_out = LEFT_OUT_PX.get(name, 0)
    assert stones.total_area_px == int((grey > 0).sum()) - left_out
    assert codes(stones) == (["W111"] if left_out else [])
    for stone in stones:
        top = grey.shape[0] - stone.bottom_px - stone.mask.shape[0]
        rows = slice(top, top + stone.mask.shape[0])
        cols = slice(stone.left_px, stone.left_px + stone.mask.shape[1])
        assert (grey[rows, cols][stone.mask] == stone.id).all()


@pytest.mark.parametrize(
    ("name", "count", "said"),
    [
        *((f"thangavelu/noise_{noise}0.png", n, "") for noise, n in zip(
            range(1, 9), (28, 23, 22, 26, 27, 23, 25, 18), strict=True)),
        ("rubble/rubble.png", 91, "W114"),
    ],
)  # fmt: skip
def test_published_pictures_have_the_stones_that_their_authors_count(data_dir, name, count, said):
    """Regions of 50 px and more, by default and by that rule."""
    for least_px in (None, 50):
        stones = read_stones(data_dir / name, settings=ReadSettings(min_area_px=least_px))
        assert len(stones) == count
        assert min(stone.area_px for stone in stones) >= 50
        assert said in codes(stones) or not said
    assert ("W136" in codes(stones)) == ("noise_30" in name)
