# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.meetings` and of ``kernels.meeting_rules``."""

from libc.math cimport fabs, sqrt
from libc.stdint cimport int32_t
from libc.stdlib cimport free, malloc, realloc
from libc.string cimport memset

import numpy as np

from drystone.kernels.meeting_rules import BESIDE, EQUAL, LEAN, LEVEL, SAME, SHARP

cdef double LEAN_C = LEAN, SAME_C = SAME, BESIDE_C = BESIDE, EQUAL_C = EQUAL, LEVEL_C = LEVEL
cdef double SHARP_C = SHARP


cdef struct Side:
    # The corner at the start of an edge, its unit vector, length and box.
    double x, y, along_x, along_y, length
    double left, bottom, right, top
    bint convex


cdef struct Sides:
    Side* of
    Py_ssize_t count


cdef struct Contact:
    Py_ssize_t edge, facing
    double start
    int32_t count, other
    double x0, y0, x1, y1, normal_x, normal_y


cdef struct Contacts:
    Contact* of
    Py_ssize_t count, room
    bint lost


cdef struct Common:
    double low, high, first, last, inside, slope


cdef struct Face:
    bint separates
    double apart, out_x, out_y, along


def meetings(
    const double[:, ::1] corners,
    const double[:, ::1] others,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    double tolerance,
    double setback,
):
    """Return others, counts, points and normals of the contacts."""
    cdef Py_ssize_t most = 4, k
    cdef Sides mine, theirs
    cdef Contacts found
    for k in range(boxes.shape[0]):
        most = max(most, first[k + 1] - first[k])
    memset(&found, 0, sizeof(Contacts))
    mine.count = corners.shape[0]
    found.room = 4 * mine.count + 16
    mine.of = <Side*>malloc(mine.count * sizeof(Side))
    theirs.of = <Side*>malloc(most * sizeof(Side))
    found.of = <Contact*>malloc(found.room * sizeof(Contact))
    try:
        if not (mine.of and theirs.of and found.of):
            raise MemoryError
        with nogil:
            meet_all(&mine, &theirs, corners, others, first, boxes, tolerance, setback, &found)
        if found.lost:
            raise MemoryError
        return told(&found)
    finally:
        free(mine.of)
        free(theirs.of)
        free(found.of)


cdef tuple told(Contacts* found):
    """Write what was found into arrays."""
    cdef Py_ssize_t count = found.count, k
    others, counts = np.empty(count, np.int32), np.empty(count, np.int32)
    points, normals = np.empty((count, 2, 2)), np.empty((count, 2))
    cdef int32_t[::1] other = others, number = counts
    cdef double[:, :, ::1] point = points
    cdef double[:, ::1] normal = normals
    cdef Contact* contact
    for k in range(count):
        contact = found.of + k
        other[k], number[k] = contact.other, contact.count
        point[k, 0, 0], point[k, 0, 1] = contact.x0, contact.y0
        point[k, 1, 0], point[k, 1, 1] = contact.x1, contact.y1
        normal[k, 0], normal[k, 1] = contact.normal_x + 0.0, contact.normal_y + 0.0
    return others, counts, points, normals


cdef void meet_all(
    Sides* mine,
    Sides* theirs,
    const double[:, ::1] corners,
    const double[:, ::1] others,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    double tolerance,
    double setback,
    Contacts* found,
) noexcept nogil:
    """Find the contacts with the ground and with every polygon that is near."""
    cdef double reach = BESIDE_C * tolerance, beyond = 1.0 + 4.0 * tolerance
    cdef double left, bottom, right, top
    cdef double ground[8]
    cdef Py_ssize_t k
    set_sides(mine, &corners[0, 0])
    left, bottom, right, top = mine.of.left, mine.of.bottom, mine.of.right, mine.of.top
    for k in range(1, mine.count):
        left, bottom = min(left, mine.of[k].left), min(bottom, mine.of[k].bottom)
        right, top = max(right, mine.of[k].right), max(top, mine.of[k].top)
    if bottom - reach <= 0.0:
        ground[0] = ground[6] = left - beyond
        ground[2] = ground[4] = right + beyond
        ground[1] = ground[3] = -beyond
        ground[5] = ground[7] = 0.0
        theirs.count = 4
        set_sides(theirs, ground)
        meet(mine, theirs, -1, tolerance, set_back_by(mine, NULL, tolerance, setback), found)
    for k in range(boxes.shape[0]):
        if not (boxes[k, 0] <= right + reach and boxes[k, 2] >= left - reach):
            continue
        if not (boxes[k, 1] <= top + reach and boxes[k, 3] >= bottom - reach):
            continue
        theirs.count = first[k + 1] - first[k]
        set_sides(theirs, &others[first[k], 0])
        meet(
            mine, theirs, <int32_t>k, tolerance,
            set_back_by(mine, theirs, tolerance, setback), found,
        )


