import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.photo.layout import (
    PAGES_MM,
    margin_mm,
    parse_layout,
    sheet_positions_m,
    single_position_m,
)


def test_a_sheet_has_its_markers_in_the_corners_of_the_page():
    places = sheet_positions_m("A4", 0.05)
    expected = [[0.015, 0.015], [0.145, 0.015], [0.145, 0.232], [0.015, 0.232]]
    assert places == pytest.approx(np.array(expected))
    layout = parse_layout("a4:5cm")
    assert layout.page == "A4"
    assert layout.ids == (0, 1, 2, 3)
    assert layout.corners_m(2)[2] == pytest.approx([0.195, 0.282])
    assert [layout.group(one) for one in (0, 3, 4)] == [0, 0, 1]
    assert parse_layout("A4:").size_m == 0.05


def test_single_markers_have_a_size_and_no_place_and_fit_on_a_page():
    layout = parse_layout("0.12 m", printed=0.9)
    assert (layout.page, layout.group(7), layout.side_m) == (None, 7, pytest.approx(0.108))
    assert layout.corners_m(7)[2] == pytest.approx([0.108, 0.108])
    assert single_position_m("A4", 0.12) == pytest.approx([0.045, 0.03])
    with pytest.raises(UsageError, match="does not fit"):
        single_position_m("A4", 0.2)
    with pytest.raises(UsageError, match="not plausible"):
        parse_layout("A4", printed=97.0)


@pytest.mark.parametrize("page", PAGES_MM)
@pytest.mark.parametrize("size_mm", [10, 30, 50, 70])
def test_the_white_border_is_a_square_and_a_half_wide(page, size_mm):
    width, height = PAGES_MM[page]
    places = sheet_positions_m(page, size_mm / 1000) * 1000
    low, high = places.min(axis=0), places.max(axis=0) + size_mm
    border = 1.5 * size_mm / 6
    assert min(*low, width - high[0], height - high[1]) >= max(border, 15.0) - 1e-9
    assert places[1, 0] - places[0, 0] - size_mm >= border
    assert margin_mm(size_mm) >= border


@pytest.mark.parametrize(
    "text", ["", "50", "0mm", "50 inches", "A5", "A4:5mm", "A4:90mm", "A4:50", "-5mm"]
)
def test_what_is_no_layout(text):
    with pytest.raises(UsageError, match="E174"):
        parse_layout(text)


def test_the_largest_size_is_said_and_fits():
    with pytest.raises(UsageError, match="fit on A4") as caught:
        sheet_positions_m("A4", 0.09)
    largest = int(caught.value.cure.split()[1])
    sheet_positions_m("A4", largest / 1000)
    with pytest.raises(UsageError):
        sheet_positions_m("A4", (largest + 1) / 1000)
