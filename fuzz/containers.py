"""Changes within PNG, NPY, NPZ and TIFF, with lengths and checksums mended after them."""

import io
import struct
import warnings
import zipfile
import zlib
from collections.abc import Iterable, Sequence
from random import Random

from fuzz.raw import BYTES, near, numbers, put, words

PNG, NPY, ZIP = b"\x89PNG\r\n\x1a\n", b"\x93NUMPY", b"PK\x03\x04"
TIFFS = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")

Chunk = tuple[bytes, bytes]
"""Kind and data of a part of a PNG."""

_MANY_ZEROS = zlib.compress(bytes(10**7))
_EXTRA: tuple[Chunk, ...] = (
    (b"tRNS", b"\0\0"), (b"PLTE", bytes(range(9))), (b"acTL", b"\0\0\0\2\0\0\0\0"),
    (b"zTXt", b"a\0\0" + _MANY_ZEROS), (b"iCCP", b"a\0\0" + zlib.compress(b"a")),
    (b"gAMA", b"\0\0\0\0"), (b"eXIf", b"II*\0\x08\0\0\0\xff\xff"), (b"tEXt", b"a\0b"),
    (b"iTXt", b"a\0\1\0\0\0" + _MANY_ZEROS), (b"pHYs", bytes(9)),
)  # fmt: skip
_SIDES = (0, 1, 2, 7, 1000, 65535, 10**6, 2**31 - 1, 2**31, 2**32 - 1)
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)
_COUNTS = (0, 1, 2, 3, 65535, 65536, 2**31 - 1, 2**31, 2**32 - 1)
_TAGS = (*range(254, 360), 700, 33432, 34377, 34412, 34665, 42112, 50838, 50839, 65000)


def write_png(chunks: Iterable[Chunk]) -> bytes:
    """Put a PNG together, with the checksums that its chunks have."""
    return PNG + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )


def png_of(
    width: int,
    height: int,
    depth: int,
    colour_type: int,
    lines: bytes,
    palette: bytes = b"",
    *,
    interlaced: bool = False,
) -> bytes:
    """Return a PNG of packed lines, each with its filter before it; there may be too few."""
    header = struct.pack(">IIBBBBB", width, height, depth, colour_type, 0, 0, interlaced)
    colours = [(b"PLTE", palette)] if palette else []
    rows = (b"IDAT", zlib.compress(lines))
    return write_png([(b"IHDR", header), *colours, rows, (b"IEND", b"")])


def read_png(data: bytes) -> list[Chunk]:
    """Take a PNG apart, also one that is cut short."""
    chunks, at = [], len(PNG)
    while at + 8 <= len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        chunks.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + length]))
        at += 12 + length
    return chunks


def change_png(data: bytes, rng: Random, pool: Sequence[bytes]) -> bytes:
    """Change a chunk of a PNG, or its size, depth or rows."""
    chunks = read_png(data)
    at = rng.randrange(len(chunks))
    kind, content = chunks[at]
    draw = rng.randrange(9)
    if draw == 0:
        chunks.insert(at, rng.choice(_EXTRA))
    elif draw == 1:
        chunks[at:at] = [chunks[rng.randrange(len(chunks))]] * rng.choice((1, 1, 200))
    elif draw == 2:
        del chunks[at]
    elif kind == b"IDAT" and draw < 7:
        rows = zlib.decompress(content)
        chunks[at] = kind, zlib.compress(rng.choice(BYTES)(rows, rng, pool))
    elif kind == b"IHDR" and draw < 7:
        width, height, *rest = struct.unpack(">IIBBBBB", content)
        size = [width, height]
        size[rng.randrange(2)] = rng.choice(_SIDES)
        rest[rng.randrange(5)] = rng.choice((0, 1, 2, 3, 4, 6, 8, 16))
        new = (size, content[8:]) if rng.random() < 0.5 else ((width, height), bytes(rest))
        chunks[at] = kind, struct.pack(">II", *new[0]) + new[1]
    else:
        chunks[at] = kind, rng.choice(BYTES)(content, rng, pool)
    return write_png(chunks)


def change_npy(data: bytes, rng: Random, pool: Sequence[bytes]) -> bytes:
    """Change the header of an array, and say its new length, or its values."""
    size = 2 if data[6] == 1 else 4
    start = 8 + size
    end = start + int.from_bytes(data[8:start], "little")
    if rng.random() < 0.3:
        return data[:end] + rng.choice(BYTES)(data[end:], rng, pool)
    header = rng.choice((numbers, near, near, words))(data[start:end], rng, pool)[: 256**size - 1]
    return data[:8] + len(header).to_bytes(size, "little") + header + data[end:]


def change_zip(data: bytes, rng: Random, pool: Sequence[bytes]) -> bytes:
    """Change, rename, add or leave out a member of an archive, or pack it in another way."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = [(one.filename, archive.read(one), one.compress_type) for one in archive.filelist]
    at = rng.randrange(len(members))
    name, content, method = members[at]
    draw = rng.randrange(8)
    if draw == 0:
        name = rng.choice(("labels.npy", "a", "../a.npy", "a/b.npy", "\u0661.npy", "", name * 99))
    elif draw == 1:
        method = rng.choice(_METHODS)
    elif draw == 2:
        content = content + bytes(10**6)
    elif draw == 3:
        members.append((name, rng.choice(pool), method))
    elif draw == 4:
        del members[at]
    elif content.startswith(NPY):
        content = change_npy(content, rng, pool)
    else:
        content = rng.choice(BYTES)(content, rng, pool)
    if draw != 4:
        members[at] = name, content, method
    buffer = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w") as archive:
        warnings.simplefilter("ignore")  # of names that are there twice
        for name, content, method in members:
            archive.writestr(zipfile.ZipInfo(name or "a"), content, method)
    return buffer.getvalue()


def change_tiff(data: bytes, rng: Random, pool: Sequence[bytes]) -> bytes:
    """Change a tag of a TIFF, its type, count or value, or where the next directory is."""
    order, big = "<" if data[:1] == b"I" else ">", b"+" in data[2:4]
    pointer, count, entry = ("Q", "Q", "HHQ8s") if big else ("I", "H", "HHI4s")
    size, first = struct.calcsize(order + entry), 8 if big else 4
    (at,) = struct.unpack_from(order + pointer, data, first)
    (entries,) = struct.unpack_from(order + count, data, at)
    begin = at + struct.calcsize(order + count)
    draw = rng.randrange(12)
    if draw == 0:
        where = rng.choice((first, begin + entries * size))
        target = rng.choice((0, at, at + 2, len(data), rng.randrange(len(data)), 2**31))
        return _over(data, where, struct.pack(order + pointer, target))
    if draw == 1:
        return _over(data, at, struct.pack(order + count, rng.choice((0, 1, entries - 1, 4000))))
    if draw == 2:
        return rng.choice(BYTES)(data, rng, pool)
    where = begin + rng.randrange(entries) * size
    tag, kind, number, value = struct.unpack_from(order + entry, data, where)
    if draw < 5:
        tag = rng.choice(_TAGS)
    elif draw < 6:
        kind = rng.randrange(20)
    elif draw < 8:
        number = rng.choice(_COUNTS)
    else:
        value = put(value, rng, pool)[: len(value)].ljust(len(value), b"\0")
    return _over(data, where, struct.pack(order + entry, tag, kind, number, value))


def _over(data: bytes, at: int, new: bytes) -> bytes:
    return data[:at] + new + data[at + len(new) :]
