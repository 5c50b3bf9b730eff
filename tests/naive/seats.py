"""Trials of seats, each wall built anew from the ground."""

import numpy as np

from drystone.model.builder import as_planned, stratified
from drystone.settle.putting import astray, bare_wall


def falls(steps, errors, trial, mu, settle):
    """Say of each step whether something falls, in one of `settle.trials` walls with errors.

    Steps are blocks, ids and corners as planned, of a stone and its wedges.
    """
    wall, fallen = bare_wall(mu, settle), []
    for (stone, corners), *wedges in steps:
        drawn = stratified(np.random.default_rng([7, stone]), settle.trials, 1 + len(wedges))[trial]
        put = [(stone, *errors.all_built(corners, drawn[:1]))]
        for k, (i, cut) in enumerate(wedges, 1):
            put.append((i, *errors.times(1 / 3).all_built(cut, drawn[k : k + 1])))
        planned = {i: as_planned(cut) for i, cut in [(stone, corners), *wedges]}
        before = wall.put([*put[1:][::-1], put[0]])
        lost = {}
        if stone in before.laid and not astray(before.laid[stone], planned[stone]):
            after = before.loaded(stone)
            now = after.laid
            lost = {i: b for i, b in before.laid.items() if i not in now or astray(now[i], b)}
            wall = before.held(lost) if lost else after
        else:
            lost = planned
            wall = wall.held(planned)
        fallen.append(bool(lost))
    return fallen
