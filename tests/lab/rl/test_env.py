import subprocess
import sys
from copy import deepcopy
from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import drystone_lab.rl
from drystone.errors import DrystoneError, UsageError
from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.planner.workshop import Workshop
from drystone.search.goal import WallFigures, figures_of, merit_of, possible_filling
from drystone.selection.policies.choices import LOWEST
from drystone.selection.policies.learned import FEATURES, features
from drystone_lab.rl.env import WallEnv
from drystone_lab.rl.episode import ARRIVING, KINDS, DrawSettings, Episode, draw_wall, in_order
from tests.pages import printed
from tests.planner import scenes

SMALL = DrawSettings(kinds=("brick", "polygon"), stones=7, size_px=12.0)


def bricks(count=6):
    """Return bricks of 20 x 10 and a wall that the first four of them fill."""
    return scenes.bricks(count), Site(40, 20)


GIVEN = dict(zip(("stones", "site"), bricks(), strict=True))


def made(**changes):
    return gymnasium.make(drystone_lab.rl.ENVIRONMENT, **({"draw": SMALL} | changes)).unwrapped


def played(env, seed):
    """Play an episode at random; return its rewards, the last info, and the bytes of it all."""
    rng = np.random.default_rng(0)
    _, info = env.reset(seed=seed)
    rewards, over, bits = [], False, b""
    while not over:
        action = rng.choice(np.flatnonzero(env.action_masks()))
        seen, reward, over, truncated, info = env.step(action)
        assert not truncated
        assert env.observation_space.contains(seen)
        rewards.append(reward)
        bits += b"".join(array.tobytes() for array in seen.values()) + repr((reward, info)).encode()
    return rewards, info, bits


@pytest.mark.parametrize("name", [drystone_lab.rl.ENVIRONMENT, "drystone_lab.rl:drystone/Wall-v0"])
def test_passes_the_checks_of_gymnasium(name):
    # Warnings are errors in these tests.
    check_env(gymnasium.make(name, draw=SMALL, render_mode="rgb_array").unwrapped)


def test_rewards_sum_up_to_the_merit_of_the_wall():
    env, all_rewards = made(), []
    for seed in range(5):
        rewards, info, _ = played(env, seed)
        possible = min(1.0, SMALL.surplus)
        worth = merit_of(WallFigures(**info["metrics"]), possible, env.settings.goal)
        assert sum(rewards) == pytest.approx(worth, abs=1e-9)
        assert info["merit"] == worth
        assert info["metrics"]["stones"] == info["placed"] == len(rewards)
        assert info["placed"] + info["aside"] == SMALL.stones
        all_rewards += rewards
    assert min(all_rewards) < 0 < max(all_rewards)
    # A seed repeats its episode.
    first, second = (played(env, seed)[2] for seed in (5, 6))
    assert played(env, 5)[2] == first == played(made(), 5)[2] != second


def test_masks_say_what_is_offered_and_another_action_puts_aside_or_is_an_error():
    env = made(offers=20)
    seen, info = env.reset(seed=1)
    count, rows = len(env.episode.offers), seen["offers"]
    assert 0 < count < 20
    assert env.action_masks().dtype == bool
    for mask in (env.action_masks(), info["action_mask"]):
        assert mask.tolist() == [k < count for k in range(20)]
    assert not rows[count:].any()
    shown = features(env.episode.offers).astype(np.float32)
    assert np.array_equal(rows[:count, : len(FEATURES)], shown)
    played(env, 1)
    assert not env.action_masks().any()
    env = made(offers=20)
    _, before = env.reset(seed=1)
    _, reward, over, _, info = env.step(np.int64(19))
    assert (reward, over, info["illegal"], info["placed"]) == (0.0, False, True, 0)
    assert info["aside"] == before["aside"] + 1
    assert info["stone"] != before["stone"]
    env = made(offers=20, illegal="error")
    env.reset(seed=1)
    with pytest.raises(UsageError, match=r"E151 .*places offered"):
        env.step(np.int64(19))
    assert env.step(np.int64(0))[4]["placed"] == 1


