# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.drops` and :mod:`drystone.kernels.drop_costs`."""

from libc.math cimport INFINITY, fabs
from libc.stdint cimport int32_t, int64_t

import numpy as np

cdef double EDGE = 1e-9
cdef double TOUCHING = 1.5
cdef double NO_JOINT = 0.5
cdef double END = 1.0
cdef double CLOSE = 1e-9

# The last stage of `look_around`.
cdef enum:
    STAGES = 3


cdef struct Terms:
    double cell_px, width_px, height_px, slack_px, clearance_px, narrowest_px
    double mean_height_px, mean_area_px
    double height, void, gap, slot, headroom, step, joint, unbalanced
    # Weights of lengths and areas.
    double of_height, of_void, of_slot, of_headroom, of_step
    # Whether no stage of `look_around` makes a place cheaper.
    bint rising


cdef struct Box:
    double left, bottom, right, top


cdef struct Wall:
    const double *tops
    Py_ssize_t columns
    # Boxes of the polygons that own columns.
    Box *boxes
    Py_ssize_t shown
    # The next column to the right that is higher, for each column.
    Py_ssize_t *higher
    # The sum of the first k columns from each on, k = 0, 1, ...
    double *sums
    # What stones that are left cannot fill of free widths and heights, up to the longest.
    const int64_t *rest_width
    const int64_t *rest_height
    Py_ssize_t longest_width, longest_height


cdef struct Stone:
    const double *bottoms
    Py_ssize_t columns
    Box box


cdef struct Places:
    double *lift
    double *lean
    # How far `look_around` has come at each place.
    unsigned char *stage
    Py_ssize_t count
    # The sum of the costs that are known so far; infinite where it cannot go.
    double *cost


cdef struct Kept:
    # The cheapest drops of all stones so far, only so many of a group.
    double *cost
    int64_t *group
    Py_ssize_t count, most, each
    # Drops that cost more, by more than CLOSE, are not asked for.
    double limit


def drops(
    profile,
    stones,
    terms,
    const double[::1] constants,
    const int64_t[:, ::1] numbers,
    (Py_ssize_t, Py_ssize_t, Py_ssize_t) wanted,
):
    """Return what `drops_numpy` returns."""
    cdef const double[::1] tops = np.ascontiguousarray(profile[0])
    cdef const int32_t[:] owners = profile[1]
    cdef const double[:, :] boxes = profile[2]
    cdef const double[::1] bottoms = stones[0]
    cdef const int64_t[::1] first = stones[1]
    cdef const double[:, ::1] extents = stones[2]
    cdef const int64_t[::1] rest_width = np.ascontiguousarray(terms[16])
    cdef const int64_t[::1] rest_height = np.ascontiguousarray(terms[17])
    cdef Terms weights = terms_of(terms)
    cdef Py_ssize_t size = constants.shape[0], columns = tops.shape[0], most = 0, widest = 1
    cdef Py_ssize_t at, turn
    for at in range(size):
        most = max(most, numbers[at, 0])
        if numbers[at, 0] > 0:
            widest = max(widest, first[at + 1] - first[at])
    # What is cheap by itself first: it limits how dear the others may be.
    cdef const Py_ssize_t[::1] order = np.argsort(constants, kind="stable")
    cdef double[:, ::1] floats = np.empty((3, max(1, columns)))
    cdef double[:, ::1] sums = np.empty((widest, max(1, columns)))
    cdef Py_ssize_t[::1] higher = np.empty(max(1, columns), np.intp)
    cdef unsigned char[::1] stages = np.empty(max(1, columns), np.uint8)
    cdef unsigned char[::1] owns = np.zeros(max(1, boxes.shape[0]), np.uint8)
    cdef double[:, ::1] shown = np.empty((owns.shape[0], 4))
    cdef double[::1] costs = np.empty(max(1, wanted[1]))
    cdef int64_t[::1] groups = np.empty(max(1, wanted[1]), np.int64)
    rows = np.empty((size, min(most, max(0, wanted[0])), 4))
    taken = np.zeros(size, np.intp)
    cdef double[:, :, ::1] out = rows
    cdef Py_ssize_t[::1] ends = taken
    cdef Kept kept = Kept(&costs[0], &groups[0], 0, wanted[1], wanted[2], INFINITY)
    cdef double limit
    cdef Stone stone
    cdef Wall wall = Wall(
        &tops[0], columns, <Box *> &shown[0, 0], 0, &higher[0], &sums[0, 0],
        &rest_width[0], &rest_height[0], rest_width.shape[0] - 1, rest_height.shape[0] - 1,
    )
    cdef Places found = Places(&floats[0, 0], &floats[1, 0], &stages[0], 0, &floats[2, 0])
    with nogil:
        at = show(owners, boxes, owns, &wall)
    if at >= 0:
        raise ValueError(f"a column of polygon {at}, but there are {boxes.shape[0]}")
    with nogil:
        rise(&wall)
        add_up(&wall, widest)
        for turn in range(size):
            at = order[turn]
            found.count = numbers[at, 0]
            if found.count <= 0:
                continue
            stone.bottoms, stone.columns = &bottoms[first[at]], first[at + 1] - first[at]
            stone.box = Box(extents[at, 0], extents[at, 1], extents[at, 2], extents[at, 3])
            lay_down(&wall, &stone, &weights, constants[at], &found)
            limit = kept.limit + CLOSE
            ends[at] = take(&wall, &stone, &weights, numbers[at, 1], limit, &found, out[at])
            keep(&kept, out[at], ends[at], numbers[at, 2])
    return rows, taken, kept.limit


