# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.support`.

The functions take about a microsecond, less than passing the interpreter from thread to thread:
they keep it.
"""

ctypedef unsigned char byte


cpdef support_ends(
    const byte[:, :] occupied, const byte[:, :] mask, Py_ssize_t row, Py_ssize_t col
):
    """Return what `support_ends_numpy` returns; the mask must be inside."""
    cdef Py_ssize_t height = mask.shape[0], width = mask.shape[1]
    cdef Py_ssize_t left = width, right = -1, left_row = 0, right_row = 0, at, below, i
    # From the bottom up: of the pixels of a column the lowest is found first.
    for i in range(height - 1, -1, -1):
        below = row + i + 1
        for at in range(left):
            if mask[i, at] and (below == occupied.shape[0] or occupied[below, col + at]):
                left, left_row = at, below
                break
        for at in range(width - 1, right, -1):
            if mask[i, at] and (below == occupied.shape[0] or occupied[below, col + at]):
                right, right_row = at, below
                break
    if right < 0:
        return None
    return col + left, col + right + 1, left_row, right_row


def resting_place(
    const byte[:, :] occupied,
    const byte[:, :] mask,
    Py_ssize_t row,
    Py_ssize_t col,
    Py_ssize_t reach,
):
    """Return what `resting_place_numpy` returns; the mask's columns must be inside."""
    cdef Py_ssize_t shift
    cdef bint above = fits(occupied, mask, row, col), below = fits(occupied, mask, row + 1, col)
    cdef bint further
    if above and not below:
        return row, support_ends(occupied, mask, row, col)
    for shift in range(1, reach + 1):
        further = fits(occupied, mask, row + shift + 1, col)
        if below and not further:
            return row + shift, support_ends(occupied, mask, row + shift, col)
        below = further
        further = fits(occupied, mask, row - shift, col)
        if further and not above:
            return row - shift, support_ends(occupied, mask, row - shift, col)
        above = further
    return None


cdef bint fits(
    const byte[:, :] occupied, const byte[:, :] mask, Py_ssize_t row, Py_ssize_t col
) noexcept nogil:
    """Say whether a mask is inside and overlaps nothing; its lowest rows are looked at first."""
    cdef Py_ssize_t i, at, here = occupied.strides[1], there = mask.strides[1]
    cdef const byte *a
    cdef const byte *b
    cdef byte hit = 0
    if row < 0 or row + mask.shape[0] > occupied.shape[0]:
        return False
    for i in range(mask.shape[0] - 1, -1, -1):
        a, b = &occupied[row + i, col], &mask[i, 0]
        if here == 1 and there == 1:
            for at in range(mask.shape[1]):
                hit |= a[at] & b[at]
        else:
            for at in range(mask.shape[1]):
                hit |= a[at * here] & b[at * there]
        if hit:
            return False
    return True
