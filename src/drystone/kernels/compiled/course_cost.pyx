# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.course_cost`."""

from libc.stdint cimport int32_t, int64_t
from libc.stdlib cimport calloc, free, malloc
from libc.string cimport memcpy

import numpy as np

from drystone.kernels.compiled.course_paths cimport (
    STARTS,
    crossing_percent,
    mean_percent,
    nearest_bed,
    path_starts,
    ways_up,
)

cdef enum:
    COLUMN_BITS = 4
    COLUMN_UNITS = 16
    SLOPE_BITS = 12
    SLOPE_ONE = 4096
    PARTS = 4
    PIXEL_UNITS = 32

cdef struct Rest:
    int32_t y
    int32_t slope
    int32_t rock
    int32_t left
    int32_t right
    int64_t void


def evaluate(poses, plan, ground, rules, const double[::1] weights):
    """Return the fields of a layout: what `evaluate_python` returns."""
    cdef const int32_t[::1] order = plan.order, turns = plan.turns
    cdef const int32_t[::1] sizes = plan.sizes, gaps = plan.gaps
    cdef Py_ssize_t courses = sizes.shape[0], stones = order.shape[0], i, start = 0
    x, y, slope = (np.zeros(int(np.sum(plan.sizes)), np.int32) for _ in range(3))
    terms = np.zeros((courses + 1, TERMS))
    cdef int32_t[::1] xs = x, ys = y, slopes = slope
    cdef double[:, ::1] counted = terms
    cdef double[::1] outer = np.zeros(TERMS)
    cdef Scene scene
    cdef Layers layers = Layers(ground, courses, stones)
    cdef Course *course = layers.courses
    cdef Places places
    cdef double cost
    fill_scene(&scene, poses, ground, rules, weights)
    with nogil:
        for i in range(courses):
            start += sizes[i]
        cost = left_out(&scene, &order[0] + start, stones - start, &outer[0])
        start = 0
        for i in range(courses):
            places = Places(&xs[0] + start, &ys[0] + start, &slopes[0] + start, &counted[i, 0])
            lay_course(
                &scene, &order[0] + start, &turns[0], sizes[i], gaps[i], course + i,
                i == courses - 1, course + i + 1, places,
            )
            cost += course[i + 1].cost
            start += sizes[i]
        cost += paths(&scene, course + 1, courses, &counted[courses, 0])
        counted[courses, 13] = outer[13]
    free_scene(&scene)
    tops, joints = layers.last(courses)
    return x, y, slope, tops, joints, terms, cost


cdef class Layers:
    """Room for courses, each on the one before, the first on the ground; and to list courses."""

    def __cinit__(self, ground, Py_ssize_t count, Py_ssize_t stones):
        cdef Py_ssize_t i, columns = ground.tops.shape[0], given = ground.joints.shape[0]
        cdef Py_ssize_t most = max(stones + 1, given)
        self.courses = <Course *> calloc(count + 1, sizeof(Course))
        self.seen = <Course *> calloc(count, sizeof(Course))
        if self.courses == NULL or self.seen == NULL:
            raise MemoryError
        self.tops = np.zeros((count + 1, columns), np.int32)
        self.joints = np.zeros((count + 1, most, 2), np.int32)
        self.ways = np.zeros((count + 1, most, STARTS), np.int32)
        np.asarray(self.tops)[0] = ground.tops
        np.asarray(self.joints)[0, :given] = ground.joints
        np.asarray(self.ways)[0, :given] = ground.ways
        for i in range(count + 1):
            self.courses[i].tops = &self.tops[i, 0]
            self.courses[i].joints = &self.joints[i, 0, 0]
            self.courses[i].ways = &self.ways[i, 0, 0]
        self.courses[0].joint_count = given

    def __dealloc__(self):
        free(self.courses)
        free(self.seen)

    cpdef tuple last(self, Py_ssize_t course):
        """Return the profile and the joints of a course."""
        cdef Py_ssize_t count = self.courses[course].joint_count
        tops, joints = np.asarray(self.tops)[course], np.asarray(self.joints)[course, :count]
        return tops.copy(), joints.copy()


