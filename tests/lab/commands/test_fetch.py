import pytest

from drystone.io.published import LICENCE, PAPER, SETS
from drystone_lab.commands import fetch
from tests.io.served import COMMIT, CONTENTS, lay_down, lay_open, nobody, serving, toy_set


def test_the_sets_are_listed_one_a_line(run):
    ran = run("fetch", "--list")
    assert (ran.code, ran.err) == (0, "")
    names = [line.split(":")[0] for line in ran.out.splitlines()]
    assert names == list(SETS) == ["almeida", "thangavelu", "rubble", "bricks", "fourier"]


def test_a_set_arrives_with_licence_and_source(run, tmp_path, monkeypatch):
    monkeypatch.setattr(fetch, "SETS", {"toy": toy_set()})
    lay_open(tmp_path / "served")
    with serving(tmp_path / "served") as address:
        monkeypatch.setattr(fetch, "RAW", address)
        ran = run("fetch", "toy", "-o", tmp_path / "here")
    assert ran.code == 0
    for name, contents in CONTENTS.items():
        path = tmp_path / "here" / name
        assert path.read_bytes() == contents
        assert f"{path}  downloaded" in ran.out
    assert f"DRYSTONE_DATA={tmp_path / 'here'}" in ran.out
    assert f"- {PAPER}\n- Nobody (2000)\n" in ran.out
    assert ran.out.endswith(LICENCE)


def test_a_local_copy_wins(run, tmp_path, monkeypatch):
    monkeypatch.setattr(fetch, "SETS", {"toy": toy_set()})
    lay_down(tmp_path, *CONTENTS)
    monkeypatch.setenv("DRYSTONE_DATA", str(tmp_path))
    monkeypatch.setattr(fetch, "RAW", nobody())
    ran = run("fetch", "toy", "toy", "--json")
    assert (ran.code, ran.err) == (0, "")
    record = ran.json()
    assert record["folder"] == str(tmp_path)
    assert [file["path"] for file in record["files"]] == [str(tmp_path / n) for n in CONTENTS]
    assert not any(file["downloaded"] for file in record["files"])
    assert all(f"/{COMMIT}/Tests/" in file["source"] for file in record["files"])
    assert record["cite"] == [PAPER, "Nobody (2000)"]
    assert record["licence"] == LICENCE


def test_no_network_ends_with_a_cure(run, tmp_path, monkeypatch):
    monkeypatch.setattr(fetch, "RAW", nobody())
    run("fetch", "almeida", "-o", tmp_path).refused("E161", "By hand: save http", exit_code=3)


@pytest.mark.parametrize(("names", "said"), [([], "no set is named"), (["ferris"], "'ferris'")])
def test_a_set_must_be_one_that_there_is(run, names, said):
    run("fetch", *names).refused("E138 fetch: ", said, "almeida or thangavelu or")
