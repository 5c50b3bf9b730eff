# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""The simplex method of :mod:`drystone.kernels.simplex`, which says what it solves and how.

From top to bottom: data; columns; basis inverse; ratio tests; state; tableau of the new bodies;
start; phases; what is written out; what Python sees.  Sums are added in a fixed order: plans must
be the same bytes on every machine.
"""

from cpython.bytearray cimport (
    PyByteArray_AS_STRING, PyByteArray_FromStringAndSize, PyByteArray_GET_SIZE
)
from libc.math cimport fabs, frexp, ldexp
from libc.stdint cimport uint64_t
from libc.stdlib cimport free, malloc
from libc.string cimport memcpy, memset

from drystone.kernels.memory cimport doubles, doubles_out, ints, ints_out, p_double, p_int

import numpy as np

ctypedef const double *c_double
ctypedef const int *c_int

# ---- Data ----------------------------------------------------------------------------------------

cdef enum:
    # What is basic in a row: a column, alpha, or ARTIFICIAL - i, the artificial variable of row i.
    ALPHA = -1
    ARTIFICIAL = -2

cdef enum:
    OPTIMAL = 0
    UNSTABLE = 1
    FAILED = 2
    UNFINISHED = -1
    INACCURATE = -2

cdef enum:
    # Where the perturbations of basic values and of the small program begin; columns begin at 0.
    VALUE_SEED = 0x10000000
    SMALL_SEED = 0x20000000

# Of the equations: basic values with larger residuals are refined once, and refused above the
# second.  Forces are in weights of the first stone or so.
cdef double REFINED_ABOVE = 1e-11
cdef double RESIDUAL = 1e-10
# A basic value leaves the basis only if it is negative by more; an answer may be by twice as much.
cdef double PRIMAL_TOLERANCE = 1e-10
cdef double PRIMAL_ACCEPTED = 2e-10
# Of reduced costs, over the largest velocity.
cdef double DUAL_TOLERANCE = 1e-10
# The same of a ray that proves infeasibility.
cdef double RAY_TOLERANCE = 1e-9
# Pivots are larger than the first; than the second where there are none or they led astray, as
# what is not looked at can leave its bounds by a millionth of a step.
cdef double LARGE_PIVOT = 1e-6
cdef double SMALL_PIVOT = 1e-9
# What a ratio may be missed by so that a large pivot can be taken (Harris), of costs and of the
# secondary ones.
cdef double HARRIS_SLACK = 1e-10
cdef double SECONDARY_SLACK = 1e-1
# By which a pivot may differ between its row and its column.
cdef double PIVOT_ERROR = 1e-8
# Of the inverse times the basis; above it a new wall's inverse is made anew.
cdef double INVERSE_ERROR = 1e-11
cdef double SINGULAR = 1e-10
# Of a weight: about what basic values are perturbed by in the parametric phase.
cdef double PERTURBATION = 1e-2
cdef int ROUNDS = 6

# Columns of friction cones: where their two bodies begin in a table of velocities, which begins
# with three zeros for the ground, and their six entries, the first ones of all columns first.
cdef struct Columns:
    Py_ssize_t count
    c_int first, second
    const double *entries

# The basis inverse: F times the inverse of the wall, bordered by an identity for the new bodies
# and by minus the live load on them in the column of alpha.  F is an identity but for a few eta
# columns: `eta[t * size : ...]` is that of row `eta_row[t]`, and `slot` is the way back.
cdef struct Inverse:
    c_double rows, cols, values
    Py_ssize_t old, alpha_row
    const double *live
    Py_ssize_t new, size, count
    p_int eta_row, slot
    double *eta
    # Scratch for sums of lines.
    double *factors
    const double **lines

cdef struct State:
    # Of the wall; its optimal basis has its inverse in `inverse`.
    Columns old
    const int *wall_basic
    c_double wall_reduced_costs, wall_secondary_costs
    const int *closed
    Py_ssize_t closed_count
    Columns new
    Py_ssize_t columns, size, alpha_row
    Inverse inverse
    double speed, pivot
    int pivots, restarts
    bint reinverted
    # One number a row.  Of the basic values x at the parameter 0, x + direction at 1; `feasible`
    # are those that the next parametric phase starts near.  A basic variable that is fixed, an
    # artificial one or a closed column, has to be 0.
    p_double rhs, live, values, direction, feasible, velocity, ray, inverse_row, pivot_column
    p_double residual, secondary_values
    p_int basic, fixed
    # Three more than that, for the ground.
    double *with_ground
    # One number a column.
    p_double reduced_costs, secondary_costs, pivot_row, opened
    char *open
    # One number a new column.
    p_int new_first, new_second
    # One number a row or a column, whichever are more.
    int *listed
    p_double tableau, small_ray
    int *small_basic
    # A new inverse, when the old one is inaccurate.
    double *anew


cdef void perturbation(uint64_t seed, Py_ssize_t count, double *out) noexcept nogil:
    """Write fixed numbers in [0, 1) without pattern: SplitMix64 (Steele, Lea & Flood, 2014)."""
    cdef Py_ssize_t i
    cdef uint64_t bits
    for i in range(count):
        bits = (seed + 1 + <uint64_t>i) * <uint64_t>0x9E3779B97F4A7C15ULL
        bits = (bits ^ (bits >> 30)) * <uint64_t>0xBF58476D1CE4E5B9ULL
        bits = (bits ^ (bits >> 27)) * <uint64_t>0x94D049BB133111EBULL
        bits ^= bits >> 31
        out[i] = <double>(bits >> 11) * (1.0 / 9007199254740992.0)


# ---- Columns -------------------------------------------------------------------------------------

cdef void price_part(const Columns *part, const double *with_ground, double *out) noexcept nogil:
    cdef Py_ssize_t j, count = part.count
    cdef const double *e = part.entries
    cdef c_double a, b
    for j in range(count):
        a = with_ground + part.first[j]
        b = with_ground + part.second[j]
        out[j] = (
            a[0] * e[j] + a[1] * e[count + j] + a[2] * e[2 * count + j]
            + b[0] * e[3 * count + j] + b[1] * e[4 * count + j] + b[2] * e[5 * count + j]
        )


cdef void price(State *state, const double *row, double *out, Py_ssize_t first) noexcept nogil:
    """Write the products of a row vector with all columns (first is 0), or only the new ones.

    Of a velocity these are the rates at which it opens the contacts.
    """
    state.with_ground[0] = state.with_ground[1] = state.with_ground[2] = 0.0
    memcpy(state.with_ground + 3, row, state.size * sizeof(double))
    if first == 0:
        price_part(&state.old, state.with_ground, out)
    price_part(&state.new, state.with_ground, out + state.old.count)


cdef void clear_basic(State *state, double *values) noexcept nogil:
    """Set what belongs to basic and to closed columns to 0."""
    cdef Py_ssize_t i
    for i in range(state.size):
        if state.basic[i] >= 0:
            values[state.basic[i]] = 0.0
    for i in range(state.closed_count):
        values[state.closed[i]] = 0.0


cdef Py_ssize_t entries_of(
    State *state, Py_ssize_t variable, Py_ssize_t *rows, double *entries
) noexcept nogil:
    """Write the rows and entries, up to six, of any variable but alpha; return how many."""
    cdef Py_ssize_t q, row, count = 0, number = variable
    cdef Columns *part = &state.old
    if variable <= ARTIFICIAL:
        rows[0] = ARTIFICIAL - variable
        entries[0] = 1.0
        return 1
    if number >= part.count:
        number -= part.count
        part = &state.new
    for q in range(6):
        row = (part.first[number] + q if q < 3 else part.second[number] + q - 3) - 3
        if row >= 0:
            rows[count] = row
            entries[count] = part.entries[q * part.count + number]
            count += 1
    return count


# ---- Basis inverse -------------------------------------------------------------------------------

cdef void add_lines(
    double *out, Py_ssize_t size, const double *factors, const double **lines, Py_ssize_t count
) noexcept nogil:
    """Add multiples of lines, one after the other; four in one pass save memory traffic."""
    cdef Py_ssize_t i, t = 0
    cdef c_double a, b, c, d
    cdef double f, g, h, k
    while t + 4 <= count:
        a, b, c, d = lines[t], lines[t + 1], lines[t + 2], lines[t + 3]
        f, g, h, k = factors[t], factors[t + 1], factors[t + 2], factors[t + 3]
        for i in range(size):
            out[i] = out[i] + f * a[i] + g * b[i] + h * c[i] + k * d[i]
        t += 4
    while t < count:
        a, f = lines[t], factors[t]
        for i in range(size):
            out[i] += f * a[i]
        t += 1


cdef void border(Inverse *inverse) noexcept nogil:
    """Start with the inverse of the wall; eta columns of new rows come first, then alpha's."""
    cdef Py_ssize_t i
    for i in range(inverse.size):
        inverse.slot[i] = -1
    inverse.count = 0
    for i in range(inverse.new):
        open_eta(inverse, inverse.old + i)
    if inverse.old:
        open_eta(inverse, inverse.alpha_row)


