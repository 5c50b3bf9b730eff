"""A fuzzer of all that drystone reads: ``python -m fuzz --help``."""

import os

# One thread a process, so that processor time is that of the reader, and children can be forked.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
