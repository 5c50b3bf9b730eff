"""Panels in rows on one sheet."""

import pytest

from drystone_lab.pictures.walls import EMPTY, Panel, sheet_of


def _panel(title: str, aspect: float) -> Panel:
    return Panel(title, aspect, lambda ax: ax.plot([0, 1], [0, 1], label="line"))


def test_panels_go_from_left_to_right_and_down_and_never_overlap() -> None:
    panels = [_panel("a", 0.2), _panel("b\nsecond", 0.5), EMPTY, _panel("d", 0.3)]
    figure = sheet_of(panels, 2)
    a, b, d = figure.axes
    boxes = [ax.get_position(original=True) for ax in (a, b, d)]
    assert [ax.get_title(loc="left") for ax in (a, b, d)] == ["a", "b\nsecond", "d"]
    assert boxes[0].x1 < boxes[1].x0 < 1
    assert boxes[2].x0 == pytest.approx(boxes[1].x0)
    assert boxes[2].y1 < boxes[1].y0
    assert min(box.y0 for box in boxes) > 0
    assert max(box.y1 for box in boxes) < 1


def test_a_panel_has_the_height_of_the_tallest_of_its_row() -> None:
    figure = sheet_of([_panel("", 0.2), _panel("", 0.5), _panel("", 0.3)], 2)
    inches = figure.get_size_inches()
    sizes = [ax.get_position(original=True).size * inches for ax in figure.axes]
    assert [high / wide for wide, high in sizes] == pytest.approx([0.5, 0.5, 0.3])
    assert {round(wide, 6) for wide, _ in sizes} == {round(sizes[0][0], 6)}


@pytest.mark.parametrize(("panels", "columns"), [([], 1), ([EMPTY], 0)])
def test_there_must_be_something(panels: list[Panel], columns: int) -> None:
    with pytest.raises(ValueError, match="a panel and a column"):
        sheet_of(panels, columns)