cdef void open_eta(Inverse *inverse, Py_ssize_t row) noexcept nogil:
    cdef double *column = inverse.eta + inverse.count * inverse.size
    memset(column, 0, inverse.size * sizeof(double))
    column[row] = 1.0
    inverse.slot[row] = <int>inverse.count
    inverse.eta_row[inverse.count] = <int>row
    inverse.count += 1


cdef void inverse_row(Inverse *inverse, Py_ssize_t row, double *out) noexcept nogil:
    """Write a row of the inverse (BTRAN of a unit vector)."""
    cdef Py_ssize_t i, t, found = 0
    cdef double factor
    cdef double *factors = inverse.factors
    memset(out, 0, inverse.size * sizeof(double))
    for t in range(inverse.count):
        factors[t] = inverse.eta[t * inverse.size + row]
    for i in range(inverse.new):
        out[inverse.old + i] = factors[i]
    if inverse.old == 0:
        return
    for i in range(0, inverse.new, 3):
        factors[inverse.new] -= inverse.live[i] * factors[i]
    for t in range(inverse.new, inverse.count):
        factor = factors[t]
        if factor != 0.0:
            factors[found] = factor
            inverse.lines[found] = inverse.rows + inverse.eta_row[t] * inverse.old
            found += 1
    if inverse.slot[row] < 0:
        factors[found] = 1.0
        inverse.lines[found] = inverse.rows + row * inverse.old
        found += 1
    add_lines(out, inverse.old, factors, inverse.lines, found)


cdef void apply_eta(Inverse *inverse, double *vector) noexcept nogil:
    """Multiply what the wall's inverse has made of a vector by border and eta columns, in place."""
    cdef Py_ssize_t i, t, found = 0
    cdef double at
    if inverse.old:
        for i in range(0, inverse.new, 3):
            vector[inverse.old + i] -= inverse.live[i] * vector[inverse.alpha_row]
    for t in range(inverse.count):
        at = vector[inverse.eta_row[t]]
        vector[inverse.eta_row[t]] = 0.0
        if at != 0.0:
            inverse.factors[found] = at
            inverse.lines[found] = inverse.eta + t * inverse.size
            found += 1
    add_lines(vector, inverse.size, inverse.factors, inverse.lines, found)


cdef void ftran(
    Inverse *inverse, const Py_ssize_t *rows, const double *entries, Py_ssize_t count, double *out
) noexcept nogil:
    """Write the inverse times a column with a few entries; rows are all there are when NULL."""
    cdef Py_ssize_t i, row, found = 0
    memset(out, 0, inverse.size * sizeof(double))
    for i in range(count):
        row = rows[i] if rows != NULL else i
        if row >= inverse.old:
            out[row] = entries[i]
        elif entries[i] != 0.0:
            inverse.factors[found] = entries[i]
            inverse.lines[found] = inverse.cols + row * inverse.old
            found += 1
    add_lines(out, inverse.old, inverse.factors, inverse.lines, found)
    apply_eta(inverse, out)


cdef void update_eta(Inverse *inverse, Py_ssize_t row, const double *pivot_column) noexcept nogil:
    """Bring another column into the basis; `pivot_column` is the inverse times it."""
    cdef Py_ssize_t i, t
    cdef double factor
    cdef double *kept
    if inverse.slot[row] < 0:
        open_eta(inverse, row)
    for t in range(inverse.count):
        kept = inverse.eta + t * inverse.size
        factor = kept[row] / pivot_column[row]
        if factor != 0.0:
            for i in range(inverse.size):
                kept[i] -= factor * pivot_column[i]
            kept[row] = factor


cdef bint invert(double *matrix, Py_ssize_t size, double *line, int *swaps) noexcept nogil:
    """Invert a matrix in place; False when it has no inverse.

    Gauss-Jordan with exchanges of rows: the libraries for it differ in the last bits from machine
    to machine.
    """
    cdef Py_ssize_t step, best, i, j
    cdef double pivot, factor
    cdef double *other
    for step in range(size):
        best = step
        for i in range(step + 1, size):
            if fabs(matrix[i * size + step]) > fabs(matrix[best * size + step]):
                best = i
        pivot = matrix[best * size + step]
        if not fabs(pivot) > SINGULAR:
            return False
        swaps[step] = <int>best
        for j in range(size):
            line[j] = matrix[best * size + j]
            matrix[best * size + j] = matrix[step * size + j]
        line[step] = 1.0
        for j in range(size):
            line[j] /= pivot
        for i in range(size):
            other = matrix + i * size
            factor = other[step]
            if i != step and factor != 0.0:
                other[step] = 0.0
                for j in range(size):
                    other[j] -= factor * line[j]
        for j in range(size):
            matrix[step * size + j] = line[j]
    for step in range(size - 1, -1, -1):
        best = swaps[step]
        if best != step:
            for i in range(size):
                other = matrix + i * size
                pivot = other[step]
                other[step] = other[best]
                other[best] = pivot
    return True


