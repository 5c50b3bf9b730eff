"""Walls that grow stone by stone, for tests of the growing analysis."""

from drystone.statics.appending import Units
from drystone.statics.contacts.blocks import model_from_labels
from drystone.statics.growing import growing
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.solvers.warm import WarmSession

PX = Units(15.0, 225.0)


def empty(mu=0.58):
    return RigidBlockModel((), (), mu)


def with_block(built, *blocks, whole):
    """The model with more blocks of a whole wall: a stone, or a stone and its wedge."""
    new = {block.id for block in blocks}
    there = {GROUND, *new, *(b.id for b in built.blocks)}
    touching = [i for i in whole.interfaces if new & {i.block, i.other}]
    return built.with_added(blocks, tuple(i for i in touching if {i.block, i.other} <= there))


def upwards(labels):
    whole = model_from_labels(labels).model
    return whole, sorted(whole.blocks, key=lambda block: block.centroid[1])


def wall_and_candidates(labels, count):
    """The analysis of the lowest blocks, and models with each of the others that stand on them."""
    whole, blocks = upwards(labels)
    analysis = growing(empty(), PX)
    for block in blocks[:count]:
        analysis = analysis.extended(with_block(analysis.model, block, whole=whole))
    return analysis, [with_block(analysis.model, block, whole=whole) for block in blocks[count:]]


class Pivots:
    """Counts the calls of all sessions, and the pivots of their last runs."""

    def __init__(self, monkeypatch):
        self.count = self.calls = 0
        minimise = WarmSession.minimise

        def counted(session, costs):
            solution = minimise(session, costs)
            self.calls += 1
            self.count += session.highs.getInfo().simplex_iteration_count
            return solution

        monkeypatch.setattr(WarmSession, "minimise", counted)

    def of(self, work):
        before = self.count
        work()
        return self.count - before