cdef void set_sides(Sides* sides, const double* corners) noexcept nogil:
    """Prepare the sides of a polygon."""
    cdef Py_ssize_t k, n = sides.count
    cdef double x, y, step_x, step_y
    cdef Side* side
    cdef Side* before
    for k in range(n):
        side = sides.of + k
        side.x, side.y = corners[2 * k], corners[2 * k + 1]
        x, y = corners[2 * ((k + 1) % n)], corners[2 * ((k + 1) % n) + 1]
        step_x, step_y = x - side.x, y - side.y
        side.length = sqrt(step_x * step_x + step_y * step_y)
        side.along_x, side.along_y = step_x / side.length, step_y / side.length
        side.left, side.right = min(side.x, x), max(side.x, x)
        side.bottom, side.top = min(side.y, y), max(side.y, y)
    before = sides.of + n - 1
    for k in range(n):
        side = sides.of + k
        side.convex = before.along_x * side.along_y - before.along_y * side.along_x > 0.0
        before = side


cdef void meet(
    Sides* p, Sides* q, int32_t other, double tolerance, double by, Contacts* found
) noexcept nogil:
    """Add the contacts of two polygons, in order along the first."""
    cdef double reach = BESIDE_C * tolerance
    cdef double left, bottom, right, top, q_left, q_bottom, q_right, q_top
    cdef Py_ssize_t begin = found.count, i, j
    cdef Side* mine
    cdef Side* theirs
    q_left, q_bottom, q_right, q_top = q.of.left, q.of.bottom, q.of.right, q.of.top
    for j in range(1, q.count):
        q_left, q_bottom = min(q_left, q.of[j].left), min(q_bottom, q.of[j].bottom)
        q_right, q_top = max(q_right, q.of[j].right), max(q_top, q.of[j].top)
    for i in range(p.count):
        mine = p.of + i
        left, bottom = mine.left - reach, mine.bottom - reach
        right, top = mine.right + reach, mine.top + reach
        if q_left > right or q_right < left or q_bottom > top or q_top < bottom:
            continue
        for j in range(q.count):
            theirs = q.of + j
            if theirs.left <= right and theirs.right >= left:
                if theirs.bottom <= top and theirs.top >= bottom:
                    facing_edges(p, i, q, j, tolerance, found)
                    corner_on_edge(p, i, q, j, tolerance, found)
                    edge_on_corner(p, i, q, j, tolerance, found)
                    corner_on_corner(p, i, q, j, tolerance, found)
    if found.lost:
        return
    without_repeats(found, begin, tolerance)
    if by > 0.0:
        j = begin
        for i in range(begin, found.count):
            if set_back(p, q, found.of + i, by, tolerance):
                found.of[j] = found.of[i]
                j += 1
        found.count = j
    for i in range(begin, found.count):
        found.of[i].other = other


cdef Contact* new_contact(Contacts* found) noexcept nogil:
    """Return a place for one more contact; NULL when there is no memory."""
    cdef Contact* more
    if found.count == found.room:
        more = <Contact*>realloc(found.of, 2 * found.room * sizeof(Contact))
        if not more:
            found.lost = True
            return NULL
        found.of = more
        found.room *= 2
    found.count += 1
    return found.of + found.count - 1


