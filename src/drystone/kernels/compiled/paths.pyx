# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""The search of :mod:`drystone.kernels.paths`: what its twin leaves to SciPy.

Cells wait in buckets and are looked at from the lowest bucket on, in any order within one.  A
bucket is narrower than any detour but 0, so few cells are looked at twice, which is not wrong: a
cell is put in again whenever its key becomes smaller.
"""

from libc.stdint cimport int64_t
from libc.stdlib cimport free, malloc, realloc

cdef enum:
    STEPS = 8
    BUCKETS = 8  # more than the greatest detour is wide
    WIDTH_BITS = 24
    ROOM = 256  # of a bucket, at first


cdef struct Entry:
    Py_ssize_t cell
    int64_t key


cdef struct Bucket:
    Entry *entries
    Py_ssize_t size
    Py_ssize_t room


cdef inline bint put(Bucket *buckets, Py_ssize_t cell, int64_t key) noexcept nogil:
    """Put a cell into the bucket of its key; False when there is no memory."""
    cdef Bucket *bucket = &buckets[(key >> WIDTH_BITS) % BUCKETS]
    cdef Entry *larger
    if bucket.size == bucket.room:
        larger = <Entry *>realloc(bucket.entries, 2 * bucket.room * sizeof(Entry))
        if larger == NULL:
            return False
        bucket.entries = larger
        bucket.room *= 2
    bucket.entries[bucket.size].cell = cell
    bucket.entries[bucket.size].key = key
    bucket.size += 1
    return True


cdef bint search_row(
    int64_t *cells,
    Py_ssize_t row_start,
    Py_ssize_t row_end,
    int64_t first,
    const int64_t *steps,
    const int64_t *detours,
    Bucket *buckets,
) noexcept nogil:
    """Make the keys of all cells final whose key is not above the end's; False without memory."""
    cdef Py_ssize_t here, there
    cdef int64_t number = first >> WIDTH_BITS, key, new
    cdef const int64_t *costs
    cdef Bucket *bucket
    cdef int i, empty = 0
    if cells[row_start] < 0 or cells[row_end] < 0:
        return True
    cells[row_start] = first
    if not put(buckets, row_start, first):
        return False
    while empty < BUCKETS and number <= cells[row_end] >> WIDTH_BITS:
        bucket = &buckets[number % BUCKETS]
        empty = 0 if bucket.size else empty + 1
        while bucket.size:
            bucket.size -= 1
            here, key = bucket.entries[bucket.size].cell, bucket.entries[bucket.size].key
            if cells[here] != key:
                continue  # its key has become smaller since
            costs = detours + STEPS * ((here >= row_start) + (here > row_end))
            for i in range(STEPS):
                there, new = here + <Py_ssize_t>steps[i], key + costs[i]
                if new < cells[there]:
                    cells[there] = new
                    if not put(buckets, there, new):
                        return False
        number += 1
    return True


def search_rows(
    int64_t[:, ::1] cells,
    const int64_t[::1] rows,
    const int64_t[::1] firsts,
    const int64_t[::1] steps,
    const int64_t[:, ::1] detours,
    int64_t[::1] found,
):
    """Search along rows; see :func:`drystone.kernels.paths._searched`.

    Parameters
    ----------
    cells : (h + 2, w + 2) int array
        Keys: -1 for closed cells, among them a rim of one, else above all that will be written.
    rows, firsts : (n,) int arrays
        Rows without the rim, and the key that each begins with, falling from row to row.
    steps, detours : (8,) and (3, 8) int arrays
        What each step adds to the place of a cell, and to its key above the row, on it, below it.
    found : (n,) int array
        Takes the keys of the last cells of the rows.
    """
    cdef Bucket[BUCKETS] buckets
    cdef Py_ssize_t k, start, stride = cells.shape[1], width = cells.shape[1] - 2
    cdef int i
    cdef bint enough = True
    for i in range(BUCKETS):
        buckets[i].room = ROOM
        buckets[i].entries = <Entry *>malloc(ROOM * sizeof(Entry))
        enough = enough and buckets[i].entries != NULL
    with nogil:
        for k in range(rows.shape[0]):
            for i in range(BUCKETS):
                buckets[i].size = 0
            start = <Py_ssize_t>(rows[k] + 1) * stride + 1
            enough = enough and search_row(
                &cells[0, 0], start, start + width - 1, firsts[k], &steps[0], &detours[0, 0],
                buckets,
            )
            found[k] = cells[rows[k] + 1, width]
    for i in range(BUCKETS):
        free(buckets[i].entries)
    if not enough:
        raise MemoryError("no room for the search along joints")
