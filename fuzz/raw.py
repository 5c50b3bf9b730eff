"""Changes of any file as bytes, and of any text by its numbers, words and lines."""

import re
import struct
from collections.abc import Callable, Sequence
from random import Random

Change = Callable[[bytes, Random, Sequence[bytes]], bytes]
"""From a file, with others that parts are taken of, to a changed one."""

LARGEST = 64_000
"""Bytes of a changed file: nothing that is read may take seconds for so few."""

NUMBERS = (
    "0", "-0.0", "1", "-1", "0.1", "1e-320", "1e20", "1e38", "1e308", "-1e308", "1e999", "255",
    "256", "65535", "65536", "2147483647", "2147483648", "4294967295", "4294967296",
    "9223372036854775808", "18446744073709551616", "20000", "100000", "1" + "0" * 400, "9" * 5000,
)  # fmt: skip
STRANGE = ("NaN", "Infinity", "-Infinity", "nan", "inf", "+inf", "1_0", "0x10", "1e", "-", "")
"""Numbers in some languages only."""
ODD = (
    "", " ", "\0", "\ud800", "\ufeff", "\u202e", "e\u0301", "\U0001f9f1", "\r\n", "\u0661", "%s",
    "../../up", "/dev/zero", "NaN", "-1", "true", "a" * 20_000, "#", "*", "'", '"', "<", "&lt;",
)  # fmt: skip
FRAGMENTS = (
    '<g transform="scale(1e300)">', "<style>* * * * * * * * a{fill:red}</style>", "</g>", "</svg>",
    "<style>g>g>g g g>g g path{display:none}</style>", '<use href="#stone"/>', "<![CDATA[", "<!--",
    '<!DOCTYPE a [<!ENTITY b "cccc">]>', 'd="M0 0A1 1 0 0 0 1e9 1"', 'width="100%"', "&b;", "%",
    'viewBox="0 0 0 0"', 'style="', "em", "z", "<?xml ?>", "\n0\nSECTION\n", "\n0\nENDSEC\n",
    "\n0\nEOF\n", "\n0\nINSERT\n2\nSTONE\n", "\n9\n$INSUNITS\n", "\n70\n1\n", "\n41\n1e300\n",
    "\nf 1 2 3\n", "\nf -1 -2 -3\n", "\nv 1e308 0 0\n", "\no \n", "endsolid", "\nend_header\n",
    "\nelement face 4000000000\n", "\nproperty list uchar int vertex_indices\n", "\n[search]\n",
    "\n[[wedge]]\n", " = ", "\nseed = 1\n", '"""', "{a.b=[", "1979-05-27", "[" * 3000, "{" * 3000,
)  # fmt: skip
"""Of all languages: files of one are also read as those of another."""

FOREIGN = (
    b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n%%EndComments\nshowpage\n%%EOF\n",
    b"/* XPM */\nstatic char *a[] = {\n\"1 1 1 1\",\n\"a c #000000\",\n\"a\"};\n", b"%PDF-1.7\n",
    b"cposix\nsystem\n(S'true'\ntR.", b"RIFF\x24\0\0\0WEBPVP8 ", b"P5\n9 9\n255\n" + bytes(81),
    b"\xd7\xcd\xc6\x9a" + bytes(40), b"\x1f\x8b\x08\0" + bytes(9), b"", b"\xff\xfe<\0s\0v\0g\0",
)  # fmt: skip
"""Beginnings of what is not read: PostScript, which starts a program in some decoders, pickles."""

_PACKED = (
    *(struct.pack(form, value) for form in ("<h", ">h", "<i", ">i", "<q") for value in (0, 1, -1)),
    *(struct.pack(form, value) for form in ("<H", ">H") for value in (255, 256, 32768)),
    *(struct.pack(form, 1 << bit) for form in ("<I", ">I") for bit in (8, 16, 20, 28, 31)),
    *(struct.pack(form, 1 << bit) for form in ("<Q", ">Q") for bit in (31, 32, 40, 63)),
    *(
        struct.pack(form, float(value))
        for form in ("<f", "<d", ">f", ">d")
        for value in ("nan", "inf", "1e38", "-1e30", "0.5")
    ),
)
_NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_WORD = re.compile(rb"[A-Za-z_$#:]{2,}")


def place(rng: Random, length: int) -> int:
    """Return a position, often one near the beginning, where headers are."""
    return rng.randrange(min(length, 64) if rng.random() < 0.5 else length) if length else 0