cdef void keep(
    Kept *kept, const double[:, ::1] rows, Py_ssize_t count, int64_t group
) noexcept nogil:
    """Take in the drops of a stone where they are among the cheapest; the limit may fall."""
    cdef Py_ssize_t row, at, of_group, dearest, dearest_of_group, out
    if kept.most <= 0:
        return
    for row in range(count):
        of_group, dearest, dearest_of_group = 0, 0, 0
        for at in range(kept.count):
            if kept.cost[at] > kept.cost[dearest]:
                dearest = at
            if kept.group[at] == group:
                if not of_group or kept.cost[at] > kept.cost[dearest_of_group]:
                    dearest_of_group = at
                of_group += 1
        if of_group < kept.each and kept.count < kept.most:
            out = kept.count
            kept.count += 1
        else:
            out = dearest if of_group < kept.each else dearest_of_group
            if rows[row, 2] >= kept.cost[out]:
                continue
        kept.cost[out], kept.group[out] = rows[row, 2], group
    if kept.count == kept.most:
        kept.limit = kept.cost[0]
        for at in range(1, kept.count):
            kept.limit = max(kept.limit, kept.cost[at])


cdef Py_ssize_t take(
    const Wall *wall,
    const Stone *stone,
    const Terms *terms,
    Py_ssize_t apart,
    double limit,
    Places *found,
    double[:, ::1] out,
) noexcept nogil:
    """Write the cheapest places that are so many columns apart; return how many there are."""
    cdef Py_ssize_t taken = 0, at, near
    if not terms.rising:
        for at in range(found.count):
            if found.cost[at] < INFINITY:
                look_around(wall, stone, terms, found, at, STAGES)
    while taken < out.shape[0]:
        at = cheapest(wall, stone, terms, limit, found)
        if at < 0:
            break
        out[taken, 0] = at * terms.cell_px
        out[taken, 1] = found.lift[at] + terms.clearance_px
        out[taken, 2] = found.cost[at]
        out[taken, 3] = found.lean[at]
        taken += 1
        for near in range(max(0, at - apart + 1), min(found.count, at + apart)):
            found.cost[near] = INFINITY
    return taken


