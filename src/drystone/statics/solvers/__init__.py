"""Linear programs in, solutions out: one module a library."""
