"""Compiled kernels: built where there is a compiler, left out where there is none."""

import os
import sys
from pathlib import Path

from setuptools import Extension, setup

KERNELS = Path("src/drystone/kernels/compiled")

# Results must not depend on the machine: no fused multiply-add, no reordering of sums.
FLAGS = ["/O2", "/fp:precise"] if sys.platform == "win32" else ["-O3", "-ffp-contract=off"]


def extensions() -> list[Extension]:
    """Return one optional extension for every kernel that is written in Cython."""
    declared = sorted(path.as_posix() for path in KERNELS.glob("*.pxd"))
    return [
        Extension(
            ".".join(("drystone", "kernels", "compiled", path.stem)),
            [path.as_posix()],
            depends=declared,
            extra_compile_args=FLAGS,
            optional=True,
        )
        for path in sorted(KERNELS.glob("*.pyx"))
    ]


setup(ext_modules=extensions(), options={"build_ext": {"parallel": os.cpu_count() or 1}})
