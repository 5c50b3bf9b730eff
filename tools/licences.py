"""List the licences of all that is installed; fail for those that bind what uses them.

``python tools/licences.py``: permissive licences and weak copyleft pass, all others must be looked
at by hand, and stand in `BY_HAND` with what was found.
"""

import re
import sys
from importlib.metadata import Distribution, distributions

PASSES = re.compile(
    r"(the |new )?(\d-clause )?(0?BSD|FreeBSD|MIT|Apache|ISC|PSF|Python Software Foundation|Zlib|"
    r"HPND|CC0|Unlicense|MPL|Mozilla Public|LGPL|DFSG approved)",
    re.IGNORECASE,
)
BINDS = re.compile(r"(?<!L)GPL|GNU General|Affero|commercial|proprietary", re.IGNORECASE)
BY_HAND = {
    "axe-playwright-python": "MIT: the file of the licence, its metadata have none",
    "docutils": "public domain and BSD; GPL is of an Emacs mode that is no part of the package",
    "pypdfium2": "BSD-3-Clause, Apache-2.0; PDFium and its libraries are permissive",
    "spyrrow": "MIT: the file of the licence, its metadata have none",
}
WITHIN = {
    "axe-playwright-python": "axe-core (MPL-2.0), for tests only",
    "numpy": "OpenBLAS (BSD), libgfortran and libquadmath (GPL with the runtime exception)",
    "opencv-python-headless": "FFmpeg (LGPL-2.1), OpenSSL, OpenBLAS, libvpx, libaom, libavif",
    "pillow": "libtiff, libjpeg, libwebp, FreeType and others, all permissive",
    "playwright": "Node.js (MIT and others), for tests only",
    "scipy": "OpenBLAS (BSD), libgfortran and libquadmath (GPL with the runtime exception)",
    "shapely": "GEOS (LGPL-2.1)",
}
"""Libraries in their wheels that have licences of their own."""


def licences_of(one: Distribution) -> list[str]:
    """Return what its metadata say: an expression, classifiers, or the first line of a text."""
    metadata = one.metadata
    if metadata["License-Expression"]:
        return re.split(r" (?:AND|OR|WITH) ", metadata["License-Expression"])
    named = [name for name in metadata.get_all("Classifier", []) if name.startswith("License ::")]
    said = [name.rpartition(" :: ")[2] for name in named] or [metadata["License"] or ""]
    return [(words.strip().splitlines() or [""])[0] for words in said]


def main() -> int:
    """Print a table; return 1 when a licence was not looked at."""
    unknown = []
    for one in sorted({one.name: one for one in distributions()}.values(), key=lambda d: d.name):
        found = licences_of(one)
        passes = one.name in BY_HAND or (
            all(map(PASSES.match, found)) and not any(map(BINDS.search, found))
        )
        unknown += [] if passes else [one.name]
        words = [BY_HAND.get(one.name, ", ".join(found)), WITHIN.get(one.name)]
        said = "; its wheels hold ".join(filter(None, words))
        sys.stdout.write(f"{one.name} {one.version}: {said}{'' if passes else '  <-- ?'}\n")
    if unknown:
        sys.stderr.write(f"look at the licences of {', '.join(unknown)} (BY_HAND)\n")
    return int(bool(unknown))


if __name__ == "__main__":
    sys.exit(main())
