"""Linear programs in three unknowns with few to some hundred rows (Seidel's algorithm).

Rows are taken one after the other, in an order that looks random and is always the same.  While
the optimum so far fulfils the next row nothing happens; otherwise the new optimum lies on that
row, which leaves a program in one unknown fewer.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import doubles

ENOUGH = cython.declare(cython.double, 1e-11)
FLAT = cython.declare(cython.double, 1e-11)
PARALLEL = cython.declare(cython.double, 1e-13)
EMPTY = cython.declare(cython.double, 1e-9)
NOTHING = cython.declare(cython.double, 1e-12)

# Of a linear congruential generator of 64 bits.
FACTOR = cython.declare(cython.ulonglong, 6364136223846793005)
STEP = cython.declare(cython.ulonglong, 1442695040888963407)


def solve(
    rows: NDArray[np.float64], gain: NDArray[np.float64], most: NDArray[np.float64]
) -> tuple[float, float, float] | None:
    """Maximise a gain; None when nothing fulfils all rows.  Kernels ask :func:`solve3`.

    Rows (n, 4) are coefficients, one of them about 1, and what their sum may be at most.  A gain
    below 1e-12 counts as none, and the smallest value is taken.  `most` are the largest absolute
    values.
    """
    shuffled, scratch = np.array(rows), np.empty(3 * len(rows) + 6)
    x: cython.double[3] = [0.0, 0.0, 0.0]
    found: cython.bint = solve3(
        doubles(shuffled), len(rows), doubles(gain), doubles(most), doubles(scratch), x
    )
    return (x[0], x[1], x[2]) if found else None


def solve3(rows, count, gain, most, scratch, x):
    """Maximise gain . x over rows (a, b) with a . x <= b, and |x| <= most.

    The rows, of four numbers, are shuffled; each has a coefficient that is not near 0.  The scratch
    has room for three numbers of each and six more.
    """
    state: cython.ulonglong = 88172645463325252
    gain2: cython.double[2] = [0.0, 0.0]
    most2: cython.double[2] = [0.0, 0.0]
    y: cython.double[2] = [0.0, 0.0]
    for i in range(count - 1, 0, -1):
        state = state * FACTOR + STEP
        if not cython.compiled:
            state &= 2**64 - 1
        j = (state >> 33) % (i + 1)
        for k in range(4):
            b0 = rows[4 * i + k]
            rows[4 * i + k] = rows[4 * j + k]
            rows[4 * j + k] = b0
    for j in range(3):
        x[j] = outermost(gain[j], most[j])
    for i in range(count):
        k = 4 * i
        if rows[k] * x[0] + rows[k + 1] * x[1] + rows[k + 2] * x[2] <= rows[k + 3] + ENOUGH:
            continue
        # The optimum lies on this row: one unknown fewer, by what the row says of it.
        e = 0
        for j in range(1, 3):
            if abs(rows[k + j]) > abs(rows[k + e]):
                e = j
        f, g = (e + 1) % 3, (e + 2) % 3
        kf, kg = -rows[k + f] / rows[k + e], -rows[k + g] / rows[k + e]
        b0 = rows[k + 3] / rows[k + e]
        scratch[0], scratch[1], scratch[2] = kf, kg, most[e] - b0
        scratch[3], scratch[4], scratch[5] = -kf, -kg, most[e] + b0
        for j in range(i):
            k = 4 * j
            scratch[3 * j + 6] = rows[k + f] + rows[k + e] * kf
            scratch[3 * j + 7] = rows[k + g] + rows[k + e] * kg
            scratch[3 * j + 8] = rows[k + 3] - rows[k + e] * b0
        gain2[0], gain2[1] = gain[f] + gain[e] * kf, gain[g] + gain[e] * kg
        most2[0], most2[1] = most[f], most[g]
        if not solve2(scratch, i + 2, gain2, most2, y):
            return False
        x[f], x[g] = y[0], y[1]
        x[e] = b0 + kf * y[0] + kg * y[1]
    return True


def solve2(rows, count, gain, most, x):
    """Maximise gain . x over rows (a, b) with a . x <= b, and |x| <= most, in two unknowns."""
    between: cython.double[2] = [0.0, 0.0]
    for j in range(2):
        x[j] = outermost(gain[j], most[j])
    for i in range(count):
        if rows[3 * i] * x[0] + rows[3 * i + 1] * x[1] <= rows[3 * i + 2] + ENOUGH:
            continue
        e = 0 if abs(rows[3 * i]) > abs(rows[3 * i + 1]) else 1
        f = 1 - e
        if abs(rows[3 * i + e]) < FLAT:
            if rows[3 * i + 2] < -EMPTY:
                return False
            continue
        k, b0 = -rows[3 * i + f] / rows[3 * i + e], rows[3 * i + 2] / rows[3 * i + e]
        between[0], between[1] = -most[f], most[f]
        if not (cut(k, most[e] - b0, between) and cut(-k, most[e] + b0, between)):
            return False
        for j in range(0, 3 * i, 3):
            if not cut(rows[j + f] + rows[j + e] * k, rows[j + 2] - rows[j + e] * b0, between):
                return False
        if between[0] > between[1]:
            if between[0] > between[1] + EMPTY:
                return False
            between[0] = between[1] = (between[0] + between[1]) / 2.0
        z = gain[f] + gain[e] * k
        # Where nothing is gained the smallest move is made.
        if z > NOTHING:
            z = between[1]
        elif z < -NOTHING or between[0] > 0.0:
            z = between[0]
        else:
            z = between[1] if between[1] < 0.0 else 0.0
        x[f] = z
        x[e] = b0 + k * z
    return True


@cython.cfunc
@cython.nogil
@cython.inline
@cython.exceptval(check=False)
def outermost(gain: cython.double, most: cython.double) -> cython.double:
    """Return the best value in [-most, most]."""
    if gain > NOTHING:
        return most
    return -most if gain < -NOTHING else 0.0


@cython.cfunc
@cython.nogil
@cython.inline
@cython.exceptval(check=False)
def cut(a: cython.double, b: cython.double, between: cython.p_double) -> cython.bint:
    """Narrow an interval by a x <= b; False when no x fulfils that."""
    if abs(a) < PARALLEL:
        return b >= -EMPTY
    v = b / a
    if a > 0.0:
        between[1] = min(between[1], v)
    elif v > between[0]:
        between[0] = v
    return True
