"""Compiled kernels: built where there is a compiler, left out where there is none."""

import sys
from pathlib import Path

from setuptools import Extension, setup

# Results must not depend on the machine: no fused multiply-add, no reordering of sums.
FLAGS = ["/O2", "/fp:precise"] if sys.platform == "win32" else ["-O3", "-ffp-contract=off"]


def extensions() -> list[Extension]:
    """Return one optional extension for every kernel that is written in Cython."""
    return [
        Extension(
            ".".join(("drystone", "kernels", "compiled", path.stem)),
            [path.as_posix()],
            extra_compile_args=FLAGS,
            optional=True,
        )
        for path in sorted(Path("src/drystone/kernels/compiled").glob("*.pyx"))
    ]


setup(ext_modules=extensions())
