"""Files that once started a program, never ended, filled the memory or ended in a traceback.

One of each kind, made of a few bytes: nothing of the files themselves that were found.
"""

import base64
import io
import json
import struct
import zipfile
import zlib

import ezdxf
import numpy as np
from fuzz.containers import png_of
from fuzz.drawings import binary_stl
from fuzz.pictures import npy, pillow
from fuzz.tiffs import write_tiff

from drystone.io.read_settings import ReadSettings
from tests.io import test_annotations
from tests.io.pictures import two_stones
from tests.io.test_dxf import text_of

EPS = b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 60 36\n%%EndComments\n(x) print\n%%EOF\n"
STONE, USE = '<rect width="9" height="9"/>', "<use href='#p'/>"


def tiff_of(tags=None, **more):
    """A TIFF of 6 x 4 px, with some tags of other values."""
    tags = {tag: [value] for tag, value in (tags or {}).items()}
    return write_tiff(np.arange(24).reshape(4, 6), tags=tags, **more)


def many_entries():
    """A BigTIFF with more entries than offsets can count."""
    data = tiff_of(big=True)
    return data[:40] + struct.pack("<Q", 2**63) + data[48:]


def signalling():
    """An array with a NaN that arithmetic warns of, as few others do."""
    values = two_stones(7, 9, np.float32)
    values.view(np.uint32)[0, 0] = 0x7F800001
    return values


def npy_of(shape, descr="<u4"):
    """The header of an array, and 4 bytes of it."""
    text = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\0" + struct.pack("<H", len(text)) + text.encode() + bytes(4)


