import math

import pytest

from drystone.io.wall_image import read_wall_image
from drystone.metrics.frame import reduce_labels
from drystone.metrics.measure import measure_labels
from drystone_lab.walls import PR
from tests.lab.reproduce.small_walls import RUBBLE, context, gids, of, rows

MADE = of("fig17", RUBBLE)


def test_factors_are_those_of_the_run_and_of_the_table(here, output):
    (row,) = rows(output, "figures")
    (outcome,) = here.run((RUBBLE.run(1),))
    assert row["F_AV %"] == pytest.approx(outcome.figures["F_AV"], abs=1e-4)
    assert row["F_AH %"] == pytest.approx(outcome.figures["F_AH"], abs=1e-4)
    for way, name, straight in (
        ("horizontal", "F_AH %", row["straight across px"]),
        ("vertical", "F_AV %", row["straight upright px"]),
    ):
        found = [one for one in rows(output, "paths") if one["way"] == way]
        assert len(found) > 5
        excess = [one["longer than straight %"] for one in found]
        assert math.fsum(excess[:5]) / 5 == pytest.approx(row[name], abs=1e-4)
        lengths = [one["length px"] for one in found]
        assert lengths == sorted(lengths)
        assert lengths == pytest.approx([straight * (1 + e / 100) for e in excess], rel=1e-5)


def test_the_masons_wall_is_measured_beside_it(tmp_path, data_dir):
    output = of("fig17").make(context(tmp_path, data_dir))
    ours, masons = rows(output, "figures")
    assert (ours["wall"], masons["wall"]) == ("planned PR", "the masons' PR")
    labels = reduce_labels(read_wall_image(data_dir / PR.source.name), PR.scale)
    measured = measure_labels(labels)
    assert masons["F_AH %"] == pytest.approx(measured.F_AH, abs=1e-4)
    assert masons["F_AV %"] == pytest.approx(measured.F_AV, abs=1e-4)
    assert {"path-1", "path-7"} <= set(gids(output, "fig17-masons"))
