"""A search goes on from a file, in a folder where one run at a time works."""

import errno
import json
import math
import subprocess
import sys
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import PlanError, UsageError
from drystone.io import checkpoint, folder_lock
from drystone.io.checkpoint import CHECKPOINT, Checkpoint, read_checkpoint, write_checkpoint
from drystone.io.folder_lock import LOCK, has_files, locked
from drystone.io.json_text import as_json, from_plain
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.planner.planner import Planner
from drystone.search.anytime import searching
from drystone.search.goal import FoundWall
from drystone.search.whole_search import run_to_end
from drystone.search.yard import Yard
from tests.planner.scenes import WITH_WEDGES, few_stones, finish, greedy
from tests.strategies import repeatable

FEW_SITE = Site(90, 30)
SMALL = {"budget": 9, "passes": 3, "chains": 2, "share_every": 2, "cycle": 3}


def searched(planner, start=None):
    begin = start or FoundWall.of(planner)
    return list(searching(begin, Yard.of(planner), planner.seed))


def again(state, folder, planner):
    """Write where a search stands, and read it."""
    made_of = {"stones": "abc", "settings": {"mu": 0.58}}
    write_checkpoint(Checkpoint(made_of, state), folder)
    ids = [stone.id for stone in planner.workshop.stones]
    read = read_checkpoint(folder, ids, planner.settings.search)
    assert read.made_of == made_of
    return read.state


def test_a_search_goes_on_from_a_file_to_the_same_walls(tmp_path):
    search = {**SMALL, "budget": 7}
    stones, settings = few_stones(), greedy({"geometry": "exact", **WITH_WEDGES, "search": search})
    planner = finish(Planner(stones, FEW_SITE, seed=2, settings=settings))
    whole = searched(planner)
    stood = [one.state for one in whole if one.state is not None]
    assert [one.reached.walls for one in stood] == [2, 3, 5, 7]
    assert any(group.wedges for wall in whole[-1].kept for group in wall.groups)
    for state in stood[:-1:2]:
        read = again(state, tmp_path, planner)
        found = searched(planner, read)
        ends = [
            (one.walls, one.solves, one.best.groups,
             [(w.groups, w.figures, w.merit, w.courses) for w in one.kept])
            for one in (found[-1], whole[-1])
        ]  # fmt: skip
        assert ends[0] == ends[1]
        first = (tmp_path / CHECKPOINT).read_bytes()
        again(read, tmp_path, planner)
        assert (tmp_path / CHECKPOINT).read_bytes() == first


def test_without_a_search_it_says_what_is_planned(tmp_path):
    search = greedy().search
    assert read_checkpoint(tmp_path, [], search) is None
    write_checkpoint(Checkpoint({"--seed": 1}), tmp_path)
    read = read_checkpoint(tmp_path, [], search)
    assert (read.made_of, read.state) == ({"--seed": 1}, None)
    (tmp_path / CHECKPOINT).unlink()
    (tmp_path / CHECKPOINT).mkdir()
    assert read_checkpoint(tmp_path, [], search) is None


@pytest.fixture(scope="module")
def stood():
    """Where chains stand, in the second round, with what they are of."""
    search = {**SMALL, "budget": 20, "patience": 1}
    settings = greedy({"geometry": "exact", "search": search})
    planner = finish(Planner(few_stones(), FEW_SITE, seed=1, settings=settings))
    states = (one.state for one in searching(FoundWall.of(planner), Yard.of(planner), 1))
    return next(one for one in states if one and one.number > 0 and one.chains), planner


def refused(folder, planner, ids=None):
    known = [stone.id for stone in planner.workshop.stones] if ids is None else ids
    with pytest.raises(PlanError, match="E207") as caught:
        read_checkpoint(folder, known, planner.settings.search)
    assert caught.value.where == str(folder / CHECKPOINT)
    return caught.value.what


