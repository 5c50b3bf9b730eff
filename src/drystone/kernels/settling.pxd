from drystone.kernels.gaps cimport Heap, MovingStone, crosses, find_gaps, heap_of, measure, stone_of
from drystone.kernels.memory cimport doubles, kept_doubles, p_double
from drystone.kernels.seidel cimport solve2, solve3
from libc.math cimport cos, isfinite, sin, sqrt


cdef class State(MovingStone):
    cdef double turn, least


cdef class Way:
    cdef list room
    cdef p_double corners, edges
    cdef State here, there
    cdef Py_ssize_t count, made
    cdef double arm, lean, stop, mu, clearance, tolerance, corner, near, far, most_turn, most_shift
    cdef double gain, overlap, steep, beyond, margin
    cdef bint sticks, turns
    cdef Py_ssize_t steps


cdef Way way_of(object outline, object edges, object rules)
cdef int let_go(Way way, Heap heap, double x, double y, double turn) except -1
cdef State state_of(Way way)
cdef int look(State state, Way way, Heap heap) except -1 nogil
cdef void exchange(State a, State b) noexcept nogil
cdef double margin_of(Way way, State here) noexcept nogil
cdef int descend(Way way, Heap heap, State here, State there) except -1 nogil
cdef int tried(
    Way way, Heap heap, State here, State there, double *move, double radius,
    double gained
) except -1 nogil
cdef bint best_move(State state, Way way, double radius, double *move) noexcept nogil
cdef double turning(MovingStone stone, Py_ssize_t k, double nx, double ny) noexcept nogil
cdef double arm_of(const double *corners, Py_ssize_t count, double x, double y) noexcept nogil
cdef double firmness(
    MovingStone stone, double arm, double mu, double tolerance, double steep
) noexcept nogil
