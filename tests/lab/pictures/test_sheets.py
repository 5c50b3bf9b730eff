"""Panels and walls side by side on one sheet."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

from drystone.drawing.palette import PLAIN_COLOUR, cluster_colour
from drystone_lab.pictures import walls
from tests.drawing.examples import CLUSTERS, WEDGE, wall


def _panel(title, aspect):
    return walls.Panel(title, aspect, lambda ax: ax.plot([0, 1], [0, 1], label="line"))


def test_panels_go_from_left_to_right_and_down_and_never_overlap():
    panels = [_panel("a", 0.2), _panel("b\nsecond", 0.5), walls.EMPTY, _panel("d", 0.3)]
    figure = walls.sheet_of(panels, 2)
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["a", "b\nsecond", "d"]
    boxes = [ax.get_position(original=True) for ax in figure.axes]
    assert boxes[0].x1 < boxes[1].x0 < 1
    assert boxes[2].x0 == pytest.approx(boxes[1].x0)
    assert boxes[2].y1 < boxes[1].y0
    assert min(box.y0 for box in boxes) > 0
    assert max(box.y1 for box in boxes) < 1


def test_a_panel_has_the_height_of_the_tallest_of_its_row():
    figure = walls.sheet_of([_panel("", 0.2), _panel("", 0.5), _panel("", 0.3)], 2)
    inches = figure.get_size_inches()
    sizes = [ax.get_position(original=True).size * inches for ax in figure.axes]
    assert [high / wide for wide, high in sizes] == pytest.approx([0.5, 0.5, 0.3])
    assert {round(wide, 6) for wide, _ in sizes} == {round(sizes[0][0], 6)}


def test_every_wall_is_drawn_whole_under_its_title():
    figure = walls.plot_walls([("one", wall(), CLUSTERS), ("two\nlines", wall(), None)], 2)
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["one", "two\nlines"]
    for ax in figure.axes:
        gids = {patch.get_gid() for patch in ax.patches}
        assert {f"stone-{p.stone_id}" for p in wall().placements} | {f"wedge-{WEDGE}"} <= gids
        assert ax.get_xlabel() == "px"
        assert ax.get_legend() is None
    site, (x0, x1), (y0, y1) = wall().site, ax.get_xlim(), ax.get_ylim()
    assert walls.wall_aspect(site.height_px / site.width_px) == pytest.approx((y1 - y0) / (x1 - x0))


def test_masonry_is_coloured_by_cluster_and_in_source_px():
    labels = np.kron([[1, 2], [7, 7]], np.ones((4, 10), int)).astype(np.uint32)
    panel = walls.masonry_panel("masons", labels, {1: 2, 7: 1}, 5.0)
    (ax,) = walls.sheet_of([panel], 1).axes
    colours = {p.get_gid(): p.get_facecolor() for p in ax.patches if p.get_gid() != "ground"}
    expected = {"stone-1": cluster_colour(2), "stone-2": PLAIN_COLOUR, "stone-7": cluster_colour(1)}
    assert {gid: to_hex(colour) for gid, colour in colours.items()} == expected
    seven = next(p for p in ax.patches if p.get_gid() == "stone-7").get_path().vertices
    assert seven.max(axis=0).tolist() == [100.0, 20.0]
