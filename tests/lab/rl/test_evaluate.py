import numpy as np
import pytest
from scipy.stats import ttest_rel

from drystone.search.goal import GoalSettings
from drystone_lab.rl.episode import DrawSettings
from drystone_lab.rl.evaluate import FIGURES, difference, figures_by, held_out_wall, main, report


def test_a_report_has_means_and_differences_with_intervals_of_the_paired_t_test():
    rng = np.random.default_rng(1)
    first, second = rng.normal(1.0, 1.0, 12), rng.normal(0.5, 1.0, 12)
    mean, half = difference((first - second).tolist())
    theirs = ttest_rel(first, second).confidence_interval(0.95)
    assert (mean - half, mean + half) == pytest.approx((theirs.low, theirs.high))
    assert difference([2.0])[1] == np.inf
    walls = {
        way: dict.fromkeys(FIGURES, values)
        for way, values in {"one": [1.0, 3.0], "two": [0.5, 2.5], "far": [0.0, 3.0]}.items()
    }
    text = report(walls, "Two walls")
    # Starred without zero
    for row in ("| one | 2.000 |", "| two | 1.500 |", "| two | +0.500 ± 0.000* |",
                "| far | +0.500 ± 6.353 |"):  # fmt: skip
        assert row in text


def test_figures_of_a_policy_are_those_of_its_walls():
    draw = DrawSettings(stones=6, size_px=10.0)
    walls = [held_out_wall("brick", number, draw) for number in range(2)]
    found = figures_by("lowest", walls)
    assert list(found) == list(FIGURES)
    assert found == figures_by("lowest", walls)
    goal = GoalSettings()
    for k in range(2):
        parts = goal.filling * found["F_SF"][k] + goal.resistance * min(1.0, found["F_LR"][k])
        parts += goal.vertical * found["F_AV"][k] - goal.horizontal * found["F_AH"][k]
        # Top and ends are left, which count against a wall.
        assert parts - 2.0 < found["merit"][k] <= parts


def test_command(capsys):
    few = ["--walls", "1", "--stones", "5", "--kinds", "brick", "rubble", "--policies", "learned"]
    assert main([*few, "paper"]) == main([*few, "paper", "--free"]) == 0
    given, free = capsys.readouterr().out.split("All 2 walls: `learned` less each other")[:2]
    assert given.count("1 walls of rubble stones: means") == 1
    assert given.splitlines()[-5:] != free.splitlines()[-5:]  # a free order is another
    assert main([*few, "nobody"]) == 2
    assert "E146" in capsys.readouterr().err
