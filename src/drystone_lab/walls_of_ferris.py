"""Walls of Ferris and Tin-Loi (2001), by the blocks of their courses.

M. C. Ferris and F. Tin-Loi, Limit analysis of frictional block assemblies as a mathematical
program with complementarity constraints, International Journal of Mechanical Sciences 43 (2001)
209-224.  Full blocks 4 x 1.75, half blocks 2 x 1.75, weight proportional to area, mu .65, bottom
course on the ground, every touching bed and head joint a contact.

The associative load factors were computed independently from the matrices of GAMS MPECLib (with
two misprints of example 3 corrected, which makes it symmetric) and by a program on the
rectangles.  They are given to five digits.  The non-associative ones depend on the method, which
finds one of many; the ranges hold what several methods found and what is said to be published.
"""

from dataclasses import dataclass

from drystone.contacts.given import model_from_json
from drystone.statics.model import RigidBlockModel

HEIGHT, MU = 1.75, 0.65

Course = tuple[tuple[int, int], ...]
"""Where blocks begin and end."""

A: Course = ((0, 2), (2, 6), (6, 10), (10, 14), (14, 18), (18, 20))
B: Course = ((0, 4), (4, 8), (8, 12), (12, 16), (16, 20))
P: Course = ((0, 4), (4, 8), (8, 12), (12, 16))
Q: Course = ((0, 2), (2, 6), (6, 10), (10, 14), (14, 16))
Q_OPEN: Course = ((0, 2), (2, 6), (10, 14), (14, 16))
P_OPEN: Course = ((0, 4), (4, 6), (10, 12), (12, 16))
A_OPEN: Course = ((0, 4), (8, 12), (16, 20))
B_OPEN: Course = ((0, 2), (2, 4), (8, 10), (10, 12), (16, 18), (18, 20))
C: Course = ((0, 2), (2, 6), (6, 10), (10, 12))
D: Course = ((0, 4), (4, 8), (8, 12))
C_OPEN: Course = ((0, 4), (8, 12))
D_OPEN: Course = ((0, 2), (2, 4), (8, 10), (10, 12))
E: Course = ((0, 2), (2, 6), (6, 10), (10, 14), (14, 18), (18, 22), (22, 26), (26, 28))
F: Course = ((0, 4), (4, 8), (8, 12), (12, 16), (16, 20), (20, 24), (24, 28))
E_OPEN: Course = ((0, 2), (2, 6), (10, 14), (14, 18), (22, 26), (26, 28))
F_OPEN: Course = ((0, 4), (4, 6), (10, 12), (12, 16), (16, 18), (22, 24), (24, 28))


@dataclass(frozen=True)
class FerrisWall:
    """One of the examples.

    Parameters
    ----------
    number : int
        1 to 6, as published.
    courses : tuple of courses
        Bottom first.
    blocks, contacts : int
        How many there are.
    associative : float
        Load factor, the same in both directions.
    nonassociative : (float, float)
        Range of accepted load factors without dilatancy; never above the associative one.
    may_not_converge : bool
        An answer without a factor is accepted too.
    """

    number: int
    courses: tuple[Course, ...]
    blocks: int
    contacts: int
    associative: float
    nonassociative: tuple[float, float]
    may_not_converge: bool = False

    @property
    def rectangles(self) -> tuple[tuple[float, float, float, float], ...]:
        """Blocks as x, y, width, height, course by course and from left to right."""
        return tuple(
            (float(left), HEIGHT * course, float(right - left), HEIGHT)
            for course, ranges in enumerate(self.courses)
            for left, right in ranges
        )

    @property
    def model(self) -> RigidBlockModel:
        """The wall as a model.

        Examples
        --------
        >>> model = WALLS[0].model
        >>> len(model.blocks), len(model.interfaces)
        (33, 83)
        """
        return model_from_json({"blocks_xywh": self.rectangles, "mu": MU})


_DOORS_3 = (Q_OPEN, P_OPEN)
_DOORS_4 = (A_OPEN, B_OPEN)
_DOORS_5 = (C_OPEN, D_OPEN)
_DOORS_6 = (E_OPEN, F_OPEN)

WALLS = (
    FerrisWall(1, (A, B) * 3, 33, 83, 0.64286, (0.638, 0.650)),
    FerrisWall(2, (A, B) * 5, 55, 141, 0.58000, (0.550, 0.564)),
    FerrisWall(3, (P, Q, P, *_DOORS_3 * 2, Q_OPEN, P, Q, P), 46, 102, 0.40369, (0.350, 0.361)),
    FerrisWall(4, (A, B, A, *_DOORS_4 * 2, A_OPEN, A, B, A), 55, 116, 0.33195, (0.262, 0.267)),
    FerrisWall(
        5,
        (*(C, D, C, *_DOORS_5 * 2, C_OPEN) * 2, C, D, C),
        61,
        120,
        0.23964,
        (0.205, 0.217),
    ),
    FerrisWall(
        6,
        (E, F, E, F, *_DOORS_6 * 2, E_OPEN, F, E, F, *_DOORS_6 * 2, E_OPEN, F, E, F, E),
        146,
        345,
        0.34782,
        (0.0, 0.34783),
        may_not_converge=True,
    ),
)
