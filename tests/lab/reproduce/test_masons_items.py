from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from drystone.contacts.blocks import model_from_labels
from drystone.metrics.measure import measure_labels
from drystone.statics.limit import lateral_resistance
from drystone_lab.reproduce import masons
from drystone_lab.runs.spec import published
from drystone_lab.walls import Target
from tests.lab.reproduce.small_walls import RUBBLE, context, of, on, outcome, rows

BLOCKS = Target("blocks", published("blocks.png"), 66, 32, 1.0, 1)
SEEDS = (1, 2)


@pytest.fixture(scope="module")
def here(tmp_path_factory):
    """Has a wall of masons: courses of blocks with gaps of a pixel above and beside."""
    folder = tmp_path_factory.mktemp("data")
    labels = np.zeros((33, 68), np.uint16)
    corners = [
        (top, left) for k, top in enumerate((1, 12, 23)) for left in range(1 - k % 2 * 10, 66, 21)
    ]
    for block, (top, left) in enumerate(corners, 1):
        labels[top : top + 10, max(left, 0) : left + 20] = 20 * block
    Image.fromarray(labels).save(folder / "blocks.png")
    return context(tmp_path_factory.mktemp("runs"), folder)


def test_fig13_closes_gaps_in_every_way(here):
    wall = masons.masons_wall(BLOCKS, here.data)
    found = {way: told for way, *told in masons.treatments(wall)}
    assert found["as traced"] == [None, "unstable"]
    assert found["gaps up to 1 px closed"][1] == "optimal"
    papers, _ = found["drawn together and dilated (the paper's way)"]
    by_hand = lateral_resistance(model_from_labels(wall.papers_way).model).value
    assert papers == pytest.approx(by_hand, abs=1e-4)
    assert (wall.papers_way > 0).sum() > (wall.labels > 0).sum()
    output = of("fig13", (BLOCKS,)).make(here)
    traced, closed, papers = rows(output, "fig13")
    measured = measure_labels(wall.labels)
    found = traced["F_SF"], traced["F_AV"]
    assert found == pytest.approx((measured.F_SF, measured.F_AV), abs=1e-4)
    assert traced["F_LR"] is None
    assert closed["F_SF"] > traced["F_SF"]
    assert (papers["F_SF"], papers["F_LR"]) == (0.837, 0.64)
    assert len(rows(output, "fig13_resistance")) == 11
    assert len(output.pictures[0].figure.axes) == 2


def test_base_case(here):
    output = on("fig14-15", RUBBLE).make(here)
    outcomes = here.run([RUBBLE.run(seed) for seed in SEEDS])
    (row,) = rows(output, "fig14")
    over = np.mean([outcome.figures["alpha_left"] for outcome in outcomes]) / 0.58
    assert row["alpha left / mu median"] == pytest.approx(over, abs=1e-4)
    by_rule = {(row["towards"], row["flow rule"]): row["alpha"] for row in rows(output, "fig15")}
    for side in ("left", "right"):
        alpha = outcomes[0].figures[f"alpha_{side}"]
        assert by_rule[side, "associative"] == pytest.approx(alpha, abs=1e-4)
        loose = by_rule[side, "without dilatancy"]
        assert loose is None or loose <= alpha + 1e-4
    names = {picture.name for picture in output.pictures}
    assert {"fig14", "fig15_left", "fig15_right", "fig14_seeds"} <= names


def test_table2(here):
    stand_in = replace(RUBBLE, name="other", number=4, stand_in=True)
    output = on("table2", BLOCKS, stand_in).make(here)
    outcomes = here.run([BLOCKS.run(seed) for seed in SEEDS])
    filled = [one.figures["F_SF"] for one in outcomes]
    table = rows(output, "table2")
    mine = {row["what"].split(",")[0]: row for row in table if row["wall"] == 1}
    most = (np.asarray(Image.open(here.data / "blocks.png")) > 0).sum() / (66 * 32)
    for what, expected in {
        "best of 2": filled[masons.best_trial(outcomes)], "fixed seed": filled[0],
        "fullest of 2": max(filled), "all stones": most,
    }.items():  # fmt: skip
        assert mine[what]["F_SF"] == pytest.approx(expected, abs=1e-4)
    assert max(filled) <= most + 1e-9
    assert mine["best of 2"]["paper F_SF"] == 0.974
    assert mine["masons"]["paper F_AV"] == 39.78
    others = [row for row in table if row["wall"] == 4]
    # The paper's figures never stand beside those of other stones.
    assert all(row["F_SF"] is None or row["paper F_SF"] is None for row in others)
    assert {0.8, 0.839} <= {row["paper F_SF"] for row in others}
    assert len(output.pictures[0].figure.axes) == 4 + 3


@pytest.mark.parametrize(
    ("walls", "best"),
    [
        # Filling to one decimal first, however strong the others are.
        ([(0.38, 0.9), (0.98, 0.7)], 0),
        # .78 and .82 are both .8: the multiplier decides.
        ([(0.38, 0.82), (0.46, 0.78)], 1),
        # .42 and .38 are both .4 too: the fuller one.
        ([(0.42, 0.78), (0.38, 0.8)], 1),
        # Equal in filling: the larger multiplier, then the earlier trial.
        ([(0.38, 0.8), (0.42, 0.8), (0.42, 0.8)], 1),
        # Among equally full walls those without a multiplier are last.
        ([(None, 0.84), (0.01, 0.76)], 1),
    ],
)
def test_the_best_trial(walls, best):
    assert masons.best_trial([outcome(F_LR=value, F_SF=filled) for value, filled in walls]) == best
    # Halves are rounded up whatever the solver leaves.
    for tenth, value in enumerate((0.05, 0.15, 0.25, 0.35, 0.45, 0.55), 1):
        assert masons.tenths(value - 1e-12) == masons.tenths(value + 1e-12) == tenth


APART = np.zeros((12, 30), np.uint32)
APART[7:11, 3:9], APART[6:11, 12:19], APART[1:4, 5:15], APART[2:5, 20:27] = 5, 2, 9, 300


def test_stones_keep_their_shape_and_come_nearer_until_they_are_stopped():
    before = APART.copy()
    after = masons.drawn_together(before)
    assert after.dtype == before.dtype
    corner = (before.shape[0] - 0.5, -0.5)
    for block in (5, 2, 9, 300):
        old, new = np.argwhere(before == block), np.argwhere(after == block)
        assert np.array_equal(old - old.min(axis=0), new - new.min(axis=0))
        was, now = (np.hypot(*(pixels.mean(axis=0) - corner)) for pixels in (old, new))
        assert now <= was
    # The first goes into the corner, the second on top of it; the third ends beside that one.
    for block, corner in ((5, [8, 0]), (9, [5, 0]), (2, [7, 10])):
        assert np.argwhere(after == block).min(axis=0).tolist() == corner


def test_dilation_is_by_one_pixel_and_takes_nothing_from_others():
    after = masons.dilated(APART)
    for row, col in np.ndindex(*APART.shape):
        around = APART[max(row - 1, 0) : row + 2, max(col - 1, 0) : col + 2]
        assert after[row, col] == (APART[row, col] or min(around[around > 0], default=0))
    assert after.dtype == APART.dtype
