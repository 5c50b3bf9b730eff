# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.cones`."""

from libc.stdint cimport int32_t


def cone_edges(
    bodies,
    normals,
    frictions,
    counts,
    const double[:, :] points,
    double length,
    int32_t[::1] first,
    int32_t[::1] second,
    double[:, ::1] entries,
):
    """Write the two edges of the cone at every contact point into the last three arrays.

    The lock of the interpreter is kept: all of it takes less time than getting that back.
    """
    cdef Py_ssize_t point = 0, end, edge
    cdef int32_t one, two
    cdef double one_x, one_y, two_x, two_y, normal_x, normal_y, mu, along, force_x, force_y
    for (body, other), (nx, ny), friction, count in zip(bodies, normals, frictions, counts):
        one, one_x, one_y = body
        two, two_x, two_y = other
        normal_x, normal_y, mu = nx, ny, friction
        end = point + <Py_ssize_t>count
        while point < end:
            along = mu
            for edge in range(2 * point, 2 * point + 2):
                force_x = normal_x + along * normal_y
                force_y = normal_y - along * normal_x
                along = -along
                first[edge] = one
                second[edge] = two
                entries[0, edge] = force_x
                entries[1, edge] = force_y
                entries[2, edge] = _moment(
                    points[point, 0] - one_x, points[point, 1] - one_y, length, force_x, force_y
                )
                if two < 0:
                    entries[3, edge] = entries[4, edge] = entries[5, edge] = 0.0
                    continue
                entries[3, edge] = -force_x
                entries[4, edge] = -force_y
                entries[5, edge] = _moment(
                    points[point, 0] - two_x, points[point, 1] - two_y, length, -force_x, -force_y
                )
            point += 1


cdef inline double _moment(
    double arm_x, double arm_y, double length, double force_x, double force_y
) noexcept nogil:
    return arm_x / length * force_y - arm_y / length * force_x
