"""The published stone sets, planned with the paper's method, hold."""

import numpy as np
import pytest

from drystone.generate import FourierSettings, fourier_stones
from drystone.io.read_stones import read_stones
from drystone.search.plan_wall import plan_wall
from drystone.verify import check_plan


def _planned(stones, width, height, scale):
    """Plan with variant sampling from one side, verify everything, and return the result."""
    result = plan_wall(stones, width, height, scale=scale, method="paper", seed=1)
    report = check_plan(result.plan, stones, wall_labels=result.wall.labels)
    assert report.problems == ()
    assert result.resistance.stable
    return result


@pytest.mark.parametrize(
    ("name", "scale", "width", "height", "count"),
    [("PR", 0.5, 560, 160, 32), ("R", 0.2, 1445, 395, 34), ("IR", 0.2, 1443, 383, 61)],
)
def test_almeida(name, scale, width, height, count, data_dir):
    stones = read_stones(data_dir / "almeida" / f"{name}.png")
    assert len(stones) == count
    plan = _planned(stones, width, height, scale).plan
    assert len(plan.stone_steps) > count / 2


@pytest.mark.parametrize("noise", [10, 70])
def test_thangavelu(noise, data_dir):
    stones = read_stones(data_dir / "thangavelu" / f"noise_{noise}.png")
    plan = _planned(stones, 420, 420, 0.5).plan  # 210 x 210 working px
    assert len(plan.stone_steps) >= 8


def test_fourier():
    settings = FourierSettings(count=24, smallest_radius_px=15, largest_radius_px=15)
    stones = fourier_stones(settings, np.random.default_rng(1))
    plan = _planned(stones, 210, 210, 1.0).plan
    assert len(plan.stone_steps) > 12
