"""Trials of seats, each wall built anew from the ground."""

import numpy as np

from drystone.model.builder import NUMBERS, as_planned, stratified
from drystone.settle.as_built import BuiltWall
from drystone.settle.putting import astray


def falls(steps, errors, trial, mu, settle):
    """Say of each step whether something falls, in one of `settle.trials` walls with errors.

    Steps are blocks, ids and corners as planned, of a stone and its wedges.
    """
    wall, fallen = BuiltWall(mu, settle), []
    for (stone, corners), *wedges in steps:
        rng, count = np.random.default_rng([7, stone]), 1 + len(wedges)
        drawn = stratified(rng, settle.trials, count * NUMBERS)[trial].reshape(count, 1, NUMBERS)
        put = [(stone, *errors.all_built(corners, drawn[0]))]
        for (i, cut), numbers in zip(wedges, drawn[1:], strict=True):
            put.append((i, *errors.times(1 / 3).all_built(cut, numbers)))
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