cdef Py_ssize_t cheapest(
    const Wall *wall, const Stone *stone, const Terms *terms, double limit, Places *found
) noexcept nogil:
    """Return the place of the least cost; of equal ones the lower, then the first.

    -1 when it costs more than the limit.  Places that are dearer already than that, or than
    another one at last, are left as they are: they only become dearer.
    """
    cdef Py_ssize_t at, best
    cdef int stage
    for stage in range(1, STAGES + 1):
        # What costs least so far does not cost much more at last.
        best = least(found)
        if not found.cost[best] <= limit or found.cost[best] == INFINITY:
            return -1
        look_around(wall, stone, terms, found, best, STAGES)
        limit = min(limit, found.cost[best])
        for at in range(found.count):
            if found.cost[at] <= limit and found.stage[at] < stage:
                look_around(wall, stone, terms, found, at, stage)
                if stage == STAGES:
                    limit = min(limit, found.cost[at])
    best = least(found)
    return best if found.cost[best] <= limit else -1


cdef Py_ssize_t least(const Places *found) noexcept nogil:
    """Return the place that costs least so far; of equal ones the lower, then the first."""
    cdef Py_ssize_t at, best = 0
    cdef double cost = found.cost[0]
    for at in range(1, found.count):
        if found.cost[at] <= cost and (
            found.cost[at] < cost or found.lift[at] < found.lift[best]
        ):
            best, cost = at, found.cost[at]
    return best


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
    read.rising = read.mean_area_px > 0.0 and min(
        read.gap, read.of_slot, read.of_step, read.joint, read.unbalanced
    ) >= 0.0
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


cdef void rise(const Wall *wall) noexcept nogil:
    """Find the next higher column to the right of each; past the last where there is none."""
    cdef Py_ssize_t at, next_one
    for at in range(wall.columns - 1, -1, -1):
        next_one = at + 1
        while next_one < wall.columns and wall.tops[next_one] <= wall.tops[at]:
            next_one = wall.higher[next_one]
        wall.higher[at] = next_one


cdef void lay_down(
    const Wall *wall, const Stone *stone, const Terms *terms, double constant, Places *found
) noexcept nogil:
    """Drop the stone everywhere: what that costs without a look around."""
    cdef Py_ssize_t before = stone.columns - 1, at, k
    cdef double hollow = 0.0, last_bottom = stone.bottoms[before], lift, void, cost
    cdef double width = stone.box.right - stone.box.left, last = width - before * terms.cell_px
    cdef double highest = terms.height_px + terms.slack_px, cell = terms.cell_px
    cdef double of_height = terms.of_height, of_void = terms.of_void, top = stone.box.top
    cdef double of_headroom = terms.of_headroom
    cdef double wide = terms.cell_px * width, most = <double> wall.longest_height, free
    cdef const double *last_top = wall.tops + before
    cdef const double *under = wall.sums + before * wall.columns
    for k in range(before):
        hollow += stone.bottoms[k]
    land(found.lift, wall.tops, stone, found.count)
    for at in range(found.count):
        lift = found.lift[at]
        void = cell * ((lift * before + hollow) - under[at]) + last * (
            (lift + last_bottom) - last_top[at]
        )
        free = min(max((terms.height_px - (lift + top)) / cell + EDGE, 0.0), most)
        cost = constant + of_height * lift
        cost = cost + of_void * void
        cost = cost + of_headroom * (<double> wall.rest_height[<Py_ssize_t> free] * wide)
        found.cost[at] = INFINITY if lift + top > highest else cost
        found.stage[at] = 0


cdef void add_up(const Wall *wall, Py_ssize_t widest) noexcept nogil:
    """Sum up as many columns as may be under a stone, but for its last one."""
    cdef Py_ssize_t at, k
    cdef double *one
    cdef double *more
    for at in range(wall.columns):
        wall.sums[at] = 0.0
    for k in range(widest - 1):
        one = wall.sums + k * wall.columns
        more = one + wall.columns
        for at in range(wall.columns - k):
            more[at] = one[at] + wall.tops[at + k]