def test_no_action_before_the_start_or_after_the_end():
    env = made()
    for begin, action, said in (
        (lambda: None, 0, "no wall was begun"),
        (lambda: played(env, 1), 0, "finished"),
        (lambda: env.reset(seed=1), 8, "none of"),
    ):
        begin()
        with pytest.raises(UsageError, match=said):
            env.step(np.int64(action))


@pytest.mark.parametrize("profile", [[0.5] * 4 + [0.0] * 4, [0.5, 0.25, 0.0]])
def test_profile_is_the_top_of_the_wall(profile):
    """The second one has parts that are no whole columns."""
    env = made(columns=len(profile))
    seen, _ = env.reset(seed=1, options=GIVEN | {"order": [1, 2]})
    assert seen["left"].tolist() == [pytest.approx(1 / 6), 1.0]
    assert not seen["profile"].any()
    offers = env.episode.offers
    lying = next(k for k, one in enumerate(offers) if one.width_px == 20 and one.left_px == 0)
    seen, *_ = env.step(np.int64(lying))
    assert seen["profile"] == pytest.approx(profile)
    assert seen["left"].tolist() == [0.0, 0.75]


def test_given_stones_arrive_in_a_random_order_of_the_seed():
    env = made()

    def order(seed):
        _, info = env.reset(seed=seed, options=GIVEN)
        while info["stone"]:
            yield info["stone"]
            info = env.step(np.int64(0))[4]

    orders = [tuple(order(seed)) for seed in (1, *range(6))]
    assert orders[0] == orders[2]
    assert len(set(orders)) > 1


@pytest.mark.parametrize(
    "options",
    [{"stone": 1}, {"stones": GIVEN["stones"]}, {"site": Site(10, 10)}, {"order": [1]},
     *(GIVEN | {"order": order} for order in ([1, 1], [77], [], [1.5], 3))],
)  # fmt: skip
def test_reset_refuses(options):
    code = "E201" if options.get("order") == [77] else "E123"
    with pytest.raises(DrystoneError, match=code):
        made().reset(seed=1, options=options)


@pytest.mark.parametrize(
    ("made", "wrong"),
    [(WallEnv, wrong) for wrong in
     ({"offers": 0}, {"columns": 0}, {"illegal": "ignore"}, {"render_mode": "human"})]
    + [(DrawSettings, wrong) for wrong in
       ({"kinds": ()}, {"kinds": ("marble",)}, {"stones": 2}, {"size_px": 3.0}, {"surplus": 0.0},
        {"aspect": 0.0}, {"aspect": 0.049}, {"aspect": 20.1}, {"aspect": np.nan})],
)  # fmt: skip
def test_settings_that_are_refused(made, wrong):
    with pytest.raises(UsageError, match="E123"):
        made(**wrong)


def test_example_of_the_documents_runs(capsys):
    code, names = printed("evidence/learning.md", "python")[0], {}
    exec(code.replace("gymnasium.make(", "gymnasium.make(draw=draw, id="), names | {"draw": SMALL})  # noqa: S102 - ours
    assert "F_SF" in capsys.readouterr().out


def test_stones_of_outlines_arrive_too():
    settings = replace(ARRIVING, geometry="exact")
    rewards, info, _ = played(made(settings=settings, draw=replace(SMALL, stones=4)), 1)
    assert info["placed"] == len(rewards) >= 2
    assert sum(rewards) == pytest.approx(info["merit"])


@pytest.mark.parametrize("illegal", ["aside", "error"])
def test_a_wall_in_which_nothing_can_be_built_is_over_with_any_action(illegal):
    env = made(illegal=illegal)
    seen, info = env.reset(seed=1, options=GIVEN | {"site": Site(4, 4)})
    assert (info["stone"], info["merit"], info["metrics"]) == (0, 0.0, {})
    action = env.action_space.sample(mask=info["action_mask"])  # as the loop of the documents does
    seen, reward, over, truncated, info = env.step(action)
    assert env.observation_space.contains(seen)
    assert (reward, over, truncated, info["placed"], info["illegal"]) == (0.0, True, False, 0, True)
    with pytest.raises(UsageError, match="finished"):
        env.step(action)