def flip(data: bytes, rng: Random, _: Sequence[bytes]) -> bytes:
    """Turn single bits around."""
    found = bytearray(data)
    for _ in range(rng.choice((1, 1, 1, 4, 16)) if data else 0):
        found[place(rng, len(found))] ^= 1 << rng.randrange(8)
    return bytes(found)


def put(data: bytes, rng: Random, _: Sequence[bytes]) -> bytes:
    """Write an extreme number over what is there, or between."""
    at, new = place(rng, len(data)), rng.choice(_PACKED)
    at -= at % 2 if rng.random() < 0.8 else 0
    return data[:at] + new + data[at + rng.choice((0, len(new), len(new))) :]


def cut(data: bytes, rng: Random, _: Sequence[bytes]) -> bytes:
    """Leave out a part, or the end."""
    at = place(rng, len(data))
    return data[:at] + (data[at + rng.choice((1, 2, 4, 16, 64)) :] if rng.random() < 0.6 else b"")


def repeat(data: bytes, rng: Random, _: Sequence[bytes]) -> bytes:
    """Write a part several times."""
    at = place(rng, len(data))
    part = data[at : at + rng.choice((1, 2, 4, 16, 64, 512))]
    return data[:at] + part * rng.choice((2, 3, 17, 300, 5000)) + data[at:]


def insert(data: bytes, rng: Random, _: Sequence[bytes]) -> bytes:
    """Put something between that means something elsewhere, or nothing."""
    at = place(rng, len(data))
    new = rng.choice(FRAGMENTS).encode() if rng.random() < 0.3 else rng.randbytes(rng.randrange(9))
    return data[:at] + new + data[at:]


def splice(data: bytes, rng: Random, pool: Sequence[bytes]) -> bytes:
    """Go on as another file does."""
    other = rng.choice(pool)
    return data[: place(rng, len(data))] + other[place(rng, len(other)) :]


BYTES: Sequence[Change] = (flip, flip, put, put, cut, repeat, insert, splice)


def _swapped(data: bytes, pattern: re.Pattern[bytes], rng: Random, new: Sequence[bytes]) -> bytes:
    """Put something new, or what is there elsewhere, in the place of one or more that match."""
    found = [match.span() for match in pattern.finditer(data)]
    for start, end in sorted(rng.sample(found, min(len(found), rng.choice((1, 1, 3)))))[::-1]:
        other = slice(*rng.choice(found))
        chosen = rng.choice(new) if rng.random() < 0.7 else data[other]
        data = data[:start] + chosen + data[end:]
    return data


def numbers(data: bytes, rng: Random, _: Sequence[bytes]) -> bytes:
    """Put extreme numbers in the place of some."""
    return _swapped(data, _NUMBER, rng, [number.encode() for number in (*NUMBERS, *STRANGE)])


def near(data: bytes, rng: Random, _: Sequence[bytes]) -> bytes:
    """Change a number so little that it may go on meaning something."""
    found = [*_NUMBER.finditer(data)]
    if not found:
        return data
    match = rng.choice(found)
    return (
        data[: match.start()] + near_number(match[0].decode(), rng).encode() + data[match.end() :]
    )


def near_number(number: str, rng: Random) -> str:
    """Return a number of the same kind near to another."""
    if number.lstrip("+-").isdigit() and len(number) < 20:
        value = int(number)
        return str(rng.choice((value + 1, value - 1, 2 * value, -value, value // 2)))
    value = float(number)
    return repr(rng.choice((value + 1, 2 * value, -value, value * 1.001, value / 3, value + 1e-6)))


def words(data: bytes, rng: Random, _: Sequence[bytes]) -> bytes:
    """Put other or odd words in the place of some."""
    return _swapped(data, _WORD, rng, [odd.encode("utf-8", "surrogatepass") for odd in ODD])


def lines(data: bytes, rng: Random, _: Sequence[bytes]) -> bytes:
    """Leave out, write again, or move some lines."""
    found = data.splitlines(keepends=True)
    start = rng.randrange(len(found))
    some = slice(start, start + rng.choice((1, 1, 2, 8)))
    part = found[some]
    if rng.random() < 0.6:
        del found[some]
    at = rng.randrange(len(found) + 1)
    return b"".join([*found[:at], *(part * rng.choice((0, 1, 1, 2, 100, 3000))), *found[at:]])


TEXT: Sequence[Change] = (numbers, near, words, lines, insert, splice)
GENTLE: Sequence[Change] = (near, near, numbers, lines)
"""What leaves most text in its language."""
