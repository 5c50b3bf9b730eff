"""Walls of several sets, ways and seeds, done together."""

from dataclasses import replace
from pathlib import Path

from drystone_lab.reproduce.base import LIU_5, PR
from drystone_lab.reproduce.trials import all_specs, at_hand, run_trials, seeds_of
from drystone_lab.runs.source import generated
from tests.lab.reproduce.small_walls import RUBBLE, context

BRICKS = replace(
    RUBBLE, name="bricks", source=generated("brick", 1, count=6, height_px=10, aspect=2),
    width=60, height=20,
)  # fmt: skip
OTHER = replace(BRICKS, name="narrow", width=40)
WAYS = {"base": (), "lowest": (("placement.rule", "lowest"),)}


def test_every_wall_is_of_its_set_way_and_seed(tmp_path: Path) -> None:
    here = context(tmp_path)
    found = run_trials(here, (BRICKS, OTHER), WAYS, (3, 4))
    assert [(each.wall, each.way) for each in found] == [
        (BRICKS, "base"), (BRICKS, "lowest"), (OTHER, "base"), (OTHER, "lowest"),
    ]  # fmt: skip
    for each in found:
        assert each.specs == tuple(each.wall.run(seed, *WAYS[each.way]) for seed in (3, 4))
        assert [out.key for out in each.outcomes] == [spec.key for spec in each.specs]
        assert each.values("F_SF") == tuple(out.figures["F_SF"] for out in each.outcomes)
    assert len(set(all_specs(found))) == 8
    wall, clusters = found[1].drawn(here, 1)
    assert len(wall.placements) == found[1].outcomes[1].figures["placed"] == len(clusters)


def test_seeds_and_data(tmp_path: Path) -> None:
    here = context(tmp_path)
    assert list(seeds_of(here, 20, 3)) == list(range(here.seed, here.seed + 20))
    assert list(seeds_of(replace(here, quick=True, seed=7), 20, 3)) == [7, 8, 9]
    assert at_hand(here, (PR, LIU_5)) == (LIU_5,)
