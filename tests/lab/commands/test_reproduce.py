import pytest

from drystone.cli.parser import build_parser
from drystone.errors import ExitCode, UsageError
from drystone.io.folder_lock import LOCK, locked
from drystone_lab.commands import reproduce
from tests.cli.conftest import Ran
from tests.lab.reproduce import fakes


@pytest.fixture(autouse=True)
def _no_data_named(monkeypatch, tmp_path):
    monkeypatch.setenv("DRYSTONE_DATA", str(tmp_path / "none"))


@pytest.fixture
def run_items(capsys):
    """Call the command on small items."""

    def call(*arguments, items=fakes.ITEMS):
        capsys.readouterr()
        parsed = build_parser().parse_args(["reproduce", *map(str, arguments)])
        return Ran(int(reproduce.run(parsed, items)), *capsys.readouterr())

    return call


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ((), "nothing to make is named"),
        (("fig5",), "no folder to write to is named"),
        (("fig99", "-o", "x"), "'fig99'"),
    ],
)
def test_what_is_not_said_well(options, said, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run("reproduce", *options).refused("E138", said)
    assert not any(tmp_path.iterdir())


def test_tables_pages_and_json(run_items, tmp_path):
    out = tmp_path / "out"
    ran = run_items("beta", "fig5", "-o", out)
    assert ran.code == 0
    assert ran.out.index("fig5: filling of bricks (§3.4)") < ran.out.index("beta: words (5.1)")
    assert "Filling\nseed  F_SF  F_AV\n" in ran.out
    assert "Seconds\nseed " in ran.out
    assert f"page: {out / 'fig5' / 'index.html'}" in ran.out
    assert ran.out.endswith(f"report: {out / 'index.html'}\n")
    assert "1 of 2, fig5: 1 of 2 walls" in ran.err
    again = run_items("beta", "fig5", "-o", out, "--quiet")
    assert again.out == ran.out
    assert again.err == f"drystone: there is no folder {tmp_path / 'none'} of published data\n"
    ran = run_items("fig5", "fig13", "-o", tmp_path / "out", "--json", "--seed", "3", "--quick")
    assert ran.code == 3
    assert ran.json()["report"] == str(tmp_path / "out" / "index.html")
    made, missed = ran.json()["items"]
    assert (made["name"], made["status"], made["request"]["seed"]) == ("fig5", "made", 3)
    assert made["tables"][0]["columns"] == ["seed", "F_SF", "F_AV"]
    assert len(made["tables"][0]["rows"]) == 1
    assert (missed["status"], missed["error"]["code"]) == ("missing data", "E100")


def test_all_goes_on_without_some_stones(run_items, tmp_path, monkeypatch):
    items = dict.fromkeys(("table1", "fig13", "beta"), fakes.NEEDY)
    monkeypatch.setattr(reproduce, "ITEMS", items)
    assert run_items("all", "-o", tmp_path / "none", items=items).code == ExitCode.BAD_INPUT
    ran = run_items("all", "-o", tmp_path / "out", items=items | {"beta": fakes.WORDS})
    assert ran.code == 0
    assert ran.err.count("E100") == len(items) - 1
    # What is kept from before is as good as made.
    assert run_items("all", "-o", tmp_path / "out", items=items | {"beta": fakes.WORDS}).code == 0


def test_an_error_is_told_and_is_the_exit_code(run_items, tmp_path):
    fakes.lay_needed(tmp_path / "data")
    ran = run_items("figB33", "fig13", "-o", tmp_path / "out", "--data", tmp_path / "data")
    assert ran.code == ExitCode.BAD_INPUT
    assert "drystone: figB33: E104 broken: there are no stones." in ran.err
    assert "fig13: published stones" in ran.out


def test_two_runs_do_not_write_into_one_folder(run_items, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    with locked(out), pytest.raises(UsageError, match="E149"):
        run_items("beta", "-o", out, "--quick")
    with pytest.raises(UsageError, match="E138"):
        run_items("fig5", "-o", out, "--jobs", 2, "--dask", "tcp://127.0.0.1:1")
    # What a run that was killed has left makes no folder another's.
    (out / LOCK).write_bytes(b"")
    part = out / "runs" / f".a.json.{32 * 'a'}.part"
    part.parent.mkdir()
    part.write_bytes(b"half")
    (out / "reproduce.json").write_text('{"schema": "drystone-reproduce/1", "misses": {}}')
    assert run_items("beta", "-o", out, "--quick").code == ExitCode.DONE
    assert not part.exists()
    assert not (out / LOCK).exists()
