"""TIFF of every depth, compression, layout and predictor gives the numbers that were written."""

from itertools import product

import numpy as np
import pytest
from fuzz.tiffs import DEFLATE, LZW, NONE, PACKBITS, write_tiff

from drystone.errors import InputError
from drystone.io.images import decode
from drystone.io.read_stones import read_stones
from tests.io.pictures import areas, codes, two_stones
from tests.io.test_formats import LIMIT


def labels(bits):
    """Ids up to the largest that the depth holds, in a picture whose rows end within a byte."""
    return two_stones(1, 2 ** min(bits, 16) - 1, np.int64)[:, :59]


LAYOUTS = [{}, {"rows": 7, "big": True}, {"tile": 16}]
packings = pytest.mark.parametrize("compression", [NONE, LZW, DEFLATE, PACKBITS])


def read_back(values, bits, compression, **choices):
    """Write and read numbers in all layouts, orders of bytes and combinations of choices."""
    for layout, *chosen in product(LAYOUTS, *choices.values()):
        options = layout | dict(zip(choices, chosen, strict=True))
        found = decode(write_tiff(values, bits, compression, **options), LIMIT).values
        found = found if found.dtype.kind == "f" else found.astype(np.int64)
        np.testing.assert_array_equal(found, values.squeeze(), err_msg=f"{bits} bits, {options}")


@packings
def test_whole_numbers_differences_and_numbers_with_a_point(compression):
    for bits in (1, 2, 4, 6, 8, 12, 16, 32):
        both = {"reverse": (False, True), "photometric": (0, 1)}
        read_back(labels(bits), bits, compression, order="<>", **both)
    for bits, channels in ((8, 1), (16, 1), (32, 1), (8, 3), (16, 3)):
        values = np.dstack([labels(bits), labels(bits) // 2, labels(bits) // 3])[..., :channels]
        read_back(values, bits, compression, order="<>", planar=(False, True), predictor=[2])
    for bits in (16, 32, 64):
        read_back(labels(8) + 0.5, bits, compression, order="<>", predictor=(1, 3), sample=[3])


@packings
@pytest.mark.parametrize("bits", [1, 4, 8, 16])
def test_what_a_sparse_file_leaves_out_is_ground(tmp_path, bits, compression):
    values = two_stones(1, 1, np.int64)
    values[:16] = 0  # two strips or four tiles
    for layout, missing, said in ((LAYOUTS[1], 2, "2 of 6"), (LAYOUTS[2], 4, "4 of 12")):
        data = write_tiff(values, bits, compression, sparse=range(missing), **layout)
        (tmp_path / "a.tif").write_bytes(data)
        np.testing.assert_array_equal(decode(data, LIMIT).values, values)
        stones = read_stones(tmp_path / "a.tif")
        assert stones.total_area_px == values.sum()
        assert f"{said} strips or tiles are not in the file (sparse)" in str(stones.notices[0])


def test_no_data_of_gdal_is_ground(tmp_path):
    def read(ground, bits, sample, said):
        values = np.where(two_stones() == 0, ground, two_stones(3, 7, np.int64))
        values[0, 0] = 0
        data = write_tiff(values, bits, DEFLATE, rows=5, sample=sample, tags={42113: said + b"\0"})
        (tmp_path / "a.tif").write_bytes(data)
        return read_stones(tmp_path / "a.tif")

    for case in ((-9999, 32, 3, b"-9999"), (-9999, 16, 2, b"-9999"), (200, 8, 1, b"200 ")):
        stones = read(*case)
        assert areas(stones) == {3: 375, 7: 600}
        assert codes(stones) == ["W135"]
        assert f"1424 px are {case[0]}, which the file says is no data" in str(stones.notices[0])
    with pytest.raises(InputError, match=r"E105 .*value 9 fills"):
        read(9, 8, 1, b"nan")  # no whole number is


def test_what_cannot_be_read_is_refused():
    for bits, options, text in (
        (4, {"predictor": 2}, r"E107 .*predictor 2 of 4 bits"),
        (8, {"tags": {317: [3]}}, r"E107 .*predictor 3 of 8 bits"),
        (8, {"tags": {317: [34892]}}, r"E107 .*predictor 34892"),
        (8, {"tags": {279: [50]}}, r"E106 .*too short"),
        (4, {"tags": {257: [90], 278: [90]}}, r"E106 .*too short"),
    ):
        with pytest.raises(InputError, match=text):
            decode(write_tiff(labels(bits), bits, **options), LIMIT)
