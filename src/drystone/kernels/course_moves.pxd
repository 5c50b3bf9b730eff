from drystone.kernels.memory cimport ints, kept_ints, move_ints, p_int


cdef class Dice:
    cdef unsigned long long state


cdef class Draft:
    cdef list room
    cdef p_int order, turns, sizes, gaps, spare
    cdef int stones, courses


cdef int start(Draft draft, object plan, int most) except -1
cdef tuple parts_of(Draft draft)
cdef void copy(Draft source, Draft to) noexcept nogil
cdef long long drawn(Dice dice, long long count) noexcept nogil
cdef int start_of(Draft draft, int course) noexcept nogil
cdef int change(Draft draft, Dice dice, int most) noexcept nogil
cdef int course_of(Draft draft, int place) noexcept nogil
cpdef int left_of(int gap) noexcept nogil
cdef void move_gap(Draft draft, int course, int by) noexcept nogil
cdef void turn_stone(Draft draft, Dice dice, int stone) noexcept nogil
cdef int swap(Draft draft, Dice dice, bint turned) noexcept nogil
cdef int turn(Draft draft, Dice dice) noexcept nogil
cdef int move(Draft draft, Dice dice) noexcept nogil
cdef void insert(Draft draft, Dice dice, int stone, int course) noexcept nogil
cdef void drop_course(Draft draft, int course) noexcept nogil
cdef int shift_gap(Draft draft, Dice dice) noexcept nogil
cdef int reverse(Draft draft, Dice dice) noexcept nogil
cdef int exchange(Draft draft, Dice dice) noexcept nogil
cdef int split(Draft draft, Dice dice, int most) noexcept nogil
cdef int join(Draft draft, Dice dice) noexcept nogil
