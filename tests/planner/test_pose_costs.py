"""What poses cost wherever they go."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.planner import craft
from drystone.planner.craft import PoseCosts, pose_cost
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.selection.scored import ScoreSettings
from tests.planner.scenes import RUBBLE_SITE, rubble

NOTHING = ScoreSettings(roughness=0.0, upright=0.0, area=0.0, thickness=0.0)
WORKSHOP = Workshop.prepare(rubble(), RUBBLE_SITE, PlannerSettings(orientations="quarter"))
POSES = [posed for stone in WORKSHOP.stones for posed in WORKSHOP.poses(stone.id)]


def test_a_cost_is_the_weighted_sum_of_its_terms() -> None:
    stock = WORKSHOP.stock
    assert any(posed.width_px < posed.height_px for posed in POSES)
    for posed in POSES:
        upright = max(0.0, 1.0 - posed.width_px / posed.height_px)
        terms = {
            "roughness": posed.top_roughness_px / stock.mean_height_px,
            "upright": upright,
            "area": -posed.mask.sum() / stock.mean_area_px,
            "thickness": -min(posed.mask.shape) / stock.mean_height_px,
        }
        for name, expected in terms.items():
            weighted = replace(NOTHING, **{name: 2.0})
            assert pose_cost(posed, stock, weighted) == pytest.approx(2.0 * expected)
        every = ScoreSettings(roughness=0.4, upright=0.7, area=1.8, thickness=1.5)
        expected = sum(getattr(every, name) * term for name, term in terms.items())
        assert pose_cost(posed, stock, every) == pytest.approx(expected)


def test_costs_are_worked_out_once_for_the_weights_of_now(monkeypatch: pytest.MonkeyPatch) -> None:
    made = []

    def watched(*args: object) -> float:
        made.append(args[0])
        return pose_cost(*args)  # type: ignore[arg-type]

    monkeypatch.setattr(craft, "pose_cost", watched)
    costs, other = PoseCosts(WORKSHOP.stock), ScoreSettings(area=0.3)
    for score, poses, new in (
        (ScoreSettings(), POSES[:3], 3),
        (ScoreSettings(), POSES[1:5], 2),
        (other, POSES[:3], 3),
        (other, POSES[:3], 0),
        (ScoreSettings(), POSES[:3], 3),
    ):
        made.clear()
        found = costs.of(poses, score)
        assert len(made) == new
        assert found.tolist() == [pose_cost(posed, WORKSHOP.stock, score) for posed in poses]
    assert costs.of([], other).shape == (0,)
    assert costs.of([], other).dtype == np.float64
