"""Real photographs of the suite photos; without others those of scikit-image are there."""

from drystone_lab import photos
from drystone_lab.photographs.real import ALL, pixels_of, there, truth_of
from drystone_lab.photos import whole_stones
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
    (coins,) = [one for one in there(None) if one.file == "coins"]
    image = pixels_of(coins, None)
    truth = truth_of(coins, None, (image.shape[1], image.shape[0]))
    assert truth.shape == image.shape[:2]
    assert len(whole_stones(truth)) == 24
    assert len(whole_stones(truth[:, 20:])) < 24