cdef void transpose(const double *rows, double *cols, Py_ssize_t size) noexcept nogil:
    """Copy a square matrix, transposed, in tiles that fit into the cache."""
    cdef Py_ssize_t i, j, top, left
    for top in range(0, size, 16):
        for left in range(0, size, 16):
            for i in range(top, min(top + 16, size)):
                for j in range(left, min(left + 16, size)):
                    cols[j * size + i] = rows[i * size + j]


# ---- Ratio tests ---------------------------------------------------------------------------------

cdef Py_ssize_t leaving_row(State *state) noexcept nogil:
    """Return the row that is infeasible down to the largest parameter; -1 if none is at 0.

    That is the row which leaves first as the parameter of the right-hand side goes from 1 to 0.
    """
    cdef Py_ssize_t i, row = -1
    cdef double excess, towards, parameter, largest = -1.0
    for i in range(state.size):
        excess = fabs(state.values[i]) if state.fixed[i] else -state.values[i]
        if not excess > PRIMAL_TOLERANCE or i == state.alpha_row:
            continue
        towards = state.direction[i]
        if state.fixed[i] and state.values[i] > 0.0:
            towards = -towards
        parameter = excess / towards if towards > 1e-14 else 1e30
        if parameter > largest:
            largest = parameter
            row = i
    return row


cdef Py_ssize_t harris(
    const double *pivots, double sign, const double *values, double slack, int *listed,
    Py_ssize_t count
) noexcept nogil:
    """Keep of a list what passes a ratio test with slack, in two passes; return how many.

    Harris, Pivot selection methods of the Devex LP code, Mathematical Programming 5 (1973).
    """
    cdef Py_ssize_t i, first = 0, kept = 0
    cdef double ratio, least = 0.0
    for i in range(count):
        ratio = (max(0.0, values[listed[i]]) + slack) / (sign * pivots[listed[i]])
        if i == 0 or ratio < least:
            least, first = ratio, i
    for i in range(count):
        # The first one also where it is so large that the slack is lost.
        if max(0.0, values[listed[i]]) <= least * (sign * pivots[listed[i]]) or i == first:
            listed[kept] = listed[i]
            kept += 1
    return kept


cdef Py_ssize_t ratio_test(
    const double *pivots, double sign, const double *values, const double *secondary,
    int *listed, Py_ssize_t count
) noexcept nogil:
    """Return what has the smallest ratio of value to pivot, then of secondary value; -1 if none.

    Of what is equal within tolerances the largest pivot is taken.
    """
    cdef Py_ssize_t i, best = 0
    if count == 0:
        return -1
    count = harris(pivots, sign, values, HARRIS_SLACK, listed, count)
    count = harris(pivots, sign, secondary, SECONDARY_SLACK, listed, count)
    for i in range(1, count):
        if sign * pivots[listed[i]] > sign * pivots[listed[best]]:
            best = i
    return listed[best]


cdef Py_ssize_t dual_ratio_test(
    State *state, double sign, Py_ssize_t count, double smallest
) noexcept nogil:
    """Return the column, of the first so many, that enters where the pivot row has this sign."""
    cdef Py_ssize_t j, found = 0
    for j in range(count):
        state.listed[found] = <int>j
        found += sign * state.pivot_row[j] > smallest
    return ratio_test(
        state.pivot_row, sign, state.reduced_costs, state.secondary_costs, state.listed, found
    )


cdef Py_ssize_t primal_ratio_test(State *state) noexcept nogil:
    """Return the row that leaves as a column enters; -1 if the column can grow for ever.

    A basic variable that is fixed cannot change at all, and goes first.
    """
    cdef Py_ssize_t i, row = -1, found = 0
    cdef const double *column = state.pivot_column
    for i in range(state.size):
        if state.fixed[i] and fabs(column[i]) > state.pivot:
            if row < 0 or fabs(column[i]) > fabs(column[row]):
                row = i
    if row >= 0:
        return row
    for i in range(state.size):
        state.listed[found] = <int>i
        found += column[i] > state.pivot and not state.fixed[i] and i != state.alpha_row
    return ratio_test(column, 1.0, state.values, state.secondary_values, state.listed, found)


# ---- State ---------------------------------------------------------------------------------------

cdef Py_ssize_t lay_out(State *state, char *memory, Py_ssize_t room) noexcept nogil:
    """Share out a block of memory, with room for more columns; return how many bytes it takes."""
    cdef Py_ssize_t i, used = 0, size = state.size, new = size - state.inverse.old
    cdef Py_ssize_t columns = state.new.count + room
    # Lines begin at borders of 64 bytes.
    cdef Py_ssize_t height = (size + 10) // 8 * 64, width = (state.columns + room + 7) // 8 * 64
    cdef void **rows[19]
    cdef void **wide[7]
    rows[:] = [
        <void **>&state.rhs, <void **>&state.live, <void **>&state.values,
        <void **>&state.direction, <void **>&state.feasible, <void **>&state.velocity,
        <void **>&state.ray, <void **>&state.inverse_row, <void **>&state.pivot_column,
        <void **>&state.residual, <void **>&state.secondary_values, <void **>&state.with_ground,
        <void **>&state.inverse.factors, <void **>&state.inverse.lines,
        <void **>&state.inverse.eta_row, <void **>&state.inverse.slot, <void **>&state.basic,
        <void **>&state.fixed, <void **>&state.small_basic,
    ]
    wide[:] = [
        <void **>&state.reduced_costs, <void **>&state.secondary_costs, <void **>&state.pivot_row,
        <void **>&state.opened, <void **>&state.open, <void **>&state.new_first,
        <void **>&state.new_second,
    ]
    for i in range(19):
        rows[i][0] = memory + used
        used += height
    for i in range(7):
        wide[i][0] = memory + used
        used += width
    # What is listed are rows or columns; a small ray is followed by scratch for columns.
    state.listed = <int *>(memory + used)
    state.small_ray = <double *>(memory + used + height + width)
    used += 2 * (height + width)
    state.tableau = <double *>(memory + used)
    used += (new + 2) * (columns + new + 2) * sizeof(double)
    # Mostly not touched: a few eta columns only.
    state.inverse.eta = <double *>(memory + used)
    return used + size * size * sizeof(double)


