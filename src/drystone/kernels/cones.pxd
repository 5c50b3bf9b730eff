from drystone.kernels.memory cimport doubles, doubles_out, ints_out

cdef double moment(double x, double y, double length, double force_x, double force_y) noexcept nogil
