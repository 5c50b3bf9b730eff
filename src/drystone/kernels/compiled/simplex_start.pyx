# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.simplex_start`."""

from libc.math cimport fabs
from libc.string cimport memcpy, memset

from drystone.kernels.compiled.simplex_choice cimport LARGE_PIVOT, entering
from drystone.kernels.compiled.simplex_inverse cimport apply, row_of, times
from drystone.kernels.compiled.simplex_small cimport FOUND, NO_FORCES, solve_small
from drystone.kernels.compiled.simplex_state cimport (
    ALPHA, ARTIFICIAL, FAILED, GOING_ON, UNSTABLE, State, column_of, dual_step, exchange, falls,
    opening, reopen, slopes_of,
)

cdef double START_PIVOT = 1e-7


cdef int start(State *state) noexcept nogil:
    """Begin with rates that are not below 0, or make them so by force."""
    cdef bint wall = state.wall.size > 0
    cdef int found
    cdef Py_ssize_t count
    reopen(state)
    if state.size == 0:
        return FAILED
    begin(state)
    if state.size == state.wall.size:
        return GOING_ON
    found = small_program(state, &count)
    if found == NO_FORCES:
        extend_fall(state)
        if falls(state):
            return UNSTABLE
    if found == FOUND and take_over(state, count):
        return GOING_ON
    if not wall:
        return FAILED
    state.restarts += 1
    reopen(state)
    begin(state)
    return GOING_ON


cdef void begin(State *state) noexcept nogil:
    """Clear the basis of the wall of closed columns; find the mechanism that it then has."""
    if state.wall.size == 0:
        memset(state.velocity, 0, state.size * sizeof(double))
        return
    if state.closed_count:
        expel_closed(state)
    row_of(&state.inverse, state.alpha_place, state.velocity)
    opening(state, state.velocity, state.rates, state.old.count)


cdef void expel_closed(State *state) noexcept nogil:
    """Exchange what is closed for other columns of the wall, or for an artificial force."""
    cdef Py_ssize_t i, place, number, force, row
    cdef double one = 1.0, flip
    for place in range(state.wall.size):
        if state.heads[place] < 0 or not state.fixed[place]:
            continue
        row_of(&state.inverse, place, state.row)
        slopes_of(state, state.row)
        for i in range(state.old.count, state.columns):
            state.slopes[i] = 0.0
        flip = 1.0 if state.levels[place] > 0.0 else -1.0
        number = entering(
            state.slopes, flip, state.rates, state.ties, state.columns, LARGE_PIVOT, state.listed
        )
        if number >= 0:
            column_of(state, number, state.column)
            dual_step(state, place, state.slopes, number, state.column)
            continue
        force = 0
        for row in range(state.inverse.old):
            if fabs(state.row[row]) > fabs(state.row[force]):
                force = row
        times(&state.inverse, &force, &one, 1, state.column)
        exchange(state, place, state.column, ARTIFICIAL - force)


cdef int small_program(State *state, Py_ssize_t *count) noexcept nogil:
    """Solve for the forces on the new bodies, with alpha eliminated; write how many columns."""
    cdef Py_ssize_t i, j, q, row, old = state.inverse.old, new = state.size - old
    cdef Py_ssize_t columns = state.new.count, width
    cdef double alpha
    cdef double *tableau = state.tableau
    cdef double *costs
    cdef double *last
    if old == 0:
        # With room for the row that is eliminated.
        width = columns + new
        costs = tableau
        tableau = tableau + width
    else:
        width = columns + 1 + new + 1
        costs = state.rates + state.old.count
    memset(state.tableau, 0, (width * (new + 2)) * sizeof(double))
    for j in range(columns):
        for q in range(6):
            row = (state.new.first[j] + q if q < 3 else state.new.second[j] + q - 3) - 3 - old
            if row >= 0:
                state.tableau[row * width + j] = state.new.entries[q * columns + j]
    if old:
        count[0] = columns + 1
        for i in range(0, new, 3):
            for j in range(columns):
                tableau[i * width + j] -= state.live[old + i] * costs[j]
        for i in range(new):
            tableau[i * width + columns] = -state.live[old + i]
            tableau[i * width + width - 1] = state.levels[old + i]
        last = tableau + (new + 1) * width
        memcpy(last, costs, columns * sizeof(double))
        last[columns] = 1.0
        return solve_small(
            tableau, new, columns + 1, state.small_heads, state.small_fall, state.small_fall + new
        )
    count[0] = columns
    for j in range(columns):
        costs[j] /= state.live[0]
    for i in range(3, new, 3):
        for j in range(columns):
            state.tableau[i * width + j] -= state.live[i] * costs[j]
    for i in range(1, new):
        state.tableau[i * width + width - 1] = state.levels[i]
    last = tableau + new * width
    memcpy(last, costs, columns * sizeof(double))
    return solve_small(
        tableau, new - 1, columns, state.small_heads, state.small_fall, state.small_fall + new
    )


