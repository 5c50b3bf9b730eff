# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.drops` and :mod:`drystone.kernels.drop_costs`."""

from libc.math cimport INFINITY, fabs, floor
from libc.stdint cimport int32_t, int64_t

import numpy as np

cdef double EDGE = 1e-9
cdef double TOUCHING = 1.5
cdef double NO_JOINT = 0.5
cdef double END = 1.0


cdef struct Terms:
    double cell_px, width_px, height_px, slack_px, clearance_px, narrowest_px
    double mean_height_px, mean_area_px
    double height, void, gap, slot, headroom, step, joint, unbalanced
    # Weights of lengths and areas.
    double of_height, of_void, of_slot, of_headroom, of_step


cdef struct Box:
    double left, bottom, right, top


cdef struct Wall:
    const double *tops
    Py_ssize_t columns
    # Boxes of the polygons that own columns.
    Box *boxes
    Py_ssize_t shown


cdef struct Places:
    double *lift
    double *cost
    double *lean
    # The next column to the right that is higher, for each column.
    Py_ssize_t *higher
    Py_ssize_t count


def drops(profile, stone, terms, double constant, (Py_ssize_t, Py_ssize_t, Py_ssize_t) numbers):
    """Return what `drops_numpy` returns."""
    cdef const double[::1] tops = np.ascontiguousarray(profile[0])
    cdef const int32_t[:] owners = profile[1]
    cdef const double[:, :] boxes = profile[2]
    cdef const double[::1] bottoms = np.ascontiguousarray(stone[0])
    cdef const int64_t[:] rest_width = terms[16]
    cdef const int64_t[:] rest_height = terms[17]
    cdef Terms weights = terms_of(terms)
    cdef Box box = Box(stone[2], stone[3], stone[4], stone[5])
    cdef Py_ssize_t places = numbers[0], at, near, taken = 0
    cdef double[:, ::1] floats = np.empty((3, places))
    cdef Py_ssize_t[::1] higher = np.empty(tops.shape[0], np.intp)
    cdef unsigned char[::1] owns = np.zeros(max(1, boxes.shape[0]), np.uint8)
    cdef double[:, ::1] shown = np.empty((min(owns.shape[0], tops.shape[0]), 4))
    rows = np.empty((min(places, max(0, numbers[2])), 4))
    cdef double[:, ::1] out = rows
    cdef Wall wall = Wall(&tops[0], tops.shape[0], <Box *> &shown[0, 0], 0)
    cdef Places found = Places(&floats[0, 0], &floats[1, 0], &floats[2, 0], &higher[0], places)
    with nogil:
        at = show(owners, boxes, owns, &wall)
    if at >= 0:
        raise ValueError(f"a column of polygon {at}, but there are {boxes.shape[0]}")
    with nogil:
        rise(&wall, &found)
        lay_down(&wall, bottoms, &box, &weights, rest_height, constant, &found)
        for at in range(places):
            if found.cost[at] < INFINITY:
                look_around(&wall, bottoms, &box, &weights, rest_width, &found, at)
        while taken < out.shape[0]:
            at = cheapest(&found)
            if found.cost[at] == INFINITY:
                break
            out[taken, 0] = at * weights.cell_px
            out[taken, 1] = found.lift[at] + weights.clearance_px
            out[taken, 2] = found.cost[at]
            out[taken, 3] = found.lean[at]
            taken += 1
            for near in range(max(0, at - numbers[1] + 1), min(places, at + numbers[1])):
                found.cost[near] = INFINITY
    return rows[:taken]


cdef Terms terms_of(terms):
    """Read the numbers of a `DropTerms`."""
    cdef Terms read
    (
        read.cell_px, read.width_px, read.height_px, read.slack_px, read.clearance_px,
        read.narrowest_px, read.mean_height_px, read.mean_area_px, read.height, read.void,
        read.gap, read.slot, read.headroom, read.step, read.joint, read.unbalanced, _, _,
    ) = terms
    read.of_height = read.height / read.mean_height_px
    read.of_void = read.void / read.mean_area_px
    read.of_slot = read.slot / read.mean_area_px
    read.of_headroom = read.headroom / read.mean_area_px
    read.of_step = read.step / read.mean_height_px
    return read


