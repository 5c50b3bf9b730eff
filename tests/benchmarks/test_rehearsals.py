"""The harness of rehearsals: rows stay on disk, and a run goes on where it was stopped."""

from benchmarks import rehearsals as harness
from drystone_lab.walls import BRICKS


def test_what_is_on_disk_is_not_done_again(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(harness, "WALLS", (BRICKS,))
    asked = [str(tmp_path), "--seeds", "1", "--budget", "1", "--tilts", "0"]
    harness.main([*asked, "--runs", "1"])
    rows = tmp_path / "bricks-0" / "rows.jsonl"
    assert len(rows.read_text().splitlines()) == 1 + 2 * 2  # without errors; levels x loops
    first = capsys.readouterr().out.splitlines()
    assert first[1].startswith("bricks | 100%, 0.0 | 100%, 0.0 | 100%, 0.0 (0.0) | ")
    # Rows that are there are believed, missing ones added, the plan is not made again.
    monkeypatch.setattr(harness.subprocess, "run", None)
    lost = [line.replace('"fallen": 0', '"fallen": 2') for line in rows.read_text().splitlines()]
    rows.write_text("\n".join(lost) + "\n")
    harness.main([*asked, "--runs", "2", "--against", str(tmp_path)])
    assert len(rows.read_text().splitlines()) == 1 + 2 * 2 * 2
    mine, other = capsys.readouterr().out.splitlines()[1:]
    assert mine == other
    assert " | 50%, 1.0 | 50%, 1.0 | 50%, 1.0 (0.0) | " in mine
