"""Valid files made strange: which of a case, and by which kinds of change."""

from collections.abc import Callable, Mapping, Sequence
from random import Random

from fuzz.containers import NPY, PNG, TIFFS, ZIP, change_npy, change_png, change_tiff, change_zip
from fuzz.drawn import change_dxf, change_svg
from fuzz.raw import BYTES, GENTLE, LARGEST, TEXT, Change
from fuzz.tree import change_json

Case = Mapping[str, bytes | str]
"""Files by name, the main one first; a text is one of `KINDS`, which are no regular files."""

KINDS = ("fifo", "folder", "loop", "endless", "nowhere")

_UNCHANGED, _NO_FILE, _RENAMED, _GENTLY = 0.01, 0.003, 0.02, 0.7
_ENDINGS = (
    ".png", ".tif", ".gif", ".bmp", ".jpg", ".npy", ".npz", ".json", ".geojson", ".dxf", ".svg",
    ".obj", ".ply", ".stl", ".toml", ".txt", "",
)  # fmt: skip
_HEAD = 512

_STRUCTURES: tuple[tuple[Callable[[bytes], bool], Sequence[Change]], ...] = (
    (lambda data: data.startswith(PNG), (change_png,)),
    (lambda data: data.startswith(NPY), (change_npy,)),
    (lambda data: data.startswith(ZIP), (change_zip,)),
    (lambda data: data.startswith(TIFFS), (change_tiff,)),
    (lambda data: data[:1] in (b"{", b"["), (change_json, change_json, *GENTLE[:1])),
    (lambda data: b"<svg" in data[:_HEAD], (change_svg, change_svg, *GENTLE)),
    (lambda data: data.startswith(b"  0\nSECTION"), (change_dxf,)),
    (lambda data: b"\0" not in data[:_HEAD], GENTLE),
)


def mutated(case: Case, rng: Random, pool: Sequence[bytes]) -> Case:
    """Return a case with one of its files changed; now and then all are as they were.

    Parameters
    ----------
    case : mapping
        Files by name.
    rng : Random
        Decides everything.
    pool : sequence of bytes
        Files that parts are taken of.
    """
    draw = rng.random()
    if draw < _UNCHANGED:
        return case
    name = rng.choice([*case, next(iter(case))])
    data = case[name]
    if draw < _UNCHANGED + _NO_FILE or isinstance(data, str):
        return {**case, name: rng.choice(KINDS)}
    gently = rng.random() < _GENTLY
    for _ in range(1 + min(6, int(rng.expovariate(0.8)))):
        data = changed(data, rng, pool, gently=gently)
    if len(case) == 1 and rng.random() < _RENAMED:
        return {f"a{rng.choice(_ENDINGS)}": data}
    return {**case, name: data}


def changed(data: bytes, rng: Random, pool: Sequence[bytes], *, gently: bool) -> bytes:
    """Change a file once: in the parts that its format has, or in any way."""
    changes = next((found for tells, found in _STRUCTURES if tells(data)), BYTES)
    if not gently:
        changes = (*changes, *BYTES, *(() if b"\0" in data[:_HEAD] else TEXT))
    try:
        found = rng.choice(changes)(data, rng, pool)
    except Exception:  # what was changed before has broken the format, in one way or another
        found = rng.choice(BYTES)(data, rng, pool)
    return found[: max(LARGEST, len(data))]