cdef void reset(State *state) noexcept nogil:
    """Begin with the basis of the wall, and artificial variables on the new bodies."""
    cdef Py_ssize_t i, j, old = state.inverse.old
    cdef double alpha
    state.alpha_row = state.inverse.alpha_row
    state.inverse.live = state.live + old
    state.inverse.new = state.size - old
    state.inverse.size = state.size
    border(&state.inverse)
    for i in range(old):
        j = state.basic[i] = state.wall_basic[i]
        state.fixed[i] = j <= ARTIFICIAL or (j >= 0 and not state.open[j])
        state.values[i] = state.feasible[i] = state.inverse.values[i]
        state.direction[i] = 0.0
    for i in range(old, state.size):
        state.basic[i] = <int>(ARTIFICIAL - i)
        state.fixed[i] = True
        state.values[i] = state.rhs[i]
        state.feasible[i] = state.direction[i] = 0.0
    if old:
        alpha = state.inverse.values[state.alpha_row]
        for i in range(old, state.size):
            state.values[i] -= state.live[i] * alpha
    for j in range(state.old.count):
        state.reduced_costs[j] = state.wall_reduced_costs[j]
        state.secondary_costs[j] = state.wall_secondary_costs[j]
    perturbation(state.old.count, state.new.count, state.secondary_costs + state.old.count)
    for j in range(state.old.count, state.columns):
        state.reduced_costs[j] = 0.0
        state.secondary_costs[j] = 1.0 + state.secondary_costs[j]


cdef void compute_pivot_row(State *state, Py_ssize_t row) noexcept nogil:
    """Multiply a row of the inverse by all that may enter the basis."""
    inverse_row(&state.inverse, row, state.inverse_row)
    price(state, state.inverse_row, state.pivot_row, 0)
    clear_basic(state, state.pivot_row)


cdef void compute_pivot_column(State *state, Py_ssize_t number) noexcept nogil:
    """Multiply the inverse by a column."""
    cdef Py_ssize_t[6] rows
    cdef double[6] entries
    cdef Py_ssize_t count = entries_of(state, number, rows, entries)
    ftran(&state.inverse, rows, entries, count, state.pivot_column)


cdef void pivot_on(State *state, Py_ssize_t row, Py_ssize_t variable) noexcept nogil:
    """Make a variable basic in a row; `state.pivot_column` is the inverse times its column."""
    cdef Py_ssize_t i
    cdef const double *column = state.pivot_column
    cdef double value = state.values[row] / column[row]
    cdef double step = state.direction[row] / column[row]
    update_eta(&state.inverse, row, column)
    for i in range(state.size):
        state.values[i] -= value * column[i]
        state.direction[i] -= step * column[i]
    state.values[row] = value
    state.direction[row] = step
    state.basic[row] = <int>variable
    state.fixed[row] = variable <= ARTIFICIAL
    state.pivots += 1


cdef void dual_pivot_on(State *state, Py_ssize_t row, Py_ssize_t number) noexcept nogil:
    """Let a column enter and update reduced costs, none of which falls below 0."""
    cdef Py_ssize_t j, leaves = state.basic[row]
    cdef const double *pivot_row = state.pivot_row
    cdef double step = max(state.reduced_costs[number], 0.0) / pivot_row[number]
    cdef double secondary = max(state.secondary_costs[number], 0.0) / pivot_row[number]
    for j in range(state.columns):
        state.reduced_costs[j] -= step * pivot_row[j]
        state.secondary_costs[j] -= secondary * pivot_row[j]
    state.reduced_costs[number] = state.secondary_costs[number] = 0.0
    if leaves >= 0:
        state.reduced_costs[leaves] = -step
        state.secondary_costs[leaves] = -secondary
    pivot_on(state, row, number)


cdef bint compute_reduced_costs(State *state) noexcept nogil:
    """Compute velocities, the duals, and reduced costs anew; False when they are inaccurate."""
    cdef Py_ssize_t i
    cdef double error = 0.0
    inverse_row(&state.inverse, state.alpha_row, state.velocity)
    state.speed = 1.0
    for i in range(state.size):
        state.speed = max(state.speed, fabs(state.velocity[i]))
    price(state, state.velocity, state.reduced_costs, 0)
    for i in range(state.size):
        if state.basic[i] >= 0:
            error = max(error, fabs(state.reduced_costs[state.basic[i]]))
    clear_basic(state, state.reduced_costs)
    return error <= DUAL_TOLERANCE * state.speed


cdef bint compute_basic_values(State *state) noexcept nogil:
    """Compute basic values anew, refined once; False when they are inaccurate."""
    cdef Py_ssize_t i, old = state.inverse.old
    for i in range(state.size):
        state.values[i] = state.inverse.values[i] if i < old else state.rhs[i]
    apply_eta(&state.inverse, state.values)
    if compute_residual(state) <= REFINED_ABOVE:
        return True
    ftran(&state.inverse, NULL, state.residual, state.size, state.pivot_column)
    for i in range(state.size):
        state.values[i] += state.pivot_column[i]
    return compute_residual(state) <= RESIDUAL


cdef double compute_residual(State *state) noexcept nogil:
    """Compute rhs minus basis times basic values; return the largest."""
    cdef Py_ssize_t[6] rows
    cdef double[6] entries
    cdef Py_ssize_t i, q, count
    cdef double alpha = state.values[state.alpha_row], largest = 0.0
    cdef double *total = state.residual
    memset(total, 0, state.size * sizeof(double))
    for i in range(state.size):
        if state.basic[i] >= 0:
            count = entries_of(state, state.basic[i], rows, entries)
            for q in range(count):
                total[rows[q]] += entries[q] * state.values[i]
    for i in range(state.size):
        total[i] = state.live[i] * alpha + total[i]
    for i in range(state.size):
        if state.basic[i] <= ARTIFICIAL:
            total[ARTIFICIAL - state.basic[i]] += state.values[i]
    for i in range(state.size):
        state.residual[i] = state.rhs[i] - total[i]
        largest = max(largest, fabs(state.residual[i]))
    return largest


cdef bint primal_feasible(State *state) noexcept nogil:
    cdef Py_ssize_t i
    cdef double excess
    for i in range(state.size):
        excess = fabs(state.values[i]) if state.fixed[i] else -state.values[i]
        if not excess <= PRIMAL_ACCEPTED and i != state.alpha_row:
            return False
    return True


cdef bint dual_feasible(State *state) noexcept nogil:
    cdef Py_ssize_t j
    cdef double least = -DUAL_TOLERANCE * state.speed
    for j in range(state.columns):
        if not state.reduced_costs[j] >= least:
            return False
    return True


cdef bint proves_infeasible(State *state) noexcept nogil:
    """Say whether `state.ray` is a fall: no alpha and no forces balance the weights (Farkas)."""
    cdef Py_ssize_t i
    cdef double largest = 0.0, closes = 0.0, work = 0.0, fall = 0.0
    for i in range(state.size):
        largest = max(largest, fabs(state.ray[i]))
        work += state.live[i] * state.ray[i]
        fall -= state.rhs[i] * state.ray[i]
    price(state, state.ray, state.opened, 0)
    for i in range(state.columns):
        if state.open[i]:
            closes = max(closes, -state.opened[i])
    closes = max(closes, fabs(work))
    return closes <= RAY_TOLERANCE * largest and fall > closes


cdef void write_basis_matrix(State *state, double *matrix) noexcept nogil:
    cdef Py_ssize_t[6] rows
    cdef double[6] entries
    cdef Py_ssize_t i, column, count, size = state.size
    memset(matrix, 0, size * size * sizeof(double))
    for column in range(size):
        if state.basic[column] == ALPHA:
            for i in range(size):
                matrix[i * size + column] = state.live[i]
        else:
            count = entries_of(state, state.basic[column], rows, entries)
            for i in range(count):
                matrix[rows[i] * size + column] = entries[i]


