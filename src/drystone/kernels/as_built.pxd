from drystone.kernels.gaps cimport Heap, measure
from drystone.kernels.meetings cimport find_meetings
from drystone.kernels.memory cimport (
    doubles, kept_doubles, kept_flags, kept_ints, move_doubles, move_ints, p_double, p_int, p_uchar
)
from drystone.kernels.putting cimport Press, press_of, put_down
from drystone.kernels.settling cimport Way, let_go, way_of


cdef class Bed:
    cdef list kept
    cdef p_double rows
    cdef Py_ssize_t count
    cdef double level
    cdef bint held, hangs


cdef class BuiltWall(Heap):
    cdef readonly object how
    cdef double mu
    cdef dict numbers
    cdef list ids, built, beds
    cdef p_int places, order


cdef int make_room(BuiltWall wall, Py_ssize_t count, Py_ssize_t corners) except -1
cdef BuiltWall copied(BuiltWall wall, object pieces)
cdef Py_ssize_t number_of(BuiltWall wall, object block) except -1
cdef int add(BuiltWall wall, Py_ssize_t number, object built) except -1
cdef int take_up(BuiltWall wall, p_uchar marks) except -1
cdef BuiltWall laid_too(BuiltWall before, list pieces)
cdef int lay(BuiltWall wall, Py_ssize_t number, object built) except -1
cdef int find_beds(BuiltWall wall) except -1
cdef Bed bed_of(list rows, bint held)
cdef bint bears(Bed bed, Py_ssize_t k, bint faced) noexcept
cdef bint is_on(Bed bed, Py_ssize_t k) noexcept
cdef bint rests_on(Bed bed, p_uchar marks) noexcept
cdef int mark_burden(BuiltWall wall, p_uchar marks) except -1
cdef p_double loads_of(BuiltWall wall, p_uchar marks, Py_ssize_t unfaced, list kept) except NULL
cdef void pass_on(
    Bed bed, Py_ssize_t k, double up, double aside, p_uchar burden, p_double sums
) noexcept
cdef double leaning(Bed bed, Py_ssize_t k, double mu, double sign) noexcept
cdef double reaction(Bed bed, Py_ssize_t k, double mu, bint upward) noexcept
cdef double lever(Bed bed, Py_ssize_t k, Py_ssize_t a, double mu) noexcept
cdef void find_carrying(Bed bed, bint faced, double x, Py_ssize_t *two) noexcept
cdef int stays(BuiltWall wall, Py_ssize_t number, p_double loads, bint faced) except -1
cdef BuiltWall rolled(BuiltWall wall, Py_ssize_t number, p_double loads)
cdef int comes_back(BuiltWall below, Py_ssize_t number, object tipped, list again) except -1