cdef int fill_scene(Scene *scene, poses, ground, rules, const double[::1] weights) except -1:
    """Point to the arrays of poses, and make room for what is worked out."""
    cdef const int64_t[::1] first = poses.first, first_row = poses.first_row, area = poses.area
    cdef const int32_t[::1] bottoms = poses.bottoms, tops = poses.tops
    cdef const int32_t[::1] lefts = poses.lefts, rights = poses.rights
    cdef const int32_t[::1] width = poses.width, middle = poses.middle
    cdef const int32_t[:, ::1] peaks = poses.peaks, part_at = poses.part_at, faces = poses.faces
    cdef const int32_t[:, ::1] beds = ground.beds
    scene.first, scene.first_row, scene.area = &first[0], &first_row[0], &area[0]
    scene.bottoms, scene.tops = &bottoms[0], &tops[0]
    scene.lefts, scene.rights = &lefts[0], &rights[0]
    scene.width, scene.middle = &width[0], &middle[0]
    scene.peaks, scene.part_at, scene.faces = &peaks[0, 0], &part_at[0, 0], &faces[0, 0]
    scene.weights = &weights[0]
    scene.stones = area.shape[0]
    scene.columns = ground.tops.shape[0]
    scene.wall_width, scene.wall_height = ground.width, ground.height
    scene.reach, scene.margin, scene.steepest = rules.reach, rules.margin, rules.steepest
    scene.joint = rules.joint
    scene.target, scene.beds, scene.bed_count = rules.target, &beds[0, 0], beds.shape[0]
    scene.start_count = path_starts(scene.wall_width, scene.starts)
    scene.lift = <int32_t *> malloc(scene.columns * sizeof(int32_t))
    if scene.lift == NULL:
        raise MemoryError
    return 0


cdef void free_scene(Scene *scene) noexcept nogil:
    """Give back what :func:`fill_scene` took."""
    free(scene.lift)


cdef double left_out(
    const Scene *scene, const int32_t *stones, Py_ssize_t count, double *terms
) noexcept nogil:
    """Count the stones that are left out, and return what that costs."""
    cdef Py_ssize_t i
    cdef int64_t area = 0
    for i in range(count):
        area += scene.area[stones[i]]
    for i in range(TERMS):
        terms[i] = 0.0
    terms[13] = <double> area
    return weighted(scene, terms)


cdef double paths(
    const Scene *scene, const Course *courses, Py_ssize_t count, double *terms
) noexcept nogil:
    """Count paths along the joints of a whole wall, and return what that costs."""
    cdef const Course *last = courses + count - 1
    cdef int32_t starts[STARTS]
    cdef int32_t lengths[STARTS]
    cdef int32_t top = last.tops[0], found, half = PIXEL_UNITS / 2
    cdef const int32_t *bed
    cdef double crossed
    cdef Py_ssize_t i
    for i in range(1, scene.columns):
        top = last.tops[i] if last.tops[i] > top else top
    for i in range(TERMS):
        terms[i] = 0.0
    found = path_starts(top, starts)
    for i in range(found):
        # Along the ground; and over the top.
        lengths[i] = 2 * (top - starts[i] + half)
        lengths[i] = lengths[i] if lengths[i] > 0 else -lengths[i]
    nearest_bed(top + half, top + half, 0, starts, found, top, lengths)
    for i in range(scene.bed_count):
        bed = scene.beds + 3 * i
        nearest_bed(bed[0], bed[1], bed[2], starts, found, top, lengths)
    for i in range(count):
        bed = &courses[i].bed[0]
        nearest_bed(bed[0], bed[1], bed[2], starts, found, top, lengths)
    terms[14] = mean_percent(lengths, found, scene.wall_width + 2 * PIXEL_UNITS)
    if scene.start_count > 0:
        crossed = crossing_percent(
            last.joints, last.joint_count, last.ways, scene.starts, scene.start_count, top
        )
        terms[15] = scene.target - crossed if scene.target > crossed else 0.0
    return weighted(scene, terms)


cdef double weighted(const Scene *scene, const double *terms) noexcept nogil:
    """Return the sum of terms times their weights, one after the other."""
    cdef Py_ssize_t i
    cdef double cost = 0.0
    for i in range(TERMS):
        cost += terms[i] * scene.weights[i]
    return cost