cdef void write_values(State *state, const double *cols, double *out) noexcept nogil:
    """Write the inverse, given by its columns, times the right-hand side."""
    cdef Py_ssize_t i, j, size = state.size
    memset(out, 0, size * sizeof(double))
    for i in range(size):
        if state.rhs[i] != 0.0:
            for j in range(size):
                out[j] += state.rhs[i] * cols[i * size + j]


cdef bint reinvert(State *state) noexcept nogil:
    """Invert the basis from scratch, once; False when it is singular or was inverted before."""
    cdef Py_ssize_t size = state.size
    cdef double *cols
    if state.reinverted:
        return False
    state.anew = <double *>malloc((2 * size * size + size) * sizeof(double))
    if state.anew == NULL:
        return False
    cols = state.anew + size * size
    write_basis_matrix(state, state.anew)
    if not invert(state.anew, size, state.pivot_column, state.listed):
        free(state.anew)
        state.anew = NULL
        return False
    state.reinverted = True
    state.restarts += 1
    transpose(state.anew, cols, size)
    write_values(state, cols, cols + size * size)
    state.inverse.rows = state.anew
    state.inverse.cols = cols
    state.inverse.values = cols + size * size
    state.inverse.old = size
    state.inverse.new = 0
    state.inverse.alpha_row = state.alpha_row
    border(&state.inverse)
    return True


# ---- Tableau of the new bodies: phases 1 and 2 of the primal simplex method ----------------------

cdef enum:
    SMALL_OPTIMAL = 0
    SMALL_INFEASIBLE = 1
    SMALL_UNBOUNDED = 2
    SMALL_FAILED = 3

cdef double SMALL_DUAL_TOLERANCE = 1e-11
cdef double SMALL_PRIMAL_TOLERANCE = 1e-9
cdef double TABLEAU_PIVOT = 1e-9
cdef double ARTIFICIAL_PIVOT = 1e-7
cdef double SMALL_PERTURBATION = 1e-6


cdef int solve_small(
    double *tableau, Py_ssize_t rows, Py_ssize_t count, int *basic, double *ray, double *lift
) noexcept nogil:
    """Minimise costs . x for columns x = rhs, x >= 0, of which `ray` is a certificate if empty.

    The tableau has a line for each row: columns, room for artificial variables, right-hand side;
    then one for the costs of phase 1, and one for those of phase 2.  Lines are `count + rows + 1`
    long.  To be filled in are columns, right-hand side and costs of phase 2; the last line ends as
    the reduced costs.  `lift` is scratch for `count` numbers.
    """
    cdef Py_ssize_t i, j, width = count + rows + 1
    cdef double *line
    cdef double *phase1 = tableau + rows * width
    cdef double flip
    cdef int status
    # A little of every column on the right-hand side: no ties, and no solution is lost by it.
    perturbation(SMALL_SEED, count, lift)
    for j in range(width):
        phase1[j] = 0.0
    for j in range(count):
        lift[j] = SMALL_PERTURBATION * (0.5 + lift[j])
    for i in range(rows):
        line = tableau + i * width
        for j in range(count):
            line[width - 1] += lift[j] * line[j]
        flip = -1.0 if line[width - 1] < 0.0 else 1.0
        for j in range(count, width - 1):
            line[j] = 0.0
        for j in range(width):
            line[j] *= flip
        line[count + i] = 1.0
        ray[i], basic[i] = flip, <int>count
    for i in range(rows):
        line = tableau + i * width
        for j in range(count):
            phase1[j] -= line[j]
        phase1[width - 1] -= line[width - 1]
    for j in range(count, width):
        phase1[width + j] = 0.0
    status = two_phases(tableau, rows, count, basic)
    if status == SMALL_OPTIMAL and -phase1[width - 1] > SMALL_PRIMAL_TOLERANCE:
        status = SMALL_INFEASIBLE
    # Artificial variables cost 1 each, so their reduced costs are 1 - y.
    for i in range(rows):
        ray[i] = (phase1[count + i] - 1.0) * ray[i]
    return status


cdef int two_phases(
    double *tableau, Py_ssize_t rows, Py_ssize_t count, int *basic
) noexcept nogil:
    """Pivot by Dantzig's rule, after a while by Bland's, until no column improves the costs."""
    cdef Py_ssize_t step, row, column, patience = 20 + 10 * rows, width = count + rows + 1
    for step in range(6 * patience):
        column = tableau_column(tableau + rows * width, width, count, step > patience)
        if column < 0:
            return SMALL_OPTIMAL
        row = tableau_row(tableau, rows, count, column, basic)
        if row < 0:
            return SMALL_UNBOUNDED
        tableau_pivot(tableau, rows + 2, width, row, column)
        basic[row] = <int>column
    return SMALL_FAILED


cdef Py_ssize_t tableau_column(
    const double *phase1, Py_ssize_t width, Py_ssize_t count, bint bland
) noexcept nogil:
    """Return the column that enters, in phase 2 once phase 1 has ended at 0; -1 if none does."""
    cdef Py_ssize_t j, best = -1
    cdef const double *phase2 = phase1 + width
    cdef double tolerance = SMALL_DUAL_TOLERANCE
    for j in range(count):
        if phase1[j] < -tolerance and (best < 0 or (not bland and phase1[j] < phase1[best])):
            best = j
    if best >= 0 or -phase1[width - 1] > SMALL_PRIMAL_TOLERANCE:
        return best
    for j in range(count):
        if phase1[j] <= tolerance and phase2[j] < -tolerance:
            if best < 0 or (not bland and phase2[j] < phase2[best]):
                best = j
    return best


cdef Py_ssize_t tableau_row(
    const double *tableau, Py_ssize_t rows, Py_ssize_t count, Py_ssize_t column,
    const int *basic
) noexcept nogil:
    """Return the row that leaves, the largest pivot among equals; -1 if none does.

    Artificial variables that are 0 go first: in phase 2 they must not grow again.
    """
    cdef Py_ssize_t i, best = -1, width = count + rows + 1
    cdef double pivot, ratio, most = 0.0, least = 0.0
    cdef bint bounded = False
    for i in range(rows):
        pivot = fabs(tableau[i * width + column])
        if basic[i] == count and tableau[i * width + width - 1] <= SMALL_PRIMAL_TOLERANCE:
            if pivot > ARTIFICIAL_PIVOT and pivot > most:
                most = pivot
                best = i
    if best >= 0:
        return best
    for i in range(rows):
        pivot = tableau[i * width + column]
        if pivot > TABLEAU_PIVOT:
            ratio = (max(0.0, tableau[i * width + width - 1]) + 1e-12) / pivot
            if not bounded or ratio < least:
                bounded, least = True, ratio
    for i in range(rows):
        pivot = tableau[i * width + column]
        if pivot > TABLEAU_PIVOT:
            if not max(0.0, tableau[i * width + width - 1]) <= least * pivot:
                pivot = 0.0
            if best < 0 or pivot > most:
                best, most = i, pivot
    return best


