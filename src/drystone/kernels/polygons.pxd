from libc.math cimport floor, sqrt

from drystone.kernels.memory cimport doubles, doubles_out, p_double