cdef void lay_course(
    const Scene *scene,
    const int32_t *stones,
    const int32_t *turns,
    Py_ssize_t count,
    Py_ssize_t gap,
    const Course *below,
    bint last,
    Course *out,
    Places places,
) noexcept nogil:
    """Lay a course of stones, at least one, on what is below; `out` is what is then there."""
    cdef double *terms = places.terms
    cdef Py_ssize_t i, j
    cdef int32_t pose, column, mean, peak, highest, before = 0
    cdef int32_t room
    cdef int64_t peaks = 0, steps = 0, off = 0
    cdef Rest rest
    for i in range(TERMS):
        terms[i] = 0.0
    room = side_by_side(scene, stones, turns, count, gap, places.x)
    if room < 0:
        terms[4] = -<double> room
    memcpy(out.tops, below.tops, scene.columns * sizeof(int32_t))
    for i in range(count):
        pose = 4 * stones[i] + turns[stones[i]]
        column = column_of(scene, pose, places.x[i])
        rest = dropped(scene, pose, below.tops + column)
        places.y[i], places.slope[i] = rest.y, rest.slope
        raise_tops(scene, pose, &rest, out.tops + column)
        count_rest(scene, pose, &rest, terms)
        highest = scene.wall_height
        for j in range(PARTS):
            peak = peak_of(scene, pose, j, &rest)
            highest = peak if peak > highest else highest
            if i + j > 0:
                steps += peak - before if peak > before else before - peak
            before = peak
            peaks += peak
        if highest > scene.wall_height:
            terms[10] += <double> (highest - scene.wall_height)
            terms[11] += 1.0
        if i == 0:
            out.bed[0] = peak_of(scene, pose, 0, &rest)
    out.bed[1], out.bed[2] = before, <int32_t> steps
    terms[0] = <double> steps
    mean = <int32_t> (peaks / (PARTS * count))
    for i in range(count):
        pose = 4 * stones[i] + turns[stones[i]]
        rest.y, rest.slope = places.y[i], places.slope[i]
        for j in range(PARTS):
            peak = peak_of(scene, pose, j, &rest)
            off += peak - mean if peak > mean else mean - peak
    terms[2 if last else 1] = <double> off
    open_ends(scene, stones, turns, count, places.x, out)
    terms[3] = crossing(out, below, scene.reach)
    terms[5] = slack(scene, out, below.tops, mean)
    terms[12] = faces_of(scene, stones, turns, count, out)
    ways_up(
        out.joints, out.joint_count, below.joints, below.joint_count, below.ways, scene.starts,
        scene.start_count, out.ways,
    )
    out.cost = weighted(scene, terms)


cdef inline double faces_of(
    const Scene *scene,
    const int32_t *stones,
    const int32_t *turns,
    Py_ssize_t count,
    const Course *course,
) noexcept nogil:
    """Return how far the faces at the ends of a course are from the ends of the wall."""
    cdef int32_t left = 4 * stones[0] + turns[stones[0]]
    cdef int32_t right = 4 * stones[count - 1] + turns[stones[count - 1]]
    cdef const int32_t *end = course.joints + 2 * count
    return <double> (
        course.joints[1] + scene.faces[2 * left] + end[1] - end[0] + scene.faces[2 * right + 1]
    )


cdef int32_t side_by_side(
    const Scene *scene,
    const int32_t *stones,
    const int32_t *turns,
    Py_ssize_t count,
    Py_ssize_t gap,
    int32_t *x,
) noexcept nogil:
    """Find the left ends of the stones of a course; return the room that they leave."""
    cdef Py_ssize_t i
    cdef int32_t pose, before = 4 * stones[0] + turns[stones[0]], room, most
    # Distances first, then places.
    room = scene.wall_width
    x[0] = 0
    for i in range(1, count):
        pose = 4 * stones[i] + turns[stones[i]]
        x[i] = nest(scene, before, pose) + scene.joint
        room -= x[i]
        before = pose
    room -= scene.width[before]
    for i in range(1, count):
        x[i] += x[i - 1]
    if gap < count:
        # What is laid from the right end is as far from there as it would be from a full course.
        for i in range(gap, count):
            x[i] += room
    for i in range(count):
        most = scene.wall_width - scene.width[4 * stones[i] + turns[stones[i]]]
        x[i] = max(0, min(x[i], most))
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


cdef inline int32_t column_of(const Scene *scene, int32_t pose, int32_t place) noexcept nogil:
    """Return the column that a pose's first column is on, the nearest to its left end."""
    cdef int32_t count = <int32_t> (scene.first[pose + 1] - scene.first[pose])
    return min((place + COLUMN_UNITS / 2) >> COLUMN_BITS, scene.columns - count)


cdef inline Py_ssize_t first_of(
    const int32_t *lift, Py_ssize_t start, Py_ssize_t end
) noexcept nogil:
    """Return where a lift is largest, the first of equals."""
    cdef Py_ssize_t i
    cdef int32_t most = lift[start]
    for i in range(start + 1, end):
        most = lift[i] if lift[i] > most else most
    for i in range(start, end):
        if lift[i] == most:
            return i
    return start


cdef inline Py_ssize_t last_of(
    const int32_t *lift, Py_ssize_t start, Py_ssize_t end
) noexcept nogil:
    """Return where a lift is largest, the last of equals."""
    cdef Py_ssize_t i
    cdef int32_t most = lift[start]
    for i in range(start + 1, end):
        most = lift[i] if lift[i] > most else most
    for i in range(end - 1, start - 1, -1):
        if lift[i] == most:
            return i
    return start


