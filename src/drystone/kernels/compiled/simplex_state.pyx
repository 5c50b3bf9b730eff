# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.simplex_state`."""

from libc.math cimport fabs
from libc.stdint cimport int32_t
from libc.stdlib cimport free, malloc
from libc.string cimport memcpy, memset

from drystone.kernels.compiled.simplex_choice cimport PLACE_SEED, scattered
from drystone.kernels.compiled.simplex_inverse cimport (
    apply, exchange_in, inverted, open_inverse, row_of, times, times_all,
)
from drystone.kernels.compiled.simplex_small cimport tableau_size

cdef double FAULTLESS = 1e-11
cdef double RESIDUAL = 1e-10
cdef double INADMISSIBLE = 1e-10
cdef double VIOLATION = 2e-10
cdef double FALL = 1e-9
cdef double LITTLE = 1e-2


cdef char *room(char *memory, Py_ssize_t *used, Py_ssize_t size) noexcept nogil:
    """Take so many bytes of a block, on a border of 64 bytes."""
    cdef char *taken = memory + used[0] if memory != NULL else NULL
    used[0] += (size + 63) // 64 * 64
    return taken


cdef Py_ssize_t lay_out(State *state, char *memory) noexcept nogil:
    """Share out a block of memory for the sizes given; return how many bytes it takes."""
    cdef Py_ssize_t used = 0, size = state.size, columns = state.columns
    cdef Py_ssize_t new = size - state.wall.size
    cdef Py_ssize_t longest = size if size > columns else columns
    cdef double **rows[13]
    cdef double **per_column[4]
    cdef Py_ssize_t i
    rows[:] = [
        &state.rhs, &state.live, &state.levels, &state.steps, &state.reference, &state.velocity,
        &state.fall, &state.row, &state.column, &state.rest, &state.second, &state.moving,
        &state.total,
    ]
    per_column[:] = [&state.rates, &state.ties, &state.slopes, &state.opened]
    for i in range(13):
        rows[i][0] = <double *>room(memory, &used, (size + 3) * sizeof(double))
    for i in range(4):
        per_column[i][0] = <double *>room(memory, &used, columns * sizeof(double))
    state.heads = <int32_t *>room(memory, &used, size * sizeof(int32_t))
    state.fixed = room(memory, &used, size)
    state.open = room(memory, &used, columns)
    state.new_first = <int32_t *>room(memory, &used, state.new.count * sizeof(int32_t))
    state.new_second = <int32_t *>room(memory, &used, state.new.count * sizeof(int32_t))
    state.listed = <int32_t *>room(memory, &used, (longest + 1) * sizeof(int32_t))
    i = tableau_size(new, state.new.count + 1)
    state.tableau = <double *>room(memory, &used, i * sizeof(double))
    state.small_fall = <double *>room(
        memory, &used, (new + state.new.count + 1) * sizeof(double)
    )
    state.small_heads = <int32_t *>room(memory, &used, new * sizeof(int32_t))
    state.inverse.places = <int32_t *>room(memory, &used, size * sizeof(int32_t))
    state.inverse.slot = <int32_t *>room(memory, &used, size * sizeof(int32_t))
    state.inverse.factors = <double *>room(memory, &used, (size + 1) * sizeof(double))
    state.inverse.lines = <const double **>room(memory, &used, (size + 1) * sizeof(double *))
    # Mostly not touched: a few columns only.
    state.inverse.changed = <double *>room(memory, &used, size * size * sizeof(double))
    return used


cdef void reopen(State *state) noexcept nogil:
    """Begin with the basis of the wall, bordered by artificial forces on the new bodies."""
    cdef Py_ssize_t i, j, old = state.wall.size, more = state.new.count
    cdef double alpha
    state.inverse.rows = state.wall.rows
    state.inverse.cols = state.wall.cols
    state.inverse.levels = state.wall.levels
    state.inverse.old = old
    state.inverse.alpha_place = state.alpha_place = state.wall.alpha_place
    state.inverse.live = state.live + old
    state.inverse.new = state.size - old
    state.inverse.size = state.size
    open_inverse(&state.inverse)
    for i in range(old):
        j = state.heads[i] = state.wall.heads[i]
        state.fixed[i] = j <= ARTIFICIAL or (j >= 0 and not state.open[j])
        state.levels[i] = state.reference[i] = state.wall.levels[i]
        state.steps[i] = 0.0
    for i in range(old, state.size):
        state.heads[i] = <int32_t>(ARTIFICIAL - i)
        state.fixed[i] = True
        state.levels[i] = state.rhs[i]
        state.reference[i] = state.steps[i] = 0.0
    if old:
        alpha = state.wall.levels[state.wall.alpha_place]
        for i in range(old, state.size):
            state.levels[i] -= state.live[i] * alpha
    for j in range(state.old.count):
        state.rates[j] = state.wall.rates[j]
        state.ties[j] = state.wall.ties[j]
    scattered(state.old.count, more, state.ties + state.old.count)
    for j in range(state.old.count, state.columns):
        state.rates[j] = 0.0
        state.ties[j] = 1.0 + state.ties[j]