cdef void add_point(
    Contacts* found,
    Py_ssize_t edge,
    Py_ssize_t facing,
    double start,
    double x,
    double y,
    double normal_x,
    double normal_y,
) noexcept nogil:
    """Add a contact at a point."""
    cdef Contact* contact = new_contact(found)
    if contact:
        contact.edge, contact.facing, contact.start, contact.count = edge, facing, start, 1
        contact.x0 = contact.x1 = x
        contact.y0 = contact.y1 = y
        contact.normal_x, contact.normal_y = normal_x, normal_y


cdef void facing_edges(
    Sides* p, Py_ssize_t i, Sides* q, Py_ssize_t j, double tolerance, Contacts* found
) noexcept nogil:
    """Add the contact along edges that face each other; one point where it is short."""
    cdef Common c
    cdef double at_low, at_high, reach, over, share, normal_x, normal_y, length, start, end
    cdef bint low_first
    cdef Side* e = p.of + i
    cdef Side* f = q.of + j
    cdef Contact* contact
    if not common(p, i, q, j, tolerance, &c):
        return
    at_low, at_high = c.inside + c.slope * (c.low - c.first), c.inside + c.slope * (c.high - c.first)
    low_first = fabs(at_low) <= fabs(at_high)
    reach = tolerance * (1.0 - fabs(c.slope) / LEAN_C)
    if not within(c.low, c.high, at_low, at_high, reach, &start, &end):
        if min(fabs(at_low), fabs(at_high)) > tolerance:
            return
        start = end = c.low if low_first else c.high
    over = c.last if low_first else e.length - c.first
    share = 0.5 + over / (2.0 * tolerance)
    share = 0.0 if share < 0.0 else 1.0 if share > 1.0 else share
    normal_x = share * -e.along_y + (1.0 - share) * f.along_y
    normal_y = share * e.along_x + (1.0 - share) * -f.along_x
    length = sqrt(normal_x * normal_x + normal_y * normal_y)
    contact = new_contact(found)
    if not contact:
        return
    contact.edge, contact.facing, contact.count = i, j, 2
    if not end - start > tolerance:
        start = end = (start + end) / 2.0
        contact.count = 1
    contact.start = start
    contact.x0, contact.y0 = e.x + start * e.along_x, e.y + start * e.along_y
    contact.x1, contact.y1 = e.x + end * e.along_x, e.y + end * e.along_y
    contact.normal_x, contact.normal_y = normal_x / length, normal_y / length


cdef void corner_on_edge(
    Sides* p, Py_ssize_t i, Sides* q, Py_ssize_t j, double tolerance, Contacts* found
) noexcept nogil:
    """Add the contact of corner `i` on edge `j`, away from its ends."""
    cdef Common c
    cdef double along
    cdef Side* e = p.of + i
    cdef Side* f = q.of + j
    if not stands_on(p, i, q, j, tolerance, &along):
        return
    if common(p, before(p, i), q, j, tolerance, &c) or common(p, i, q, j, tolerance, &c):
        return
    add_point(found, i, j, 0.0, e.x, e.y, f.along_y, -f.along_x)


cdef void edge_on_corner(
    Sides* p, Py_ssize_t i, Sides* q, Py_ssize_t j, double tolerance, Contacts* found
) noexcept nogil:
    """Add the contact of edge `i`, away from its ends, on corner `j`."""
    cdef Common c
    cdef double along
    cdef Side* e = p.of + i
    if not stands_on(q, j, p, i, tolerance, &along):
        return
    if common(p, i, q, before(q, j), tolerance, &c) or common(p, i, q, j, tolerance, &c):
        return
    add_point(
        found,
        i,
        j,
        along,
        e.x + along * e.along_x,
        e.y + along * e.along_y,
        -e.along_y,
        e.along_x,
    )