cdef Py_ssize_t show(
    const int32_t[:] owners, const double[:, :] boxes, unsigned char[::1] owns, Wall *wall
) noexcept nogil:
    """Gather the boxes of owners, in their order; return an owner that has none, or -1."""
    cdef Py_ssize_t at
    for at in range(owners.shape[0]):
        if owners[at] >= boxes.shape[0]:
            return owners[at]
        if owners[at] >= 0:
            owns[owners[at]] = 1
    for at in range(boxes.shape[0]):
        if owns[at]:
            wall.boxes[wall.shown] = Box(boxes[at, 0], boxes[at, 1], boxes[at, 2], boxes[at, 3])
            wall.shown += 1
    return -1


cdef void rise(const Wall *wall, Places *found) noexcept nogil:
    """Find the next higher column to the right of each; past the last where there is none."""
    cdef Py_ssize_t at, next_one
    for at in range(wall.columns - 1, -1, -1):
        next_one = at + 1
        while next_one < wall.columns and wall.tops[next_one] <= wall.tops[at]:
            next_one = found.higher[next_one]
        found.higher[at] = next_one


cdef void lay_down(
    const Wall *wall,
    const double[::1] bottoms,
    const Box *stone,
    const Terms *terms,
    const int64_t[:] rest_height,
    double constant,
    Places *found,
) noexcept nogil:
    """Drop the stone everywhere: what that costs without a look around."""
    cdef Py_ssize_t columns = bottoms.shape[0], k, at, free, most = rest_height.shape[0] - 1
    cdef double hollow = 0.0, top, void, headroom, fits
    cdef double width = stone.right - stone.left, last = width - (columns - 1) * terms.cell_px
    cdef double *under = found.cost
    for at in range(found.count):
        found.lift[at] = -INFINITY
        under[at] = 0.0
    for k in range(columns - 1):
        hollow += bottoms[k]
        lay(found.lift, under, wall.tops + k, bottoms[k], found.count)
    for at in range(found.count):
        found.lift[at] = max(found.lift[at], wall.tops[at + columns - 1] - bottoms[columns - 1])
        void = terms.cell_px * ((found.lift[at] * (columns - 1) + hollow) - under[at]) + last * (
            (found.lift[at] + bottoms[columns - 1]) - wall.tops[at + columns - 1]
        )
        top = found.lift[at] + stone.top
        if top > terms.height_px + terms.slack_px:
            found.cost[at] = INFINITY
            continue
        fits = floor((terms.height_px - top) / terms.cell_px + EDGE)
        free = <Py_ssize_t> min(max(fits, 0.0), <double> most)
        headroom = <double> rest_height[free] * (terms.cell_px * width)
        found.cost[at] = constant + terms.of_height * found.lift[at]
        found.cost[at] = found.cost[at] + terms.of_void * void
        found.cost[at] = found.cost[at] + terms.of_headroom * headroom


cdef inline void lay(
    double *lift, double *under, const double *tops, double bottom, Py_ssize_t count
) noexcept nogil:
    """Take in one column of the stone at all places."""
    cdef Py_ssize_t at
    cdef double high
    for at in range(count):
        high = tops[at] - bottom
        lift[at] = high if high > lift[at] else lift[at]
        under[at] += tops[at]


cdef void look_around(
    const Wall *wall,
    const double[::1] bottoms,
    const Box *stone,
    const Terms *terms,
    const int64_t[:] rest_width,
    Places *found,
    Py_ssize_t at,
) noexcept nogil:
    """Add the other costs of a place."""
    cdef double lift = found.lift[at], cost = found.cost[at], area = 0.0, lean, slot
    cdef double left = at * terms.cell_px, width = stone.right - stone.left
    cdef Box box = Box(left, lift + stone.bottom, left + width, lift + stone.top)
    cdef double middle = (box.bottom + box.top) / 2.0, foot = box.bottom + terms.cell_px
    cdef double full = terms.mean_area_px / terms.cell_px
    cdef Py_ssize_t to_left = at - 1, end = at + bottoms.shape[0], to_right = end, free
    while to_left >= 0 and wall.tops[to_left] < middle and area < full:
        area += box.top - max(wall.tops[to_left], box.bottom)
        to_left -= 1
    cost += terms.gap * min(1.0, area * terms.cell_px / terms.mean_area_px)
    while to_right < wall.columns and wall.tops[to_right] <= foot:
        to_right = found.higher[to_right]
    free = min(to_right - end, rest_width.shape[0] - 1)
    slot = <double> rest_width[free] * (terms.cell_px * (box.top - box.bottom))
    cost += terms.of_slot * slot
    cost += terms.of_step * step(wall, &box)
    cost += terms.joint * joint(wall, &box, terms)
    lean = leaning(wall.tops + at, bottoms, stone, terms, lift)
    found.cost[at] = cost + terms.unbalanced * fabs(lean)
    found.lean[at] = lean