cdef void land(
    double *lift, const double *tops, const Stone *stone, Py_ssize_t count
) noexcept nogil:
    """Find where the stone touches at all places: four of its columns at a time."""
    cdef Py_ssize_t at, k = 0
    cdef double one, two, three, four, high
    cdef const double *bottoms = stone.bottoms
    for at in range(count):
        lift[at] = -INFINITY
    while k + 4 <= stone.columns:
        one, two, three, four = bottoms[k], bottoms[k + 1], bottoms[k + 2], bottoms[k + 3]
        for at in range(count):
            high = max(lift[at], tops[at] - one)
            high = max(high, tops[at + 1] - two)
            high = max(high, tops[at + 2] - three)
            lift[at] = max(high, tops[at + 3] - four)
        tops += 4
        k += 4
    while k < stone.columns:
        one = bottoms[k]
        for at in range(count):
            lift[at] = max(lift[at], tops[at] - one)
        tops += 1
        k += 1


cdef void look_around(
    const Wall *wall,
    const Stone *stone,
    const Terms *terms,
    Places *found,
    Py_ssize_t at,
    int stage,
) noexcept nogil:
    """Add further costs of a place, up to a stage.

    The first is that of what is free beside the stone, then that of the left neighbour, then
    those of joints and of what carries it.
    """
    cdef double lift = found.lift[at], left = at * terms.cell_px
    cdef double right = left + (stone.box.right - stone.box.left)
    cdef double *cost = found.cost + at
    cdef Box box = Box(left, lift + stone.box.bottom, right, lift + stone.box.top)
    if found.stage[at] < 1 <= stage:
        cost[0] = with_room(cost[0], wall, stone, terms, &box, at)
    if found.stage[at] < 2 <= stage:
        cost[0] = cost[0] + terms.of_step * step(wall, &box)
    if found.stage[at] < STAGES <= stage:
        found.lean[at] = leaning(wall.tops + at, stone, terms, lift)
        cost[0] = cost[0] + terms.joint * joint(wall, &box, terms)
        cost[0] = cost[0] + terms.unbalanced * fabs(found.lean[at])
    found.stage[at] = stage


cdef double with_room(
    double cost,
    const Wall *wall,
    const Stone *stone,
    const Terms *terms,
    const Box *box,
    Py_ssize_t at,
) noexcept nogil:
    """Add the costs of what is free on the left of a stone and on its right."""
    cdef double slot, area = 0.0
    cdef double middle = (box.bottom + box.top) / 2.0, foot = box.bottom + terms.cell_px
    cdef double full = terms.mean_area_px / terms.cell_px
    cdef Py_ssize_t to_left = at - 1, end = at + stone.columns, to_right = end, free
    while to_left >= 0 and wall.tops[to_left] < middle and area < full:
        area += box.top - max(wall.tops[to_left], box.bottom)
        to_left -= 1
    cost = cost + terms.gap * min(1.0, area * terms.cell_px / terms.mean_area_px)
    while to_right < wall.columns and wall.tops[to_right] <= foot:
        to_right = wall.higher[to_right]
    free = min(to_right - end, wall.longest_width)
    slot = <double> wall.rest_width[free] * (terms.cell_px * (box.top - box.bottom))
    return cost + terms.of_slot * slot


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


cdef double leaning(
    const double *tops, const Stone *stone, const Terms *terms, double lift
) noexcept nogil:
    """Return how far the centroid is right of what carries the stone, in widths."""
    cdef Py_ssize_t start = 0, end = stone.columns - 1
    cdef double width = stone.box.right - stone.box.left, limit = TOUCHING * terms.cell_px
    cdef double left, right
    # One column at least touches.
    while start < end and (lift + stone.bottoms[start]) - tops[start] >= limit:
        start += 1
    while end > start and (lift + stone.bottoms[end]) - tops[end] >= limit:
        end -= 1
    left = -stone.box.left - start * terms.cell_px
    right = -stone.box.left - min(width, (end + 1) * terms.cell_px)
    return (min(0.0, left) + max(0.0, right)) / width
