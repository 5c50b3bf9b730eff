import numpy as np
import pytest
from matplotlib.figure import Figure

from drystone.contacts.blocks import model_from_labels
from drystone_lab.reproduce import fig12
from tests.lab.reproduce.small_walls import RUBBLE, built, gids, of, rows

MADE = of("fig12", RUBBLE)


@pytest.fixture(scope="module")
def labels(folder):
    return fig12.three_stones(built(folder, RUBBLE).wall)


def naive_edges(labels):
    """Pixel pairs side by side or above each other that belong to different blocks."""
    height, width = labels.shape
    found = set()
    for row, col in np.argwhere(labels > 0).tolist():
        here, x, y = int(labels[row, col]), col + 1, height - row
        right = int(labels[row, x]) if x < width else 0
        if right and here != right:
            found.add(((x, y - 1), (x, y)) if here > right else ((x, y), (x, y - 1)))
        below = int(labels[row + 1, col]) if row + 1 < height else -1
        if below and below != here:
            ends = ((col, y - 1), (col + 1, y - 1))
            found.add(ends if here > below else ends[::-1])
    return found


def test_edges_are_where_pixels_of_two_blocks_meet(labels):
    found = [tuple(map(tuple, edge)) for edge in np.stack(fig12.boundary_edges(labels), 1).tolist()]
    assert len(found) == len(set(found)) > 10
    assert set(found) == naive_edges(labels)


def test_three_stones_stand_on_the_ground_and_on_each_other(folder, labels):
    run = built(folder, RUBBLE)
    ids = set(np.unique(labels).tolist()) - {0}
    assert len(ids) == 3
    for stone in ids:
        assert np.count_nonzero(labels == stone) == np.count_nonzero(run.wall.labels == stone)
    on_ground = set(np.unique(labels[-1]).tolist()) - {0}
    assert len(on_ground) == 2
    (top,) = ids - on_ground
    pairs = {frozenset((i.block, i.other)) for i in model_from_labels(labels).model.interfaces}
    assert all(frozenset((top, below)) in pairs for below in on_ground)
    # Where none stands on two, the first three are taken.
    first = {stage.stone.stone for stage in run.stages[:3]}
    assert set(np.unique(fig12.three_stones(run.stages[2].after)).tolist()) == first | {0}


def test_interfaces_end_on_corners_of_pixel_edges_and_are_drawn(output, labels):
    corners = {point for edge in naive_edges(labels) for point in edge}
    table = rows(output, "interfaces")
    for row in table:
        ends = (row["x0"], row["y0"]), (row["x1"], row["y1"])
        if row["length px"] > 0:
            assert set(ends) <= corners
        assert row["length px"] == pytest.approx(np.hypot(*np.subtract(*ends)), abs=1e-4)
        assert np.hypot(row["normal x"], row["normal y"]) == pytest.approx(1, abs=1e-3)
    assert {row["other"] for row in table} > {"ground"}
    drawn = gids(output, "fig12")
    for row in rows(output, "blocks"):
        assert drawn.count(f"block-{row['stone']}") == 3
        assert f"centre-{row['stone']}" in drawn
    assert {"edges", "normals", "interfaces"} <= set(drawn)


def test_the_mean_of_the_normals_of_pixels_is_across_the_ends():
    steps = [0, 0, 1, 2, 2, 3, 4, 4, 5, 6, 6, 7]
    labels = np.ones((12, 12), np.uint32)
    for col, height in enumerate(steps):
        labels[: 11 - height, col] = 2
    starts, ends = fig12.boundary_edges(labels)
    way = (ends - starts)[(starts[:, 1] > 0) | (ends[:, 1] > 0)]
    mean = np.array([-way[:, 1], way[:, 0]]).mean(axis=1)
    mean /= np.hypot(*mean)
    (run,) = [i for i in model_from_labels(labels).model.interfaces if i.other == 1]
    np.testing.assert_allclose(fig12._mean_normal(run), mean, atol=1e-12)
    assert 0 < fig12._apart_deg(run) < 10


LABELS = np.repeat(np.array([[0, 7, 7], [3, 3, 5]], np.uint32), 4, axis=0).repeat(4, axis=1)


def test_normals_are_to_the_left_of_the_way():
    starts, ends = np.array([[4.0, 4.0], [8.0, 0.0]]), np.array([[5.0, 4.0], [8.0, 1.0]])
    ax = Figure().add_subplot()
    fig12.plot_boundary_edges(ax, LABELS, starts, ends)
    lines = {one.get_gid(): one.get_segments() for one in ax.collections}
    np.testing.assert_allclose(lines["edges"], np.stack([starts, ends], axis=1))
    ups = [[[4.5, 4.0], [4.5, 4.0 + fig12.NORMAL_PX]], [[8.0, 0.5], [8.0 - fig12.NORMAL_PX, 0.5]]]
    np.testing.assert_allclose(lines["normals"], ups)
