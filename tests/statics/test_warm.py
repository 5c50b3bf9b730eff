from functools import partial

from drystone.statics.contacts.blocks import model_from_labels
from drystone.statics.growing_highs import begun
from drystone.statics.program import assemble
from drystone.statics.solvers.warm import PIVOTS_FOR_A_RAY, WarmSession, read_basis
from tests.statics.growth import PX, Pivots, empty, upwards, wall_and_candidates, with_block
from tests.statics.walls import coursed, irregular, stacked


def test_the_bases_of_the_wall_save_most_of_the_work(monkeypatch):
    analysis, candidates = wall_and_candidates(coursed(1, 6, 130), 30, begun)
    pivots = Pivots(monkeypatch)
    assert pivots.of(lambda: analysis.resistance_with(analysis.model.with_added((), ()))) == 0
    assert pivots.calls == 2
    warm = pivots.of(lambda: [analysis.resistance_with(model) for model in candidates])
    start = begun(empty(), PX)
    cold = pivots.of(lambda: [start.resistance_with(model) for model in candidates])
    assert 0 < warm < cold / 3


def test_the_bases_are_of_use_when_contacts_go(monkeypatch):
    whole, blocks = upwards(coursed(6, 4, 80))
    analysis = begun(empty(), PX)
    for block in blocks:
        analysis = analysis.extended(with_block(analysis.model, block, whole=whole))
    models = [analysis.model.with_added((), (), (k,)) for k in (3, 9)]
    pivots = Pivots(monkeypatch)
    warm = pivots.of(lambda: [analysis.resistance_with(model) for model in models])
    start = begun(empty(), PX)
    cold = pivots.of(lambda: [start.resistance_with(model) for model in models])
    assert 0 < warm < cold / 3


def test_how_a_stone_falls_is_found_without_a_pivot(monkeypatch):
    """The last call has the ray; without its costs set to 0 it takes a hundred pivots."""
    whole, blocks = upwards(irregular(1, 30, 110, 80))
    analysis = begun(empty(), PX)
    pivots = Pivots(monkeypatch)
    falling = 0
    for block in blocks:
        model = with_block(analysis.model, block, whole=whole)
        calls = pivots.calls
        if analysis.resistance_with(model).resistance.stable:
            analysis = analysis.extended(model)
        else:
            falling += 1
            assert pivots.of(partial(analysis.resistance_with, model)) == 0
            assert pivots.calls == calls + 2  # one tilt each time: neither has an end
    assert falling == 3


def test_there_is_no_basis_before_a_call():
    session = WarmSession(assemble(model_from_labels(stacked((20, 20, 0))).model))
    assert read_basis(session.basis()) is None


def test_the_search_for_how_a_stone_falls_is_limited(monkeypatch):
    """HiGHS once factored its basis with every pivot and went on for minutes."""
    whole, blocks = upwards(irregular(1, 30, 110, 80))
    analysis = begun(empty(), PX)
    limits, sessions = [], []
    find_ray = WarmSession._find_ray

    def watched(session):
        before = session.highs.run
        monkeypatch.setattr(session.highs, "run", lambda: (limits.append(limit(session)), before()))
        found = find_ray(session)
        sessions.append(session)
        return found

    def limit(session):
        return session.highs.getOptionValue("simplex_iteration_limit")[1]

    monkeypatch.setattr(WarmSession, "_find_ray", watched)
    for block in blocks:
        model = with_block(analysis.model, block, whole=whole)
        if analysis.resistance_with(model).resistance.stable:
            analysis = analysis.extended(model)
    assert limits == [PIVOTS_FOR_A_RAY] * len(sessions) != []
    assert [limit(session) for session in sessions] == [session.limit for session in sessions]
