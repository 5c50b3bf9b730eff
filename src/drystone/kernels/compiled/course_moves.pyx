# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.course_moves`."""

from libc.stdint cimport int32_t, uint64_t
from libc.string cimport memcpy, memmove

cdef enum:
    SWAP = 20
    MOVE = 36
    TURN = 48
    SWAP_TURN = 54
    GAP = 58
    REVERSE = 61
    EXCHANGE = 62
    SPLIT = 63


cdef int32_t below(uint64_t *state, int32_t count) noexcept nogil:
    """Return a random number from 0 to below a count: splitmix64."""
    cdef uint64_t mixed
    state[0] += <uint64_t> 0x9E3779B97F4A7C15
    mixed = state[0]
    mixed = (mixed ^ (mixed >> 30)) * <uint64_t> 0xBF58476D1CE4E5B9
    mixed = (mixed ^ (mixed >> 27)) * <uint64_t> 0x94D049BB133111EB
    mixed ^= mixed >> 31
    return <int32_t> (((mixed >> 32) * <uint64_t> count) >> 32)


cdef int32_t start_of(const Draft *draft, int32_t course) noexcept nogil:
    """Return the place of the first stone of a course, or of what is left out."""
    cdef int32_t i, start = 0
    for i in range(course):
        start += draft.sizes[i]
    return start


cdef int32_t course_of(const Draft *draft, int32_t place) noexcept nogil:
    """Return the course of a place; the number of courses for what is left out."""
    cdef int32_t course = 0
    while course < draft.courses and place >= draft.sizes[course]:
        place -= draft.sizes[course]
        course += 1
    return course


cdef inline int32_t left_of(int32_t gap) noexcept nogil:
    """Return how many stones of a course are laid from the left end."""
    return gap if gap >= 0 else -1 - gap


cdef void move_gap(Draft *draft, int32_t course, int32_t by) noexcept nogil:
    """Let so many more stones of a course be laid from the left end, as many as there are."""
    cdef int32_t gap = draft.gaps[course]
    cdef int32_t from_left = min(left_of(gap) + by, draft.sizes[course])
    draft.gaps[course] = from_left if gap >= 0 else -1 - from_left


cdef int32_t change(Draft *draft, uint64_t *state, int32_t most) noexcept nogil:
    """Change a draft at random; return the lowest course in which something changed, or -1."""
    cdef int32_t kind = below(state, 64)
    if kind < SWAP:
        return swap(draft, state, False)
    if kind < MOVE:
        return move(draft, state)
    if kind < TURN:
        return turn(draft, state)
    if kind < SWAP_TURN:
        return swap(draft, state, True)
    if kind < GAP:
        return shift_gap(draft, state)
    if kind < REVERSE:
        return reverse(draft, state)
    if kind < EXCHANGE:
        return exchange(draft, state)
    return split(draft, state, most) if kind < SPLIT else join(draft, state)


cdef void turn_stone(Draft *draft, uint64_t *state, int32_t stone) noexcept nogil:
    """Turn a stone by one, two or three quarters."""
    draft.turns[stone] = (draft.turns[stone] + 1 + below(state, 3)) % 4


cdef int32_t swap(Draft *draft, uint64_t *state, bint turned) noexcept nogil:
    """Swap a stone of a course with any other; where it was, the other may be turned."""
    cdef int32_t one = below(state, start_of(draft, draft.courses))
    cdef int32_t two = below(state, draft.stones), stone
    if one == two:
        return NOTHING
    stone = draft.order[one]
    draft.order[one] = draft.order[two]
    draft.order[two] = stone
    if turned:
        turn_stone(draft, state, draft.order[one])
    return min(course_of(draft, one), course_of(draft, two))


cdef int32_t turn(Draft *draft, uint64_t *state) noexcept nogil:
    """Turn a stone of a course."""
    cdef int32_t place = below(state, start_of(draft, draft.courses))
    turn_stone(draft, state, draft.order[place])
    return course_of(draft, place)


cdef int32_t move(Draft *draft, uint64_t *state) noexcept nogil:
    """Move a stone to a place in the same or another course, or leave it out, or take it back."""
    cdef int32_t place = below(state, draft.stones), to = below(state, draft.courses + 1)
    cdef int32_t course = course_of(draft, place), stone = draft.order[place], inside
    cdef bint outside = course == draft.courses
    cdef bint alone = not outside and draft.sizes[course] == 1
    if (outside and to == course) or (alone and (to == course or draft.courses == 1)):
        return NOTHING
    inside = place - start_of(draft, course)
    memmove(
        draft.order + place, draft.order + place + 1,
        (draft.stones - place - 1) * sizeof(int32_t),
    )
    if alone:
        drop_course(draft, course)
        if to > course:
            to -= 1
    elif not outside:
        draft.sizes[course] -= 1
        move_gap(draft, course, -(inside < left_of(draft.gaps[course])))
    insert(draft, state, stone, to)
    return min(min(course, to), draft.courses - 1)


