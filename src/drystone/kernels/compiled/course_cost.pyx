# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.course_cost`, with `course_stand` and `course_lay`."""

from libc.stdint cimport int32_t, int64_t

import numpy as np

from drystone.kernels.compiled.course_lay cimport Span, lay
from drystone.kernels.compiled.course_paths cimport (
    STARTS,
    crossing_percent,
    mean_percent,
    nearest_bed,
    path_starts,
    ways_up,
)
from drystone.kernels.compiled.course_scene cimport (
    TERMS,
    Course,
    Layers,
    Scene,
    fill_scene,
    free_scene,
    weighted,
)
from drystone.kernels.compiled.course_stand cimport meet, stand

cdef enum:
    PIXEL_UNITS = 32


def evaluate(poses, plan, ground, rules, const double[::1] weights):
    """Return the fields of a layout: what `evaluate_python` returns."""
    cdef const int32_t[::1] order = plan.order, turns = plan.turns
    cdef const int32_t[::1] sizes = plan.sizes, gaps = plan.gaps
    cdef Py_ssize_t courses = sizes.shape[0], stones = order.shape[0], i, j, start = 0
    x, y, slope = (np.zeros(int(np.sum(plan.sizes)), np.int32) for _ in range(3))
    terms = np.zeros((courses + 1, TERMS))
    cdef int32_t[::1] xs = x, ys = y, slopes = slope
    cdef double[:, ::1] counted = terms
    cdef double[::1] outer = np.zeros(TERMS)
    cdef Scene scene
    cdef Span changed
    cdef int32_t top
    cdef Layers layers = Layers(ground, courses, stones)
    cdef Course *course = layers.courses
    cdef double cost
    fill_scene(&scene, poses, ground, rules, weights)
    for i in range(courses):
        start += sizes[i]
    cost = left_out(&scene, &order[0] + start, stones - start, &outer[0])
    start = 0
    for i in range(courses):
        stand(&scene, &order[0] + start, &turns[0], sizes[i], gaps[i], NULL, course + i + 1)
        meet(&scene, course + i, NULL, course + i + 1)
        changed = Span(0, scene.columns)
        lay(&scene, course + i, NULL, i == courses - 1, &changed, course + i + 1)
        layers.seen[i] = course + i + 1
        cost += course[i + 1].cost
        for j in range(TERMS):
            counted[i, j] = course[i + 1].terms[j]
        for j in range(sizes[i]):
            xs[start + j] = course[i + 1].lain[j].x
            ys[start + j] = course[i + 1].lain[j].y
            slopes[start + j] = course[i + 1].lain[j].slope
        start += sizes[i]
        go_up(&scene, course + i, course + i + 1)
    top = top_of(&scene, course + courses)
    counted[courses, 14] = across(&scene, layers.seen, courses, top)
    counted[courses, 15] = down(&scene, course + courses, top)
    cost += weighted(&scene, &counted[courses, 0])
    counted[courses, 13] = outer[13]
    free_scene(&scene)
    tops, joints = layers.last(courses)
    return x, y, slope, tops, joints, terms, cost


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


cdef void go_up(const Scene *scene, const Course *below, Course *out) noexcept nogil:
    """Find how far paths from the bottom to the joints of a course go aside."""
    ways_up(
        out.joints, out.joint_count, below.joints, below.joint_count, below.ways, scene.starts,
        scene.start_count, out.ways,
    )


cdef int32_t top_of(const Scene *scene, const Course *last) noexcept nogil:
    """Return the height of a wall."""
    cdef Py_ssize_t i
    cdef int32_t top = last.tops[0]
    for i in range(1, scene.columns):
        top = last.tops[i] if last.tops[i] > top else top
    return top


cdef double across(
    const Scene *scene, const Course *const *courses, Py_ssize_t count, int32_t top
) noexcept nogil:
    """Return F_AH of a whole wall, in percent, as far as bed joints tell."""
    cdef int32_t starts[STARTS]
    cdef int32_t lengths[STARTS]
    cdef int32_t found = path_starts(top, starts), half = PIXEL_UNITS / 2
    cdef const int32_t *bed
    cdef Py_ssize_t i
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
    return mean_percent(lengths, found, scene.wall_width + 2 * PIXEL_UNITS)


cdef double down(const Scene *scene, const Course *last, int32_t top) noexcept nogil:
    """Return by how much F_AV is short of its target, as far as head joints tell."""
    cdef double crossed
    if scene.start_count == 0:
        return 0.0
    crossed = crossing_percent(
        last.joints, last.joint_count, last.ways, scene.starts, scene.start_count, top
    )
    return scene.target - crossed if scene.target > crossed else 0.0
