"""A plan from Python is a folder that every command reads."""

from pathlib import Path

import numpy as np
import pytest

import drystone as ds
from drystone.cli.main import main
from drystone.io.wall_image import read_wall_image
from drystone.io.walls import read_wall
from tests.planner.scenes import RUBBLE_SITE, greedy, rubble


@pytest.mark.parametrize("geometry", ["exact", "raster"])
def test_commands_read_what_python_wrote(
    geometry: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    settings = greedy({"geometry": geometry})
    result = ds.plan_wall(rubble(), 100, 36, scale=1.0, seed=2, settings=settings, px_per_m=100)
    path = ds.write_plan_folder(result, tmp_path / "new" / "out")
    assert path == tmp_path / "new" / "out" / "plan.json"
    assert ds.read_plan(path) == result.plan
    wall = read_wall(path.parent)
    assert (wall.labels == result.wall.labels).all()
    assert (wall.blocks is not None) == (geometry == "exact")
    for command in ("analyse", "measure", "craft"):
        assert main([command, str(path.parent)]) == 0
    assert main(["export", str(path.parent), "--to", "poses", "-o", str(tmp_path / "ex")]) == 0
    capsys.readouterr()


def test_no_file_of_another_wall_is_left(tmp_path: Path) -> None:
    for geometry in ("exact", "raster"):
        result = ds.plan_wall(
            rubble(), 100, 36, scale=1.0, settings=greedy({"geometry": geometry}), budget=1
        )
        (tmp_path / "mine.txt").write_text("mine")
        ds.write_plan_folder(result, str(tmp_path))
    assert {path.name for path in tmp_path.iterdir()} == {
        "mine.txt", "plan.json", "settings.toml", "wall.png",
    }  # fmt: skip


def test_a_planner_becomes_a_plan_at_any_step() -> None:
    planner = ds.Planner(rubble(), RUBBLE_SITE, seed=1, settings=greedy({}))
    for step in planner.steps():
        if step.number == 2:
            break
    half = ds.result_of(planner)
    assert (half.status, len(half.plan.stone_steps)) == ("interrupted", 2)
    assert half.plan.seed == 1
    assert half.plan.stopped == "interrupted"  # as --resume looks for
    for _ in planner.steps():
        pass
    whole = ds.result_of(planner)
    assert whole.message == planner.stopped.text
    again = ds.plan_wall(
        rubble(), *RUBBLE_SITE.extent_px, scale=1.0, seed=1, settings=greedy({}), budget=1
    )
    assert whole.plan.steps == again.plan.steps
    assert np.array_equal(whole.wall.labels, again.wall.labels)
    assert whole.plan.settings["search"]["budget"] == 1


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    result = ds.plan_wall(rubble(), 100, 36, scale=1.0, settings=greedy({}), budget=1)
    for place in (tmp_path / "file", tmp_path / "file" / "in"):
        with pytest.raises(ds.DrystoneError, match=r"E206 .*file"):
            ds.write_plan_folder(result, place)


def test_stones_of_a_few_px_are_not_taken_for_blended_ids(tmp_path: Path) -> None:
    stones = ds.generate.rubble_stones(
        ds.generate.RubbleSettings(count=14), np.random.default_rng(3)
    )
    settings = greedy({"geometry": "raster"})
    result = ds.plan_wall(stones, 200, 100, scale=0.12, settings=settings, budget=1)
    ds.write_plan_folder(result, tmp_path)
    with pytest.raises(ds.DrystoneError, match="E101"):
        read_wall_image(tmp_path / "wall.png")
    assert (read_wall(tmp_path).labels == result.wall.labels).all()
