from drystone.kernels.memory cimport (
    doubles, doubles_out, ints, ints_out, kept_doubles, kept_ints, more_doubles, new_doubles,
    p_double, p_int, release
)
from libc.math cimport sqrt


cdef class Sides:
    cdef list room
    cdef Py_ssize_t count
    cdef double first, last, low, high
    cdef p_double x, y, along_x, along_y, length, left, bottom, right, top
    cdef p_int convex


cdef class MeetingRows:
    cdef p_double at
    cdef Py_ssize_t count, room


cdef object find_meetings(
    const double *at, Py_ssize_t corners, const double *others, const int *first,
    const double *boxes, Py_ssize_t count, double near, double back
)
cdef object _told(MeetingRows found)
cdef void set_sides(Sides sides, const double *corners, Py_ssize_t first) noexcept nogil
cdef int meet(
    Sides p, Sides q, Py_ssize_t other, double tolerance, double by, MeetingRows found
) except -1 nogil
cdef void copy(double *at, Py_ssize_t one, Py_ssize_t to) noexcept nogil
cdef int add(
    MeetingRows found, Sides p, Py_ssize_t edge, Py_ssize_t facing, double start, double end,
    double normal_x, double normal_y
) except -1 nogil
cdef int facing_edges(
    Sides p, Py_ssize_t i, Sides q, Py_ssize_t j, double tolerance, MeetingRows found
) except -1 nogil
cdef int corner_on_edge(
    Sides p, Py_ssize_t i, Sides q, Py_ssize_t j, double tolerance, MeetingRows found
) except -1 nogil
cdef int edge_on_corner(
    Sides p, Py_ssize_t i, Sides q, Py_ssize_t j, double tolerance, MeetingRows found
) except -1 nogil
cdef int corner_on_corner(
    Sides p, Py_ssize_t i, Sides q, Py_ssize_t j, double tolerance, MeetingRows found
) except -1 nogil
cdef double set_back_by(double size, double tolerance, double setback) noexcept nogil
cdef double area(Sides s) noexcept nogil
cdef bint set_back(
    Sides p, Sides q, double *at, Py_ssize_t k, double by, double tolerance
) noexcept nogil
cdef double projected(Sides s, Py_ssize_t i, double x, double y) noexcept nogil
cdef double runs_on(Sides s, Py_ssize_t i, double along, double enough, int sense) noexcept nogil
cdef void without_repeats(MeetingRows found, Py_ssize_t begin, double tolerance) noexcept nogil
cdef bint comes_before(double *at, Py_ssize_t one, Py_ssize_t other) noexcept nogil
cdef Py_ssize_t before(Sides s, Py_ssize_t i) noexcept nogil
cdef bint common(
    Sides p, Py_ssize_t i, Sides q, Py_ssize_t j, double tolerance, double *c
) noexcept nogil
cdef bint within(
    double low, double high, double at_low, double at_high, double reach, double *part
) noexcept nogil
cdef double stands_on(Sides s, Py_ssize_t i, Sides t, Py_ssize_t j, double tolerance) noexcept nogil
cdef bint are_beside(Sides s, Py_ssize_t i, Sides t, Py_ssize_t j, double tolerance) noexcept nogil
cdef bint clears(Sides s, Py_ssize_t i, double out_x, double out_y) noexcept nogil
cdef int best(bint *separates, double *apart, double *level, double equal) noexcept nogil
cdef bint is_same(double *at, Py_ssize_t one, Py_ssize_t other, double tolerance) noexcept nogil
