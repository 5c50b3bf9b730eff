import math

import numpy as np
import pytest

from drystone.io.wall_image import read_wall_image
from drystone.metrics.measure import measure_labels
from drystone.metrics.reduce import reduce_labels
from drystone_lab.reproduce import fig17
from drystone_lab.walls import PR
from tests.lab.reproduce.small_walls import RUBBLE, context, gids, of, rows
from tests.naive import metrics as naive

MADE = of(fig17.PATHS, RUBBLE)


@pytest.fixture(scope="module")
def where(folder):
    return context(folder)


@pytest.fixture(scope="module")
def joint(where):
    labels = where.wall(RUBBLE.run(1)).labels
    filled = np.flatnonzero((labels > 0).any(axis=1))
    return naive.joint_mask(labels[filled[0] : filled[-1] + 1])


def test_lengths_are_those_of_a_search_step_by_step(output, joint):
    table = rows(output, "paths")
    for way, expected in (
        ("vertical", naive.vertical_lengths(joint)),
        ("horizontal", naive.vertical_lengths(joint.T)),
    ):
        lengths = [row["length px"] for row in table if row["way"] == way]
        assert lengths == pytest.approx(expected, abs=1e-4)
        assert len(lengths) > 5


def test_factors_are_those_of_the_run_and_of_the_table(where, output, joint):
    (row,) = rows(output, "figures")
    (outcome,) = where.run((RUBBLE.run(1),))
    assert row["F_AV %"] == pytest.approx(outcome.figures["F_AV"], abs=1e-4)
    assert row["F_AH %"] == pytest.approx(outcome.figures["F_AH"], abs=1e-4)
    assert row["F_AV %"] == pytest.approx(naive.vertical_arrangement(joint), abs=1e-4)
    for way, name in (("horizontal", "F_AH %"), ("vertical", "F_AV %")):
        excess = [one["longer than straight %"] for one in rows(output, "paths")
                  if one["way"] == way][:5]  # fmt: skip
        assert math.fsum(excess) / 5 == pytest.approx(row[name], abs=1e-4)


def test_the_masons_wall_is_measured_beside_it(tmp_path, data_dir):
    output = fig17.PATHS.make(context(tmp_path, data_dir))
    ours, masons = rows(output, "figures")
    assert (ours["wall"], masons["wall"]) == ("planned PR", "the masons' PR")
    labels = reduce_labels(read_wall_image(data_dir / PR.source.name), PR.scale)
    measured = measure_labels(labels)
    assert masons["F_AH %"] == pytest.approx(measured.F_AH, abs=1e-4)
    assert masons["F_AV %"] == pytest.approx(measured.F_AV, abs=1e-4)
    assert {"path-1", "path-7"} <= set(gids(output, "fig17-masons"))
