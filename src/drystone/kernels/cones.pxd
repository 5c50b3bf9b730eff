cdef double moment(double x, double y, double length, double force_x, double force_y) noexcept nogil