def test_a_damaged_file_or_one_of_another_version_or_other_stones_is_refused(
    stood, tmp_path, monkeypatch
):
    state, planner = stood
    with monkeypatch.context() as patch:
        patch.setattr(checkpoint, "version", lambda _: "0.0.1")
        again(state, tmp_path, planner)
    assert "of drystone 0.0.1" in refused(tmp_path, planner)
    again(state, tmp_path, planner)
    assert "other stones" in refused(tmp_path, planner, ids=[1, 2])
    with monkeypatch.context() as patch:
        patch.setattr(checkpoint, "LARGEST_BYTES", 1000)
        assert "too large" in refused(tmp_path, planner)
    whole = (tmp_path / CHECKPOINT).read_bytes()
    for damaged in (
        b"",
        whole[: len(whole) // 2],
        whole.replace(b'"number":1', b'"number":2', 1),
        whole.replace(b"{", b"[", 1),
        b"\xff\xfe",
        b"[]",
        b'{"sha256": 1, "data": {}}',
        b'{"sha256": "", "data": ' + b"9" * 5000 + b"}",
    ):
        assert damaged != whole
        (tmp_path / CHECKPOINT).write_bytes(damaged)
        assert refused(tmp_path, planner)


def test_a_search_that_cannot_be_is_refused(stood, tmp_path):
    state, planner = stood
    chains = state.chains
    planned = next(w for w in chains.reached.kept if w.courses is not None)

    def with_best(ends):
        wall = replace(planned, courses=replace(planned.courses, ends=ends))
        return replace(state, chains=replace(chains, reached=replace(chains.reached, best=wall)))

    for wrong in (
        replace(state, number=0),
        replace(state, before=None),
        replace(state, chains=None),
        replace(state, found=chains.reached.kept),
        replace(state, chains=replace(chains, links=())),
        replace(state, chains=replace(chains, turn=3)),
        with_best((0, 99)),
        with_best((3, 1)),
    ):
        write_checkpoint(Checkpoint({}, wrong), tmp_path)
        assert refused(tmp_path, planner)


def test_a_search_goes_on_with_what_it_is_of_alone_and_where_its_walls_stand(stood):
    state, planner = stood
    chains = state.chains
    now = chains.links[0].now
    high = replace(now.groups[0], place=(20.0, 30.0))
    floating = replace(now, groups=(high, *now.groups[1:]))
    links = tuple(replace(link, now=floating) for link in chains.links)
    forged = replace(state, chains=replace(chains, links=links, turn=0))
    stones, settings = planner.workshop.stones, planner.settings
    longer = settings.updated({"search": {"budget": 60}})
    with pytest.raises(PlanError, match=r"E207 .* do not stand where they stood"):
        run_to_end(Planner(stones, FEW_SITE, seed=1, settings=longer), start=forged)
    first, *others = stones
    for changes in (
        {"seed": 2},
        {"site": Site(91, 30)},
        {"site": replace(FEW_SITE, px_per_m=100.0)},
        {"settings": settings.updated({"ban": [first.id]})},
        {"settings": settings.updated({"mu": 0.6})},
        {"stones": StoneSet((replace(first, left_px=first.left_px + 1), *others))},
        {"stones": StoneSet((replace(first, mask=first.mask[:, ::-1]), *others))},
    ):
        given = {"stones": stones, "site": FEW_SITE, "seed": 1, "settings": settings, **changes}
        with pytest.raises(PlanError, match=r"E207 .* it is of other stones, another wall, other"):
            run_to_end(Planner(**given), start=state)


@dataclass(frozen=True)
class Inner:
    side: Literal["left", "right"]
    place: tuple[int, int] | tuple[float, float]


@dataclass(frozen=True)
class Outer:
    name: str
    count: int
    share: float
    sure: bool
    maybe: Inner | None
    many: tuple[Inner, ...]


ONE = Outer("a", 1, 0.1, True, None, (Inner("left", (1, 2)), Inner("right", (1.0, 2.5))))


# Of few characters: the table of all takes a second or two.
@repeatable(30)
@given(st.floats(allow_nan=False), st.integers(), st.text('a"\\\n\0\x7f\u2028é\uffff\U0001d54a'))
def test_values_are_the_same_again(share, count, name):
    value = Outer(name, count, share, False, Inner("left", (share, -share)), ONE.many)
    found = from_plain(Outer, json.loads(as_json(value)))
    assert found == value
    assert math.copysign(1.0, found.share) == math.copysign(1.0, share)
    assert [type(one.place[0]) for one in found.many] == [int, float]
    assert as_json(Inner("left", (np.int64(3), np.float64(4)))) == '{"side":"left","place":[3,4.0]}'


def test_what_is_of_another_type_is_refused():
    for change in (
        {"name": 3}, {"count": 1.0}, {"share": True}, {"share": float("nan")}, {"share": 10**400},
        {"sure": 1}, {"maybe": {"side": "left"}}, {"maybe": {"side": ["left"], "place": [1, 2]}},
        {"maybe": {"side": "left", "place": [1, 2, 3]}},
        {"maybe": {"side": "left", "place": {"0": 1, "1": 2}}}, {"many": [None]}, {"more": 1},
    ):  # fmt: skip
        data = json.loads(as_json(ONE)) | change
        with pytest.raises(ValueError, match=r"this is no|is not of type"):
            from_plain(Outer, data)
        data = json.loads(as_json(ONE))
        del data[next(iter(change.keys() & data.keys()), "name")]
        with pytest.raises(ValueError, match="this is not of type Outer"):
            from_plain(Outer, data)


HOLDING = """
import sys, time
from pathlib import Path
from drystone.io.folder_lock import locked

with locked(Path(sys.argv[1])):
    print("locked", flush=True)
    time.sleep(1000)
"""


def enter(folder):
    with locked(folder):
        assert (folder / LOCK).exists()


def test_a_second_run_is_refused_until_the_first_has_ended_also_when_it_is_killed(tmp_path):
    with locked(tmp_path):
        for _ in range(2):
            with pytest.raises(UsageError, match="E149") as caught:
                enter(tmp_path)
            assert caught.value.where == str(tmp_path)
    assert list(tmp_path.iterdir()) == []
    command = [sys.executable, "-c", HOLDING, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as other:  # noqa: S603
        assert other.stdout.readline() == "locked\n"
        with pytest.raises(UsageError, match="E149"):
            enter(tmp_path)
        other.kill()
        other.wait()
    assert (tmp_path / LOCK).exists()
    assert not has_files(tmp_path)
    enter(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_what_a_killed_run_was_writing_goes(tmp_path):
    part = f".plan.json.{32 * 'a'}.part"
    ours, other = tmp_path / "pareto" / "01", tmp_path / "another run"
    for place in (tmp_path, ours, other):
        place.mkdir(parents=True, exist_ok=True)
        (place / part).write_bytes(b"half")
        (place / "mine.part").write_bytes(b"whole")
    with locked(tmp_path, "pareto/*/"):
        left = {path.parent for path in tmp_path.rglob(part)}
    assert left == {other}
    assert len(list(tmp_path.rglob("mine.part"))) == 3


def test_a_lock_that_is_removed_while_it_is_taken_is_taken_again(tmp_path, monkeypatch):
    """As by a run that ends just then."""
    taken, calls = folder_lock._lock, []

    def late(file):
        if not calls:
            (tmp_path / LOCK).unlink()
        elif len(calls) == 1:
            (tmp_path / LOCK).unlink()
            (tmp_path / LOCK).write_bytes(b"")
        calls.append(file)
        taken(file)

    monkeypatch.setattr(folder_lock, "_lock", late)
    with locked(tmp_path):
        assert len(calls) == 3
        monkeypatch.undo()
        with pytest.raises(UsageError, match="E149"):
            enter(tmp_path)


def test_where_there_are_no_locks_there_is_none_or_a_code(tmp_path, monkeypatch):
    def unknown(_):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(folder_lock, "_lock", unknown)
    with locked(tmp_path):
        enter(tmp_path)
    assert list(tmp_path.iterdir()) == []
    (tmp_path / LOCK).mkdir()  # which cannot be written
    with pytest.raises(PlanError, match="E206"):
        enter(tmp_path)
