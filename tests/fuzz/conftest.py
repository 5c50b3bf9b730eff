"""Limits of processes are those of POSIX."""

import sys

collect_ignore_glob = ["test_*"] if sys.platform == "win32" else []
