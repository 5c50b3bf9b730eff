# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.simplex_solve`, and what Python sees of it."""

from libc.math cimport fabs, frexp, ldexp
from libc.stdint cimport int32_t
from libc.stdlib cimport free, malloc
from libc.string cimport memset

import numpy as np

from drystone.kernels.compiled.simplex_choice cimport (
    LARGE_PIVOT, PLACE_SEED, SMALL_PIVOT, blocking, entering, leaving, scattered,
)
from drystone.kernels.compiled.simplex_growth cimport (
    write_forces, write_inverse, write_rest, write_velocity,
)
from drystone.kernels.compiled.simplex_inverse cimport row_of
from drystone.kernels.compiled.simplex_start cimport start
from drystone.kernels.compiled.simplex_state cimport (
    FAILED, GOING_ON, LOST, OPTIMAL, UNSTABLE, State, admissible, column_of, dual_step, exchange,
    falls, lay_out, renewed_inverse, set_steps, slopes_of, take_levels, take_rates, within_bounds,
)

cdef int ROUNDS = 6
cdef double DRIFT = 1e-8


cdef int solve(State *state, int max_pivots) noexcept nogil:
    """Run to the end and return the status."""
    cdef int turn, status = start(state)
    for turn in range(ROUNDS):
        if status != GOING_ON:
            break
        status = solve_round(state, max_pivots)
        if status == LOST:
            if renewed_inverse(state) and take_levels(state) and take_rates(state):
                status = GOING_ON
            else:
                status = FAILED
    return FAILED if status == GOING_ON else status


cdef int solve_round(State *state, int max_pivots) noexcept nogil:
    """Bring the levels within bounds, then make the mechanism admissible, then look at both."""
    cdef int status = let_down(state, max_pivots)
    if status != GOING_ON:
        return status
    if not (take_levels(state) and take_rates(state)):
        return LOST
    state.pivot = SMALL_PIVOT
    if not within_bounds(state):
        return GOING_ON
    if admissible(state):
        return OPTIMAL
    return make_admissible(state, max_pivots)


cdef void refer(State *state) noexcept nogil:
    """Let the next steps begin here."""
    cdef Py_ssize_t i
    for i in range(state.size):
        state.reference[i] = state.levels[i]


cdef int let_down(State *state, int max_pivots) noexcept nogil:
    """Give the stone its weight little by little: the dual simplex method."""
    cdef Py_ssize_t j, place, number
    cdef double flip, slope
    set_steps(state)
    for j in range(state.columns):
        state.rates[j] = max(state.rates[j], 0.0)
    while True:
        place = leaving(
            state.levels, state.steps, state.fixed, state.size, state.alpha_place
        )
        if place < 0:
            refer(state)
            return GOING_ON
        if state.pivots >= max_pivots:
            return FAILED
        row_of(&state.inverse, place, state.row)
        slopes_of(state, state.row)
        flip = 1.0 if state.levels[place] > 0.0 else -1.0
        number = entering(
            state.slopes, flip, state.rates, state.ties, state.columns, LARGE_PIVOT, state.listed
        )
        if number < 0:
            for j in range(state.size):
                state.fall[j] = -flip * state.row[j]
            if falls(state):
                return UNSTABLE
            number = entering(
                state.slopes, flip, state.rates, state.ties, state.columns, SMALL_PIVOT,
                state.listed,
            )
        if number < 0:
            return LOST
        column_of(state, number, state.column)
        slope = state.slopes[number]
        if not fabs(state.column[place] - slope) <= DRIFT * (1.0 + fabs(slope)):
            return LOST
        dual_step(state, place, state.slopes, number, state.column)


cdef int make_admissible(State *state, int max_pivots) noexcept nogil:
    """Exchange columns that the mechanism closes: the primal simplex method."""
    cdef Py_ssize_t i, place, number
    cdef double step
    cdef double *ties = state.second
    scattered(PLACE_SEED, state.size, ties)
    for i in range(state.size):
        ties[i] = 0.5 + ties[i]
    while not admissible(state):
        if state.pivots >= max_pivots:
            return FAILED
        number = 0
        for i in range(1, state.columns):
            if state.rates[i] < state.rates[number]:
                number = i
        column_of(state, number, state.column)
        place = blocking(
            state.column, state.levels, ties, state.fixed, state.size, state.alpha_place,
            state.pivot, state.listed,
        )
        if place < 0:
            return FAILED
        step = max(ties[place], 0.0) / state.column[place]
        for i in range(state.size):
            ties[i] -= step * state.column[i]
        ties[place] = step
        exchange(state, place, state.column, number)
        if not take_rates(state):
            return LOST
    refer(state)
    return GOING_ON


cdef class Scratch:
    """A block of memory."""

    cdef char *memory
    cdef Py_ssize_t size

    def __cinit__(self, Py_ssize_t size):
        self.memory = <char *>malloc(size)
        self.size = size
        if self.memory == NULL:
            raise MemoryError

    def __dealloc__(self):
        free(self.memory)


