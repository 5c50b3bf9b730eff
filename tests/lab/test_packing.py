"""The packer beside the planner: what it is asked, and that it fits stones into a strip."""

from types import SimpleNamespace

import numpy as np
import pytest

from drystone.generate.brick import BrickSettings, brick_stones
from drystone_lab import packing
from drystone_lab.table import BenchSettings

BRICKS = brick_stones(BrickSettings(count=3), np.random.default_rng(1))


class Packer:
    """Notes what it is asked, and packs everything into 200 px."""

    def __init__(self):
        self.items, self.configs, self.strips = [], [], []
        self.StripPackingConfig = lambda **given: self.configs.append(given)

    def Item(self, name, shape, demand, allowed_orientations):  # noqa: N802 - as in spyrrow
        self.items.append((name, shape, demand, allowed_orientations))
        return self.items[-1]

    def StripPackingInstance(self, name, strip_height, items):  # noqa: N802
        self.strips.append((name, strip_height, items))
        return SimpleNamespace(solve=lambda _: SimpleNamespace(width=200.0))


def test_the_packer_gets_every_stone_once_as_it_lies_first():
    packer = Packer()
    assert packing.packed_width_px(packer, BRICKS, 50.0, (0.0, 90.0), 7, 3) == 200.0
    (strip,) = packer.strips
    assert strip == ("stones", 50.0, packer.items)
    assert [name for name, *_ in packer.items] == ["1", "2", "3"]
    for _, shape, demand, turns in packer.items:
        assert (demand, turns) == (1, (0.0, 90.0))
        xs, ys = zip(*shape, strict=True)
        assert (max(xs) - min(xs), max(ys) - min(ys)) == pytest.approx((36, 12))
    assert packer.configs == [
        {"early_termination": False, "total_computation_time": 7, "num_workers": 1, "seed": 3}
    ]


def test_strips_stand_beside_walls(monkeypatch):
    packer, said = Packer(), []
    monkeypatch.setattr(packing, "load_packer", lambda: packer)
    (table,) = packing.run(BenchSettings(quick=True, seconds=(0.01,), say=said.append))
    (row,) = table.rows
    density = 108 * 36 / (200 * 36)
    # Nine bricks fill the wall, or eight are bonded: which, is the search's to say.
    placed = int(row[-1].removesuffix(" of 9"))
    assert placed >= 8
    assert row[:8] == ("bricks", 36, 200.0, density, 200.0, density, 108, 1.0)
    assert row[8] == pytest.approx(placed / 9)
    assert [turns for *_, turns in packer.items[::9]] == [(0.0, 90.0, 180.0, 270.0), None]
    assert packer.configs[0]["total_computation_time"] == 1
    assert len(said) == 1


def test_the_packer_fits_stones_into_a_strip():
    packer = pytest.importorskip("spyrrow", reason="spyrrow (extra bench) is not installed")
    width = packing.packed_width_px(packer, BRICKS, 40.0, (0.0, 90.0), 1, 1)
    assert 3 * 36 * 12 / 40 <= width <= 40
