"""Many irregular stones: ours, and a user's."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from drystone_lab.reproduce.fig_b33 import GENERATED, MOST_PX, QUICK, make, wall_of_image
from tests.lab.reproduce.small_walls import RUBBLE, context, rows


def test_there_are_91_stones_that_the_wall_has_room_for():
    for wall, count in ((GENERATED, 91), (QUICK, 24)):
        stones = wall.source.stones(None)
        assert len(stones) == count
        assert stones.total_area_px / (wall.width * wall.height) == pytest.approx(0.75, abs=0.02)


def test_both_walls_are_built_and_counted(tmp_path):
    output = make(context(tmp_path), RUBBLE)
    ours, twice, left, right = rows(output, "walls")
    assert [row["built from"] for row in (ours, twice)] == ["one side", "two sides"]
    assert [(row["placed"], row["of"]) for row in (left, right)] == [(90, 91), (91, 91)]
    for ax in output.pictures[0].figure.axes:
        assert ax.get_title(loc="left").startswith("rubble, from ")
    assert [run.settings().two_sided for run in output.runs] == [False, True]
    for run, row in zip(output.runs, (ours, twice), strict=True):
        wall = context(tmp_path).wall(run)
        assert row["placed"] == len(wall.placements)
        assert row["placed"] == len({*np.unique(wall.labels)} & {*range(1, 17)})


def test_a_users_stones_are_for_a_wall_of_the_size_of_their_image(tmp_path):
    labels = np.zeros((400, 600), np.uint16)
    labels[10:90, 10:150], labels[10:90, 200:380], labels[120:200, 10:200] = 1, 2, 3
    path = tmp_path / "mine.png"
    Image.fromarray(labels).save(path)
    user = replace(context(tmp_path / "runs"), image=path)
    wall = wall_of_image(user)
    assert wall.name == "mine.png"
    assert wall.scale == 0.63  # 240 000 px to 96 000
    assert 600 * 400 * wall.scale**2 <= MOST_PX
    output = make(user)
    assert rows(output, "walls")[0]["placed"] == 3
    assert "a user's" in output.ours[0]
    with pytest.raises(ValueError, match="no image"):
        wall_of_image(context(tmp_path))
