# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""How the stones of a course stand side by side, a part of :mod:`drystone.kernels.course_cost`.

This does not depend on how they lie, so what it costs is known before any is laid.
"""

from libc.stdint cimport int32_t
from libc.string cimport memcpy

from drystone.kernels.course_types import INSET

from drystone.kernels.compiled.course_scene cimport (
    COLUMN_BITS,
    COLUMN_UNITS,
    TERMS,
    Course,
    Lain,
    Scene,
)

cdef int32_t INSET_OF = INSET[0], INSET_PARTS = INSET[1]


cdef bint stand(
    const Scene *scene,
    const int32_t *stones,
    const int32_t *turns,
    int32_t count,
    int32_t gap,
    const Course *old,
    Course *out,
) noexcept nogil:
    """Stand the stones of a course, at least one, side by side.

    Return whether they are those of an old course (or NULL): then all that is known of it is
    copied but its tops and ways.
    """
    cdef int32_t i, stone, room
    cdef bint same = old != NULL and old.stones == count and old.gap == gap
    out.stones, out.gap, out.joint_count = count, gap, count + 1
    for i in range(count):
        stone = stones[i]
        out.lain[i].pose = 4 * stone + turns[stone]
        same = same and old.lain[i].pose == out.lain[i].pose
    if same:
        memcpy(out.lain, old.lain, count * sizeof(Lain))
        memcpy(out.joints, old.joints, 2 * (count + 1) * sizeof(int32_t))
        memcpy(out.terms, old.terms, TERMS * sizeof(double))
        return True
    room = side_by_side(scene, out)
    for i in range(TERMS):
        out.terms[i] = 0.0
    if room < 0:
        out.terms[4] = -<double> room
    open_ends(scene, out)
    out.terms[12] = faces_of(scene, out)
    return False


cdef void meet(
    const Scene *scene, const Course *below, const Course *old, Course *out
) noexcept nogil:
    """Count the joints of a course above those below, and add up what is known to cost.

    `old` has the same joints above the same, or is NULL.
    """
    out.terms[3] = crossing(out, below, scene.reach) if old == NULL else old.terms[3]
    out.sure = out.terms[3] * scene.weights[3]
    out.sure += out.terms[4] * scene.weights[4] + out.terms[12] * scene.weights[12]


cdef inline int32_t side_by_side(const Scene *scene, Course *out) noexcept nogil:
    """Find the left ends of the stones of a course; return the room that they leave."""
    cdef int32_t i, room, most, total = 0, before = out.lain[0].pose, columns, inset = 0
    cdef int32_t from_left = out.gap if out.gap >= 0 else -1 - out.gap
    cdef Lain *lain = out.lain
    # Distances first, then places.
    room = scene.wall_width
    lain[0].x = 0
    for i in range(1, out.stones):
        lain[i].x = nest(scene, before, lain[i].pose) + scene.joint
        room -= lain[i].x
        before = lain[i].pose
    room -= scene.width[before]
    if out.gap < 0 and room > 0:
        inset = room * INSET_OF / INSET_PARTS
    for i in range(out.stones):
        total += lain[i].x
        # What is laid from the right end is as far from there as it would be from a full course.
        most = total + room - inset if i >= from_left else total + inset
        lain[i].x = max(0, min(most, scene.wall_width - scene.width[lain[i].pose]))
        columns = <int32_t> (scene.first[lain[i].pose + 1] - scene.first[lain[i].pose])
        lain[i].column = min(
            (lain[i].x + COLUMN_UNITS / 2) >> COLUMN_BITS, scene.columns - columns
        )
    return room


cdef inline int32_t nest(const Scene *scene, int32_t left, int32_t right) noexcept nogil:
    """Return how far apart the left ends of two neighbours are, their lowest points level."""
    cdef const int32_t *rights = scene.rights + scene.first_row[left]
    cdef const int32_t *lefts = scene.lefts + scene.first_row[right]
    cdef Py_ssize_t shared = <Py_ssize_t> min(
        scene.first_row[left + 1] - scene.first_row[left],
        scene.first_row[right + 1] - scene.first_row[right],
    )
    cdef Py_ssize_t i
    cdef int32_t apart = rights[0] - lefts[0], here
    for i in range(1, shared):
        here = rights[i] - lefts[i]
        apart = here if here > apart else apart
    return apart


cdef inline void open_ends(const Scene *scene, Course *out) noexcept nogil:
    """Find the ends of the head joints of a course, with what is free at the wall's ends."""
    cdef int32_t i, left, right, count = out.stones
    cdef const Lain *lain = out.lain
    out.joints[0], out.joints[1] = 0, lain[0].x
    for i in range(count):
        left = lain[i].x + scene.width[lain[i].pose]
        right = lain[i + 1].x if i + 1 < count else scene.wall_width
        if left > right:
            left = right = (left + right) >> 1
        out.joints[2 * i + 2], out.joints[2 * i + 3] = left, right


cdef inline double faces_of(const Scene *scene, const Course *course) noexcept nogil:
    """Return how far the faces at the ends of a course are from the ends of the wall."""
    cdef int32_t left = course.lain[0].pose, right = course.lain[course.stones - 1].pose
    cdef const int32_t *end = course.joints + 2 * course.stones
    return <double> (
        course.joints[1] + scene.faces[2 * left] + end[1] - end[0] + scene.faces[2 * right + 1]
    )


cdef inline double crossing(const Course *here, const Course *below, int32_t reach) noexcept nogil:
    """Return how much joints are above joints; what is free at the ends is none."""
    cdef Py_ssize_t i, j
    cdef int32_t apart
    cdef double total = 0.0, near
    for i in range(1, here.joint_count - 1):
        for j in range(1, below.joint_count - 1):
            apart = max(
                here.joints[2 * i] - below.joints[2 * j + 1],
                below.joints[2 * j] - here.joints[2 * i + 1],
            )
            apart = max(apart, 0)
            if apart < reach:
                near = 1.0 - <double> apart / <double> reach
                total += near * near
    return total
