"""A search goes on from a file to the walls that it would have found; a bad file is refused."""

from dataclasses import replace

import pytest

from drystone.errors import PlanError
from drystone.io import checkpoint
from drystone.io.checkpoint import CHECKPOINT, Checkpoint, read_checkpoint, write_checkpoint
from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.search.anytime import searching
from drystone.search.goal import FoundWall
from drystone.search.whole_search import run_to_end
from drystone.search.yard import Yard
from tests.planner.scenes import WITH_WEDGES, few_stones, finish, greedy

FEW_SITE = Site(90, 30)
SMALL = {"budget": 9, "passes": 3, "chains": 2, "share_every": 2, "cycle": 3}


def searched(planner, start=None):
    begin = start or FoundWall.of(planner)
    return list(searching(begin, Yard.of(planner), planner.seed))


def states_of(found):
    return [one.state for one in found if one.state is not None]


def again(state, folder, planner):
    """Write where a search stands, and read it."""
    made_of = {"stones": "abc", "settings": {"mu": 0.58}}
    write_checkpoint(Checkpoint(made_of, state), folder)
    ids = [stone.id for stone in planner.workshop.stones]
    read = read_checkpoint(folder, ids, planner.settings.search)
    assert read.made_of == made_of
    return read.state


def test_a_search_goes_on_from_a_file_to_the_same_walls(tmp_path):
    stones, settings = few_stones(), greedy({"geometry": "exact", **WITH_WEDGES, "search": SMALL})
    planner = finish(Planner(stones, FEW_SITE, seed=2, settings=settings))
    whole = searched(planner)
    stood = states_of(whole)
    assert [one.walls for one in stood] == [2, 3, 5, 7, 9]
    assert any(group.wedges for wall in whole[-1].kept for group in wall.groups)
    for state in stood[:-1:3]:
        read = again(state, tmp_path, planner)
        found = searched(planner, read)
        assert found[-1].walls == whole[-1].walls
        assert found[-1].best.groups == whole[-1].best.groups
        assert found[-1].solves == whole[-1].solves
        assert [(w.groups, w.figures, w.merit, w.courses) for w in found[-1].kept] == [
            (w.groups, w.figures, w.merit, w.courses) for w in whole[-1].kept
        ]
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


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: data[:0],
        lambda data: data[: len(data) // 2],
        lambda data: data.replace(b'"number":1', b'"number":2', 1),
        lambda data: data.replace(b"{", b"[", 1),
        lambda _: b"\xff\xfe",
        lambda _: b"[]",
        lambda _: b'{"sha256": 1, "data": {}}',
        lambda _: b'{"sha256": "", "data": ' + b"9" * 5000 + b"}",
    ],
)
def test_a_damaged_file_is_refused(damage, stood, tmp_path):
    state, planner = stood
    again(state, tmp_path, planner)
    path = tmp_path / CHECKPOINT
    whole = path.read_bytes()
    path.write_bytes(damage(whole))
    assert path.read_bytes() != whole
    assert refused(tmp_path, planner)


def test_a_file_that_is_too_large_or_of_another_version_is_refused(stood, tmp_path, monkeypatch):
    state, planner = stood
    with monkeypatch.context() as patch:
        patch.setattr(checkpoint, "version", lambda _: "0.0.1")
        again(state, tmp_path, planner)
    assert "of drystone 0.0.1" in refused(tmp_path, planner)
    again(state, tmp_path, planner)
    monkeypatch.setattr(checkpoint, "LARGEST_BYTES", 1000)
    assert "too large" in refused(tmp_path, planner)


CHANGES = {
    "rounds": lambda one: replace(one, number=0),
    "round": lambda one: replace(one, before=None),
    "first": lambda one: replace(one, chains=None),
    "both": lambda one: replace(one, found=one.chains.reached.kept),
    "links": lambda one: replace(one, chains=replace(one.chains, links=())),
    "turn": lambda one: replace(one, chains=replace(one.chains, turn=3)),
    "ends": lambda one: with_best(one, ends=(0, 99)),
    "order": lambda one: with_best(one, ends=(3, 1)),
}


def with_best(state, ends):
    chains = state.chains
    planned = next(w for w in chains.reached.kept if w.courses is not None)
    wall = replace(planned, courses=replace(planned.courses, ends=ends))
    return replace(state, chains=replace(chains, reached=replace(chains.reached, best=wall)))


@pytest.mark.parametrize("change", CHANGES)
def test_a_search_that_cannot_be_is_refused(change, stood, tmp_path):
    state, planner = stood
    write_checkpoint(Checkpoint({}, CHANGES[change](state)), tmp_path)
    assert refused(tmp_path, planner)


def test_a_search_of_other_stones_is_refused(stood, tmp_path):
    state, planner = stood
    write_checkpoint(Checkpoint({}, state), tmp_path)
    assert "other stones" in refused(tmp_path, planner, ids=[1, 2])


def test_a_forged_search_whose_walls_do_not_stand_has_a_code(stood):
    state, planner = stood
    chains = state.chains
    now = chains.links[0].now
    high = replace(now.groups[0], place=(20.0, 30.0))
    floating = replace(now, groups=(high, *now.groups[1:]))
    links = tuple(replace(link, now=floating) for link in chains.links)
    forged = replace(state, chains=replace(chains, links=links, turn=0))
    settings = planner.settings.updated({"search": {"budget": 60}})
    start = Planner(planner.workshop.stones, planner.workshop.site, settings=settings)
    with pytest.raises(PlanError, match="E207"):
        run_to_end(start, start=forged)
