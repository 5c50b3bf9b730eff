from drystone.kernels.memory cimport (
    doubles, doubles_out, flags, longs, longs_out, p_double, p_long, p_uchar
)


cdef class Terms:
    cdef double cell, width, height, slack, clearance, narrowest, mean_area, gap, joint, unbalanced
    cdef double of_height, of_void, of_slot, of_headroom, of_step
    cdef bint rising  # Whether no stage of `look_around` makes a place cheaper.


cdef class DropWall:
    cdef p_double tops
    cdef Py_ssize_t columns
    cdef p_double boxes  # Left, bottom, right and top of each polygon that owns columns.
    cdef Py_ssize_t shown
    cdef p_long higher  # The next column to the right that is higher, for each column.
    cdef p_double sums  # The sum of the first k columns from each on, k = 0, 1, ...
    cdef p_long rest_width, rest_height
    cdef Py_ssize_t longest_width, longest_height


cdef class Places:
    cdef p_double bottoms
    cdef Py_ssize_t first, columns
    cdef double left, bottom, right, top
    cdef Py_ssize_t count
    cdef p_double lift, lean
    cdef p_uchar stage  # How far `look_around` has come at each place.
    cdef p_double cost  # The sum of the costs that are known so far; infinite where it cannot go.


cdef class Kept:
    cdef p_double cost
    cdef p_long group
    cdef Py_ssize_t count, most, each
    cdef double limit  # Drops that cost more, by more than CLOSE, are not asked for.


cdef Terms terms_of(object terms)
cdef void keep(
    Kept kept, double *rows, Py_ssize_t start, Py_ssize_t count, long long group
) noexcept nogil
cdef Py_ssize_t take(
    DropWall wall, Terms terms, Py_ssize_t apart, double limit, Places found, double *out,
    Py_ssize_t start, Py_ssize_t most
) noexcept nogil
cdef Py_ssize_t cheapest(DropWall wall, Terms terms, double limit, Places found) noexcept nogil
cdef Py_ssize_t least(Places found) noexcept nogil
cdef void rise(DropWall wall) noexcept nogil
cdef void add_up(DropWall wall, Py_ssize_t widest) noexcept nogil
cdef void lay_down(DropWall wall, Terms terms, double constant, Places found) noexcept nogil
cdef void land(Places found, double *tops) noexcept nogil
cdef void look_around(
    DropWall wall, Terms terms, Places found, Py_ssize_t at, int stage
) noexcept nogil
cdef double with_room(
    double cost, DropWall wall, Terms terms, double bottom, double top, Py_ssize_t at,
    Py_ssize_t end
) noexcept nogil
cdef double step(DropWall wall, double left, double bottom, double right, double top) noexcept nogil
cdef double joint(
    DropWall wall, Terms terms, double left, double bottom, double right, double top
) noexcept nogil
cdef double leaning(DropWall wall, Terms terms, Places found, Py_ssize_t at) noexcept nogil