cdef void corner_on_corner(
    Sides* p, Py_ssize_t i, Sides* q, Py_ssize_t j, double tolerance, Contacts* found
) noexcept nogil:
    """Add the contact of two convex corners beside each other, where a face separates them."""
    cdef Common c
    cdef Face faces[4]
    cdef Py_ssize_t preceding, behind, edge = i
    cdef int place
    cdef double away_x, away_y, along, start = 0.0
    if not (p.of[i].convex and q.of[j].convex and are_beside(p, i, q, j, tolerance)):
        return
    preceding, behind = before(p, i), before(q, j)
    if common(p, preceding, q, behind, tolerance, &c) or common(p, preceding, q, j, tolerance, &c):
        return
    if common(p, i, q, behind, tolerance, &c) or common(p, i, q, j, tolerance, &c):
        return
    away_x, away_y = p.of[i].x - q.of[j].x, p.of[i].y - q.of[j].y
    faces[0] = face_of(q, behind, p, i, away_x, away_y)
    faces[1] = face_of(q, j, p, i, away_x, away_y)
    faces[2] = face_of(p, preceding, q, j, -away_x, -away_y)
    faces[3] = face_of(p, i, q, j, -away_x, -away_y)
    place = best(faces, EQUAL_C * tolerance)
    if place < 0 or fabs(faces[place].apart) > tolerance:
        return
    along = -faces[place].along if place == 0 or place == 2 else faces[place].along
    if not (along >= 0.0 or away_x * away_x + away_y * away_y <= tolerance * tolerance):
        return
    if place < 2:
        add_point(
            found, i, j if place else behind, 0.0, p.of[i].x, p.of[i].y, faces[place].out_x,
            faces[place].out_y,
        )
        return
    if along > 0.0 and place == 3:
        start = along
    elif along > 0.0:
        edge, start = preceding, p.of[preceding].length - along
    add_point(
        found,
        edge,
        j,
        start,
        p.of[edge].x + start * p.of[edge].along_x,
        p.of[edge].y + start * p.of[edge].along_y,
        -faces[place].out_x,
        -faces[place].out_y,
    )


cdef double set_back_by(
    const Sides* p, const Sides* q, double tolerance, double setback
) noexcept nogil:
    """Return by how much contacts are set back; q is NULL for the ground."""
    cdef double size
    if setback == 0.0:
        return 0.0
    size = area(p)
    if q:
        size = min(size, area(q))
    return max(tolerance, setback * sqrt(size))


cdef double area(const Sides* s) noexcept nogil:
    """Return the area of a polygon."""
    cdef Py_ssize_t k
    cdef double doubled = 0.0, x, y
    for k in range(1, s.count - 1):
        x, y = s.of[k].x - s.of.x, s.of[k].y - s.of.y
        doubled += x * (s.of[k + 1].y - s.of.y) - y * (s.of[k + 1].x - s.of.x)
    return doubled / 2.0 if doubled > 0.0 else 0.0


cdef bint set_back(
    const Sides* p, const Sides* q, Contact* c, double by, double tolerance
) noexcept nogil:
    """Set a contact back from the ends of faces; return whether anything is left of it."""
    cdef const Side* e = p.of + c.edge
    cdef double end, first, last, across
    if c.count == 2:
        end = c.start + (c.x1 - c.x0) * e.along_x + (c.y1 - c.y0) * e.along_y
        first = c.start + by - min(
            runs_on(p, c.edge, c.start, by, -1),
            runs_on(q, c.facing, projected(q, c.facing, c.x0, c.y0), by, 1),
        )
        last = end - by + min(
            runs_on(p, c.edge, end, by, 1),
            runs_on(q, c.facing, projected(q, c.facing, c.x1, c.y1), by, -1),
        )
        if last - first > tolerance:
            c.start = first
            c.x0, c.y0 = e.x + first * e.along_x, e.y + first * e.along_y
            c.x1, c.y1 = e.x + last * e.along_x, e.y + last * e.along_y
            return True
        c.start = (first + last) / 2.0
        c.start = 0.0 if c.start < 0.0 else e.length if c.start > e.length else c.start
        c.x0, c.y0 = e.x + c.start * e.along_x, e.y + c.start * e.along_y
    c.count, c.x1, c.y1 = 1, c.x0, c.y0
    if min(runs_on(p, c.edge, c.start, by, -1), runs_on(p, c.edge, c.start, by, 1)) >= by:
        return True
    across = projected(q, c.facing, c.x0, c.y0)
    return min(runs_on(q, c.facing, across, by, -1), runs_on(q, c.facing, across, by, 1)) >= by


