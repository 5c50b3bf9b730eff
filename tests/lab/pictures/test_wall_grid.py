"""Walls side by side."""

import numpy as np
import pytest

from drystone.drawing import plot_wall
from drystone.drawing.palette import PLAIN_COLOUR, cluster_colour
from drystone_lab.pictures.walls import (
    masonry_panel,
    plot_masonry,
    plot_walls,
    sheet_of,
    wall_aspect,
)
from tests.drawing.examples import CLUSTERS, WEDGE, wall


def test_every_wall_is_drawn_whole_under_its_title() -> None:
    figure = plot_walls([("one", wall(), CLUSTERS), ("two\nlines", wall(), None)], 2)
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["one", "two\nlines"]
    for ax in figure.axes:
        gids = {patch.get_gid() for patch in ax.patches}
        assert {f"stone-{p.stone_id}" for p in wall().placements} | {f"wedge-{WEDGE}"} <= gids
        assert ax.get_xlabel() == "px"
        assert ax.get_legend() is None


def test_a_panel_has_the_shape_of_its_picture() -> None:
    site = wall().site
    ax = plot_wall(wall())
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    assert wall_aspect(site.height_px / site.width_px) == pytest.approx((y1 - y0) / (x1 - x0))


def test_masonry_is_coloured_by_cluster_and_in_source_px() -> None:
    labels = np.kron([[1, 2], [7, 7]], np.ones((4, 10), int)).astype(np.uint32)
    ax = plot_masonry(labels, {1: 2, 7: 1}, units_per_px=5.0)
    colours = {p.get_gid(): p.get_facecolor() for p in ax.patches if p.get_gid() != "ground"}
    expected = {"stone-1": cluster_colour(2), "stone-2": PLAIN_COLOUR, "stone-7": cluster_colour(1)}
    assert {gid: _hex(colour) for gid, colour in colours.items()} == expected
    seven = next(p for p in ax.patches if p.get_gid() == "stone-7").get_path().vertices
    assert seven.max(axis=0).tolist() == [100.0, 20.0]
    (panel,) = sheet_of([masonry_panel("masons", labels, None, 5.0)], 1).axes
    assert panel.get_xlim() == ax.get_xlim()


def _hex(colour: tuple[float, ...]) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour[:3])
