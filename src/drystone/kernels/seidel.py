"""Linear programs in three unknowns with few to some hundred rows (Seidel's algorithm).

Rows are taken one after the other, in an order that looks random and is always the same.  While
the optimum so far fulfils the next row nothing happens; otherwise the new optimum lies on that
row, which leaves a program in one unknown fewer.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled

Floats = NDArray[np.float64]
Row = tuple[float, float, float, float]
"""The coefficients of the unknowns, and what their sum may be at most."""
Row2 = tuple[float, float, float]
Solution = tuple[float, float, float]

ENOUGH = 1e-11
FLAT = 1e-11
PARALLEL = 1e-13
EMPTY = 1e-9
NOTHING = 1e-12

_fast = compiled("seidel")


def solve(rows: Floats, gain: Floats, most: Floats) -> Solution | None:
    """Maximise a gain.

    Parameters
    ----------
    rows : (n, 4) float array
        Coefficients of the three unknowns, about 1 in size, and what their sum may be at most.
    gain : (3,) float array
        Gain of each unknown; below 1e-12 it counts as none, and the smallest value is taken.
    most : (3,) float array
        Largest absolute value of each unknown.

    Returns
    -------
    unknowns : (float, float, float) or None
        None when nothing fulfils all rows.

    Examples
    --------
    >>> solve(np.array([[0.0, -1.0, 0.0, 2.0]]), np.array([0.0, -1.0, 0.0]), np.full(3, 9.0))
    (0.0, -2.0, 0.0)
    """
    if rows.ndim != 2 or rows.shape[1] != 4 or len(gain) != 3 or len(most) != 3:
        raise ValueError("rows are (n, 4), gain and most have three numbers")
    if _fast is None:
        packed: list[Row] = [(a, b, c, d) for a, b, c, d in rows.tolist()]
        return solve_python(packed, gain.tolist(), most.tolist())
    found: Solution | None = _fast.solve(
        np.ascontiguousarray(rows), np.ascontiguousarray(gain), np.ascontiguousarray(most)
    )
    return found


def solve_python(
    rows: Sequence[Row], gain: Sequence[float], most: Sequence[float]
) -> Solution | None:
    """Twin of :func:`solve`, for lists."""
    x = [_outermost(g, m) for g, m in zip(gain, most, strict=True)]
    taken: list[Row] = []
    for i in order_of(len(rows)):
        row = rows[i]
        if not row[0] * x[0] + row[1] * x[1] + row[2] * x[2] <= row[3] + ENOUGH:
            # The optimum lies on this row: one unknown fewer, by what the row says of it.
            e = _largest(row)
            if abs(row[e]) < FLAT:
                if row[3] < -EMPTY:
                    return None
            elif not _on_row(row, e, taken, (gain, most), x):
                return None
        taken.append(row)
    return x[0], x[1], x[2]


@lru_cache(maxsize=1024)
def order_of(count: int) -> tuple[int, ...]:
    """Return the order in which rows are taken: shuffled, and always alike."""
    order = list(range(count))
    state = 88172645463325252
    for i in range(count - 1, 0, -1):
        state = (state * 6364136223846793005 + 1442695040888963407) & (2**64 - 1)
        j = (state >> 33) % (i + 1)
        order[i], order[j] = order[j], order[i]
    return tuple(order)


def _outermost(gain: float, most: float) -> float:
    """Return the best value in [-most, most]."""
    if gain > NOTHING:
        return most
    return -most if gain < -NOTHING else 0.0


def _largest(row: Row) -> int:
    """Return which unknown has the largest coefficient."""
    e = 0
    for j in (1, 2):
        if abs(row[j]) > abs(row[e]):
            e = j
    return e


def _on_row(
    row: Row,
    e: int,
    taken: Sequence[Row],
    aim: tuple[Sequence[float], Sequence[float]],
    x: list[float],
) -> bool:
    """Find the optimum on a row, given those taken so far; False when there is none."""
    gain, most = aim
    f, g = (e + 1) % 3, (e + 2) % 3
    kf, kg, b0 = -row[f] / row[e], -row[g] / row[e], row[3] / row[e]
    rows2 = [(kf, kg, most[e] - b0), (-kf, -kg, most[e] + b0)]
    rows2 += [(r[f] + r[e] * kf, r[g] + r[e] * kg, r[3] - r[e] * b0) for r in taken]
    gain2 = gain[f] + gain[e] * kf, gain[g] + gain[e] * kg
    found = solve2_python(rows2, gain2, (most[f], most[g]))
    if found is None:
        return False
    x[f], x[g] = found
    x[e] = b0 + kf * found[0] + kg * found[1]
    return True


def solve2_python(
    rows: Sequence[Row2], gain: tuple[float, float], most: tuple[float, float]
) -> tuple[float, float] | None:
    """Maximise the gain of two unknowns; rows are taken in their order."""
    x = [_outermost(gain[0], most[0]), _outermost(gain[1], most[1])]
    for i, (a0, a1, b) in enumerate(rows):
        if a0 * x[0] + a1 * x[1] <= b + ENOUGH:
            continue
        e = 0 if abs(a0) > abs(a1) else 1
        f = 1 - e
        own, far = (a0, a1) if e == 0 else (a1, a0)
        if abs(own) < FLAT:
            if b < -EMPTY:
                return None
            continue
        k, b0 = -far / own, b / own
        between = _interval(rows, i, e, (k, b0), most)
        if between is None:
            return None
        z = _best(gain[f] + gain[e] * k, *between)
        x[f], x[e] = z, b0 + k * z
    return x[0], x[1]


def _interval(
    rows: Sequence[Row2], count: int, e: int, line: tuple[float, float], most: tuple[float, float]
) -> tuple[float, float] | None:
    """Return where the first rows leave the unknown that is not e, on a line; None: nowhere."""
    f, (k, b0) = 1 - e, line
    lo, hi = -most[f], most[f]
    cuts = [(k, most[e] - b0), (-k, most[e] + b0)]
    cuts += [(row[f] + row[e] * k, row[2] - row[e] * b0) for row in rows[:count]]
    for a, b in cuts:
        if abs(a) < PARALLEL:
            if not b >= -EMPTY:
                return None
            continue
        v = b / a
        if a > 0.0:
            hi = min(hi, v)
        else:
            lo = max(lo, v)
    if lo > hi:
        if lo > hi + EMPTY:
            return None
        lo = hi = (lo + hi) / 2.0
    return lo, hi


def _best(gain: float, lo: float, hi: float) -> float:
    """Return the best value between two; where nothing is gained, the smallest."""
    if gain > NOTHING:
        return hi
    if gain < -NOTHING:
        return lo
    if lo > 0.0:
        return lo
    return hi if hi < 0.0 else 0.0
