from drystone.kernels.memory cimport flags, flags_out, ints_out
