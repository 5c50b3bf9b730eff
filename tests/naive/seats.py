"""Trials of seats, each wall built anew from the ground."""

import numpy as np

from drystone.model.builder import as_planned
from drystone.settle.as_built import BuiltWall
from drystone.settle.putting import astray


def falls(steps, errors, trial, mu, settle):
    """Say of each step whether something falls, in one wall that is built with errors.

    Steps are blocks, ids and corners as planned, of a stone and its wedges.
    """
    wall, fallen = BuiltWall(mu, settle), []
    for (stone, corners), *wedges in steps:
        rng = np.random.default_rng([7, trial, stone])
        put = [(stone, errors.built(corners, rng))]
        put += [(i, errors.times(1 / 3).built(cut, rng)) for i, cut in wedges]
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
