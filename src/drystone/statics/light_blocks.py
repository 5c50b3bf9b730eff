"""Blocks far lighter than the others: their equations in units of their own.

Solvers and certificates allow errors of 1e-9 to 1e-8 of the mean weight.  The moment that brings
down a stone of a millionth of it is no larger, so its equations are then divided by its own weight
and size.
"""

from dataclasses import replace

import numpy as np

from drystone.statics.asking import Answer, Solver, extremes
from drystone.statics.model import RigidBlockModel
from drystone.statics.program import EquilibriumProgram, Floats
from drystone.statics.result import LimitStatus

LIGHT = 1e-3
"""A block below this share of the mean weight has units of its own; others are as they were."""

WEIGHTLESS = 1e-8
"""A block below this share is meant to weigh nothing, and so has none."""


def extremes_of(
    model: RigidBlockModel, program: EquilibriumProgram, solver: Solver, *, mechanism: bool
) -> tuple[Answer, Answer]:
    """Find the least and the greatest alpha (:func:`drystone.statics.asking.extremes`).

    Parameters
    ----------
    model : RigidBlockModel
        Blocks and interfaces.
    program : EquilibriumProgram
        Of the model.
    solver, mechanism
        As for :func:`drystone.statics.limit.lateral_resistance`.

    Returns
    -------
    least, greatest : Answer
        Velocities in the units of the program; certificates in those of each block.
    """
    units = own_units(model, program)
    if units is None:
        return extremes(program, solver, mechanism=mechanism)
    value = program.value / units[program.index]
    scaled = replace(program, value=value, rhs=program.rhs / units)
    least, greatest = extremes(scaled, solver, mechanism=mechanism)
    if LimitStatus.FAILED in (least.status, greatest.status):
        # Slivers under heavy blocks are badly scaled so; an answer needs its certificate anyway.
        return extremes(program, solver, mechanism=mechanism)
    return _in_program(least, units), _in_program(greatest, units)


def own_units(model: RigidBlockModel, program: EquilibriumProgram) -> Floats | None:
    """Return the unit of every row, in those of the program; None where all of them are 1.

    Examples
    --------
    >>> from drystone.statics.contacts.given import model_from_json
    >>> from drystone.statics.program import assemble
    >>> model = model_from_json({"blocks_xywh": [[0, 0, 100, 100], [40, 100, 1, 1]]})
    >>> own_units(model, assemble(model)).round(7).tolist()
    [1.0, 1.0, 1.0, 0.0002, 0.0002, 2.8e-06]
    """
    free = [block for block in model.blocks if not block.fixed]
    weights = np.array([block.weight for block in free]) / program.weight
    light = (weights >= WEIGHTLESS) & (weights < LIGHT)
    if not light.any():
        return None
    sizes = np.sqrt([block.area for block in free]) / program.length
    own = np.column_stack((weights, weights, weights * sizes))
    own[~light] = 1.0
    units = np.ones(len(program.rhs))
    moves = program.rows >= 0
    units[program.rows[moves]] = own[moves]
    return units


def _in_program(answer: Answer, units: Floats) -> Answer:
    """Return an answer whose duals, the velocities, belong to the rows as they were."""
    duals = answer.solution.duals
    if duals is None:
        return answer
    return Answer(replace(answer.solution, duals=duals / units), answer.certificate)
