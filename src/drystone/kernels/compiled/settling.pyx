# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.settling_python`."""

from libc.math cimport cos, fabs, isfinite, sin
from libc.stdint cimport int32_t
from libc.stdlib cimport free, malloc

from drystone.kernels.compiled.firmness cimport (
    Work,
    arm_of,
    enough_rows,
    firmness,
    free_work,
    init_work,
)
from drystone.kernels.compiled.gaps cimport (
    Body,
    Gap,
    Gaps,
    Heap,
    crosses,
    find_gaps,
    free_gaps,
    heap_of,
    init_gaps,
    measure,
)
from drystone.kernels.compiled.seidel cimport Row3, solve3

cdef int RESTS = 0
cdef int FALLS = 1
cdef int OVERLAPS = 2
cdef int FAR = 3
cdef int UNFINISHED = 4
cdef int LOST = -1

cdef int END = -2

cdef double FARTHEST = 1e300
cdef double SPREAD = 2.5
cdef double SMALLEST = 1e-6
cdef double UPWARD = 0.3

ctypedef struct Rules:
    double lean
    double stop
    double mu
    double clearance
    double tolerance
    double corner
    double near
    double far
    double turn
    double shift
    double gain
    double overlap
    double steep
    bint sticks
    bint turns
    Py_ssize_t steps

ctypedef struct Shape:
    const double *corners
    const double *edges
    Py_ssize_t count
    double arm

ctypedef struct State:
    double pose[3]
    double *corners
    double *edges
    Body body
    Gaps gaps
    double least

ctypedef struct Outcome:
    double margin
    Py_ssize_t steps
    Py_ssize_t touching


def settle(
    const double[:, ::1] outline,
    const double[:, ::1] outline_edges,
    double x,
    double y,
    double angle,
    const double[:, ::1] around,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    const double[:, ::1] around_edges,
    double width,
    const double[::1] numbers,
    bint sticks,
    bint turns,
    Py_ssize_t steps,
):
    """Return what `settle_python` returns."""
    cdef Rules rules
    cdef Heap heap = heap_of(around, first, boxes, around_edges, width)
    cdef Shape shape
    cdef State here
    cdef Outcome told
    cdef int status
    rules.lean, rules.stop, rules.mu = numbers[0], numbers[1], numbers[2]
    rules.clearance, rules.tolerance, rules.corner = numbers[3], numbers[4], numbers[5]
    rules.near, rules.far = numbers[6], numbers[7]
    rules.turn, rules.shift, rules.gain = numbers[8], numbers[9], numbers[10]
    rules.overlap, rules.steep = numbers[11], numbers[12]
    heap.beyond = numbers[13]
    rules.sticks, rules.turns, rules.steps = sticks, turns, steps
    shape.corners, shape.edges, shape.count = &outline[0, 0], &outline_edges[0, 0], outline.shape[0]
    here.pose[0], here.pose[1], here.pose[2] = x, y, angle
    told.margin, told.steps, told.touching = -1.0, 0, 0
    with nogil:
        status = run(&shape, &heap, &rules, &here, &told)
    if status == LOST:
        raise MemoryError
    return (
        status, here.pose[0], here.pose[1], here.pose[2], here.least, told.margin, told.steps,
        told.touching,
    )  # fmt: skip


cdef int run(
    Shape *shape, const Heap *heap, const Rules *rules, State *here, Outcome *told
) noexcept nogil:
    """Settle with memory of its own."""
    cdef double *numbers = <double *>malloc(10 * shape.count * sizeof(double))
    cdef State there
    cdef Work work
    cdef int status
    if numbers == NULL:
        return LOST
    here.corners, here.edges = numbers, numbers + 2 * shape.count
    there.corners, there.edges = numbers + 5 * shape.count, numbers + 7 * shape.count
    init_gaps(&here.gaps)
    init_gaps(&there.gaps)
    init_work(&work)
    shape.arm = arm_of(shape.corners, shape.count, 0.0, 0.0)
    look(here, shape, heap, rules)
    if here.least < -rules.overlap or not isfinite(
        shape.arm + here.pose[0] + here.pose[1] + here.pose[2]
    ):
        status = OVERLAPS
    else:
        status = descend(shape, heap, rules, here, &there, &work, told)
        status = judged(status, shape, heap, rules, here, &there.gaps, &work, told)
    if here.gaps.lost or there.gaps.lost or work.lost:
        status = LOST
    free(numbers)
    free_gaps(&here.gaps)
    free_gaps(&there.gaps)
    free_work(&work)
    return status