cdef void tableau_pivot(
    double *tableau, Py_ssize_t rows, Py_ssize_t width, Py_ssize_t row, Py_ssize_t column
) noexcept nogil:
    cdef Py_ssize_t i, j
    cdef double factor
    cdef double *line = tableau + row * width
    cdef double *other
    factor = line[column]
    for j in range(width):
        line[j] /= factor
    for i in range(rows):
        other = tableau + i * width
        factor = other[column]
        if i != row and factor != 0.0:
            for j in range(width):
                other[j] -= factor * line[j]


# ---- Start ---------------------------------------------------------------------------------------

cdef int start(State *state) noexcept nogil:
    """Find a dual feasible basis: that of the wall, and that of the new bodies on it.

    Where there is none, reduced costs below 0 are left for the phases to deal with.
    """
    cdef int found
    cdef Py_ssize_t count
    reset(state)
    if state.size == 0:
        return FAILED
    price_new_columns(state)
    if state.size == state.inverse.old:
        return UNFINISHED
    found = solve_new_bodies(state, &count)
    if found == SMALL_INFEASIBLE:
        extend_ray(state)
        if proves_infeasible(state):
            return UNSTABLE
    if found == SMALL_OPTIMAL and adopt_small_basis(state, count):
        return UNFINISHED
    if state.inverse.old == 0:
        return FAILED
    state.restarts += 1
    reset(state)
    price_new_columns(state)
    return UNFINISHED


cdef void price_new_columns(State *state) noexcept nogil:
    """Drive closed columns out of the basis, then price new columns by the wall's velocities."""
    if state.inverse.old == 0:
        memset(state.velocity, 0, state.size * sizeof(double))
        return
    if state.closed_count:
        drive_out_closed(state)
    inverse_row(&state.inverse, state.alpha_row, state.velocity)
    price(state, state.velocity, state.reduced_costs, state.old.count)


cdef void drive_out_closed(State *state) noexcept nogil:
    """Replace closed columns by others of the wall, or by an artificial variable."""
    cdef Py_ssize_t i, row, number, artificial
    cdef double one = 1.0, sign
    for row in range(state.inverse.old):
        if state.basic[row] < 0 or not state.fixed[row]:
            continue
        compute_pivot_row(state, row)
        sign = 1.0 if state.values[row] > 0.0 else -1.0
        number = dual_ratio_test(state, sign, state.old.count, LARGE_PIVOT)
        if number >= 0:
            # New columns have no reduced costs yet.
            for i in range(state.old.count, state.columns):
                state.pivot_row[i] = 0.0
            compute_pivot_column(state, number)
            dual_pivot_on(state, row, number)
            continue
        artificial = 0
        for i in range(state.inverse.old):
            if fabs(state.inverse_row[i]) > fabs(state.inverse_row[artificial]):
                artificial = i
        ftran(&state.inverse, &artificial, &one, 1, state.pivot_column)
        pivot_on(state, row, ARTIFICIAL - artificial)


cdef int solve_new_bodies(State *state, Py_ssize_t *count) noexcept nogil:
    """Solve for the forces on the new bodies, with alpha eliminated; write how many columns.

    On a wall alpha is eliminated by the row in which it is basic: a column costs what it takes
    from alpha, and one more column takes 1 from alpha and does nothing else.  Without a wall it is
    eliminated by the first row.
    """
    cdef Py_ssize_t i, j, q, row, old = state.inverse.old, new = state.size - old
    cdef Py_ssize_t columns = state.new.count, first = 0 if old else 1
    cdef Py_ssize_t width = columns + (2 if old else 0) + new
    cdef double *tableau = state.tableau
    # Without a wall: the row that is eliminated.
    cdef double *costs = state.reduced_costs + state.old.count if old else tableau
    cdef double *last = tableau + (new + 1) * width
    memset(tableau, 0, width * (new + 2) * sizeof(double))
    for j in range(columns):
        for q in range(6):
            row = (state.new.first[j] + q if q < 3 else state.new.second[j] + q - 3) - 3 - old
            if row >= 0:
                tableau[row * width + j] = state.new.entries[q * columns + j]
    if not old:
        for j in range(columns):
            costs[j] /= state.live[0]
    for i in range(3 * first, new, 3):
        for j in range(columns):
            tableau[i * width + j] -= state.live[old + i] * costs[j]
    for i in range(first, new):
        if old:
            tableau[i * width + columns] = -state.live[old + i]
        tableau[i * width + width - 1] = state.values[old + i]
    memcpy(last, costs, columns * sizeof(double))
    if old:
        last[columns] = 1.0
    count[0] = columns + 1 - first
    return solve_small(
        tableau + first * width, new - first, count[0], state.small_basic, state.small_ray,
        state.small_ray + new,
    )


cdef void extend_ray(State *state) noexcept nogil:
    """Extend a fall of the new bodies to the wall, so that the live load does no work on it."""
    cdef Py_ssize_t i, old = state.inverse.old, first = old if old else 1
    cdef double work = 0.0
    memcpy(state.ray + first, state.small_ray, (state.size - first) * sizeof(double))
    for i in range(first, state.size):
        work += state.live[i] * state.ray[i]
    if not old:
        state.ray[0] = -work / state.live[0]
    for i in range(old):
        state.ray[i] = -work * state.velocity[i]


cdef bint adopt_small_basis(State *state, Py_ssize_t count) noexcept nogil:
    """Replace the artificial variables by the basis of the small program."""
    cdef Py_ssize_t i, j, variable, old = state.inverse.old, columns = state.new.count
    cdef Py_ssize_t rows = state.size - old - (old == 0)
    cdef const double *costs = state.tableau + (state.size - old + 1) * (count + rows + 1)
    cdef bint wall_rests = False
    if old == 0:
        memcpy(state.pivot_column, state.live, state.size * sizeof(double))
        apply_eta(&state.inverse, state.pivot_column)
        state.alpha_row = replace_artificial(state, ALPHA)
        if state.alpha_row < 0:
            return False
    for i in range(rows):
        variable = state.small_basic[i]
        if variable < columns:
            compute_pivot_column(state, state.old.count + variable)
            if replace_artificial(state, state.old.count + variable) < 0:
                return False
        elif old and variable == columns:
            wall_rests = True
    if wall_rests:
        if not adopt_wall_column(state):
            return False
    elif old:
        for j in range(state.old.count):
            state.reduced_costs[j] *= costs[columns]
    memcpy(state.reduced_costs + state.old.count, costs, columns * sizeof(double))
    for i in range(state.size):
        if state.basic[i] >= 0:
            state.reduced_costs[state.basic[i]] = state.secondary_costs[state.basic[i]] = 0.0
    return True


