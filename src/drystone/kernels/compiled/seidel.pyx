# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.seidel`."""

from libc.math cimport fabs
from libc.stdint cimport uint64_t
from libc.stdlib cimport free, malloc

cdef double ENOUGH = 1e-11
cdef double FLAT = 1e-11
cdef double PARALLEL = 1e-13
cdef double EMPTY = 1e-9
cdef double NOTHING = 1e-12


def solve(const double[:, ::1] rows, const double[::1] gain, const double[::1] most):
    """Return what `solve_python` returns; the arrays have the right shapes."""
    cdef Py_ssize_t i, count = rows.shape[0]
    cdef double x[3]
    cdef bint found
    cdef Row3 *packed = <Row3 *>malloc(max(1, count) * sizeof(Row3))
    cdef Row2 *scratch = <Row2 *>malloc((count + 2) * sizeof(Row2))
    if packed == NULL or scratch == NULL:
        free(packed)
        free(scratch)
        raise MemoryError
    for i in range(count):
        packed[i].a[0], packed[i].a[1], packed[i].a[2] = rows[i, 0], rows[i, 1], rows[i, 2]
        packed[i].b = rows[i, 3]
    found = solve3(packed, count, &gain[0], &most[0], scratch, x)
    free(packed)
    free(scratch)
    return (x[0], x[1], x[2]) if found else None


cdef bint solve3(
    Row3 *rows, Py_ssize_t count, const double *gain, const double *most, Row2 *scratch, double *x
) noexcept nogil:
    """Maximise gain . x over a . x <= b and |x| <= most; the rows are shuffled."""
    cdef uint64_t state = 88172645463325252
    cdef Py_ssize_t i, j, e, f, g
    cdef Row3 swap
    cdef double kf, kg, b0
    cdef double gain2[2]
    cdef double most2[2]
    cdef double y[2]
    for i in range(count - 1, 0, -1):
        state = state * <uint64_t>6364136223846793005 + <uint64_t>1442695040888963407
        j = <Py_ssize_t>((state >> 33) % <uint64_t>(i + 1))
        swap = rows[i]
        rows[i] = rows[j]
        rows[j] = swap
    for j in range(3):
        x[j] = most[j] if gain[j] > NOTHING else (-most[j] if gain[j] < -NOTHING else 0.0)
    for i in range(count):
        if rows[i].a[0] * x[0] + rows[i].a[1] * x[1] + rows[i].a[2] * x[2] <= rows[i].b + ENOUGH:
            continue
        # The optimum lies on this row: one unknown fewer, by what the row says of it.
        e = 0
        for j in range(1, 3):
            if fabs(rows[i].a[j]) > fabs(rows[i].a[e]):
                e = j
        if fabs(rows[i].a[e]) < FLAT:
            if rows[i].b < -EMPTY:
                return False
            continue
        f, g = (e + 1) % 3, (e + 2) % 3
        kf, kg = -rows[i].a[f] / rows[i].a[e], -rows[i].a[g] / rows[i].a[e]
        b0 = rows[i].b / rows[i].a[e]
        scratch[0].a[0], scratch[0].a[1], scratch[0].b = kf, kg, most[e] - b0
        scratch[1].a[0], scratch[1].a[1], scratch[1].b = -kf, -kg, most[e] + b0
        for j in range(i):
            scratch[j + 2].a[0] = rows[j].a[f] + rows[j].a[e] * kf
            scratch[j + 2].a[1] = rows[j].a[g] + rows[j].a[e] * kg
            scratch[j + 2].b = rows[j].b - rows[j].a[e] * b0
        gain2[0], gain2[1] = gain[f] + gain[e] * kf, gain[g] + gain[e] * kg
        most2[0], most2[1] = most[f], most[g]
        if not solve2(scratch, i + 2, gain2, most2, y):
            return False
        x[f], x[g] = y[0], y[1]
        x[e] = b0 + kf * y[0] + kg * y[1]
    return True


cdef bint solve2(
    const Row2 *rows, Py_ssize_t count, const double *gain, const double *most, double *x
) noexcept nogil:
    """Maximise gain . x over a . x <= b and |x| <= most, in two unknowns."""
    cdef Py_ssize_t i, j, e, f
    cdef double k, b0, lo, hi, z
    for j in range(2):
        x[j] = most[j] if gain[j] > NOTHING else (-most[j] if gain[j] < -NOTHING else 0.0)
    for i in range(count):
        if rows[i].a[0] * x[0] + rows[i].a[1] * x[1] <= rows[i].b + ENOUGH:
            continue
        e = 0 if fabs(rows[i].a[0]) > fabs(rows[i].a[1]) else 1
        f = 1 - e
        if fabs(rows[i].a[e]) < FLAT:
            if rows[i].b < -EMPTY:
                return False
            continue
        k, b0 = -rows[i].a[f] / rows[i].a[e], rows[i].b / rows[i].a[e]
        lo, hi = -most[f], most[f]
        if not (cut(k, most[e] - b0, &lo, &hi) and cut(-k, most[e] + b0, &lo, &hi)):
            return False
        for j in range(i):
            if not cut(rows[j].a[f] + rows[j].a[e] * k, rows[j].b - rows[j].a[e] * b0, &lo, &hi):
                return False
        if lo > hi:
            if lo > hi + EMPTY:
                return False
            lo = hi = (lo + hi) / 2.0
        z = gain[f] + gain[e] * k
        # Where nothing is gained the smallest move is made.
        if z > NOTHING:
            z = hi
        elif z < -NOTHING:
            z = lo
        else:
            z = lo if lo > 0.0 else (hi if hi < 0.0 else 0.0)
        x[f] = z
        x[e] = b0 + k * z
    return True


cdef bint cut(double a, double b, double *lo, double *hi) noexcept nogil:
    """Take a x <= b into account; False when no x fulfils it."""
    cdef double v
    if fabs(a) < PARALLEL:
        return b >= -EMPTY
    v = b / a
    if a > 0.0:
        if v < hi[0]:
            hi[0] = v
    elif v > lo[0]:
        lo[0] = v
    return True
