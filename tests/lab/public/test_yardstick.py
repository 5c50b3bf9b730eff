"""The yardstick of the public benchmark: strips packed without gravity."""

import pytest

from drystone.errors import UsageError
from drystone_lab import packing
from drystone_lab.public import bench
from drystone_lab.public.bench import run_public
from drystone_lab.public.history import history_table, medians_of
from drystone_lab.public.store import Stamp, kept_runs
from drystone_lab.public.suites import method_named, walls_of
from drystone_lab.runs.outcome import FIGURES, execute
from drystone_lab.table import BenchSettings

STAMP = Stamp("0.1.0", "2026-01-01T00:00:00+00:00", "Linux x86_64")
WALL = walls_of("bricks")[0]


def packing_into(monkeypatch, width):
    """Pack everything into a strip of a width; return what is asked."""
    asked = []

    def packed(_packer, stones, height, turns, seconds, seed):
        asked.append((len(stones), height, turns, seconds, seed))
        return width

    monkeypatch.setattr(packing, "load_packer", lambda: None)
    monkeypatch.setattr(bench, "load_packer", lambda: None)
    monkeypatch.setattr(packing, "packed_width_px", packed)
    return asked


@pytest.mark.parametrize(("strip", "over"), [(300.0, 300.0), (60.0, 120.0)])
def test_it_fills_a_strip_as_high_as_the_wall(monkeypatch, strip, over):
    asked = packing_into(monkeypatch, strip)
    outcome = execute(method_named("spyrrow").run(WALL, 3), None)
    stones = WALL.source.stones(None)
    assert asked == [(len(stones), 84, (0.0, 90.0, 180.0, 270.0), 3, 3)]
    # A strip that is shorter than the wall leaves the rest of the wall empty.
    area = sum(int(stone.mask.sum()) for stone in stones)
    assert outcome.figures["F_SF"] == pytest.approx(area / (over * 84))
    assert {k for k, v in outcome.figures.items() if v is None} == {*FIGURES} - {"F_SF", "stones"}


def test_it_is_in_tables_but_in_no_pairs(monkeypatch, tmp_path):
    packing_into(monkeypatch, 150.0)
    policies = ("paper", "spyrrow", "lowest")
    settings = BenchSettings(policies=policies, quick=True, seeds=1, store=tmp_path)
    walls, everything, seconds, *others = run_public("bricks", settings, STAMP)
    for table, column in ((walls, 1), (everything, 0), (seconds, 1)):
        assert "spyrrow" in [row[column] for row in table.rows]
    (row,) = (row for row in walls.rows if row[1] == "spyrrow")
    assert [cell for cell in row[3:] if cell is not None] == [row[6], row[8]]
    assert any(note.startswith("spyrrow is a yardstick") for note in walls.notes)
    assert not any("spyrrow" in row for table in others for row in table.rows)
    kept = {run.method: run for run in kept_runs(tmp_path)}
    assert (kept["spyrrow"].F_LR, kept["spyrrow"].F_SF) == (None, pytest.approx(row[6], abs=1e-4))
    # It builds no wall, so a history of it has no share of the stones, not 0.
    history = history_table(medians_of(kept.values())).records()
    shares = {row["method"]: row["placed share"] for row in history}
    assert shares["spyrrow"] is None
    assert shares["paper"] > 0.5
    # What is kept is not packed again.
    monkeypatch.setattr(packing, "packed_width_px", None)
    assert run_public("bricks", settings, STAMP)[0].rows == walls.rows


def test_what_is_missing_is_said_before_anything_is_done(monkeypatch):
    def absent(name):
        raise ImportError(name)

    monkeypatch.setattr(packing, "import_module", absent)
    monkeypatch.setattr(bench, "work_of", None)
    with pytest.raises(UsageError, match="E305"):
        run_public("bricks", BenchSettings(policies=("paper", "spyrrow")), STAMP)
