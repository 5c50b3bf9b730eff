from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from drystone.planner.planner import Planner
from drystone.search.plan_wall import plan_wall
from drystone_lab.runs.outcome import FIGURES, execute
from tests.lab.runs.bricks import SOURCE, run


def test_it_is_what_plan_wall_gives() -> None:
    outcome = execute(run(3), None)
    stones, rest = SOURCE.stones(None), {"seed": 3, "method": "paper", "scale": 1.0}
    result = plan_wall(stones, 60, 20, **rest, coulomb=False)
    assert outcome.as_plan == result.plan
    assert result.metrics.F_LR_coulomb is None
    assert plan_wall(stones, 60, 20, **rest).metrics.F_LR_coulomb is not None
    assert tuple(outcome.figures) == FIGURES
    assert outcome.figures["placed"] == outcome.figures["stones"] == 6
    assert outcome.figures["F_LR"] == result.metrics.F_LR
    assert outcome.figures["wedges"] == 0
    assert outcome.key == run(3).key


def test_the_wall_is_built_again_from_its_plan() -> None:
    outcome = execute(run(1), None)
    wall = outcome.wall(run(1), None)
    assert set(np.unique(wall.labels)) - {0} == set(outcome.clusters)
    assert np.count_nonzero(wall.labels) / wall.labels.size == outcome.figures["F_SF"]


def test_the_image_is_the_wall_when_no_size_is_given() -> None:
    spec = replace(run(1), width=0.0, height=0.0)
    source = spec.source.stones(None).source
    assert execute(spec, None).plan["wall"] == {
        "width": source.width_px,
        "height": source.height_px,
    }


def test_an_interrupted_wall_is_no_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(_: Planner) -> Iterator[None]:
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr(Planner, "steps", interrupted)
    with pytest.raises(KeyboardInterrupt):
        execute(run(1), None)