cdef bint adopt_wall_column(State *state) noexcept nogil:
    """Let a column of the wall replace the last one: the new bodies move and the wall rests."""
    cdef Py_ssize_t j, number, old = state.old.count
    cdef double step
    for j in range(old):
        state.pivot_row[j] = state.reduced_costs[j] if state.open[j] else 0.0
    memset(state.reduced_costs, 0, old * sizeof(double))
    number = dual_ratio_test(state, 1.0, old, LARGE_PIVOT)
    if number < 0:
        return False
    compute_pivot_column(state, number)
    if replace_artificial(state, number) < 0:
        return False
    step = max(state.secondary_costs[number], 0.0) / state.pivot_row[number]
    for j in range(old):
        state.secondary_costs[j] -= step * state.pivot_row[j]
    return True


cdef Py_ssize_t replace_artificial(State *state, Py_ssize_t variable) noexcept nogil:
    """Let a variable enter for the artificial one of the largest pivot; return its row, or -1."""
    cdef Py_ssize_t i, row = -1
    cdef double size, largest = ARTIFICIAL_PIVOT
    for i in range(state.inverse.old, state.size):
        size = fabs(state.pivot_column[i])
        if state.fixed[i] and size > largest:
            largest = size
            row = i
    if row >= 0:
        pivot_on(state, row, variable)
    return row


# ---- Phases --------------------------------------------------------------------------------------

cdef int solve(State *state, int max_pivots) noexcept nogil:
    """Run to the end and return the status."""
    cdef int turn, status = start(state)
    for turn in range(ROUNDS):
        if status != UNFINISHED:
            break
        status = solve_round(state, max_pivots)
        if status == INACCURATE:
            if reinvert(state) and compute_basic_values(state) and compute_reduced_costs(state):
                status = UNFINISHED
            else:
                status = FAILED
    return FAILED if status == UNFINISHED else status


cdef int solve_round(State *state, int max_pivots) noexcept nogil:
    """Make the basis primal feasible, then dual feasible; it is optimal if it is both at once."""
    cdef int status = parametric_phase(state, max_pivots)
    if status != UNFINISHED:
        return status
    if not (compute_basic_values(state) and compute_reduced_costs(state)):
        return INACCURATE
    state.pivot = SMALL_PIVOT
    if not primal_feasible(state):
        return UNFINISHED
    if dual_feasible(state):
        return OPTIMAL
    return primal_phase(state, max_pivots)


cdef void set_direction(State *state) noexcept nogil:
    """Let the basic values at the parameter 1 be feasible: the last feasible ones, perturbed."""
    cdef Py_ssize_t i
    perturbation(VALUE_SEED, state.size, state.direction)
    for i in range(state.size):
        if state.fixed[i]:
            state.direction[i] = -state.values[i]
        else:
            state.direction[i] = (
                max(state.feasible[i], 0.0) + PERTURBATION * (0.1 + state.direction[i])
            ) - state.values[i]
    state.direction[state.alpha_row] = 0.0


cdef int parametric_phase(State *state, int max_pivots) noexcept nogil:
    """Let the parameter of the right-hand side go from 1 to 0, by dual pivots.

    Negative reduced costs count as 0.  That shifts costs, which :func:`primal_phase` puts right.
    """
    cdef Py_ssize_t j, row, number
    cdef double sign, element
    set_direction(state)
    for j in range(state.columns):
        state.reduced_costs[j] = max(state.reduced_costs[j], 0.0)
    while True:
        row = leaving_row(state)
        if row < 0:
            memcpy(state.feasible, state.values, state.size * sizeof(double))
            return UNFINISHED
        if state.pivots >= max_pivots:
            return FAILED
        compute_pivot_row(state, row)
        sign = 1.0 if state.values[row] > 0.0 else -1.0
        number = dual_ratio_test(state, sign, state.columns, LARGE_PIVOT)
        if number < 0:
            # Dual unbounded: the row is a ray along which nothing closes.
            for j in range(state.size):
                state.ray[j] = -sign * state.inverse_row[j]
            if proves_infeasible(state):
                return UNSTABLE
            number = dual_ratio_test(state, sign, state.columns, SMALL_PIVOT)
        if number < 0:
            return INACCURATE
        compute_pivot_column(state, number)
        element = state.pivot_row[number]
        if not fabs(state.pivot_column[row] - element) <= PIVOT_ERROR * (1.0 + fabs(element)):
            return INACCURATE
        dual_pivot_on(state, row, number)


cdef int primal_phase(State *state, int max_pivots) noexcept nogil:
    """Let columns of negative reduced cost enter, by Dantzig's rule, until there are none."""
    cdef Py_ssize_t i, row, number
    cdef double step
    cdef double *secondary = state.secondary_values
    perturbation(VALUE_SEED, state.size, secondary)
    for i in range(state.size):
        secondary[i] = 0.5 + secondary[i]
    while not dual_feasible(state):
        if state.pivots >= max_pivots:
            return FAILED
        number = 0
        for i in range(1, state.columns):
            if state.reduced_costs[i] < state.reduced_costs[number]:
                number = i
        compute_pivot_column(state, number)
        row = primal_ratio_test(state)
        if row < 0:
            return FAILED
        step = max(secondary[row], 0.0) / state.pivot_column[row]
        for i in range(state.size):
            secondary[i] -= step * state.pivot_column[i]
        secondary[row] = step
        pivot_on(state, row, number)
        if not compute_reduced_costs(state):
            return INACCURATE
    memcpy(state.feasible, state.values, state.size * sizeof(double))
    return UNFINISHED


# ---- What is written out -------------------------------------------------------------------------

cdef void write_forces(State *state, double unit, double *forces) noexcept nogil:
    """Write the forces of the open columns."""
    cdef Py_ssize_t i, j, kept = 0
    memset(state.pivot_row, 0, state.columns * sizeof(double))
    for i in range(state.size):
        if state.basic[i] >= 0:
            state.pivot_row[state.basic[i]] = state.values[i] * unit
    for j in range(state.columns):
        if state.open[j]:
            forces[kept] = state.pivot_row[j]
            kept += 1


cdef void write_inverse(State *state, double *rows, double *cols) noexcept nogil:
    """Write the inverse and its transpose, made anew if eta columns have cost it digits."""
    cdef Py_ssize_t i, size = state.size
    cdef double *anew = state.inverse.eta  # which is not needed any more
    for i in range(size):
        inverse_row(&state.inverse, i, rows + i * size)
    transpose(rows, cols, size)
    if inverse_error(state, cols) <= INVERSE_ERROR:
        return
    write_basis_matrix(state, anew)
    if invert(anew, size, state.pivot_column, state.listed):
        memcpy(rows, anew, size * size * sizeof(double))
        transpose(rows, cols, size)