cdef int judged(
    int status,
    const Shape *shape,
    const Heap *heap,
    const Rules *rules,
    const State *here,
    Gaps *scratch,
    Work *work,
    Outcome *told,
) noexcept nogil:
    """Say how settling ended: whatever stopped it, does the stone rest?"""
    cdef Py_ssize_t i
    if status == FAR:
        return FAR
    if not here.least >= 0.5 * rules.clearance or crosses(&here.body, heap, scratch):
        return OVERLAPS
    told.margin = margin_of(shape, rules, here, work)
    for i in range(here.gaps.count):
        if here.gaps.items[i].away <= rules.tolerance and here.gaps.items[i].other != END:
            told.touching += 1
    return RESTS if told.margin >= 0.0 else status


cdef void look(
    State *state, const Shape *shape, const Heap *heap, const Rules *rules
) noexcept nogil:
    """Turn and move the outline to the pose of a state, and find the gaps there."""
    cdef double c = cos(state.pose[2]), s = sin(state.pose[2]), x, y
    cdef Py_ssize_t i
    for i in range(shape.count):
        x, y = shape.corners[2 * i], shape.corners[2 * i + 1]
        state.corners[2 * i] = c * x - s * y + state.pose[0]
        state.corners[2 * i + 1] = s * x + c * y + state.pose[1]
        x, y = shape.edges[3 * i], shape.edges[3 * i + 1]
        state.edges[3 * i], state.edges[3 * i + 1] = c * x - s * y, s * x + c * y
        state.edges[3 * i + 2] = shape.edges[3 * i + 2]
    state.body.count, state.body.corners, state.body.edges = shape.count, state.corners, state.edges
    measure(&state.body)
    find_gaps(&state.body, heap, SPREAD * rules.far + rules.corner, rules.corner, &state.gaps)
    state.least = FARTHEST
    for i in range(state.gaps.count):
        if state.gaps.items[i].gap < state.least:
            state.least = state.gaps.items[i].gap


cdef double margin_of(
    const Shape *shape, const Rules *rules, const State *here, Work *work
) noexcept nogil:
    return firmness(
        &here.gaps, here.pose[0], here.pose[1], shape.arm, rules.mu, rules.tolerance, rules.steep,
        work,
    )


cdef int descend(
    const Shape *shape,
    const Heap *heap,
    const Rules *rules,
    State *here,
    State *there,
    Work *work,
    Outcome *told,
) noexcept nogil:
    """Go down step by step until nothing is gained; say why it stopped."""
    cdef double start_x = here.pose[0], start_turn = here.pose[2], radius = rules.near
    cdef double half = 0.5 * rules.clearance, gained
    cdef bint better
    cdef double move[3]
    while told.steps < rules.steps:
        if rules.stop >= 0.0 and here.least >= half:
            if margin_of(shape, rules, here, work) >= rules.stop:
                return RESTS
        told.steps += 1
        better = False
        if best_move(&here.gaps, here.pose, shape.arm, radius, rules, work, move):
            gained = -rules.lean * move[0] - move[1]
            if here.least >= half and not gained > rules.gain:
                return FALLS
            better = tried(shape, heap, rules, here, there, work, move, radius, gained)
        if not better:
            radius *= 0.5
            if radius < SMALLEST * rules.near:
                return FALLS
            continue
        here[0], there[0] = there[0], here[0]
        if fabs(here.pose[2] - start_turn) > rules.turn:
            return FAR
        if fabs(here.pose[0] - start_x) > rules.shift:
            return FAR
        if max(fabs(move[0]), max(fabs(move[1]), fabs(move[2]))) > 0.9 * radius:
            radius = min(rules.far, 1.6 * radius)
    return UNFINISHED


