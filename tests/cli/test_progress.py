"""The progress bar: on a terminal only, and on stderr only."""

BUDGET = "[search]\nbudget = 2\n"


def test_a_terminal_sees_stones_and_walls(rubble, tmp_path, run, monkeypatch):
    toml = tmp_path / "quick.toml"
    toml.write_text(BUDGET, encoding="utf-8")
    plan = ("plan", rubble, "--wall", "100x36", "--scale", "1", "--settings", toml, "--overwrite")
    monkeypatch.setenv("FORCE_COLOR", "1")  # the terminal that pytest does not have
    ran = run(*plan, "-o", tmp_path / "out")
    assert "filling" in ran.err
    assert "walls; best: " in ran.err
    assert "filling 0" not in ran.out
    for option in ("--quiet", "--json"):
        assert run(*plan, "-o", tmp_path / "out", option).err == ""
