# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.courses`."""

from libc.math cimport INFINITY, fabs
from libc.stdint cimport int32_t, uint64_t
from libc.string cimport memcpy

import numpy as np

from drystone.kernels.compiled.course_cost cimport across, down, go_up, left_out, top_of
from drystone.kernels.compiled.course_lay cimport Span, lay
from drystone.kernels.compiled.course_moves cimport NOTHING, Draft, below, change, start_of
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
    # A bound of a cost is a sum in another order: far less than this share of it off.
    ROUNDING = 1000000000

cdef struct Trial:
    Draft draft
    Course *courses
    const Course **seen
    double outer
    double cost


def anneal(
    poses, plan, ground, rules, const double[::1] weights, cooling, uint64_t seed,
    const double[::1] luck, look, Py_ssize_t each,
):
    """Return the fields of the best arrangement, and its cost; `look` is called in between."""
    cdef const int32_t[::1] order = plan.order, turns = plan.turns
    cdef const int32_t[::1] sizes = plan.sizes, gaps = plan.gaps
    cdef Py_ssize_t stones = order.shape[0], most = rules.courses, kept
    cdef Py_ssize_t numbers = 3 * stones + 2 * most
    cdef int32_t[::1] room = np.zeros(3 * numbers, np.int32)
    cdef Layers now_layers = Layers(ground, most, stones)
    cdef Layers trial_layers = Layers(ground, most, stones)
    cdef Trial now, trial, best
    cdef Scene scene
    cdef Py_ssize_t evaluations = cooling.evaluations, done = 0, count
    cdef double temperature = cooling.temperature, factor = cooling.factor, doubt = cooling.doubt
    now.courses, trial.courses = now_layers.courses, trial_layers.courses
    now.seen = trial.seen = trial_layers.seen
    point(&now.draft, &room[0], stones, most)
    point(&trial.draft, &room[numbers], stones, most)
    point(&best.draft, &room[2 * numbers], stones, most)
    now.draft.courses = <int32_t> sizes.shape[0]
    memcpy(now.draft.order, &order[0], stones * sizeof(int32_t))
    memcpy(now.draft.turns, &turns[0], stones * sizeof(int32_t))
    memcpy(now.draft.sizes, &sizes[0], sizes.shape[0] * sizeof(int32_t))
    memcpy(now.draft.gaps, &gaps[0], sizes.shape[0] * sizeof(int32_t))
    fill_scene(&scene, poses, ground, rules, weights)
    try:
        begin(&scene, &now, &best, doubt)
        while done < evaluations:
            look()
            count = min(each, evaluations - done)
            with nogil:
                search(
                    &scene, &now, &trial, &best, <int32_t> most, count, &temperature, factor,
                    doubt, &seed, &luck[0], <int32_t> luck.shape[0],
                )
            done += count
    finally:
        free_scene(&scene)
    found = np.asarray(room)[2 * numbers : 3 * numbers]
    kept = best.draft.courses
    parts = (
        found[:stones],
        found[stones : 2 * stones],
        found[3 * stones : 3 * stones + kept],
        found[3 * stones + most : 3 * stones + most + kept],
    )
    return *(part.copy() for part in parts), best.cost


cdef void point(Draft *draft, int32_t *room, Py_ssize_t stones, Py_ssize_t most) noexcept nogil:
    """Point to the room of a draft."""
    draft.order, draft.turns, draft.spare = room, room + stones, room + 2 * stones
    draft.sizes, draft.gaps = room + 3 * stones, room + 3 * stones + most
    draft.stones, draft.courses = <int32_t> stones, 0


cdef void copy(const Draft *source, Draft *to) noexcept nogil:
    """Make one draft like another."""
    memcpy(to.order, source.order, source.stones * sizeof(int32_t))
    memcpy(to.turns, source.turns, source.stones * sizeof(int32_t))
    memcpy(to.sizes, source.sizes, source.courses * sizeof(int32_t))
    memcpy(to.gaps, source.gaps, source.courses * sizeof(int32_t))
    to.courses = source.courses


cdef void begin(const Scene *scene, Trial *now, Trial *best, double doubt) noexcept nogil:
    """Lay the first arrangement; it is the best so far."""
    now.cost = laid_again(scene, now, now, 0, INFINITY, doubt)
    copy(&now.draft, &best.draft)
    best.cost = now.cost