cdef double step(const Wall *wall, const Box *box) noexcept nogil:
    """Return how far the top is from level with the left neighbour's (Eq. 6)."""
    cdef double shared, smaller
    cdef Py_ssize_t one
    cdef const Box *other
    cdef const Box *nearest = NULL
    for one in range(wall.shown):
        other = &wall.boxes[one]
        if not 2.0 * other.right <= box.left + box.right:
            continue
        if nearest != NULL and other.right < nearest.right:
            continue
        shared = min(other.top, box.top) - max(other.bottom, box.bottom)
        smaller = min(other.top - other.bottom, box.top - box.bottom)
        if not 2.0 * shared >= smaller:
            continue
        if nearest == NULL or other.right > nearest.right or other.top > nearest.top:
            nearest = other
    return 0.0 if nearest == NULL else fabs(box.top - nearest.top)


cdef double joint(const Wall *wall, const Box *box, const Terms *terms) noexcept nogil:
    """Return 1 - IWR (Eq. 9)."""
    cdef double width = terms.width_px, narrowest = terms.narrowest_px, away, rise, distance
    cdef double middle = (box.bottom + box.top) / 2.0, ratios = 0.0
    cdef double least_one = INFINITY, least_two = INFINITY
    cdef Py_ssize_t at
    cdef const Box *below
    cdef const Box *one = NULL
    cdef const Box *two = NULL
    if min(box.left, width - box.right) < narrowest:
        return END
    if box.bottom < terms.cell_px / 2.0:
        return NO_JOINT
    for at in range(wall.shown):
        below = &wall.boxes[at]
        if below.top > middle:
            continue
        rise = below.top - box.bottom
        away = below.right - box.left
        distance = away * away + rise * rise
        if below.right < width - narrowest and distance < least_one:
            one, least_one = below, distance
        away = below.left - box.right
        distance = away * away + rise * rise
        if below.left > narrowest and distance < least_two:
            two, least_two = below, distance
    if one == NULL and two == NULL:
        return NO_JOINT
    if one != NULL:
        ratios = min(1.0, fabs(one.right - box.left) / (one.right - one.left))
    if two != NULL:
        ratios += min(1.0, fabs(two.left - box.right) / (two.right - two.left))
    return 1.0 - ratios / (2.0 if one != NULL and two != NULL else 1.0)


cdef inline double leaning(
    const double *tops,
    const double[::1] bottoms,
    const Box *stone,
    const Terms *terms,
    double lift,
) noexcept nogil:
    """Return how far the centroid is right of what carries the stone, in widths."""
    cdef Py_ssize_t start = 0, end = bottoms.shape[0] - 1
    cdef double width = stone.right - stone.left, limit = TOUCHING * terms.cell_px, left, right
    # One column at least touches.
    while start < end and (lift + bottoms[start]) - tops[start] >= limit:
        start += 1
    while end > start and (lift + bottoms[end]) - tops[end] >= limit:
        end -= 1
    left = -stone.left - start * terms.cell_px
    right = -stone.left - min(width, (end + 1) * terms.cell_px)
    return (min(0.0, left) + max(0.0, right)) / width


cdef Py_ssize_t cheapest(const Places *found) noexcept nogil:
    """Return the place of the least cost; of equal ones the lower, then the first."""
    cdef Py_ssize_t at, best = 0
    for at in range(1, found.count):
        if found.cost[at] > found.cost[best]:
            continue
        if found.cost[at] < found.cost[best] or found.lift[at] < found.lift[best]:
            best = at
    return best
