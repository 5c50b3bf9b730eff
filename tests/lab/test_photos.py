"""Real photographs of the suite photos; without others those of scikit-image are there."""

import numpy as np

from drystone_lab import photos
from drystone_lab.photos import ALL, there, whole_stones
from drystone_lab.table import BenchSettings


def test_photographs_that_are_installed_have_a_row(tmp_path, monkeypatch):
    installed = {photo.name: photo for photo in there(tmp_path)}
    assert list(installed) == ["coins, light from one side", "gravel", "brick wall", "lawn"]
    few = [installed["coins, light from one side"], installed["lawn"]]
    monkeypatch.setattr(photos, "there", lambda _: few)
    monkeypatch.setattr(photos, "LEVELS", ())
    monkeypatch.setattr(photos, "_refused", tuple)
    *_, table = photos.run(BenchSettings(data=tmp_path))
    coins, lawn = table.records()
    assert (coins["stones"], coins["verdict"], coins["exit code"]) == (24, "doubtful", 5)
    assert (coins["precision"], coins["recall"] > 0.9) == (1.0, True)
    assert lawn["exit code"] == 3
    assert f"2 of {len(ALL)} are there" in table.notes[0]


def test_stones_that_the_edge_cuts_do_not_count():
    truth = np.zeros((6, 9), np.uint16)
    truth[1:4, 1:4], truth[2:5, 5:] = 1, 2
    assert whole_stones(truth).tolist() == [1]
    got = photos._compared(truth, whole_stones(truth), np.where(truth == 1, truth, 0))
    assert (got.stones, got.found, got.recall, got.ious) == (1, 1, 1.0, (1.0,))