cdef double inverse_error(State *state, const double *cols) noexcept nogil:
    """Return how far the inverse, given by its columns, times the basis is from 1."""
    cdef Py_ssize_t[6] rows
    cdef double[6] entries
    cdef Py_ssize_t i, column, count, size = state.size
    cdef double *product = state.pivot_column
    cdef double *factors = state.inverse.factors
    cdef const double **lines = state.inverse.lines
    cdef double largest = 0.0
    for column in range(size):
        if state.basic[column] == ALPHA:
            count = size // 3
            for i in range(count):
                factors[i] = state.live[3 * i]
                lines[i] = cols + 3 * i * size
        else:
            count = entries_of(state, state.basic[column], rows, entries)
            for i in range(count):
                factors[i] = entries[i]
                lines[i] = cols + rows[i] * size
        memset(product, 0, size * sizeof(double))
        add_lines(product, size, factors, lines, count)
        product[column] -= 1.0
        for i in range(size):
            largest = max(largest, fabs(product[i]))
    return largest


cdef void write_rest(
    State *state, const double *rows, int *basic, double *reduced_costs,
    double *secondary_costs
) noexcept nogil:
    """Write what is basic, reduced costs, and secondary ones that begin anew."""
    cdef Py_ssize_t i, j, kept = 0
    price(state, rows + state.alpha_row * state.size, state.pivot_row, 0)
    clear_basic(state, state.pivot_row)
    perturbation(0, state.columns - state.closed_count, secondary_costs)
    for j in range(state.columns):
        if state.open[j]:
            reduced_costs[kept] = max(state.pivot_row[j], 0.0)
            secondary_costs[kept] = 1.0 + secondary_costs[kept]
            # From now on: the number of the column among those that are left.
            state.listed[j] = <int>kept
            kept += 1
    for i in range(state.size):
        basic[i] = state.basic[i]
        if state.basic[i] >= 0:
            basic[i] = state.listed[state.basic[i]]
            secondary_costs[basic[i]] = 0.0


# ---- What Python sees ----------------------------------------------------------------------------

cdef class Program:
    """The program of a wall with its optimal basis, and scratch memory for those who ask.

    Parameters
    ----------
    optimum : Optimum
        Its arrays are read, and kept.
    """

    cdef State blank
    cdef double unit
    cdef int sign
    cdef Py_ssize_t bodies
    cdef const double *weights
    cdef tuple kept
    cdef list spare

    def __init__(self, optimum):
        basis, cones = optimum.basis, optimum.cones
        first, second = 3 * cones.first + 3, 3 * cones.second + 3
        self.kept = (optimum.weights, basis, cones, first, second)
        self.weights, self.bodies = doubles(optimum.weights), len(optimum.weights)
        self.unit = basis.unit
        self.sign = optimum.sign
        self.spare = []
        memset(&self.blank, 0, sizeof(State))
        self.blank.wall_basic = ints(basis.basic)
        self.blank.wall_reduced_costs = doubles(basis.reduced_costs)
        self.blank.wall_secondary_costs = doubles(basis.secondary_costs)
        self.blank.inverse.old, self.blank.inverse.alpha_row = len(basis.basic), basis.alpha_row
        self.blank.inverse.rows = doubles(basis.inverse)
        self.blank.inverse.cols = doubles(basis.transposed)
        self.blank.inverse.values = doubles(basis.values)
        self.blank.old = Columns(len(first), ints(first), ints(second), doubles(cones.entries))

    def solve_added(self, added, int max_pivots):
        """Return the fields of an `Answer`."""
        cdef State state
        cdef double unit = self.unit_with(added.weights)
        cdef bytearray scratch = self.opened(&state, added, unit)
        cdef int status
        cdef Py_ssize_t i
        cdef double *written
        with nogil:
            status = solve(&state, max_pivots)
            free(state.anew)
        alpha, forces, velocity = np.nan, np.empty(0), np.empty(0)
        if status == OPTIMAL:
            alpha = self.sign * state.values[state.alpha_row]
            forces = np.empty(state.columns - state.closed_count)
            write_forces(&state, unit, doubles_out(forces))
        if status == OPTIMAL or status == UNSTABLE:
            velocity = np.empty(state.size)
            written = doubles_out(velocity)
            for i in range(state.size):
                written[i] = state.velocity[i] / unit if status == OPTIMAL else state.ray[i]
        self.spare.append(scratch)
        return status, alpha, forces, velocity, state.pivots, state.restarts

    def basis_with(self, added, int max_pivots):
        """Return the fields of the `Basis` of the wall with the stone."""
        cdef State state
        cdef double unit = self.unit_with(added.weights)
        cdef bytearray scratch = self.opened(&state, added, unit)
        cdef Py_ssize_t left = state.columns - state.closed_count
        basic, values = np.empty(state.size, np.int32), np.empty(state.size)
        inverse = np.empty((state.size, state.size))
        transposed = np.empty((state.size, state.size))
        reduced_costs, secondary_costs = np.empty(left), np.empty(left)
        cdef int *basic_out = ints_out(basic)
        cdef double *values_out = doubles_out(values)
        cdef double *reduced_out = doubles_out(reduced_costs)
        cdef double *secondary_out = doubles_out(secondary_costs)
        cdef double *rows_out = doubles_out(inverse)
        cdef double *cols_out = doubles_out(transposed)
        with nogil:
            solve(&state, max_pivots)
            write_inverse(&state, rows_out, cols_out)
            write_values(&state, cols_out, values_out)
            write_rest(&state, rows_out, basic_out, reduced_out, secondary_out)
            free(state.anew)
        self.spare.append(scratch)
        return (
            unit, state.alpha_row, basic, values, inverse, transposed, reduced_costs,
            secondary_costs,
        )

    cdef double unit_with(self, weights) except -1.0:
        """Return the unit of forces: about the weight of the first stone."""
        cdef int exponent = 0
        if self.bodies or len(weights) == 0:
            return self.unit
        frexp(doubles(weights)[0], &exponent)
        return ldexp(1.0, exponent)

    cdef bytearray opened(self, State *state, added, double unit):
        """Take memory and write the program into it; the caller gives the memory back."""
        cones = added.cones
        cdef const double *weights = doubles(added.weights)
        cdef c_int first = ints(cones.first)
        cdef c_int second = ints(cones.second)
        cdef c_int closed = ints(added.closed)
        cdef Py_ssize_t i, count = len(cones.first), size = self.bodies + len(added.weights)
        cdef bytearray scratch = None
        if len(cones.second) != count or cones.entries.shape != (6, count):
            raise ValueError("the arrays of the columns have different lengths")
        state[0] = self.blank
        state.pivot = LARGE_PIVOT
        state.new.count = count
        state.columns = state.old.count + count
        state.size = 3 * size
        if self.spare:
            scratch = self.spare.pop()
        if scratch is None or PyByteArray_GET_SIZE(scratch) < lay_out(state, NULL, 0):
            # With some room for columns, as not all stones touch equally many.
            scratch = PyByteArray_FromStringAndSize(NULL, lay_out(state, NULL, 32))
        lay_out(state, PyByteArray_AS_STRING(scratch), 0)
        state.new.first = state.new_first
        state.new.second = state.new_second
        state.new.entries = doubles(cones.entries)
        state.closed = closed
        state.closed_count = len(added.closed)
        memset(state.open, 1, state.columns)
        for i in range(state.closed_count):
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