cdef Rest dropped(const Scene *scene, int32_t pose, const int32_t *below) noexcept nogil:
    """Drop a pose on a profile and turn it until it rests on both sides of its centroid."""
    cdef const int32_t *bottoms = scene.bottoms + scene.first[pose]
    cdef int32_t count = <int32_t> (scene.first[pose + 1] - scene.first[pose]), j
    cdef int32_t middle = scene.middle[pose], slope
    cdef int32_t *lift = scene.lift
    cdef Py_ssize_t left, right
    cdef int64_t total = 0
    cdef Rest rest
    rest.slope = rest.rock = rest.left = rest.right = 0
    rest.void = 0
    for j in range(count):
        lift[j] = below[j] - bottoms[j]
    rest.y = lift[0]
    if count == 1:
        return rest
    left, right = first_of(lift, 0, middle), last_of(lift, middle, count)
    slope = <int32_t> (<int64_t> (lift[right] - lift[left]) * SLOPE_ONE / (right - left))
    slope = max(-scene.steepest, min(slope, scene.steepest))
    if slope != 0:
        for j in range(count):
            lift[j] -= (slope * (j - middle)) >> SLOPE_BITS
        left, right = first_of(lift, 0, middle), last_of(lift, middle, count)
    for j in range(count):
        total += lift[j]
    rest.y = max(lift[left], lift[right])
    rest.slope = slope
    rest.rock = lift[left] - lift[right]
    if rest.rock < 0:
        rest.rock = -rest.rock
    rest.left, rest.right = <int32_t> left, <int32_t> right
    rest.void = <int64_t> rest.y * count - total
    return rest


cdef inline void raise_tops(
    const Scene *scene, int32_t pose, const Rest *rest, int32_t *over
) noexcept nogil:
    """Raise a profile by a stone."""
    cdef const int32_t *tops = scene.tops + scene.first[pose]
    cdef int32_t count = <int32_t> (scene.first[pose + 1] - scene.first[pose]), j, tip
    cdef int32_t middle = scene.middle[pose], slope = rest.slope, y = rest.y
    for j in range(count):
        tip = y + tops[j] + ((slope * (j - middle)) >> SLOPE_BITS)
        over[j] = tip if tip > over[j] else over[j]


cdef inline int32_t peak_of(
    const Scene *scene, int32_t pose, Py_ssize_t part, const Rest *rest
) noexcept nogil:
    """Return the height of a part of a stone's top."""
    cdef Py_ssize_t at = PARTS * pose + part
    cdef int32_t tilt = (rest.slope * (scene.part_at[at] - scene.middle[pose])) >> SLOPE_BITS
    return rest.y + scene.peaks[at] + tilt


cdef inline void count_rest(
    const Scene *scene, int32_t pose, const Rest *rest, double *terms
) noexcept nogil:
    """Count how a stone lies."""
    cdef int32_t count = <int32_t> (scene.first[pose + 1] - scene.first[pose])
    cdef int32_t middle = scene.middle[pose], inside
    cdef int32_t steep = rest.slope if rest.slope > 0 else -rest.slope
    cdef double short_
    terms[6] += <double> rest.void
    terms[7] += <double> ((steep * count) >> SLOPE_BITS)
    terms[8] += <double> rest.rock
    if count > 1:
        inside = min(middle - rest.left, rest.right + 1 - middle)
        short_ = scene.margin - <double> inside / <double> count
        if short_ > 0.0:
            terms[9] += short_


cdef inline void open_ends(
    const Scene *scene,
    const int32_t *stones,
    const int32_t *turns,
    Py_ssize_t count,
    const int32_t *x,
    Course *out,
) noexcept nogil:
    """Find the ends of the head joints of a course, with what is free at the wall's ends."""
    cdef Py_ssize_t i
    cdef int32_t left, right
    out.joint_count = count + 1
    out.joints[0], out.joints[1] = 0, x[0]
    for i in range(count):
        left = x[i] + scene.width[4 * stones[i] + turns[stones[i]]]
        right = x[i + 1] if i + 1 < count else scene.wall_width
        if left > right:
            left = right = (left + right) >> 1
        out.joints[2 * i + 2], out.joints[2 * i + 3] = left, right


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


cdef inline double slack(
    const Scene *scene, const Course *here, const int32_t *below, int32_t mean
) noexcept nogil:
    """Return the widths of joints times what is free in them from below to a mean height."""
    cdef Py_ssize_t i
    cdef int32_t left, right, j
    cdef int64_t free_
    cdef double total = 0.0
    for i in range(here.joint_count):
        left, right = here.joints[2 * i], here.joints[2 * i + 1]
        free_ = 0
        for j in range(left >> COLUMN_BITS, right >> COLUMN_BITS):
            if mean > below[j]:
                free_ += mean - below[j]
        total += <double> (right - left) * <double> free_
    return total