cdef void open_part(const Columns *part, const double *moving, double *out) noexcept nogil:
    """Write the rates at which columns are opened."""
    cdef Py_ssize_t j, count = part.count
    cdef const double *e = part.entries
    cdef const double *a
    cdef const double *b
    for j in range(count):
        a = moving + part.first[j]
        b = moving + part.second[j]
        out[j] = (
            a[0] * e[j] + a[1] * e[count + j] + a[2] * e[2 * count + j]
            + b[0] * e[3 * count + j] + b[1] * e[4 * count + j] + b[2] * e[5 * count + j]
        )


cdef void opening(
    State *state, const double *velocity, double *out, Py_ssize_t first
) noexcept nogil:
    """Write the rates at which a motion opens all columns, or only the new ones."""
    state.moving[0] = state.moving[1] = state.moving[2] = 0.0
    memcpy(state.moving + 3, velocity, state.size * sizeof(double))
    if first == 0:
        open_part(&state.old, state.moving, out)
    open_part(&state.new, state.moving, out + state.old.count)


cdef void clear_basic(State *state, double *values) noexcept nogil:
    """Set what belongs to basic and to closed columns to 0."""
    cdef Py_ssize_t i
    for i in range(state.size):
        if state.heads[i] >= 0:
            values[state.heads[i]] = 0.0
    for i in range(state.closed_count):
        values[state.closed[i]] = 0.0


cdef void slopes_of(State *state, const double *row) noexcept nogil:
    """Compute the products of a row of the inverse with what may enter the basis."""
    opening(state, row, state.slopes, 0)
    clear_basic(state, state.slopes)


cdef Columns *part_of(State *state, Py_ssize_t *number) noexcept nogil:
    if number[0] < state.old.count:
        return &state.old
    number[0] -= state.old.count
    return &state.new


cdef Py_ssize_t entries_of(
    State *state, Py_ssize_t head, Py_ssize_t *rows, double *entries
) noexcept nogil:
    """Write the rows and entries, up to six, of anything basic but alpha; return how many."""
    cdef Py_ssize_t q, row, count = 0, number = head
    cdef Columns *part
    if head <= ARTIFICIAL:
        rows[0] = ARTIFICIAL - head
        entries[0] = 1.0
        return 1
    part = part_of(state, &number)
    for q in range(6):
        row = (part.first[number] + q if q < 3 else part.second[number] + q - 3) - 3
        if row >= 0:
            rows[count] = row
            entries[count] = part.entries[q * part.count + number]
            count += 1
    return count


cdef void column_of(State *state, Py_ssize_t number, double *out) noexcept nogil:
    """Write the inverse times a column."""
    cdef Py_ssize_t[6] rows
    cdef double[6] entries
    cdef Py_ssize_t count = entries_of(state, number, rows, entries)
    times(&state.inverse, rows, entries, count, out)


cdef void exchange(
    State *state, Py_ssize_t place, const double *column, Py_ssize_t head
) noexcept nogil:
    """Put something into a place of the basis; `column` is the inverse times it."""
    cdef Py_ssize_t i
    cdef double level = state.levels[place] / column[place]
    cdef double step = state.steps[place] / column[place]
    exchange_in(&state.inverse, place, column)
    for i in range(state.size):
        state.levels[i] -= level * column[i]
        state.steps[i] -= step * column[i]
    state.levels[place] = level
    state.steps[place] = step
    state.heads[place] = <int32_t>head
    state.fixed[place] = head <= ARTIFICIAL
    state.pivots += 1


cdef void dual_step(
    State *state, Py_ssize_t place, const double *slopes, Py_ssize_t number, const double *column
) noexcept nogil:
    """Put a column into a place of the basis and keep all rates from falling below 0."""
    cdef Py_ssize_t j, head = state.heads[place]
    cdef double rate = max(state.rates[number], 0.0) / slopes[number]
    cdef double tie = max(state.ties[number], 0.0) / slopes[number]
    for j in range(state.columns):
        state.rates[j] -= rate * slopes[j]
        state.ties[j] -= tie * slopes[j]
    state.rates[number] = state.ties[number] = 0.0
    if head >= 0:
        state.rates[head] = -rate
        state.ties[head] = -tie
    exchange(state, place, column, number)


cdef void set_steps(State *state) noexcept nogil:
    """Let the levels come from a state within bounds, with a little more everywhere."""
    cdef Py_ssize_t i
    scattered(PLACE_SEED, state.size, state.steps)
    for i in range(state.size):
        if state.fixed[i]:
            state.steps[i] = -state.levels[i]
        else:
            state.steps[i] = (
                max(state.reference[i], 0.0) + LITTLE * (0.1 + state.steps[i])
            ) - state.levels[i]
    state.steps[state.alpha_place] = 0.0


cdef bint take_rates(State *state) noexcept nogil:
    """Compute the mechanism and its rates; False when the inverse has lost its digits."""
    cdef Py_ssize_t i
    cdef double drift = 0.0
    row_of(&state.inverse, state.alpha_place, state.velocity)
    state.speed = 1.0
    for i in range(state.size):
        state.speed = max(state.speed, fabs(state.velocity[i]))
    opening(state, state.velocity, state.rates, 0)
    for i in range(state.size):
        if state.heads[i] >= 0:
            drift = max(drift, fabs(state.rates[state.heads[i]]))
    clear_basic(state, state.rates)
    return drift <= INADMISSIBLE * state.speed