cdef void search(
    const Scene *scene,
    Trial *now,
    Trial *trial,
    Trial *best,
    int32_t most,
    Py_ssize_t evaluations,
    double *temperature,
    double factor,
    double doubt,
    uint64_t *state,
    const double *luck,
    int32_t luck_count,
) noexcept nogil:
    """Anneal for a while; what is best is in the draft and the cost of `best`."""
    cdef Py_ssize_t step
    cdef int32_t lowest, i
    cdef double limit
    cdef Course held
    for step in range(evaluations):
        temperature[0] *= factor
        copy(&now.draft, &trial.draft)
        lowest = change(&trial.draft, state, most)
        if lowest == NOTHING:
            continue
        limit = now.cost + temperature[0] * luck[below(state, luck_count)]
        trial.cost = laid_again(scene, now, trial, lowest, limit, doubt)
        if not trial.cost <= limit:
            continue
        copy(&trial.draft, &now.draft)
        now.cost, now.outer = trial.cost, trial.outer
        for i in range(lowest + 1, trial.draft.courses + 1):
            held = now.courses[i]
            now.courses[i] = trial.courses[i]
            trial.courses[i] = held
        if now.cost < best.cost:
            copy(&now.draft, &best.draft)
            best.cost = now.cost


cdef double laid_again(
    const Scene *scene, const Trial *now, Trial *trial, int32_t lowest, double limit, double doubt
) noexcept nogil:
    """Lay the courses of a trial from the lowest that changed, until it costs more than a limit.

    What it must cost at least is known before any stone is laid.
    """
    cdef const Draft *draft = &trial.draft
    cdef const Course *below = &now.courses[lowest]
    cdef const Course *old
    cdef Course *here
    cdef int32_t course, courses = draft.courses, olds = 0 if trial == now else now.draft.courses
    cdef int32_t highest = 0
    cdef double bound = limit + fabs(limit) / <double> ROUNDING, cost, was, sure
    cdef Span changed = Span(0, 0)
    was, cost = now.outer, set_out(scene, trial)
    for course in range(lowest):
        trial.seen[course] = &now.courses[course + 1]
        was += trial.seen[course].cost
        cost += trial.seen[course].cost
    sure = stood(scene, now, trial, lowest, olds, &highest)
    if cost + sure > bound:
        return INFINITY
    for course in range(lowest, courses):
        here = &trial.courses[course + 1]
        old = &now.courses[course + 1] if course < olds else NULL
        lay(scene, below, old, course == courses - 1, &changed, here)
        trial.seen[course] = below = here
        cost += here.cost
        sure -= here.sure
        if cost + sure > bound:
            return INFINITY
        if courses == olds:
            was += old.cost
            if highest <= course < courses - 1 and cost - was > limit - now.cost + doubt:
                return INFINITY
    return with_paths(scene, now, trial, lowest, cost, bound)


cdef double set_out(const Scene *scene, Trial *trial) noexcept nogil:
    """Return what the stones that are left out of a trial cost."""
    cdef const Draft *draft = &trial.draft
    cdef int32_t start = start_of(draft, draft.courses)
    cdef double terms[TERMS]
    trial.outer = left_out(scene, draft.order + start, draft.stones - start, terms)
    return trial.outer


cdef double with_paths(
    const Scene *scene,
    const Trial *now,
    const Trial *trial,
    int32_t lowest,
    double cost,
    double bound,
) noexcept nogil:
    """Add to the cost of all courses that of the paths along the joints of the wall."""
    cdef int32_t course, courses = trial.draft.courses
    cdef const Course *below = &now.courses[lowest]
    cdef int32_t top = top_of(scene, trial.seen[courses - 1]), i
    cdef double terms[TERMS]
    for i in range(TERMS):
        terms[i] = 0.0
    terms[14] = across(scene, trial.seen, courses, top)
    if cost + terms[14] * scene.weights[14] > bound:
        return INFINITY
    for course in range(lowest, courses):
        go_up(scene, below, &trial.courses[course + 1])
        below = &trial.courses[course + 1]
    terms[15] = down(scene, trial.seen[courses - 1], top)
    return cost + weighted(scene, terms)


cdef double stood(
    const Scene *scene, const Trial *now, Trial *trial, int32_t lowest, int32_t olds,
    int32_t *highest
) noexcept nogil:
    """Stand the stones of a trial side by side; return what its courses cost at least.

    `highest` is set to the highest of its courses that changed.
    """
    cdef const Draft *draft = &trial.draft
    cdef const Course *below = &now.courses[lowest]
    cdef const Course *old
    cdef Course *here
    cdef int32_t start = start_of(draft, lowest), course
    cdef bint same, was = True
    cdef double sure = 0.0
    for course in range(lowest, draft.courses):
        here = &trial.courses[course + 1]
        old = &now.courses[course + 1] if course < olds else NULL
        same = stand(
            scene, draft.order + start, draft.turns, draft.sizes[course], draft.gaps[course],
            old, here,
        )
        if not same:
            highest[0] = course
        meet(scene, below, old if same and was else NULL, here)
        was, below = same, here
        sure += here.sure
        start += draft.sizes[course]
    return sure
