"""Free space around a mask, compiled and NumPy, against walking pixel by pixel."""

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels import columns
from drystone.kernels.backend import compiled
from drystone.kernels.columns import free_below, free_beside, gap_filling
from drystone.kernels.raster import Mask
from tests.naive import overlap as naive
from tests.naive.placement import all_positions, gap_beside, void_below
from tests.naive.support import gap_pixels
from tests.strategies import landscapes, masks, repeatable

FAST = compiled("columns")
KERNELS = [
    pytest.param(None, id="numpy"),
    pytest.param(
        FAST,
        id="compiled",
        marks=pytest.mark.skipif(FAST is None, reason="kernels are not compiled here"),
    ),
]


@pytest.fixture(autouse=True, scope="module", params=KERNELS)
def kernel(request: pytest.FixtureRequest) -> Iterator[None]:
    """Everything here by NumPy, then by the compiled kernels."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(columns, "_fast", request.param)
        yield


def lowest(mask: Mask) -> columns.Ints:
    return np.asarray(mask.shape[0] - 1 - np.argmax(mask[::-1], axis=0))


@repeatable(150)
@given(data=st.data(), occupied=landscapes(14), mask=masks(), mirror=st.booleans())
def test_free_space_is_counted_pixel_by_pixel(
    data: st.DataObject, occupied: Mask, mask: Mask, mirror: bool
) -> None:
    if mirror:  # views with strides of their own
        occupied, mask = np.pad(occupied, 1)[1:-1, -2:0:-1], np.asfortranarray(mask)
    free = [at for at in all_positions(occupied, mask) if not naive.overlaps(occupied, mask, *at)]
    if not free:
        return
    row, col = data.draw(st.sampled_from(free))
    below = free_below(occupied, lowest(mask), row, col)
    single = [
        void_below(occupied, mask[:, j : j + 1], (row, col + j)) for j in range(mask.shape[1])
    ]
    assert below.dtype == np.intp
    assert below.tolist() == single
    beside = free_beside(occupied, mask, row, col)
    flipped_col = occupied.shape[1] - col - mask.shape[1]
    assert beside[0] == gap_beside(occupied, mask, (row, col))
    rows = [
        gap_beside(occupied[:, ::-1], mask[k : k + 1, ::-1], (row + k, flipped_col))
        for k in range(mask.shape[0])
    ]
    assert beside[-1] == min(rows)


@repeatable(150)
@given(
    data=st.data(),
    occupied=landscapes(16),
    mask=masks(),
    sizes=st.tuples(st.integers(1, 3), st.integers(0, 6)),
)
def test_a_filling_has_the_pixels_of_the_gap_that_is_lowest(
    data: st.DataObject, occupied: Mask, mask: Mask, sizes: tuple[int, int]
) -> None:
    free = [at for at in all_positions(occupied, mask) if not naive.overlaps(occupied, mask, *at)]
    if not free:
        return
    at = data.draw(st.sampled_from(free))
    first, end = data.draw(st.tuples(*[st.integers(0, mask.shape[1])] * 2))
    sizes = sizes[0], sizes[0] + sizes[1]
    expected = gap_pixels(occupied, mask, at, (first, end), sizes)
    filling = gap_filling(occupied, mask, *at, (first, end), sizes)
    if filling is None:
        assert expected is None
        return
    pixels, top, left = filling
    rows, cols = np.nonzero(pixels)
    found = {(top + i, left + j) for i, j in zip(rows.tolist(), cols.tolist(), strict=True)}
    assert found == expected
    assert pixels.dtype == bool
    assert pixels.any(axis=0).all()
    assert pixels[0].any()
    assert pixels[-1].any()


@pytest.mark.parametrize("mirror", [False, True])
def test_wide_gaps_are_counted_to_the_pixel(mirror: bool) -> None:
    mask = np.ones((2, 1), bool)
    for gap in range(30):
        occupied = np.zeros((2, 40), bool)
        occupied[1, 34 - gap : 35 - gap] = True
        scene = np.ascontiguousarray(occupied[:, ::-1])[:, ::-1] if mirror else occupied
        assert free_beside(scene, mask, 0, 35) == (35 + gap, 4)


def gap_of(*heights: int) -> Mask:
    """A landscape under a row of pixels, with free columns of these heights."""
    occupied = np.zeros((1 + max(heights), len(heights)), bool)
    for col, height in enumerate(heights):
        occupied[1 + height :, col] = True
    return occupied


@pytest.mark.parametrize(
    ("heights", "sizes", "columns_taken"),
    [
        ((5, 2, 2, 5, 5), (2, 9), (1, 3)),
        ((5, 3, 2, 3, 5), (2, 9), (1, 4)),  # a pixel higher goes with the lowest
        ((5, 2, 4, 5, 9), (2, 9), (1, 3)),  # two, as it would be too narrow
        ((5, 3, 5, 6, 9), (3, 9), (0, 3)),  # three, both sides at once
        ((1, 2, 2, 9, 2), (2, 4), (1, 3)),  # too low and too high stay out
        ((1, 2, 9, 3, 3), (2, 4), None),  # what is not lowest does not touch first
        ((2, 2, 9, 2, 2, 2), (2, 4), (0, 2)),  # of two runs the left one
        ((2, 9, 2, 2, 2, 9), (2, 4), (2, 5)),
        ((2, 9, 2, 9, 2), (2, 4), None),
        ((1, 1, 1), (2, 4), None),
        ((5, 5, 5), (2, 4), None),
    ],
)
def test_the_columns_that_touch_first_are_filled(
    heights: tuple[int, ...], sizes: tuple[int, int], columns_taken: tuple[int, int] | None
) -> None:
    bar = np.ones((1, len(heights)), bool)
    filling = gap_filling(gap_of(*heights), bar, 0, 0, (0, len(heights)), sizes)
    if columns_taken is None:
        assert filling is None
    else:
        assert filling is not None
        assert (filling[2], filling[2] + filling[0].shape[1]) == columns_taken
        assert filling[0].sum(axis=0).tolist() == list(heights[slice(*columns_taken)])


def test_a_filling_that_would_fall_apart_is_none() -> None:
    """Two columns of the same height, the second one lower than the first by that height."""
    mask = np.array([[1, 1], [0, 1], [0, 1], [0, 1]], bool)
    occupied = np.zeros((8, 2), bool)
    occupied[4:, 0] = True
    occupied[7:, 1] = True
    assert gap_filling(occupied, mask, 0, 0, (0, 2), (1, 5)) is None
    occupied[4, 0] = False
    joined = gap_filling(occupied, mask, 0, 0, (0, 2), (1, 5))
    assert joined is not None
    assert joined[0].tolist() == [[i < 4, i > 2] for i in range(6)]


@pytest.mark.parametrize("columns", [(0, -1), (-2, 3), (0, 4)])
def test_columns_outside_are_refused(columns: tuple[int, int]) -> None:
    """Of slices from the end NumPy would make something else."""
    with pytest.raises(ValueError, match="columns"):
        gap_filling(np.zeros((6, 6), bool), np.ones((2, 3), bool), 0, 0, columns, (1, 3))


@pytest.mark.parametrize("at", [(-1, 0), (0, -1), (3, 0), (0, 4)])
def test_a_mask_outside_is_refused(at: tuple[int, int]) -> None:
    occupied, mask = np.zeros((4, 5), bool), np.ones((2, 2), bool)
    with pytest.raises(ValueError, match="leaves the landscape"):
        free_beside(occupied, mask, *at)
    with pytest.raises(ValueError, match="leaves the landscape"):
        gap_filling(occupied, mask, *at, (0, 2), (1, 3))
    if at[0] < 3:
        with pytest.raises(ValueError, match="leave the landscape"):
            free_below(occupied, lowest(mask), *at)