cdef bint tried(
    const Shape *shape,
    const Heap *heap,
    const Rules *rules,
    const State *here,
    State *there,
    Work *work,
    const double *move,
    double radius,
    double gained,
) noexcept nogil:
    """Make a move; False when it leads nowhere."""
    cdef double half = 0.5 * rules.clearance, small
    cdef double back[3]
    moved(here, move, shape.arm, there)
    look(there, shape, heap, rules)
    if here.least < half:
        # It was let go in an overlap: whatever brings it apart is welcome.
        return there.least >= half or there.least > here.least
    if there.least < half:
        # Turns are not straight: what came too near is brought apart, at the least cost.
        small = 4.0 * (rules.clearance - there.least)
        if not small <= radius:
            return False
        if not best_move(&there.gaps, there.pose, shape.arm, small, rules, work, back):
            return False
        moved(there, back, shape.arm, there)
        look(there, shape, heap, rules)
        gained = gained - rules.lean * back[0] - back[1]
        if not (there.least >= half and gained > rules.gain):
            return False
    return not crosses(&there.body, heap, &there.gaps)


cdef void moved(const State *state, const double *move, double arm, State *out) noexcept nogil:
    """Move a pose; a turn is given as the way of the furthest corner."""
    out.pose[0], out.pose[1] = state.pose[0] + move[0], state.pose[1] + move[1]
    out.pose[2] = state.pose[2] + move[2] / arm


cdef bint best_move(
    const Gaps *gaps,
    const double *pose,
    double arm,
    double radius,
    const Rules *rules,
    Work *work,
    double *move,
) noexcept nogil:
    """Find the move within a radius that goes down most while all gaps, linearised, stay open."""
    cdef double gain[3]
    cdef double most[3]
    cdef double room, lift, reach = SPREAD * radius + rules.clearance
    cdef const Gap *gap
    cdef const Gap *pivot
    cdef Row3 *row
    cdef Py_ssize_t i, count
    cdef int attempt
    if not enough_rows(work, gaps.count + 2):
        return False
    gain[0], gain[1], gain[2] = -rules.lean, -1.0, 0.0
    most[0] = most[1] = radius
    most[2] = radius if rules.turns else 0.0
    for attempt in range(2):
        count = 0
        pivot = NULL
        for i in range(gaps.count):
            gap = gaps.items + i
            if gap.gap > reach:
                continue
            room = gap.gap - rules.clearance
            lift = 0.0
            if room < 0.0:
                # First it is brought apart, by half a radius at most; then at least not nearer.
                lift = min(0.0, room + 0.5 * radius) if attempt == 0 else room
            row = work.rows + count
            count += 1
            row.a[0], row.a[1] = -gap.normal[0], -gap.normal[1]
            row.a[2] = -cross(gap, pose, gap.normal[0], gap.normal[1]) / arm
            row.b = room - lift
            if gap.away <= rules.tolerance and gap.other != END and gap.normal[1] > UPWARD:
                if pivot == NULL or fabs(gap.point[0] - pose[0]) < fabs(pivot.point[0] - pose[0]):
                    pivot = gap
        if rules.sticks and pivot != NULL:
            for i in range(2):
                row = work.rows + count
                count += 1
                row.a[0], row.a[1] = pivot.normal[1], -pivot.normal[0]
                row.a[2] = cross(pivot, pose, pivot.normal[1], -pivot.normal[0]) / arm
                if i:
                    row.a[0], row.a[1], row.a[2] = -row.a[0], -row.a[1], -row.a[2]
                row.b = 0.2 * rules.clearance
        if solve3(work.rows, count, gain, most, work.scratch, move):
            return True
    return False


cdef double cross(const Gap *gap, const double *pose, double nx, double ny) noexcept nogil:
    """Return how fast a turn about a pose moves the point of a gap along a direction."""
    return (gap.point[0] - pose[0]) * ny - (gap.point[1] - pose[1]) * nx