def npz(members, compression=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(buffer := io.BytesIO(), "w", compression) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return buffer.getvalue()


def gif(width, height):
    """A GIF of 6 x 4 px whose frame has another size."""
    data = pillow(np.ones((4, 6), np.uint8), "GIF")
    frame = struct.pack("<HHHH", 0, 0, 6, 4)
    assert data.count(frame) == 1
    return data.replace(frame, struct.pack("<HHHH", 0, 0, width, height))


def bmp(width):
    """A BMP of one row of run lengths, which goes two rows up before its first pixel."""
    data = bytearray(pillow(np.ones((4, 6), np.uint8), "BMP"))
    data[18:34] = struct.pack("<iiHHI", width, 1, 1, 8, 1)
    start = int.from_bytes(data[10:14], "little")
    return bytes(data[:start]) + b"\0\2\0\xff" * 9


def jpeg(scans):
    """A progressive JPEG whose last scan comes again and again."""
    data = pillow(np.full((40, 60), 7, np.uint8), "JPEG", progressive=True)
    last = data.rindex(b"\xff\xda")
    return data[:last] + data[last:-2] * scans + data[-2:]


def svg(body, **attributes):
    said = " ".join(f'{name}="{value}"' for name, value in attributes.items())
    return f'<svg xmlns="http://www.w3.org/2000/svg" {said}>{body}</svg>'.encode()


def labelme(mask):
    shape = {"label": "1", "points": [[0, 0], [9, 9]], "shape_type": "mask"}
    shape["mask"] = base64.b64encode(mask).decode()
    return json.dumps(test_annotations.labelme(shapes=[shape])).encode()


def coco(*segmentations, side=60):
    found = dict(enumerate(segmentations, start=1))
    images = [{"id": 7, "width": side, "height": side}]
    return json.dumps(test_annotations.coco(found, images=images)).encode()


def runs(side):
    return {"size": [side, side], "counts": [1, side * side - 1]}


def dxf(draw):
    document = ezdxf.new(units=4)
    draw(document)
    return text_of(document)


def polygon(*corners):
    return lambda document: document.modelspace().add_lwpolyline(corners, close=True)


def far_away(document):
    for left in range(0, 200, 20):
        polygon((left, 0), (left + 15, 0), (left + 15, 10))(document)
    polygon((0, 20), (1200, 20), (0, 1200))(document)


def in_rows(document):
    document.blocks.new("NOTHING")
    reference = document.modelspace().add_blockref("NOTHING", (0, 0)).dxf
    reference.row_count = reference.column_count = 30_000
    reference.row_spacing = reference.column_spacing = 1.0


def nested(document):
    for side in range(700, 0, -1):
        polygon((-side, -side), (side, -side), (side, side), (-side, side))(document)


def high_degree(document):
    points = [(x, y, 0.0) for x, y in np.random.default_rng(0).random((90, 2)).tolist()]
    document.modelspace().add_open_spline(points, degree=89)


RANDOM = np.random.default_rng(0).random
CROSSING = [(float(x), float(y)) for x, y in RANDOM((600, 2))]
CORNERS = "\n".join(f"v {x} {y} 0" for x, y in CROSSING)
FACE = f"f {' '.join(map(str, range(1, 601)))}"
SLATES = [[[i, 0, 0], [i + 1, 0, 0], [i, 0, 1]] for i in range(0, 99, 2)]

PLY = (
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    b"property float z\nelement face %b\nproperty list uchar int vertex_indices\nend_header\n"
    b"0 0 0\n1 0 0\n0 1 0\n"
)


def inflated():
    """A TIFF whose strip becomes more than a million times as large as the picture."""
    strip = zlib.compress(bytes(90_000_000), 1)
    return tiff_of({259: 8, 273: 200, 279: len(strip)}).ljust(200, b"\0") + strip


SETTINGS = {
    "far.dxf": ReadSettings(px_per_m=10_000.0),
    "far.stl": ReadSettings(up="z"),
    "together.json": ReadSettings(max_image_mpx=1.0),
    "packed.npz": ReadSettings(max_image_mpx=0.5),
}
"""With which some files are as bad as larger ones are without."""

FILES = {
    # a program that is started
    "eps.json": (lambda: labelme(EPS), "E114 .*is not a picture"),
    # no end
    "circle.tif": (lambda: tiff_of(following=32), "E106 .*in a circle"),
    "circle_big.tif": (lambda: tiff_of(following=40, big=True), "E106 .*in a circle"),
    "selectors.svg": (
        lambda: svg(
            f"<style>.z {'g ' * 12}rect{{opacity:0}}</style>{'<g>' * 50}{STONE}{'</g>' * 50}"
        ),
        "E114 .*style sheet",
    ),
    "rules.svg": (
        lambda: svg(f"<style>{'*{opacity:1}' * 3000}</style>{STONE * 3000}"),
        "E110 .*lie over each other",
    ),
    "digits.svg": (lambda: svg(STONE, width=f"{'1' * 60_000}!"), "E114 .*not a length"),
    "turn.svg": (lambda: svg(f'<g transform="{" " * 60_000}!"/>'), "E114 .*not a transform"),
    "not.svg": (
        lambda: svg(f"<style>rect:not({'(' * 60_000}{')' * 60_000}){{x:1}}</style>{STONE}"),
        "E114 .*sheet",
    ),
    "crossing.dxf": (lambda: dxf(polygon(*CROSSING)), "E114 .*cross themselves more than"),
    "crossing.obj": (f"{CORNERS}\n{FACE}".encode, "E114 .*cross themselves more than"),
    "rows.dxf": (lambda: dxf(in_rows), "E114 .*too often"),
    "nested.dxf": (lambda: dxf(nested), "E114 .*in each other too often"),
    "degree.dxf": (lambda: dxf(high_degree), "E114 .*degree is 89"),
    "pile.stl": (lambda: binary_stl(RANDOM((900, 3, 3))), "E110 .*over each other"),
    # a memory that is filled
    "large.json": (lambda: coco(runs(2400), side=2400), ""),
    "largest.json": (lambda: coco(runs(46_340)), "E110 .*46340 x 46340"),
    "together.json": (lambda: coco(*[runs(990)] * 3, side=990), "E110 .*million px together"),
    "apart.json": (
        lambda: coco([[0, 0, 5, 0, 5, 5], [1e8, 1e8, 1e8, 1e8 + 5, 1e8 + 5, 1e8]]),
        "E110 .*far away",
    ),
    "up_and_down.json": (
        lambda: coco([[v for x, y in CROSSING for v in (x, y * 900)]]),
        "E110 .*up and down",
    ),
    "bomb.json": (lambda: labelme(png_of(20_000, 20_000, 1, 0, bytes(9))), "E110 .*20000 x 20000"),
    "far.dxf": (lambda: dxf(far_away), "E110 .*reaches over .*far away"),
    "far.stl": (
        lambda: binary_stl(np.array([*SLATES, [[0, 0, 2], [90, 0, 2], [0, 0, 99]]])),
        "E110 .*far away",
    ),
    "curves.svg": (lambda: svg(f'<path d="M1 1t{"1 1 " * 10_000}z"/>'), "E114 .*corners"),
    "used.svg": (
        lambda: svg(f"<defs><path id='p' class='{'x' * 10_000}'/></defs>" + USE * 999),
        "E110 .*used too often",
    ),
    "scans.jpg": (lambda: jpeg(500), "E106 .*more than 100 scans"),
    "few_scans.jpg": (lambda: jpeg(50), "E104"),
    "side.bmp": (lambda: bmp(150_000_000), "E110 .*of a side"),
    "frame.gif": (lambda: gif(60_000, 60_000), "E110"),
    "strips.tif": (inflated, "E106 .*larger than the picture"),
    "packed.npz": (
        lambda: npz({f"{i}.npy": npy(np.zeros((700, 700))) for i in range(2)}),
        "E110",
    ),
    # tracebacks
    "compression.tif": (lambda: tiff_of({259: 364}), "E107 .*compression 364"),
    "no_tiles.tif": (lambda: tiff_of({322: 0, 323: 0}), "E10"),
    "no_bits.tif": (lambda: tiff_of({258: 0}), "E107"),
    "no_channels.tif": (lambda: tiff_of({277: 0}), "E10"),
    "channels.tif": (lambda: tiff_of({277: 60_000}), "E109 .*60000 channels"),
    "wide.tif": (lambda: tiff_of({256: 2**32 - 1, 257: 2**32 - 1}), "E110"),
    "planes.tif": (lambda: tiff_of({32997: 9}), "E109 .*9 planes"),
    "entries.tif": (many_entries, "E106"),
    "signalling.npy": (lambda: npy(signalling()), ""),
    "shape.npy": (lambda: npy_of(f"({2**62}, {2**62})"), "E106"),
    "sides.npy": (lambda: npy_of(f"({'9' * 400}, -1)"), "E106 .*below 0"),
    "nothing.npy": (lambda: npy_of(f"({'9' * 400}, 9)", "|S0"), "E106 .*no bytes"),
    "alpha.tif": (lambda: tiff_of({338: 1}), "E101 "),
    "letters.tif": (
        lambda: tiff_of({259: 8}).replace(
            struct.pack("<HHII", 256, 4, 1, 6), struct.pack("<HHI4s", 256, 7, 1, b"6")
        ),
        "E106 .*not a number",
    ),
    "name.npy": (lambda: npy_of("(wide, 4)"), r"E106 .*<ast\.Name object>\)"),  # without address
    "width.npy": (lambda: npy_of("(2160,)", "|S1000000000"), "E106"),
    "lzma.npz": (lambda: npz({"a.npy": npy(two_stones())}, zipfile.ZIP_LZMA), "E106"),
    "infinite.dxf": (lambda: dxf(polygon((0, 0), (9, 0), (9, 9))).replace(b"9.0", b"1e999"), "E1"),
    "infinite.obj": (lambda: b"v 0 0 0\nv 1e999 0 0\nv 0 0 1\nf 1 2 3\n", "E114"),
    "faces.ply": (lambda: PLY % (b"9" * 5000) + b"3 0 1 2\n", "E1"),
    "side.json": (
        lambda: json.dumps({"shapes": [], "imageWidth": 10**400, "imageHeight": 36}).encode(),
        "E114 .*more than 1e9 px",
    ),
    "levels.json": (lambda: b'{"shapes":' + b"[" * 400 + b"]" * 400 + b"}", "E113 .*100 levels"),
    "quotes.json": (lambda: b'["' + b'\\"' * 300_000, "E113"),
    "arc.svg": (lambda: svg('<path d="M0 0A9e11 9e11 0 0 0 1e-300 0z"/>'), "E1"),
}
"""What makes a file, and what it ends with; nothing when it is read."""
