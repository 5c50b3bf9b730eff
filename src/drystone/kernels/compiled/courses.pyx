# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.courses`."""

from libc.math cimport INFINITY
from libc.stdint cimport int32_t, uint64_t
from libc.string cimport memcpy

import numpy as np

from drystone.kernels.compiled.course_cost cimport (
    TERMS,
    Course,
    Layers,
    Places,
    Scene,
    fill_scene,
    free_scene,
    lay_course,
    left_out,
    paths,
)
from drystone.kernels.compiled.course_moves cimport NOTHING, Draft, below, change, start_of

cdef struct Trial:
    Draft draft
    Course *courses
    Course *seen
    double cost


def anneal(
    poses, plan, ground, rules, const double[::1] weights, cooling, uint64_t seed,
    const double[::1] luck,
):
    """Return the fields of the best arrangement, and its cost."""
    cdef const int32_t[::1] order = plan.order, turns = plan.turns
    cdef const int32_t[::1] sizes = plan.sizes, gaps = plan.gaps
    cdef Py_ssize_t stones = order.shape[0], most = rules.courses, kept
    cdef Py_ssize_t numbers = 3 * stones + 2 * most
    # Three drafts and places, in one array.
    cdef int32_t[::1] room = np.zeros(3 * numbers + 3 * stones, np.int32)
    cdef double[::1] terms = np.zeros(TERMS)
    cdef Layers now_layers = Layers(ground, most, stones)
    cdef Layers trial_layers = Layers(ground, most, stones)
    cdef Trial now, trial, best
    cdef Places places
    cdef Scene scene
    cdef Py_ssize_t evaluations = cooling.evaluations
    cdef double temperature = cooling.temperature, factor = cooling.factor
    places = Places(
        &room[3 * numbers], &room[3 * numbers + stones], &room[3 * numbers + 2 * stones], &terms[0]
    )
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
    with nogil:
        search(
            &scene, &now, &trial, &best, places, <int32_t> most, evaluations, temperature,
            factor, seed, &luck[0], <int32_t> luck.shape[0],
        )
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


cdef void search(
    const Scene *scene,
    Trial *now,
    Trial *trial,
    Trial *best,
    Places places,
    int32_t most,
    Py_ssize_t evaluations,
    double temperature,
    double factor,
    uint64_t state,
    const double *luck,
    int32_t luck_count,
) noexcept nogil:
    """Anneal; what is best is in the draft and the cost of `best`."""
    cdef Py_ssize_t step
    cdef int32_t lowest, i
    cdef double limit
    cdef Course held
    now.cost = lay(scene, now, now, 0, places, INFINITY)
    copy(&now.draft, &best.draft)
    best.cost = now.cost
    for step in range(evaluations):
        temperature *= factor
        copy(&now.draft, &trial.draft)
        lowest = change(&trial.draft, &state, most)
        if lowest == NOTHING:
            continue
        limit = now.cost + temperature * luck[below(&state, luck_count)]
        trial.cost = lay(scene, now, trial, lowest, places, limit)
        if not trial.cost <= limit:
            continue
        copy(&trial.draft, &now.draft)
        now.cost = trial.cost
        for i in range(lowest + 1, trial.draft.courses + 1):
            held = now.courses[i]
            now.courses[i] = trial.courses[i]
            trial.courses[i] = held
        if now.cost < best.cost:
            copy(&now.draft, &best.draft)
            best.cost = now.cost


cdef double lay(
    const Scene *scene,
    Trial *now,
    Trial *trial,
    int32_t lowest,
    Places places,
    double limit,
) noexcept nogil:
    """Lay the courses of a trial from the lowest that changed, until it costs more than a limit."""
    cdef const Draft *draft = &trial.draft
    cdef const Course *below = &now.courses[lowest]
    cdef int32_t start = start_of(draft, draft.courses), course
    cdef double cost = left_out(scene, draft.order + start, draft.stones - start, places.terms)
    for course in range(lowest):
        trial.seen[course] = now.courses[course + 1]
        cost += trial.seen[course].cost
    start = start_of(draft, lowest)
    for course in range(lowest, draft.courses):
        if cost > limit:
            return cost
        lay_course(
            scene, draft.order + start, draft.turns, draft.sizes[course], draft.gaps[course],
            below, course == draft.courses - 1, &trial.courses[course + 1], places,
        )
        below = &trial.courses[course + 1]
        trial.seen[course] = below[0]
        start += draft.sizes[course]
        cost += below.cost
    return cost + paths(scene, trial.seen, draft.courses, places.terms)
