"""HiGHS started from the basis of a smaller program: primal simplex."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import highspy
import numpy as np
from numpy.typing import NDArray

from drystone.statics.program import EquilibriumProgram
from drystone.statics.solvers.highs import HighsSession
from drystone.statics.solvers.silent import set_options

NAME = "HiGHS warm simplex"

PIVOTS_FOR_A_RAY = 100
"""Hardly any need one."""

Statuses = tuple[highspy.HighsBasisStatus, ...]

_BASIC = highspy.HighsBasisStatus.kBasic
_AT_ZERO = highspy.HighsBasisStatus.kLower
_FREE = highspy.HighsBasisStatus.kZero
# A new block is out of balance, so neither method can start at once; the primal one then needs
# a fifth of the pivots at 60 blocks.
_PRIMAL: Mapping[str, Any] = {"simplex_strategy": 4}
_DUAL: Mapping[str, Any] = {"simplex_strategy": 1}


@dataclass(frozen=True)
class Basis:
    """Which unknowns and equations are basic; it does not depend on the units of a program.

    Parameters
    ----------
    columns, rows : tuple of HighsBasisStatus
        Of the unknowns and of the equations.
    whole : bool
        False when unknowns that were basic are gone.
    """

    columns: Statuses = (_FREE,)
    rows: Statuses = ()
    whole: bool = True

    def appended(self, columns: int, rows: int) -> "Basis":
        """Return the basis for so many unknowns, the new ones at 0, and so many equations.

        The slack of a new equation is basic, so the basis stays regular.
        """
        more_columns = (_AT_ZERO,) * (columns - len(self.columns))
        more_rows = (_BASIC,) * (rows - len(self.rows))
        return Basis(self.columns + more_columns, self.rows + more_rows, self.whole)

    def with_columns(self, stay: NDArray[np.bool_]) -> "Basis":
        """Return the basis with some of the unknowns only."""
        both = list(zip(self.columns, stay.tolist(), strict=True))
        columns = tuple(status for status, stays in both if stays)
        return Basis(columns, self.rows, all(stays or status != _BASIC for status, stays in both))


class WarmSession(HighsSession):
    """One program in HiGHS, solved from given bases.

    Parameters
    ----------
    program : EquilibriumProgram
        The equations.
    """

    def __init__(self, program: EquilibriumProgram) -> None:
        super().__init__(program)
        self.name = NAME

    def start_from(self, basis: Basis) -> None:
        """Start the next call from a basis, and from nothing else; HiGHS fills its gaps."""
        given = highspy.HighsBasis()
        given.col_status = list(basis.columns)
        given.row_status = list(basis.rows)
        given.valid = True
        given.alien = not basis.whole
        set_options(self.highs, _PRIMAL)
        taken = self.highs.setBasis(given)
        assert taken == highspy.HighsStatus.kOk  # noqa: S101 - it would go on from its last basis

    def basis(self) -> highspy.HighsBasis:
        """Return the basis that the last call ended with, as HiGHS has it; see `read_basis`."""
        return self.highs.getBasis()

    def _find_ray(self) -> str:
        """Find the ray that the primal simplex method leaves out.

        Without costs its last basis is dual feasible, and the dual simplex method has the ray
        without a pivot.  With them it may need seconds, and so may numerical trouble, in which
        HiGHS factors the basis again with every pivot: other solvers are quicker then.
        """
        columns = np.arange(len(self._costs), dtype=np.int32)
        self._costs = np.zeros(len(columns))
        self.highs.changeColsCost(len(columns), columns, self._costs)
        set_options(self.highs, {**_DUAL, "simplex_iteration_limit": PIVOTS_FOR_A_RAY})
        self.highs.run()
        set_options(self.highs, {"simplex_iteration_limit": self.limit})
        return self.name


def read_basis(found: highspy.HighsBasis) -> Basis | None:
    """Copy a basis out of HiGHS; None when it has none."""
    return Basis(tuple(found.col_status), tuple(found.row_status)) if found.valid else None