cdef void insert(Draft *draft, uint64_t *state, int32_t stone, int32_t course) noexcept nogil:
    """Insert a stone anywhere in a course, or in what is left out; the last place is free."""
    cdef int32_t start = start_of(draft, course), inside, place
    if course == draft.courses:
        inside = below(state, draft.stones - start)
    else:
        inside = below(state, draft.sizes[course] + 1)
    place = start + inside
    memmove(
        draft.order + place + 1, draft.order + place,
        (draft.stones - place - 1) * sizeof(int32_t),
    )
    draft.order[place] = stone
    if course < draft.courses:
        draft.sizes[course] += 1
        move_gap(draft, course, inside < left_of(draft.gaps[course]))


cdef void drop_course(Draft *draft, int32_t course) noexcept nogil:
    """Take a course out of the list of courses."""
    cdef int32_t i
    draft.courses -= 1
    for i in range(course, draft.courses):
        draft.sizes[i] = draft.sizes[i + 1]
        draft.gaps[i] = draft.gaps[i + 1]


cdef int32_t shift_gap(Draft *draft, uint64_t *state) noexcept nogil:
    """Put the gap of a course somewhere else; of one in four it keeps away from the ends."""
    cdef int32_t course = below(state, draft.courses)
    cdef int32_t gap = below(state, draft.sizes[course] + 1)
    if below(state, 4) == 0:
        gap = -1 - gap
    if gap == draft.gaps[course]:
        return NOTHING
    draft.gaps[course] = gap
    return course


cdef int32_t reverse(Draft *draft, uint64_t *state) noexcept nogil:
    """Reverse some neighbours of a course."""
    cdef int32_t course = below(state, draft.courses), stone
    cdef int32_t start = start_of(draft, course), size = draft.sizes[course]
    cdef int32_t one = below(state, size), two = below(state, size)
    if one == two:
        return NOTHING
    size = start + max(one, two)
    start += min(one, two)
    while start < size:
        stone = draft.order[start]
        draft.order[start] = draft.order[size]
        draft.order[size] = stone
        start += 1
        size -= 1
    return course


cdef int32_t exchange(Draft *draft, uint64_t *state) noexcept nogil:
    """Exchange two courses."""
    cdef int32_t one = below(state, draft.courses), two = below(state, draft.courses)
    cdef int32_t low = min(one, two), high = max(one, two), held
    cdef int32_t *order = draft.order
    cdef int32_t start, low_size, between, high_size
    if one == two:
        return NOTHING
    start, low_size, high_size = start_of(draft, low), draft.sizes[low], draft.sizes[high]
    between = start_of(draft, high) - start - low_size
    memcpy(draft.spare, order + start, (low_size + between + high_size) * sizeof(int32_t))
    memcpy(order + start, draft.spare + low_size + between, high_size * sizeof(int32_t))
    memcpy(order + start + high_size, draft.spare + low_size, between * sizeof(int32_t))
    memcpy(order + start + high_size + between, draft.spare, low_size * sizeof(int32_t))
    draft.sizes[low], draft.sizes[high] = high_size, low_size
    held = draft.gaps[low]
    draft.gaps[low] = draft.gaps[high]
    draft.gaps[high] = held
    return low


cdef int32_t split(Draft *draft, uint64_t *state, int32_t most) noexcept nogil:
    """Make two courses of one."""
    cdef int32_t course = below(state, draft.courses), i
    cdef int32_t size = draft.sizes[course], lower
    if size < 2 or draft.courses >= most:
        return NOTHING
    lower = 1 + below(state, size - 1)
    for i in range(draft.courses, course + 1, -1):
        draft.sizes[i] = draft.sizes[i - 1]
        draft.gaps[i] = draft.gaps[i - 1]
    draft.courses += 1
    draft.sizes[course], draft.sizes[course + 1] = lower, size - lower
    draft.gaps[course], draft.gaps[course + 1] = (lower + 1) / 2, (size - lower + 1) / 2
    return course


cdef int32_t join(Draft *draft, uint64_t *state) noexcept nogil:
    """Make one course of two."""
    cdef int32_t course, size
    if draft.courses < 2:
        return NOTHING
    course = below(state, draft.courses - 1)
    draft.gaps[course] = draft.sizes[course]
    size = draft.sizes[course] + draft.sizes[course + 1]
    drop_course(draft, course + 1)
    draft.sizes[course] = size
    return course