cdef class Wall:
    """A tilt for the compiled kernel.

    Parameters
    ----------
    tilt : Tilt
        Its arrays are read, and kept.
    """

    cdef State blank
    cdef double unit
    cdef int sign
    cdef Py_ssize_t bodies
    cdef const double[::1] weights
    cdef tuple kept
    cdef list spare

    def __init__(self, tilt):
        cdef const double[::1] levels = tilt.basis.levels, rates = tilt.basis.rates
        cdef const double[::1] ties = tilt.basis.ties
        cdef const double[:, ::1] rows = tilt.basis.rows, cols = tilt.basis.cols
        cdef const double[:, ::1] entries = tilt.cones.entries
        cdef const int32_t[::1] heads = tilt.basis.heads
        cdef const int32_t[::1] first = 3 * tilt.cones.first + 3
        cdef const int32_t[::1] second = 3 * tilt.cones.second + 3
        self.kept = (tilt.basis, tilt.cones, first.base, second.base)
        self.weights = tilt.weights
        self.unit = tilt.basis.unit
        self.sign = tilt.sign
        self.bodies = self.weights.shape[0]
        self.spare = []
        memset(&self.blank, 0, sizeof(State))
        self.blank.wall.size = heads.shape[0]
        self.blank.wall.alpha_place = tilt.basis.alpha_place
        self.blank.old.count = first.shape[0]
        if self.bodies:
            self.blank.wall.heads = &heads[0]
            self.blank.wall.levels = &levels[0]
            self.blank.wall.rows = &rows[0, 0]
            self.blank.wall.cols = &cols[0, 0]
        if first.shape[0]:
            self.blank.old.first = &first[0]
            self.blank.old.second = &second[0]
            self.blank.old.entries = &entries[0, 0]
            self.blank.wall.rates = &rates[0]
            self.blank.wall.ties = &ties[0]

    def solve_added(self, added, int max_pivots):
        """Return status, alpha, forces, velocity, pivots and restarts; see `Answer`."""
        cdef State state
        cdef double unit = self.unit_with(added.weights)
        cdef Scratch scratch = self.opened(&state, added, unit)
        cdef int status
        with nogil:
            status = solve(&state, max_pivots)
            free(state.anew)
        alpha, forces, velocity = np.nan, np.empty(0), np.empty(0)
        if status == OPTIMAL:
            alpha = self.sign * state.levels[state.alpha_place]
            forces = np.empty(state.columns - state.closed_count)
            write_forces(&state, unit, forces)
        if status == OPTIMAL or status == UNSTABLE:
            velocity = np.empty(state.size)
            write_velocity(&state, unit, status == UNSTABLE, velocity)
        self.spare.append(scratch)
        return status, alpha, forces, velocity, state.pivots, state.restarts

    def grown(self, added, int max_pivots):
        """Return the arguments of the `Basis` of the wall with the stone."""
        cdef State state
        cdef double unit = self.unit_with(added.weights)
        cdef Scratch scratch = self.opened(&state, added, unit)
        cdef Py_ssize_t left = state.columns - state.closed_count
        heads, levels = np.empty(state.size, np.int32), np.empty(state.size)
        rows, cols = np.empty((state.size, state.size)), np.empty((state.size, state.size))
        rates, ties = np.empty(left), np.empty(left)
        cdef int32_t[::1] heads_out = heads
        cdef double[::1] levels_out = levels, rates_out = rates, ties_out = ties
        cdef double[:, ::1] rows_out = rows, cols_out = cols
        with nogil:
            solve(&state, max_pivots)
            write_inverse(&state, rows_out, cols_out)
            write_rest(&state, rows_out, cols_out, heads_out, levels_out, rates_out, ties_out)
            free(state.anew)
        self.spare.append(scratch)
        return unit, state.alpha_place, heads, levels, rows, cols, rates, ties

    cdef double unit_with(self, const double[::1] weights):
        """Return the unit of forces: about the weight of the first stone."""
        cdef int exponent = 0
        if self.bodies or weights.shape[0] == 0:
            return self.unit
        frexp(weights[0], &exponent)
        return ldexp(1.0, exponent)

    cdef Scratch opened(self, State *state, added, double unit):
        """Take memory and write the program into it; the caller gives the memory back."""
        cdef const double[::1] weights = added.weights
        cdef const int32_t[::1] first = added.cones.first, second = added.cones.second
        cdef const double[:, ::1] entries = added.cones.entries
        cdef const int32_t[::1] closed = added.closed
        cdef Py_ssize_t i, size = self.bodies + weights.shape[0], count = first.shape[0]
        cdef Scratch scratch
        if second.shape[0] != count or entries.shape[0] != 6 or entries.shape[1] != count:
            raise ValueError("the arrays of the columns have different lengths")
        state[0] = self.blank
        state.pivot = LARGE_PIVOT
        state.new.count = count
        state.columns = state.old.count + count
        state.size = 3 * size
        try:
            scratch = self.spare.pop()
        except IndexError:
            scratch = None
        if scratch is None or scratch.size < lay_out(state, NULL):
            # With some room for columns, as not all stones touch equally many.
            state.new.count += 32
            state.columns += 32
            scratch = Scratch(lay_out(state, NULL))
            state.new.count -= 32
            state.columns -= 32
        lay_out(state, scratch.memory)
        state.new.first = state.new_first
        state.new.second = state.new_second
        state.new.entries = &entries[0, 0] if count else NULL
        state.closed = &closed[0] if closed.shape[0] else NULL
        state.closed_count = closed.shape[0]
        memset(state.open, 1, state.columns)
        for i in range(closed.shape[0]):
            if not 0 <= closed[i] < state.old.count:
                raise ValueError(f"there is no column {closed[i]} to close")
            if i and closed[i] <= closed[i - 1]:
                raise ValueError("the columns to close are not in ascending order")
            state.open[closed[i]] = False
        for i in range(count):
            if not (0 <= first[i] < size and -1 <= second[i] < size):
                raise ValueError(f"column {i} is between bodies that are not there")
            state.new_first[i] = 3 * first[i] + 3
            state.new_second[i] = 3 * second[i] + 3
        memset(state.rhs, 0, state.size * sizeof(double))
        memset(state.live, 0, state.size * sizeof(double))
        for i in range(size):
            state.rhs[3 * i + 1] = (
                self.weights[i] if i < self.bodies else weights[i - self.bodies]
            ) / unit
            state.live[3 * i] = self.sign * state.rhs[3 * i + 1]
        return scratch
