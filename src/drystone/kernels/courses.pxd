from drystone.kernels.course_moves cimport (
    Dice, Draft, change, copy, drawn, left_of, parts_of, start, start_of
)
from drystone.kernels.memory cimport (
    doubles, ints, kept_doubles, kept_ints, longs, move_ints, p_double, p_int, p_long
)


cdef class Scene:
    cdef list room
    # Poses, wall and rules.
    cdef p_long first, first_row, area
    cdef p_int bottoms, tips, lefts, rights, width, height, middle, peaks, part_at, faces, given
    cdef p_double weights
    cdef double margin, target
    cdef int wall_width, wall_height, reach, steepest, joint, start_count, given_count
    cdef Py_ssize_t columns, most, most_joints
    # Of the stones of each course.
    cdef p_int pose, x, column, y, slope, rock, heights
    cdef p_double void, short_
    # Of each course.
    cdef p_int tops, joints, ways, counts, gaps, joint_counts, beds
    cdef p_double terms, sure, costs
    # For a while.
    cdef p_int lift, seen, starts, top_starts, lengths, best
    cdef int changed, unchanged
    cdef double temperature, across, down


cdef class Trial(Draft):
    cdef p_int slots
    cdef int laid
    cdef double outer, cost


cdef Scene scene_on(object ground, Py_ssize_t slots, Py_ssize_t stones)
cdef int furnish(Scene s, object poses, object rules) except -1
cdef Trial trial_of(object plan, int most, int first_slot)
cdef void search(
    Scene s, Trial now, Trial trial, Trial best, int most, Dice dice, const double *luck,
    Py_ssize_t evaluations, double factor, double doubt
) noexcept nogil
cdef double laid_again(
    Scene s, Trial now, Trial trial, int lowest, double limit, double doubt
) noexcept nogil
cdef double left_out(Scene s, Draft draft) noexcept nogil
cdef double with_paths(
    Scene s, Trial now, Trial trial, int lowest, double cost, double bound
) noexcept nogil
cdef double stood(Scene s, Trial now, Trial trial, int lowest, int *highest) noexcept nogil
cdef bint stand(Scene s, Draft draft, int start, int course, int old, int out) noexcept nogil
cdef void copy_stone(Scene s, Py_ssize_t one, Py_ssize_t to) noexcept nogil
cdef void meet(Scene s, int below, int old, int out) noexcept nogil
cdef int side_by_side(Scene s, int out) noexcept nogil
cdef int nest(Scene s, int left, int right) noexcept nogil
cdef void open_ends(Scene s, int out) noexcept nogil
cdef double crossing(Scene s, int out, int below) noexcept nogil
cdef bint lay(Scene s, int below, int old, bint last, double left, int out) noexcept nogil
cdef double lies(Scene s, Py_ssize_t stone, bint beside) noexcept nogil
cdef int columns_of(Scene s, int pose) noexcept nogil
cdef Py_ssize_t found_in(Scene s, int course, int i, int count, Py_ssize_t stone) noexcept nogil
cdef void widen(Scene s, int first, int last) noexcept nogil
cdef Py_ssize_t first_of(const int *lift, Py_ssize_t end) noexcept nogil
cdef Py_ssize_t last_of(const int *lift, Py_ssize_t start, Py_ssize_t end) noexcept nogil
cdef void drop(Scene s, int below, Py_ssize_t stone) noexcept nogil
cdef void raise_tops(Scene s, int below, int old, int out) noexcept nogil
cdef void count_up(Scene s, int below, bint last, int out) noexcept nogil
cdef double slack(Scene s, int below, int mean, int out) noexcept nogil
cdef int fill_starts(int side, int *starts) noexcept nogil
cdef void go_up(Scene s, int below, int out) noexcept nogil
cdef void sweep(Scene s, int below, int out) noexcept nogil
cdef int apart(const int *joints, Py_ssize_t at, int left, int right) noexcept nogil
cdef bint ordered(Scene s, int course) noexcept nogil
cdef void shorten(
    int *ways, Py_ssize_t at, const int *others, Py_ssize_t start, int aside
) noexcept nogil
cdef int top_of(Scene s, int last) noexcept nogil
cdef double across(Scene s, int courses, int top) noexcept nogil
cdef double down(Scene s, int last, int top) noexcept nogil
cdef void along_bed(Scene s, int left, int right, int ups, int top, int count) noexcept nogil
cdef double mean_percent(int *lengths, int count, int straight) noexcept nogil