def test_a_deep_copy_goes_on_by_itself():
    wrapped = gymnasium.make(drystone_lab.rl.ENVIRONMENT, draw=SMALL)
    wrapped.reset(seed=1)
    wrapped.action_space.seed(1)
    wrapped.step(np.int64(0))
    other, third = deepcopy(wrapped), deepcopy(wrapped)
    (seen, reward, *_), again = other.step(np.int64(1)), third.step(np.int64(1))
    assert reward == again[1]
    np.testing.assert_equal(seen, again[0])
    assert len(wrapped.unwrapped.episode.build.actions) == 1
    # Both draw the same walls, and neither draws for the other.
    np.testing.assert_equal(wrapped.reset()[0], other.reset()[0])
    assert wrapped.action_space.sample() == other.action_space.sample()


def test_builds_the_wall_of_the_planner_with_the_same_policy():
    settings = replace(ARRIVING, selection_rule="lowest")
    for seed in range(2):
        stones, site = draw_wall(SMALL, np.random.default_rng(seed))
        episode = Episode(Workshop.prepare(stones, site, ARRIVING))
        while not episode.over:
            episode.take(LOWEST.choose(episode.offers, np.random.default_rng(0)))
        planner = Planner(stones, site, settings=settings)
        list(planner.steps())
        assert np.array_equal(episode.build.wall.labels, planner.build.wall.labels)
        possible = possible_filling(planner.workshop)
        assert episode.merit == merit_of(figures_of(planner.build), possible, settings.goal)
        assert episode.aside == len(stones) - len(planner.build.actions)


def test_keeps_the_lowest_of_the_offers_and_is_over_when_the_wall_is_full():
    workshop = Workshop.prepare(*bricks(), ARRIVING)
    episode = Episode(workshop)
    while not episode.over:
        lying = [k for k, offer in enumerate(episode.offers) if offer.width_px == 20]
        episode.take(lying[0])
    assert episode.build.wall.filling == 1.0
    assert (len(episode.build.actions), episode.aside, episode.waiting) == (4, 0, 2)
    every, few = Episode(workshop).offers, Episode(workshop, most=3).offers
    heights, kept = ([offer.centroid_px[1] for offer in offers] for offers in (every, few))
    assert len(heights) > 3
    assert sorted(kept) == sorted(heights)[:3]
    assert [offer for offer in every if offer in few] == list(few)
    for position in (-1, len(every)):
        with pytest.raises(IndexError):
            Episode(workshop).take(position)


@pytest.mark.parametrize("kind", KINDS)
def test_size_and_surplus_are_those_asked_for(kind):
    settings = DrawSettings(kinds=(kind,), stones=30, size_px=16.0, surplus=1.3, aspect=2.0)
    stones, site = draw_wall(settings, np.random.default_rng(3))
    assert [stone.id for stone in stones] == list(range(1, 31))
    assert (stones.total_area_px / 30) ** 0.5 == pytest.approx(16.0, rel=0.12)
    area = site.width_px * site.height_px
    assert stones.total_area_px / area == pytest.approx(1.3, rel=0.03)
    assert site.width_px / site.height_px == pytest.approx(2.0, rel=0.03)
    # Every wall that may be drawn is.
    for stones in (3, 8, 40):
        for aspect in (1.0 / stones, 0.9, 2.5, stones):
            settings = DrawSettings(kinds=(kind,), stones=stones, size_px=8, aspect=aspect)
            assert len(draw_wall(settings, np.random.default_rng(1))[0]) == stones


def test_order_keeps_every_stone():
    stones = scenes.bricks(8, halves=4)
    again = in_order(stones, np.random.default_rng(2))
    widths = [[stone.mask.shape[1] for stone in some] for some in (stones, again)]
    assert widths[0] != widths[1]
    assert sorted(widths[0]) == sorted(widths[1])


def test_without_gymnasium_it_says_what_to_install_and_the_policy_needs_none():
    code = (
        "import sys; sys.modules['gymnasium'] = None\n"
        "from drystone.selection.policies.learned import learned; learned()\n"
        "print('chosen'); import drystone_lab.rl\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)  # noqa: S603
    assert done.stdout == "chosen\n"
    said = done.stderr.splitlines()[-1]
    assert said.startswith("drystone.errors.UsageError: E150 ")
    assert said.endswith(' Install it with `pip install "drystone[rl]"`.')
