# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.firmness`."""

from libc.math cimport sqrt
from libc.stdint cimport int32_t
from libc.stdlib cimport free, realloc

from drystone.kernels.compiled.gaps cimport (
    Body,
    Gap,
    Gaps,
    Heap,
    find_gaps,
    free_gaps,
    heap_of,
    init_gaps,
    measure,
)
from drystone.kernels.compiled.seidel cimport Row2, Row3, solve2, solve3

cdef int END = -2

cdef double GAINED = 1e-6
cdef double FASTEST = 1e3
cdef double FIRMEST = 10.0
cdef double HOLDS_DOWN = -0.1


def rest_margin(
    const double[:, ::1] corners,
    const double[:, ::1] edges,
    double x,
    double y,
    const double[:, ::1] around,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    const double[:, ::1] around_edges,
    double width,
    double mu,
    double tolerance,
    double corner,
    double steep,
):
    """Return what `rest_margin_python` returns."""
    cdef Heap heap = heap_of(around, first, boxes, around_edges, width)
    cdef Body body
    cdef Gaps gaps
    cdef Work work
    cdef double margin = 0.0
    body.count, body.corners, body.edges = corners.shape[0], &corners[0, 0], &edges[0, 0]
    init_gaps(&gaps)
    init_work(&work)
    with nogil:
        measure(&body)
        find_gaps(&body, &heap, tolerance, corner, &gaps)
        margin = firmness(
            &gaps, x, y, arm_of(body.corners, body.count, x, y), mu, tolerance, steep, &work
        )
    free_gaps(&gaps)
    free_work(&work)
    if gaps.lost or work.lost:
        raise MemoryError
    return margin


cdef void init_work(Work *work) noexcept nogil:
    work.rows, work.scratch, work.room, work.lost = NULL, NULL, 0, False


cdef void free_work(Work *work) noexcept nogil:
    free(work.rows)
    free(work.scratch)


cdef bint enough_rows(Work *work, Py_ssize_t count) noexcept nogil:
    """Make room for so many rows of a linear program."""
    cdef void *rows
    cdef void *scratch
    if count <= work.room:
        return True
    rows = realloc(work.rows, 2 * count * sizeof(Row3))
    if rows != NULL:
        work.rows = <Row3 *>rows
    scratch = realloc(work.scratch, (2 * count + 2) * sizeof(Row2))
    if scratch != NULL:
        work.scratch = <Row2 *>scratch
    if rows == NULL or scratch == NULL:
        work.lost = True
        return False
    work.room = 2 * count
    return True


cdef double arm_of(const double *corners, Py_ssize_t count, double x, double y) noexcept nogil:
    """Return the distance of the furthest corner from a point."""
    cdef double dx, dy, most = 0.0
    cdef Py_ssize_t i
    for i in range(count):
        dx, dy = corners[2 * i] - x, corners[2 * i + 1] - y
        dx = dx * dx + dy * dy
        # What is not a number stays.
        if dx > most or dx != dx:
            most = dx
    return sqrt(most)


cdef double firmness(
    const Gaps *gaps, double x, double y, double arm, double mu, double tolerance,
    double steep, Work *work
) noexcept nogil:
    """Return how far gravity may lean, over mu, until a stone moves; -1 when it does not rest."""
    cdef double gain[3]
    cdef double most[3]
    cdef double found[3]
    cdef double gx, gy, least = FIRMEST, turning, grip
    cdef Py_ssize_t i, count = 0
    cdef const Gap *gap
    cdef int sign
    if not enough_rows(work, 2 * gaps.count + 2):
        return -1.0
    for i in range(gaps.count):
        gap = gaps.items + i
        if gap.away > tolerance or gap.other == END:
            continue
        if steep >= 0.0 and gap.normal[1] < HOLDS_DOWN:
            continue
        grip = mu if gap.normal[1] >= steep else 0.0
        for sign in range(-1, 2, 2):
            gx = gap.normal[0] + sign * grip * gap.normal[1]
            gy = gap.normal[1] - sign * grip * gap.normal[0]
            turning = (gap.point[0] - x) * gy - (gap.point[1] - y) * gx
            work.rows[count].a[0], work.rows[count].a[1] = -gx, -gy
            work.rows[count].a[2], work.rows[count].b = -turning / arm, 0.0
            count += 1
    if count < 4:
        return -1.0
    gain[0], gain[1], gain[2] = 0.0, -1.0, 0.0
    most[0] = most[1] = most[2] = 1.0
    if not solve3(work.rows, count, gain, most, work.scratch, found) or found[1] < -GAINED:
        return -1.0
    # With a speed of 1 aside: by how much must it rise at least?
    gain[0], gain[1] = -1.0, 0.0
    most[0] = most[1] = FASTEST
    for sign in range(-1, 2, 2):
        for i in range(count):
            work.scratch[i].a[0] = work.rows[i].a[1]
            work.scratch[i].a[1] = work.rows[i].a[2]
            work.scratch[i].b = -sign * work.rows[i].a[0]
        if solve2(work.scratch, count, gain, most, found):
            least = min(least, found[0] / mu)
    return max(least, 0.0)
