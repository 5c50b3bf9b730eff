from drystone.kernels.memory cimport longs
