"""What a stone changes near it: small programs whose answers are proved for the whole wall.

Most stones on a large wall leave its mechanism as it is: they rest on what does not move, or go
along with what does.  Then alpha is that of the wall, or that of the stone alone on supports that
do not yield, and what is left to find are forces that carry the stone to the ground at this alpha.
A strip of the wall below the stone does that while all other forces stay as they are.

Nothing here is sure to hold.  Forces and mechanism of the whole wall are put together, and it is
for the caller to certify them; what was not found, or not proved, is for another solver.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, hstack, vstack

from drystone.kernels.simplex import OPTIMAL, UNSTABLE, Added, Cones, Optimum
from drystone.statics.lp.cone_program import NONE_CLOSED, ConeProgram
from drystone.statics.lp.highs import TOLERANCE, WarmBasis, corrected, loaded, solved
from drystone.statics.lp.program import Floats

REACHES = (2.0, 4.0)
"""Half widths of strips beyond the centroids of what the stone touches, in units of length.

The second is taken where the first was not enough.  A third, of 8, helps a tenth of the stones that
both were not enough for; where it does not, HiGHS may be in trouble for a minute.
"""

NO_MORE = 1e-12
"""Alphas of a wall and of the wall with a stone that differ by no more count as the same."""

NO_WORK = 1e-11
"""Work of a stone on the mechanism of the wall that counts as none."""

# Dual simplex without perturbed costs takes half the time of the primal method where only feasible
# unknowns are sought, from a basis with gaps.  With costs the primal one takes a seventh.
_DUAL, _PRIMAL, _DANTZIG = 1, 4, 0
_HIGHS_OPTIONS: Mapping[str, Any] = {
    "solver": "simplex",
    "presolve": "off",
    "simplex_scale_strategy": 0,
    "simplex_dual_edge_weight_strategy": _DANTZIG,
    "dual_simplex_cost_perturbation_multiplier": 0.0,
}


class PrimalDual(NamedTuple):
    """Forces and mechanism of one end of the range of alpha."""

    sign: int  # 1 for the greatest alpha, -1 for the least
    alpha: float  # load multiplier; NaN when there is none
    forces: Floats  # (N,): one a column; empty when there is no alpha
    velocity: Floats  # (3 n,): the mechanism, with sign live . v = 1; a fall when there is no alpha


@dataclass(frozen=True, eq=False)
class Strip:
    """What of a wall is within some reach of a stone, with the stone: a program of its own."""

    places: NDArray[np.int32]  # of the bodies of the wall and of the stone; -1 outside
    inside: NDArray[np.intp]  # columns of the wall: those on bodies of the strip alone
    across: NDArray[np.intp]  # and those between a body of the strip and one outside
    acted_on: NDArray[np.int32]  # of each column across, the body of the strip
    acting: Floats  # (3, across): what it does there
    matrix: csc_array  # of the columns inside, then the new ones

    @classmethod
    def of(cls, program: ConeProgram, added: Added, reach: float) -> "Strip":
        """Take what lies so far beyond what the stone touches, in units of length."""
        wall, new = program.cones, added.cones
        places = _places_in_strip(program, added, reach)
        place = np.append(places, np.int32(-1))  # that of the ground, which is -1 as well
        first, second = place[wall.first], place[wall.second]
        within = (first >= 0) & ((second >= 0) | (wall.second < 0))
        across = ((first >= 0) | (second >= 0)) & ~within
        within[added.closed] = across[added.closed] = False
        inside, outwards = np.flatnonzero(within), np.flatnonzero(across)
        on_first = first[outwards] >= 0
        cones = Cones(
            np.concatenate((first[inside], place[new.first])),
            np.concatenate((second[inside], place[new.second])),
            np.concatenate((wall.entries[:, inside], new.entries), axis=1),
        )
        acting = wall.entries[:, outwards]
        return cls(
            places,
            inside,
            outwards,
            np.where(on_first, first[outwards], second[outwards]),
            np.where(on_first, acting[:3], acting[3:]),
            _matrix(cones, int(places.max()) + 1),
        )


@dataclass(frozen=True, eq=False)
class Near:
    """A wall and one more stone."""

    program: ConeProgram
    added: Added
    _strips: dict[float, Strip] = field(default_factory=dict)  # both ends ask for the same ones

    def strip(self, reach: float) -> Strip:
        """Return what lies so far beyond what the stone touches, in units of length."""
        if reach not in self._strips:
            self._strips[reach] = Strip.of(self.program, self.added, reach)
        return self._strips[reach]


def local_update(near: Near, end: PrimalDual, opposite: PrimalDual) -> PrimalDual | None:
    """Put together forces and a mechanism of a wall with one more stone.

    `end` is the one to be found, of the wall without the stone.  Where the mechanism of the wall,
    or of the stone alone, is not that of both, one is looked for in which all bodies near the stone
    move as they will.  None when there is none, or when no strip is enough.  A fall comes without
    forces: none hold the stone.
    """
    if not len(near.added.weights):
        return None
    for mechanism, reaches in ((_mechanism, REACHES[:1]), (_mechanism_near, REACHES[1:])):
        moved = mechanism(near, end)
        if moved is None:
            continue
        if np.isnan(moved.alpha) or end.sign * moved.alpha < -TOLERANCE:
            return moved._replace(forces=np.empty(0))
        forces = forces_at(near, end, opposite, moved.alpha, reaches)
        if forces is not None:
            return moved._replace(forces=forces)
    return None


def forces_at(
    near: Near,
    end: PrimalDual,
    opposite: PrimalDual,
    alpha: float,
    reaches: Iterable[float] = REACHES,
) -> Floats | None:
    """Return forces that carry a wall with one more stone at some alpha; None where none are found.

    Both ends are those of the wall without the stone.
    """
    carried = _carried(end, opposite, alpha)
    if carried is None or not len(near.added.weights):
        return None
    known = carried, end.forces > 0.0
    found = (_strip_forces(near, alpha, known, reach) for reach in reaches)
    return next((forces for forces in found if forces is not None), None)


def _carried(end: PrimalDual, opposite: PrimalDual, alpha: float) -> Floats | None:
    """Return forces that carry the wall at some alpha; None where they are not known.

    Any alpha between the two ends is carried by a mixture of their forces.
    """
    if alpha == end.alpha:
        return end.forces
    if not end.sign * opposite.alpha <= end.sign * alpha < end.sign * end.alpha:
        return None
    share = (alpha - opposite.alpha) / (end.alpha - opposite.alpha)
    return share * end.forces + (1.0 - share) * opposite.forces


def _mechanism(near: Near, end: PrimalDual) -> PrimalDual | None:
    """Return alpha and a mechanism: of the stone alone, or that of the wall, extended."""
    added = near.added
    alone, work = _on_supports(near.program, end, added)
    stone = Added(added.weights, alone, NONE_CLOSED)
    answer = Optimum.of_nothing(end.sign).solved_with(stone)
    governs = answer.status == OPTIMAL and end.sign * (end.alpha - answer.alpha) > 0.0
    if governs or answer.status == UNSTABLE:
        velocity = np.concatenate((np.zeros(len(end.velocity)), answer.velocity))
        return PrimalDual(end.sign, answer.alpha, answer.forces, velocity)
    if not work.any():  # nothing below it moves, and so it rests
        velocity = np.concatenate((end.velocity, np.zeros(3 * len(added.weights))))
        return PrimalDual(end.sign, end.alpha, np.empty(0), velocity)
    rhs = np.zeros(3 * len(added.weights))
    rhs[0::3] = -end.alpha * added.weights
    rhs[1::3] = added.weights
    found = least(work, _matrix(alone, len(added.weights)), rhs)
    if found is None or abs(float((work * found[0]).sum())) > NO_WORK:
        return None
    velocity = np.concatenate((end.velocity, -found[1]))
    return PrimalDual(end.sign, end.alpha, found[0], velocity)


def _mechanism_near(near: Near, end: PrimalDual) -> PrimalDual | None:
    """Return alpha and a mechanism in which bodies near the stone move as they will.

    All others move as in the mechanism of the wall, all slower or faster by one factor, or rest.
    Without any alpha it is a fall.  None where there is none, or alpha is greater than before by
    more than `NO_MORE`.
    """
    program, added = near.program, near.added
    wall, place = program.cones, near.strip(REACHES[1]).places
    built, count = len(program.weights), int(place.max()) + 1
    velocity = end.velocity.reshape(-1, 3)
    # All columns that act on a body that is near; what they do far off is work on the mechanism.
    open_ = np.ones(len(wall.first), bool)
    open_[added.closed] = False
    on = (place[wall.first] >= 0) | ((wall.second >= 0) & (place[wall.second] >= 0))
    chosen = open_ & on
    new = np.zeros(len(added.cones.first), bool)
    first = np.concatenate((wall.first[chosen], added.cones.first))
    second = np.concatenate((wall.second[chosen], added.cones.second))
    entries = np.concatenate((wall.entries[:, chosen], added.cones.entries), axis=1)
    work = np.zeros(len(first))
    places = []
    for bodies, part in ((first, entries[:3]), (second, entries[3:])):
        far = (bodies >= 0) & (place[bodies] < 0)
        work[far] += (part[:, far].T * velocity[bodies[far]]).sum(axis=1)
        places.append(np.where((bodies < 0) | far, -1, place[bodies]))
    cones = Cones(places[0].astype(np.int32), places[1].astype(np.int32), entries)
    weights = np.concatenate((program.weights, added.weights))[place >= 0]
    moves = velocity * program.weights[:, None] * (place[:built] < 0)[:, None]
    live = np.append(np.column_stack((weights, 0.0 * weights, 0.0 * weights)), moves[:, 0].sum())
    rhs = np.append(np.column_stack((0.0 * weights, weights, 0.0 * weights)), moves[:, 1].sum())
    rest = np.append(np.zeros(3 * count), 1.0)  # other columns work on the mechanism as well
    forces = vstack((_matrix(cones, count), work[None, :]))
    matrix = csc_array(hstack((live[:, None], -live[:, None], rest[:, None], forces)))
    costs = np.zeros(matrix.shape[1])
    costs[:2] = -end.sign, end.sign
    starts = [end.alpha > 0.0, end.alpha < 0.0, True], end.forces[chosen] > 0.0, new
    alpha, found = np.nan, least(costs, matrix, rhs, np.concatenate(starts))
    if found is not None:
        alpha = float(found[0][0] - found[0][1])
    else:
        held = csc_array(np.diag(rhs)[:, 1 : 3 * count : 3])
        matrix = csc_array(hstack((matrix, held)))
        found = least(np.append(0.0 * costs, np.ones(count)), matrix, rhs)
    if abs(alpha - end.alpha) <= NO_MORE:
        alpha = end.alpha
    if found is None or end.sign * (alpha - end.alpha) > 0.0:
        return None
    moved = np.zeros((built + len(added.weights), 3))
    moved[:built] = -found[1][-1] * velocity
    moved[place >= 0] = -found[1][:-1].reshape(-1, 3)
    return PrimalDual(end.sign, alpha, np.empty(0), moved.ravel())


def _on_supports(program: ConeProgram, end: PrimalDual, added: Added) -> tuple[Cones, Floats]:
    """Return the columns of a stone and its wedges on supports that do not yield.

    With them comes the work of each column on the velocities of the blocks of the wall.
    """
    built, cones = len(program.weights), added.cones
    # Where the first body is of the wall, the two change places.
    swapped = cones.first < built
    first = np.where(swapped, cones.second, cones.first) - built
    second = np.where(swapped, cones.first, cones.second)
    entries = np.where(swapped, np.roll(cones.entries, 3, axis=0), cones.entries)
    on_wall = (second >= 0) & (second < built)
    velocity = end.velocity.reshape(-1, 3).T[:, np.where(on_wall, second, 0)]
    work = np.where(on_wall, (entries[3:] * velocity).sum(axis=0), 0.0)
    second = np.where(second < built, -1, second - built)
    entries[3:, second < 0] = 0.0
    new = first >= 0
    alone = Cones(
        first[new].astype(np.int32),
        second[new].astype(np.int32),
        np.ascontiguousarray(entries[:, new]),
    )
    return alone, work[new]


def _strip_forces(
    near: Near, alpha: float, known: tuple[Floats, NDArray[np.bool_]], reach: float
) -> Floats | None:
    """Find forces that carry a stone down through the strip of the wall below it, or None.

    Known are forces (N,) that carry the wall without the stone at this alpha, and which columns
    (N,) to start with.  Returned are the forces of the wall's columns that are left, then of the
    new ones.
    """
    carried, basic = known
    program, added, strip = near.program, near.added, near.strip(reach)
    weights = np.concatenate((program.weights, added.weights))[strip.places >= 0]
    rhs = np.column_stack((-alpha * weights, weights, np.zeros(len(weights))))
    for row, acting in enumerate(strip.acting * carried[strip.across]):
        rhs[:, row] -= np.bincount(strip.acted_on, acting, len(weights))
    starts = np.concatenate((basic[strip.inside], np.zeros(len(added.cones.first), bool)))
    found = least(np.zeros(len(starts)), strip.matrix, rhs.ravel(), starts)
    if found is None:
        return None
    count = len(strip.inside)
    forces = carried.copy()
    forces[strip.inside] = found[0][:count]
    return np.concatenate((np.delete(forces, added.closed), found[0][count:]))


def _places_in_strip(program: ConeProgram, added: Added, reach: float) -> NDArray[np.int32]:
    """Return the place of each body of the wall and the stone in the strip; -1 outside.

    The strip reaches so far beyond what the stone touches, in units of length.
    """
    built, x = len(program.weights), program.centroid_x
    touched = np.concatenate((added.cones.first, added.cones.second))
    under = x[touched[(touched >= 0) & (touched < built)]]
    inside = np.ones(built + len(added.weights), bool)
    inside[:built] = False
    if len(under):
        reach = reach * program.units.length
        inside[:built] = (x >= under.min() - reach) & (x <= under.max() + reach)
    return np.where(inside, np.cumsum(inside) - 1, -1).astype(np.int32)


def _matrix(cones: Cones, bodies: int) -> csc_array:
    """Return the same as a sparse matrix, without what acts on the ground."""
    places = np.repeat((cones.first, cones.second), 3, axis=0).T
    rows = 3 * places + np.tile(np.arange(3), 2)
    moves = places >= 0
    start = np.concatenate(([0], np.cumsum(moves.sum(axis=1)))).astype(np.int32)
    parts = cones.entries.T[moves], rows[moves].astype(np.int32), start
    return csc_array(parts, shape=(3 * bodies, len(cones.first)))


def least(
    costs: Floats, matrix: csc_array, rhs: Floats, basic: NDArray[np.bool_] | None = None
) -> tuple[Floats, Floats] | None:
    """Minimise c . x with A x = b, x >= 0; return x and y with c - y . A >= 0.

    None when there is no optimum, whatever the reason.  `basic` unknowns are so at the start, at
    most as many as there are rows; they need not be independent.  HiGHS fills the gaps.
    """
    # What it gives up on is asked of the whole.  Feasible unknowns take 0.2 pivots a row, at most
    # 0.7.  Where there are none HiGHS may factor the basis again with every pivot, for seconds.
    strategy, pivots = (_PRIMAL, 10_000) if costs.any() else (_DUAL, 20 + len(rhs))
    limited = {"simplex_strategy": strategy, "simplex_iteration_limit": pivots}
    highs = loaded({**_HIGHS_OPTIONS, **limited}, matrix, (rhs, rhs), np.zeros(len(costs)), costs)
    if basic is not None:
        WarmBasis(columns=()).carrying(basic, len(rhs)).given_to(highs)
    unknowns = solved(highs)
    if unknowns is None:
        return None
    duals = np.array(highs.getSolution().row_dual)
    return corrected(highs, (costs, matrix, rhs), unknowns, duals)
