"""Changes reach what they are meant to reach: checksums hold, and most trees stay trees."""

import io
import json
import struct
import tomllib
import zipfile
import zlib
from contextlib import suppress
from operator import ne
from random import Random
from xml.etree import ElementTree as ET

from fuzz.containers import PNG, change_npy, change_png, change_tiff, change_zip
from fuzz.drawings import coco, dxf, labelme, svg
from fuzz.drawn import change_dxf, change_svg
from fuzz.mutate import KINDS, mutated
from fuzz.pictures import folders, npys, npzs, pngs, tiffs
from fuzz.raw import GENTLE, LARGEST
from fuzz.tree import change_json
from fuzz.walls import settings

POOL = [*pngs(), *coco(), b""]


def changes(change, seeds, count=150):
    """Files after a change; most are changed."""
    befores = [Random(number).choice(seeds) for number in range(count)]
    rngs = [Random(number) for number in range(count)]
    afters = [change(rng.choice(seeds), rng, POOL) for rng in rngs]
    assert sum(map(ne, befores, afters)) > count / 2
    return afters


def test_checksums_hold_and_headers_say_how_long_they_are():
    for data in changes(change_png, pngs()[:-1]):
        at = len(PNG)
        while at < len(data):
            (length,) = struct.unpack_from(">I", data, at)
            end = at + 8 + length
            assert struct.unpack_from(">I", data, end)[0] == zlib.crc32(data[at + 4 : end])
            at = end + 4
    for data in changes(change_zip, npzs()):
        assert zipfile.ZipFile(io.BytesIO(data)).testzip() is None
    for data in changes(change_npy, npys()[:5]):
        end = 10 + int.from_bytes(data[8:10], "little")
        assert data[8:end].endswith(b"\n") or b"\n" not in data[:end]
    seed = tiffs()[0]  # whose tags change in place
    files = changes(change_tiff, [seed])
    assert sum(len(data) == len(seed) for data in files) > len(files) / 2


def test_most_texts_stay_in_their_language():
    for change, seeds, read in (
        (change_json, [*coco(), *labelme()], json.loads),
        (change_svg, svg(), ET.fromstring),
        (change_dxf, dxf()[:1], lambda data: [int(code) for code in data.split(b"\n")[:-1:2]]),
        (GENTLE[0], [case["settings.toml"] for case in settings()],
         lambda data: tomllib.loads(data.decode())),
    ):  # fmt: skip
        files, read_well = changes(change, seeds), 0
        for data in files:
            with suppress(ValueError, LookupError, RecursionError, ET.ParseError):
                read(data)
                read_well += 1
        assert read_well > 0.7 * len(files)


def test_json_gets_doubled_and_odd_keys_deep_nesting_and_other_pictures():
    files = changes(change_json, coco(), 250)
    assert any(b"[" * 400 in data or b'{"a":' * 400 in data for data in files)
    assert any(b"\\ud800" in data for data in files)
    assert any(data.count(b'"images"') > 1 for data in files)
    seeds = labelme()[1:]
    mask = json.loads(seeds[0])["shapes"][0]["mask"].encode()
    files = [data for data in changes(change_json, seeds, 150) if mask not in data]
    assert any(b'"iVBORw0KGgo' in data for data in files)


def test_files_stay_small_and_some_are_no_files():
    seed, kinds = folders()[0], set()
    for number in range(3000):
        found = mutated(seed, Random(number), POOL).values()
        kinds |= {data for data in found if isinstance(data, str)}
        assert all(isinstance(data, str) or len(data) <= LARGEST for data in found)
    assert kinds <= set(KINDS)
    assert len(kinds) > 2
