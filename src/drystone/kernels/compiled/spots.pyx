# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.spots`.

Most positions are passed over: what a place is worth at most is known before its rays are counted.
The bound goes through the same operations in the same order as the merit, so it is never below it.
"""

from libc.math cimport rint
from libc.stdint cimport int32_t, int64_t
from libc.stdlib cimport free, malloc

from drystone.kernels.compiled.rays cimport RaySums, Swept

cdef double UNITS = 1e12


cdef struct Place:
    double merit
    int64_t row
    int64_t col


cdef class Best:
    """The best places so far, in order."""

    cdef Place *places
    cdef Py_ssize_t count, room
    cdef bint lowest_first

    def __cinit__(self, Py_ssize_t room, bint lowest_first):
        self.count, self.room, self.lowest_first = 0, room, lowest_first
        self.places = <Place *> malloc(max(room, 1) * sizeof(Place))
        if self.places == NULL:
            raise MemoryError

    def __dealloc__(self):
        free(self.places)

    cdef bint before(self, const Place *one, const Place *other) noexcept nogil:
        if self.lowest_first and one.row != other.row:
            return one.row > other.row
        if one.merit != other.merit:
            return one.merit > other.merit
        if one.row != other.row:
            return one.row > other.row
        return one.col < other.col

    cdef bint wants(self, double merit) noexcept nogil:
        """Say whether a place of this merit can be among the best."""
        return self.count < self.room or merit >= self.places[self.room - 1].merit

    cdef void offer(self, Place place) noexcept nogil:
        cdef Py_ssize_t at = self.count
        if self.count == self.room:
            at -= 1
            if not self.before(&place, &self.places[at]):
                return
        else:
            self.count += 1
        while at > 0 and self.before(&place, &self.places[at - 1]):
            self.places[at] = self.places[at - 1]
            at -= 1
        self.places[at] = place

    cdef list found(self):
        cdef Py_ssize_t at
        return [
            (self.places[at].merit, self.places[at].row, self.places[at].col)
            for at in range(self.count)
        ]


cdef struct Terms:
    double dice  # H(GDS, beta)
    double end  # x_c / w


cdef double worth(double share, const Terms *terms) noexcept nogil:
    """Return the merit by Eq. 12 for a filled share of the rays."""
    return rint((share + terms.dice - terms.end) * UNITS)


cdef void look_up(
    const int64_t[:, ::1] positions,
    const int32_t[::1] area_from,
    RaySums rays,
    int64_t built_height,
    double anchor_x,
    double beta,
    Terms *terms,
) noexcept nogil:
    """Fill in what is known of the merits without counting rays."""
    cdef int64_t height = area_from.shape[0] - 1, box_top = rays.height - built_height
    cdef double width = rays.width, area = area_from[0], box_area = rays.width * built_height
    cdef double inside, dice = 0.0
    cdef Py_ssize_t at
    for at in range(positions.shape[0]):
        if at == 0 or positions[at, 0] != positions[at - 1, 0]:
            inside = area_from[max(0, min(box_top - positions[at, 0], height))]
            dice = inside / area * (box_area / (box_area + area - inside))
            dice = dice if dice > beta else 0.0
        terms[at].dice = dice
        terms[at].end = (<double> positions[at, 1] + anchor_x) / width


def best_by_eq12(
    const int64_t[:, ::1] positions,
    mask,
    RaySums rays,
    int64_t built_height,
    double anchor_x,
    double beta,
    Py_ssize_t tries,
):
    """Return the best places as (merit, row, column)."""
    cdef const int32_t[::1] area_from = mask.area_from
    cdef Py_ssize_t count = positions.shape[0], at, first
    cdef Best best = Best(min(tries, count), False)
    cdef Swept swept = Swept(mask)
    rays.check(swept, positions)
    cdef Terms *terms = <Terms *> malloc(max(count, 1) * sizeof(Terms))
    if terms == NULL:
        raise MemoryError
    with nogil:
        look_up(positions, area_from, rays, built_height, anchor_x, beta, terms)
        # The most promising place comes first: most of the others are not worth a look then.
        first = most_promising(terms, count)
        if count > 0:
            offer(best, positions, first, rays, swept, &terms[first])
        for at in range(count - 1, -1, -1):
            if at != first and best.wants(worth(1.0, &terms[at])):
                offer(best, positions, at, rays, swept, &terms[at])
    free(terms)
    return best.found()


cdef Py_ssize_t most_promising(const Terms *terms, Py_ssize_t count) noexcept nogil:
    """Return the place that would be worth most if all rays were filled."""
    cdef Py_ssize_t at, first = 0
    for at in range(1, count):
        if terms[at].dice - terms[at].end > terms[first].dice - terms[first].end:
            first = at
    return first


cdef void offer(
    Best best,
    const int64_t[:, ::1] positions,
    Py_ssize_t at,
    RaySums rays,
    Swept swept,
    const Terms *terms,
) noexcept nogil:
    """Count the rays of a place and offer it."""
    cdef Py_ssize_t row = positions[at, 0], col = positions[at, 1]
    best.offer(Place(worth(rays.share(swept, row, col), terms), row, col))


def best_by_height(const int64_t[:, ::1] positions, mask, RaySums rays, Py_ssize_t tries):
    """Return the lowest places as (merit, row, column)."""
    cdef Best best = Best(min(tries, positions.shape[0]), True)
    cdef Swept swept = Swept(mask)
    cdef int64_t row, col
    cdef Py_ssize_t at
    rays.check(swept, positions)
    with nogil:
        for at in range(positions.shape[0] - 1, -1, -1):
            row, col = positions[at, 0], positions[at, 1]
            if best.count == best.room and row < best.places[best.room - 1].row:
                break
            best.offer(Place(rint(rays.share(swept, row, col) * UNITS), row, col))
    return best.found()


cdef int64_t void_below(
    const int32_t[::1] top, const int32_t[::1] bottom, int64_t row, int64_t col
) noexcept nogil:
    """Return the empty pixels between a mask and the highest ones below."""
    cdef Py_ssize_t at
    cdef int32_t under, lowest = <int32_t> row + 1
    cdef int64_t empty = 0
    for at in range(bottom.shape[0]):
        under = top[col + at] - bottom[at] - lowest
        empty += under if under > 0 else 0
    return empty


def best_by_snugness(
    const int64_t[:, ::1] positions,
    mask,
    const int32_t[::1] top,
    RaySums rays,
    (double, double, double, double) weights,
    Py_ssize_t tries,
):
    """Return the best places as (merit, row, column)."""
    cdef const int32_t[::1] bottom = mask.bottom
    cdef Best best = Best(min(tries, positions.shape[0]), False)
    cdef Swept swept = Swept(mask)
    cdef double area = mask.area_from[0], width = rays.width, high = mask.height
    cdef double low, void, gap, end
    cdef int64_t row, col
    cdef Py_ssize_t at
    # A negative weight would make the bound too low: then nothing is passed over.
    cdef bint bounded = weights[1] >= 0.0 and weights[2] >= 0.0
    rays.check(swept, positions)
    with nogil:
        for at in range(positions.shape[0] - 1, -1, -1):
            row, col = positions[at, 0], positions[at, 1]
            low = weights[0] * <double> (rays.height - row - swept.height) / high
            end = weights[3] * (<double> col / width)
            if bounded and not best.wants(rint(-(low + end) * UNITS)):
                continue
            void = weights[1] * (<double> void_below(top, bottom, row, col) / area)
            if bounded and not best.wants(rint(-(low + void + end) * UNITS)):
                continue
            gap = <double> rays.beside(swept, row, col) / area
            gap = weights[2] * (gap if gap < 1.0 else 1.0)
            best.offer(Place(rint(-(low + void + gap + end) * UNITS), row, col))
    return best.found()
