"""Kernels are compiled where there is a compiler; where there is none, they run as they are.

Every kernel that imports `cython` is compiled in place, beside its source: Python takes what is
compiled first.  So is what is written in Cython alone.  All of it is compiled, or nothing.
"""

import os
import shutil
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path("src")
KERNELS = SOURCE / "drystone" / "kernels"

# Results must not depend on the machine: no fused multiply-add, no reordering of sums.
# Debug information and symbols would be nine tenths of the files. Warnings are of C by Cython.
FLAGS, LINKED = ["-O2", "-g0", "-w", "-ffp-contract=off"], []
if sys.platform == "win32":
    FLAGS = ["/O2", "/fp:precise"]
elif sys.platform == "linux":
    LINKED = ["-Wl,-s"]

# Long loops over columns gain by it, a third and a tenth, others nothing.
HOT = {f"drystone.kernels.{name}" for name in ("courses", "drops")}
FASTER = [] if sys.platform == "win32" else ["-O3"]

DIRECTIVES = {
    "language_level": 3,
    "boundscheck": False,
    "wraparound": False,
    "cdivision": True,
    "initializedcheck": False,
    "autotestdict": False,
    # Nobody pickles a kernel or asks for its signature: a tenth of the C for nothing.
    "auto_pickle": False,
    "binding": False,
    "infer_types": True,
}


def extensions() -> list[Extension]:
    """Return one extension for every kernel that can be compiled."""
    sources = [
        *KERNELS.rglob("*.pyx"),
        *(path for path in KERNELS.rglob("*.py") if "import cython\n" in path.read_text("utf-8")),
    ]
    declared = sorted(path.as_posix() for path in KERNELS.rglob("*.pxd"))
    names = [".".join(path.relative_to(SOURCE).with_suffix("").parts) for path in sorted(sources)]
    return [
        Extension(
            name,
            [path.as_posix()],
            depends=declared,
            extra_compile_args=[*FLAGS, *(FASTER if name in HOT else ())],
            extra_link_args=LINKED,
        )
        for name, path in zip(names, sorted(sources), strict=True)
    ]


def is_up_to_date(made: Path, extension: Extension) -> bool:
    """Say whether a kernel is newer than all that it is made from."""
    needed = (Path(name) for name in [__file__, *extension.sources, *extension.depends])
    last = max(path.stat().st_mtime for path in needed)
    return made.exists() and made.stat().st_mtime > last


class BuildKernels(build_ext):
    """Compile all kernels, or none; Cython is not even asked where there is no compiler."""

    def run(self) -> None:
        """Build, and go on without compiled kernels where that fails.

        An editable installation keeps what `build_ext --inplace` has made of these very sources.
        """
        made = [SOURCE / self.get_ext_filename(extension.name) for extension in self.extensions]
        in_place = self.inplace
        if self.editable_mode and all(map(is_up_to_date, made, self.extensions)):
            self.extensions = []
            return
        try:
            super().run()
        except Exception as error:
            print(f"kernels are not compiled, they run in Python: {error}", flush=True)
            for extension in self.extensions:
                Path(self.get_ext_fullpath(extension.name)).unlink(missing_ok=True)
            for path in made if in_place else ():  # of sources that were others
                path.unlink(missing_ok=True)
            self.extensions = []

    def build_extensions(self) -> None:
        """Look for a compiler, then build."""
        command = getattr(self.compiler, "compiler_so", None) or getattr(self.compiler, "cc", None)
        if self.compiler.compiler_type == "msvc":
            self.compiler.initialize()
        elif not command or shutil.which(command[0]) is None:
            raise FileNotFoundError("no compiler was found")
        super().build_extensions()

    def build_extension(self, extension: Extension) -> None:
        """Translate one kernel to C and compile it."""
        from Cython.Build import cythonize  # noqa: PLC0415 - only where there is a compiler

        number = 1 + self.extensions.index(extension)
        print(f"kernel {number} of {len(self.extensions)}: {extension.name}", flush=True)
        (translated,) = cythonize(
            [extension], include_path=[str(SOURCE)], compiler_directives=DIRECTIVES, quiet=True
        )
        extension.sources = translated.sources
        super().build_extension(extension)


if __name__ == "__main__":
    setup(
        ext_modules=extensions(),
        cmdclass={"build_ext": BuildKernels},
        options={"build_ext": {"parallel": os.cpu_count() or 1}},
    )
