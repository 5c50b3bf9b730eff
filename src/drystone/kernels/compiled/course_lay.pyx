# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""How the stones of a course lie on what is below, a part of the twin of `course_cost`.

A course that is laid again takes from the old one the stones that lie where they did, on columns
that are as they were.
"""

from libc.stdint cimport int32_t, int64_t
from libc.string cimport memcpy

from drystone.kernels.compiled.course_scene cimport (
    COLUMN_BITS,
    PARTS,
    TERMS,
    Course,
    Lain,
    Scene,
    weighted,
)

cdef enum:
    SLOPE_BITS = 12
    SLOPE_ONE = 4096


cdef void lay(
    const Scene *scene,
    const Course *below,
    const Course *old,
    bint last,
    Span *changed,
    Course *out,
) noexcept nogil:
    """Lay the stones of a course on what is below, and count how they lie.

    `changed` says in which columns this is not what was below an old course (or NULL), and then in
    which ones the tops are others.
    """
    cdef int32_t i, first, end
    cdef Lain *lain = out.lain
    cdef const Lain *was
    cdef Span lower = changed[0]
    if old == NULL:
        lower = changed[0] = Span(0, scene.columns)
    for i in range(out.stones):
        first = lain[i].column
        end = first + columns_of(scene, lain[i].pose)
        was = found_in(old, i, out.stones, lain + i)
        if was == NULL:
            drop(scene, below.tops + first, lain + i)
            widen(changed, first, end)
        elif first < lower.last and lower.first < end:
            drop(scene, below.tops + first, lain + i)
            if lain[i].y != was.y or lain[i].slope != was.slope:
                widen(changed, first, end)
        else:
            first = lain[i].x
            lain[i] = was[0]
            lain[i].x = first
    if old != NULL:
        for i in range(old.stones):
            if found_in(out, i, old.stones, old.lain + i) == NULL:
                first = old.lain[i].column
                widen(changed, first, first + columns_of(scene, old.lain[i].pose))
    raise_tops(scene, below, old, changed, out)
    count_up(scene, below, last, out)


cdef inline int32_t columns_of(const Scene *scene, int32_t pose) noexcept nogil:
    """Return over how many columns a pose is."""
    return <int32_t> (scene.first[pose + 1] - scene.first[pose])


cdef inline const Lain *found_in(
    const Course *course, int32_t place, int32_t count, const Lain *lain
) noexcept nogil:
    """Return a stone in the same pose on the same columns in another course, or NULL.

    It is looked for as far from the left and from the right end of the course.
    """
    cdef int32_t other
    if course == NULL:
        return NULL
    other = place
    if other < course.stones and course.lain[other].pose == lain.pose:
        return course.lain + other if course.lain[other].column == lain.column else NULL
    other += course.stones - count
    if 0 <= other < course.stones and course.lain[other].pose == lain.pose:
        return course.lain + other if course.lain[other].column == lain.column else NULL
    return NULL


cdef inline void widen(Span *span, int32_t first, int32_t last) noexcept nogil:
    """Make some columns a part of a span."""
    if span.first == span.last:
        span[0] = Span(first, last)
    else:
        span.first, span.last = min(span.first, first), max(span.last, last)


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


cdef void drop(const Scene *scene, const int32_t *below, Lain *out) noexcept nogil:
    """Drop a stone on a profile and turn it until it rests on both sides of its centroid."""
    cdef const int32_t *bottoms = scene.bottoms + scene.first[out.pose]
    cdef int32_t count = columns_of(scene, out.pose), j, tilt
    cdef int32_t middle = scene.middle[out.pose], slope = 0, at
    cdef int32_t *lift = scene.lift
    cdef Py_ssize_t left = 0, right = 0
    cdef int64_t total = 0
    cdef double short_
    for j in range(count):
        lift[j] = below[j] - bottoms[j]
    out.y, out.slope, out.rock, out.void, out.short_ = lift[0], 0, 0, 0, 0.0
    if count > 1:
        left, right = first_of(lift, 0, middle), last_of(lift, middle, count)
        slope = <int32_t> (<int64_t> (lift[right] - lift[left]) * SLOPE_ONE / (right - left))
        slope = max(-scene.steepest, min(slope, scene.steepest))
        if slope != 0:
            tilt = -slope * middle
            for j in range(count):
                lift[j] -= tilt >> SLOPE_BITS
                tilt += slope
            left, right = first_of(lift, 0, middle), last_of(lift, middle, count)
        for j in range(count):
            total += lift[j]
        out.y, out.slope = max(lift[left], lift[right]), slope
        out.rock = lift[left] - lift[right]
        if out.rock < 0:
            out.rock = -out.rock
        out.void = <int64_t> out.y * count - total
        tilt = <int32_t> min(middle - left, right + 1 - middle)
        short_ = scene.margin - <double> tilt / <double> count
        if short_ > 0.0:
            out.short_ = short_
    for j in range(PARTS):
        at = PARTS * out.pose + j
        tilt = (slope * (scene.part_at[at] - middle)) >> SLOPE_BITS
        out.peaks[j] = out.y + scene.peaks[at] + tilt


cdef inline void raise_tops(
    const Scene *scene, const Course *below, const Course *old, Span *changed, Course *out
) noexcept nogil:
    """Raise what is below by the stones of a course, where that is not what it was."""
    cdef int32_t i, j, first, count, middle, slope, y, tip, tilt
    cdef const int32_t *tops
    cdef int32_t *over
    if old != NULL:
        memcpy(out.tops, old.tops, scene.columns * sizeof(int32_t))
    memcpy(
        out.tops + changed.first, below.tops + changed.first,
        (changed.last - changed.first) * sizeof(int32_t),
    )
    for i in range(out.stones):
        first, count = out.lain[i].column, columns_of(scene, out.lain[i].pose)
        if first >= changed.last or changed.first >= first + count:
            continue
        tops = scene.tops + scene.first[out.lain[i].pose]
        middle, slope, y = scene.middle[out.lain[i].pose], out.lain[i].slope, out.lain[i].y
        over = out.tops + first
        tilt = -slope * middle
        for j in range(count):
            tip = y + tops[j] + (tilt >> SLOPE_BITS)
            tilt += slope
            over[j] = tip if tip > over[j] else over[j]
    if old != NULL:
        while changed.first < changed.last and (
            out.tops[changed.first] == old.tops[changed.first]
        ):
            changed.first += 1
        while changed.first < changed.last and (
            out.tops[changed.last - 1] == old.tops[changed.last - 1]
        ):
            changed.last -= 1


cdef inline void count_up(
    const Scene *scene, const Course *below, bint last, Course *out
) noexcept nogil:
    """Count how the stones of a course lie, and what the course costs."""
    cdef double *terms = out.terms
    cdef const Lain *lain
    cdef int32_t i, j, peak, highest, steep, mean, before = out.lain[0].peaks[0]
    cdef int64_t peaks = 0, steps = 0, off = 0
    for i in range(TERMS):
        if i != 3 and i != 4 and i != 12:
            terms[i] = 0.0
    for i in range(out.stones):
        lain = out.lain + i
        steep = lain.slope if lain.slope > 0 else -lain.slope
        terms[6] += <double> lain.void
        terms[7] += <double> ((steep * columns_of(scene, lain.pose)) >> SLOPE_BITS)
        terms[8] += <double> lain.rock
        terms[9] += lain.short_
        highest = scene.wall_height
        for j in range(PARTS):
            peak = lain.peaks[j]
            highest = peak if peak > highest else highest
            steps += peak - before if peak > before else before - peak
            before = peak
            peaks += peak
        if highest > scene.wall_height:
            terms[10] += <double> (highest - scene.wall_height)
            terms[11] += 1.0
    out.bed[0], out.bed[1], out.bed[2] = out.lain[0].peaks[0], before, <int32_t> steps
    terms[0] = <double> steps
    mean = <int32_t> (peaks / (PARTS * out.stones))
    for i in range(out.stones):
        for j in range(PARTS):
            peak = out.lain[i].peaks[j]
            off += peak - mean if peak > mean else mean - peak
    terms[2 if last else 1] = <double> off
    terms[5] = slack(out, below.tops, mean)
    out.cost = weighted(scene, terms)


cdef inline double slack(const Course *here, const int32_t *below, int32_t mean) noexcept nogil:
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