cdef double projected(const Sides* s, Py_ssize_t i, double x, double y) noexcept nogil:
    """Return how far along an edge a point is beside it; its ends for what is beyond them."""
    cdef const Side* e = s.of + i
    cdef double along = (x - e.x) * e.along_x + (y - e.y) * e.along_y
    return 0.0 if along < 0.0 else e.length if along > e.length else along


cdef double runs_on(
    const Sides* s, Py_ssize_t i, double along, double enough, int sense
) noexcept nogil:
    """Return how far a face goes on from a point of edge `i`, at most `enough`."""
    cdef const Side* e = s.of + i
    cdef const Side* f
    cdef double run = e.length - along if sense > 0 else along, dot, away
    cdef Py_ssize_t edge = i, k
    for k in range(s.count - 1):
        if run >= enough:
            return enough
        if sense > 0:
            edge = edge + 1 if edge + 1 < s.count else 0
        else:
            edge = before(s, edge)
        f = s.of + edge
        dot = e.along_x * f.along_x + e.along_y * f.along_y
        away = sense * (e.along_x * f.along_y - e.along_y * f.along_x)
        if fabs(away) > SHARP_C * dot:
            return run if away >= 0.0 else enough
        run += f.length
    return run if run < enough else enough


cdef void without_repeats(Contacts* found, Py_ssize_t begin, double tolerance) noexcept nogil:
    """Leave out points that are told already, and sort the others, from a place on."""
    cdef Py_ssize_t k, other, kept = begin, end = found.count
    cdef Contact contact
    cdef bint again
    # Marked first: also what is left out makes others repeats.
    for k in range(begin, end):
        found.of[k].other = 0
        if found.of[k].count == 2:
            continue
        again = False
        for other in range(begin, end):
            if found.of[other].count == 2 or other < k:
                if is_same(found.of + k, found.of + other, tolerance):
                    again = True
                    break
        found.of[k].other = again
    for k in range(begin, end):
        contact = found.of[k]
        if contact.other:
            continue
        other = kept
        while other > begin and comes_before(&contact, found.of + other - 1):
            found.of[other] = found.of[other - 1]
            other -= 1
        found.of[other] = contact
        kept += 1
    found.count = kept


cdef inline bint comes_before(const Contact* one, const Contact* other) noexcept nogil:
    """Tell whether a contact comes before another one, along the polygon."""
    if one.edge != other.edge:
        return one.edge < other.edge
    return one.start < other.start


cdef inline Py_ssize_t before(const Sides* s, Py_ssize_t i) noexcept nogil:
    """Return the edge that ends where edge `i` starts."""
    return i - 1 if i else s.count - 1


cdef bint common(
    const Sides* p, Py_ssize_t i, const Sides* q, Py_ssize_t j, double tolerance, Common* told
) noexcept nogil:
    """Find where two edges face each other; return whether they do."""
    cdef const Side* e = p.of + i
    cdef const Side* f = q.of + j
    cdef const Side* end
    cdef double dot = e.along_x * f.along_x + e.along_y * f.along_y
    cdef double cross = e.along_x * f.along_y - e.along_y * f.along_x
    cdef double away_x, away_y
    if dot >= 0.0 or fabs(cross) > LEAN_C * -dot:
        return False
    end = q.of + j + 1 if j + 1 < q.count else q.of
    away_x, away_y = f.x - e.x, f.y - e.y
    told.first = away_x * e.along_x + away_y * e.along_y
    told.last = (end.x - e.x) * e.along_x + (end.y - e.y) * e.along_y
    told.low = told.last if told.last > 0.0 else 0.0
    told.high = told.first if told.first < e.length else e.length
    told.inside = e.along_x * away_y - e.along_y * away_x
    told.slope = cross / dot
    return told.high - told.low > tolerance


