from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import ttest_rel

from drystone.errors import ExitCode, UsageError
from drystone.model.site import Site
from drystone.planner.workshop import Workshop
from drystone.search.goal import GoalSettings
from drystone.selection.policies.learned import FEATURES, learned, model_from_json, shipped_model
from drystone_lab.rl import evaluate, train
from drystone_lab.rl.episode import ARRIVING, DrawSettings, Episode, draw_wall
from tests.lab.rl.test_env import bricks

TINY = train.TrainSettings(
    seed=3, rounds=1, walls=8, validation=6, strength=10.0,
    draw=DrawSettings(kinds=("rubble",), stones=8, size_px=10.0),
)  # fmt: skip


def test_better_than_random_on_other_walls():
    said = []
    model = train.train(TINY, said.append)
    assert model.trained["merit_learned"] > model.trained["merit_random"] + 0.5
    assert model.trained["finished"] > 2 * TINY.rounds * TINY.walls
    assert len(said) == TINY.rounds + 1


def test_equal_seeds_equal_bytes():
    short = replace(TINY, rounds=2, walls=2, validation=1, draw=replace(TINY.draw, stones=5))
    text = train.train(short).to_json()
    assert train.train(short).to_json() == text
    assert train.train(replace(short, seed=4)).to_json() != text


def test_shipped_weights_are_of_the_settings_of_today_and_beat_random_on_other_walls():
    draw = DrawSettings(kinds=train.TRAINED_ON, stones=9, size_px=12.0)
    drawn = [draw_wall(draw, np.random.default_rng([9, k])) for k in range(6)]
    walls = [Workshop.prepare(*one, ARRIVING) for one in drawn]
    by_value = train.mean_merit(learned().choose, walls)
    assert by_value > train.mean_merit(train.at_random, walls) + 0.3
    trained, settings = shipped_model().trained, train.TrainSettings()
    for name in ("seed", "rounds", "walls", "strength"):
        assert trained[name] == getattr(settings, name)
    assert (trained["kinds"], trained["stones"]) == ([*train.TRAINED_ON], settings.draw.stones)
    assert trained["merit_learned"] > trained["merit_random"]


def test_command_writes_the_file(tmp_path, capsys):
    path = tmp_path / "weights.json"
    few = ["--walls", "1", "--validation", "1", "--stones", "4", "--minutes", "-1"]
    assert train.main(["-o", str(path), *few]) == 0
    model = model_from_json(path.read_text("utf-8"), path.name)
    # Time cut it short.
    assert model.trained["rounds"] == model.trained["finished"] == 0
    assert model.weights == (0.0,) * len(FEATURES)
    out, err = capsys.readouterr()
    assert out == f"{path}\n"
    assert "at random" in err


def test_walls_without_a_choice_teach_nothing(tmp_path):
    full = DrawSettings(kinds=("brick",), stones=3, size_px=12.0, surplus=60.0)
    with pytest.raises(UsageError, match=r"E123 .*no stone of these walls has a choice"):
        train.train(replace(TINY, walls=2, draw=full))
    few = ["-o", str(tmp_path / "w.json"), "--stones", "2"]
    assert train.main(few) == ExitCode.USAGE
    stones, _ = bricks(3)
    workshop = Workshop.prepare(stones, Site(5, 5), ARRIVING)
    assert train.branching(workshop, train.at_random, (1,)) is None
    assert train.finished(Episode(workshop), train.at_random, np.random.default_rng(0)) == 0.0


@pytest.mark.parametrize(
    "wrong", ["--walls 0", "--seed -1", f"--seed {train.HELD_OUT}", "--rounds 0"]
)
def test_command_refuses(wrong, tmp_path):
    with pytest.raises(SystemExit) as caught:
        train.main(["-o", str(tmp_path / "w.json"), *wrong.split()])
    assert caught.value.code == 2


def test_fit_finds_the_weights_whatever_the_walls_are_worth_and_is_drawn_to_zero():
    weights = [1.0, -2.0, 0.0]

    def made(count, noise=0.0):
        """Branchings whose merits are weighted sums of features, and a sum of their own."""
        rng = np.random.default_rng(5)
        for _ in range(count):
            features = rng.normal(size=(4, 3))
            merits = features @ weights + rng.normal() + noise * rng.normal(size=4)
            yield train.Branching(features, merits)

    for count, noise, off in ((50, 0.0, 1e-6), (2000, 1.0, 0.06)):
        found = train.fitted(list(made(count, noise)), 1e-9)
        assert found == pytest.approx(weights, abs=off)
    data = list(made(50))
    assert train.fitted(data, 1e9) == pytest.approx(np.zeros(3), abs=1e-4)
    # 50 times 4 places: as many zeros halve them.
    halved = train.fitted(data, 200.0)
    assert halved[1] == pytest.approx(-1.0, abs=0.2)
    # Of a feature in other units they are as many times less; of one that never differs 0.
    other = [(one.features * (2.0, 0.5, 0.0) + 5.0 * k, one.merits) for k, one in enumerate(data)]
    found = train.fitted([train.Branching(*one) for one in other], 200.0)
    assert found[:2] / halved[:2] == pytest.approx([0.5, 2.0], abs=0.1)
    assert found[2] == 0.0


def test_a_report_has_means_and_differences_with_intervals_of_the_paired_t_test():
    rng = np.random.default_rng(1)
    first, second = rng.normal(1.0, 1.0, 12), rng.normal(0.5, 1.0, 12)
    mean, half = evaluate.difference((first - second).tolist())
    theirs = ttest_rel(first, second).confidence_interval(0.95)
    assert (mean - half, mean + half) == pytest.approx((theirs.low, theirs.high))
    assert evaluate.difference([2.0])[1] == np.inf
    walls = {
        way: dict.fromkeys(evaluate.FIGURES, values)
        for way, values in {"one": [1.0, 3.0], "two": [0.5, 2.5], "far": [0.0, 3.0]}.items()
    }
    text = evaluate.report(walls, "Two walls")
    # Starred without zero
    for row in ("| one | 2.000 |", "| two | 1.500 |", "| two | +0.500 ± 0.000* |",
                "| far | +0.500 ± 6.353 |"):  # fmt: skip
        assert row in text


def test_figures_of_a_policy_are_those_of_its_walls():
    draw = DrawSettings(stones=6, size_px=10.0)
    walls = [evaluate.held_out_wall("brick", number, draw) for number in range(2)]
    found = evaluate.figures_by("lowest", walls)
    assert list(found) == list(evaluate.FIGURES)
    assert found == evaluate.figures_by("lowest", walls)
    goal = GoalSettings()
    for k in range(2):
        parts = goal.filling * found["F_SF"][k] + goal.resistance * min(1.0, found["F_LR"][k])
        parts += goal.vertical * found["F_AV"][k] - goal.horizontal * found["F_AH"][k]
        # Top and ends are left, which count against a wall.
        assert parts - 2.0 < found["merit"][k] <= parts


def test_command_compares_policies(capsys):
    few = ["--walls", "1", "--stones", "5", "--kinds", "brick", "rubble", "--policies", "learned"]
    assert evaluate.main([*few, "paper"]) == evaluate.main([*few, "paper", "--free"]) == 0
    given, free = capsys.readouterr().out.split("All 2 walls: `learned` less each other")[:2]
    assert given.count("1 walls of rubble stones: means") == 1
    assert given.splitlines()[-5:] != free.splitlines()[-5:]  # a free order is another
    assert evaluate.main([*few, "nobody"]) == 2
    assert "E146" in capsys.readouterr().err
