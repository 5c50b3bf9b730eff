"""The kernels in Cython; :mod:`drystone.kernels.backend` says which of them are used."""