cdef bint within(
    double low,
    double high,
    double at_low,
    double at_high,
    double reach,
    double* start,
    double* end,
) noexcept nogil:
    """Find the part from low to high on which a value is at most `reach` from 0."""
    cdef double limit
    if min(at_low, at_high) > reach or max(at_low, at_high) < -reach:
        return False
    start[0], end[0] = low, high
    if fabs(at_low) > reach:
        limit = reach if at_low > 0.0 else -reach
        start[0] = low + (high - low) * ((limit - at_low) / (at_high - at_low))
    if fabs(at_high) > reach:
        limit = reach if at_high > 0.0 else -reach
        end[0] = low + (high - low) * ((limit - at_low) / (at_high - at_low))
    return True


cdef bint stands_on(
    const Sides* s,
    Py_ssize_t i,
    const Sides* t,
    Py_ssize_t j,
    double tolerance,
    double* along,
) noexcept nogil:
    """Find how far along edge `j` corner `i` stands on it; return whether it does."""
    cdef const Side* corner = s.of + i
    cdef const Side* edge = t.of + j
    cdef double away_x = corner.x - edge.x, away_y = corner.y - edge.y
    cdef double outside = away_x * edge.along_y - away_y * edge.along_x
    cdef Py_ssize_t end = j + 1 if j + 1 < t.count else 0
    along[0] = away_x * edge.along_x + away_y * edge.along_y
    if not (along[0] >= 0.0 and along[0] <= edge.length and corner.convex):
        return False
    if fabs(outside) > tolerance or not clears(s, i, edge.along_y, -edge.along_x):
        return False
    if edge.convex and are_beside(s, i, t, j, tolerance):
        return False
    return not (t.of[end].convex and are_beside(s, i, t, end, tolerance))


cdef inline bint are_beside(
    const Sides* s, Py_ssize_t i, const Sides* t, Py_ssize_t j, double tolerance
) noexcept nogil:
    """Tell whether two corners are so near that neither stands on an edge away from its ends."""
    cdef double away_x = s.of[i].x - t.of[j].x, away_y = s.of[i].y - t.of[j].y
    return away_x * away_x + away_y * away_y <= 2.0 * tolerance * tolerance


cdef inline bint clears(
    const Sides* s, Py_ssize_t i, double out_x, double out_y
) noexcept nogil:
    """Tell whether both edges at a corner lead outwards, or hardly inwards."""
    cdef const Side* coming = s.of + before(s, i)
    cdef const Side* leaving = s.of + i
    if coming.along_x * out_x + coming.along_y * out_y > LEAN_C:
        return False
    return leaving.along_x * out_x + leaving.along_y * out_y >= -LEAN_C


cdef Face face_of(
    const Sides* s, Py_ssize_t k, const Sides* t, Py_ssize_t j, double away_x, double away_y
) noexcept nogil:
    """Return how a face of one corner separates another one from it."""
    cdef Face face
    face.out_x, face.out_y = s.of[k].along_y, -s.of[k].along_x
    face.separates = clears(t, j, face.out_x, face.out_y)
    face.apart = away_x * face.out_x + away_y * face.out_y
    face.along = away_x * s.of[k].along_x + away_y * s.of[k].along_y
    return face


cdef int best(const Face* faces, double equal) noexcept nogil:
    """Return which face separates most; -1 when none does."""
    cdef int place, chosen = -1
    cdef double most = 0.0, level = 0.0
    for place in range(4):
        if faces[place].separates and (chosen < 0 or faces[place].apart > most):
            most, chosen = faces[place].apart, place
    chosen = -1
    for place in range(4):
        if faces[place].separates and faces[place].apart >= most - equal:
            if chosen < 0 or fabs(faces[place].out_y) > level + LEVEL_C:
                chosen, level = place, fabs(faces[place].out_y)
    return chosen


cdef inline bint is_same(
    const Contact* one, const Contact* other, double tolerance
) noexcept nogil:
    """Tell whether a contact at a point has the place and the normal of another contact."""
    cdef double limit = 4.0 * tolerance * tolerance, x, y
    if one.normal_x * other.normal_x + one.normal_y * other.normal_y < SAME_C:
        return False
    x, y = one.x0 - other.x0, one.y0 - other.y0
    if x * x + y * y <= limit:
        return True
    x, y = one.x0 - other.x1, one.y0 - other.y1
    return x * x + y * y <= limit
