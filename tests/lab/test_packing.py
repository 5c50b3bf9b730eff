from unittest.mock import Mock

import numpy as np
import pytest

from drystone.generate.brick import BrickSettings, brick_stones
from drystone_lab import packing
from drystone_lab.table import BenchSettings

BRICKS = brick_stones(BrickSettings(count=3), np.random.default_rng(1))


@pytest.fixture
def packer():
    """Notes what it is asked, and packs everything into 200 px."""
    packer = Mock()
    packer.StripPackingInstance.return_value.solve.return_value.width = 200.0
    return packer


def test_the_packer_gets_every_stone_once_as_it_lies_first(packer):
    assert packing.packed_width_px(packer, BRICKS, 50.0, (0.0, 90.0), 7, 3) == 200.0
    for number, ((name, shape), about) in enumerate(packer.Item.call_args_list, 1):
        assert (name, about) == (str(number), {"demand": 1, "allowed_orientations": (0.0, 90.0)})
        xs, ys = zip(*shape, strict=True)
        assert (max(xs) - min(xs), max(ys) - min(ys)) == pytest.approx((36, 12))
    packer.StripPackingInstance.assert_called_once_with(
        "stones", strip_height=50.0, items=3 * [packer.Item.return_value]
    )
    packer.StripPackingConfig.assert_called_once_with(
        early_termination=False, total_computation_time=7, num_workers=1, seed=3
    )


def test_strips_stand_beside_walls(packer, monkeypatch):
    said = []
    monkeypatch.setattr(packing, "load_packer", lambda: packer)
    (table,) = packing.run(BenchSettings(quick=True, seconds=(0.01,), say=said.append))
    (row,) = table.rows
    density = 108 * 36 / (200 * 36)
    # Nine bricks fill the wall, or eight are bonded: which, is the search's to say.
    placed = int(row[-1].removesuffix(" of 9"))
    assert placed >= 8
    assert row[:8] == ("bricks", 36, 200.0, density, 200.0, density, 108, 1.0)
    assert row[8] == pytest.approx(placed / 9)
    turns = [about["allowed_orientations"] for _, about in packer.Item.call_args_list[::9]]
    assert turns == [(0.0, 90.0, 180.0, 270.0), None]
    assert packer.StripPackingConfig.call_args.kwargs["total_computation_time"] == 1
    assert len(said) == 1


def test_the_packer_fits_stones_into_a_strip():
    packer = pytest.importorskip("spyrrow", reason="spyrrow (extra bench) is not installed")
    width = packing.packed_width_px(packer, BRICKS, 40.0, (0.0, 90.0), 1, 1)
    assert 3 * 36 * 12 / 40 <= width <= 40