cdef void extend_fall(State *state) noexcept nogil:
    """Extend a fall of the new bodies: on the whole of it the live load does no work."""
    cdef Py_ssize_t i, old = state.inverse.old
    cdef double work = 0.0
    if old:
        memcpy(state.fall + old, state.small_fall, (state.size - old) * sizeof(double))
        for i in range(old, state.size):
            work += state.live[i] * state.fall[i]
        for i in range(old):
            state.fall[i] = -work * state.velocity[i]
        return
    state.fall[0] = 0.0
    memcpy(state.fall + 1, state.small_fall, (state.size - 1) * sizeof(double))
    for i in range(state.size):
        work += state.live[i] * state.fall[i]
    state.fall[0] = -work / state.live[0]


cdef bint take_over(State *state, Py_ssize_t count) noexcept nogil:
    """Put the basis of the small program into the places of the artificial forces."""
    cdef Py_ssize_t i, j, head, old = state.inverse.old, columns = state.new.count
    cdef Py_ssize_t rows = state.size - old - (old == 0)
    cdef Py_ssize_t width = count + rows + 1
    cdef const double *costs = state.tableau + (rows + 1 + (old == 0)) * width
    cdef bint bearing = False
    if old == 0:
        memcpy(state.column, state.live, state.size * sizeof(double))
        apply(&state.inverse, state.column)
        state.alpha_place = take(state, ALPHA)
        if state.alpha_place < 0:
            return False
    for i in range(rows):
        head = state.small_heads[i]
        if head < columns:
            column_of(state, state.old.count + head, state.column)
            if take(state, state.old.count + head) < 0:
                return False
        elif old and head == columns:
            bearing = True
    if bearing:
        if not take_bearing(state):
            return False
    elif old:
        for j in range(state.old.count):
            state.rates[j] *= costs[columns]
    memcpy(state.rates + state.old.count, costs, columns * sizeof(double))
    for i in range(state.size):
        if state.heads[i] >= 0:
            state.rates[state.heads[i]] = state.ties[state.heads[i]] = 0.0
    return True


cdef bint take_bearing(State *state) noexcept nogil:
    """Let a column of the wall bear what is left: the new bodies move and the wall rests."""
    cdef Py_ssize_t j, number, old = state.old.count
    cdef double step
    for j in range(old):
        state.slopes[j] = state.rates[j] if state.open[j] else 0.0
    memset(state.rates, 0, old * sizeof(double))
    number = entering(
        state.slopes, 1.0, state.rates, state.ties, old, LARGE_PIVOT, state.listed
    )
    if number < 0:
        return False
    column_of(state, number, state.column)
    if take(state, number) < 0:
        return False
    step = max(state.ties[number], 0.0) / state.slopes[number]
    for j in range(old):
        state.ties[j] -= step * state.slopes[j]
    return True


cdef Py_ssize_t take(State *state, Py_ssize_t head) noexcept nogil:
    """Exchange the artificial force on a new body that gives the largest pivot; -1 if none."""
    cdef Py_ssize_t i, place = -1
    cdef double size, largest = START_PIVOT
    for i in range(state.inverse.old, state.size):
        size = fabs(state.column[i])
        if state.fixed[i] and size > largest:
            largest = size
            place = i
    if place >= 0:
        exchange(state, place, state.column, head)
    return place