cdef bint take_levels(State *state) noexcept nogil:
    """Compute the levels; False when the inverse has lost its digits."""
    cdef Py_ssize_t i, old = state.inverse.old
    for i in range(state.size):
        state.levels[i] = state.inverse.levels[i] if i < old else state.rhs[i]
    apply(&state.inverse, state.levels)
    if unbalanced(state) <= FAULTLESS:
        return True
    times_all(&state.inverse, state.rest, state.column)
    for i in range(state.size):
        state.levels[i] += state.column[i]
    return unbalanced(state) <= RESIDUAL


cdef double unbalanced(State *state) noexcept nogil:
    """Compute what is missing from the equations; return the largest."""
    cdef Py_ssize_t i, q, head, number
    cdef double level, largest = 0.0
    cdef double *total = state.total
    cdef Columns *part
    memset(total, 0, (state.size + 3) * sizeof(double))
    for i in range(state.size):
        if state.heads[i] >= 0:
            number = state.heads[i]
            level = state.levels[i]
            part = part_of(state, &number)
            for q in range(3):
                total[part.first[number] + q] += part.entries[q * part.count + number] * level
            for q in range(3):
                total[part.second[number] + q] += (
                    part.entries[(3 + q) * part.count + number] * level
                )
    level = state.levels[state.alpha_place]
    for i in range(state.size):
        total[3 + i] = state.live[i] * level + total[3 + i]
    for i in range(state.size):
        head = state.heads[i]
        if head <= ARTIFICIAL:
            total[3 + ARTIFICIAL - head] += state.levels[i]
    for i in range(state.size):
        state.rest[i] = state.rhs[i] - total[3 + i]
        largest = max(largest, fabs(state.rest[i]))
    return largest


cdef bint within_bounds(State *state) noexcept nogil:
    """Say whether no level is out of bounds by more than rounding."""
    cdef Py_ssize_t i
    cdef double excess
    for i in range(state.size):
        excess = fabs(state.levels[i]) if state.fixed[i] else -state.levels[i]
        if not excess <= VIOLATION and i != state.alpha_place:
            return False
    return True


cdef bint admissible(State *state) noexcept nogil:
    """Say whether the mechanism closes no contact by more than rounding."""
    cdef Py_ssize_t j
    cdef double least = -INADMISSIBLE * state.speed
    for j in range(state.columns):
        if not state.rates[j] >= least:
            return False
    return True


cdef bint falls(State *state) noexcept nogil:
    """Say whether the motion `state.fall` proves that nothing holds the bodies up."""
    cdef Py_ssize_t i
    cdef double largest = 0.0, closes = 0.0, work = 0.0, fall = 0.0
    for i in range(state.size):
        largest = max(largest, fabs(state.fall[i]))
        work += state.live[i] * state.fall[i]
        fall -= state.rhs[i] * state.fall[i]
    opening(state, state.fall, state.opened, 0)
    for i in range(state.columns):
        if state.open[i]:
            closes = max(closes, -state.opened[i])
    closes = max(closes, fabs(work))
    return closes <= FALL * largest and fall > closes


cdef bint renewed_inverse(State *state) noexcept nogil:
    """Make the inverse from its basis, once; False when there is none or it was made."""
    cdef Py_ssize_t i, j, size = state.size
    cdef double *cols
    cdef double *levels
    if state.renewed:
        return False
    state.anew = <double *>malloc((2 * size * size + size) * sizeof(double))
    if state.anew == NULL:
        return False
    cols = state.anew + size * size
    levels = cols + size * size
    write_basis(state, state.anew)
    if not inverted(state.anew, size, state.column, state.listed):
        free(state.anew)
        state.anew = NULL
        return False
    state.renewed = True
    state.restarts += 1
    for i in range(size):
        for j in range(size):
            cols[j * size + i] = state.anew[i * size + j]
    memset(levels, 0, size * sizeof(double))
    for i in range(size):
        for j in range(size):
            levels[j] += state.rhs[i] * cols[i * size + j]
    state.inverse.rows = state.anew
    state.inverse.cols = cols
    state.inverse.levels = levels
    state.inverse.old = size
    state.inverse.new = 0
    state.inverse.alpha_place = state.alpha_place
    open_inverse(&state.inverse)
    return True


cdef void write_basis(State *state, double *matrix) noexcept nogil:
    """Write the basis as a matrix."""
    cdef Py_ssize_t[6] rows
    cdef double[6] entries
    cdef Py_ssize_t i, place, count, size = state.size
    memset(matrix, 0, size * size * sizeof(double))
    for place in range(size):
        if state.heads[place] == ALPHA:
            for i in range(size):
                matrix[i * size + place] = state.live[i]
        else:
            count = entries_of(state, state.heads[place], rows, entries)
            for i in range(count):
                matrix[rows[i] * size + place] = entries[i]
