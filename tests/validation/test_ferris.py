"""Walls of Ferris and Tin-Loi (2001), associated flow.

M. C. Ferris and F. Tin-Loi, Limit analysis of frictional block assemblies as a mathematical
program with complementarity constraints, International Journal of Mechanical Sciences 43 (2001)
209-224.  Full blocks 4 x 1.75, half blocks 2 x 1.75, weight proportional to area, mu .65, bottom
course on the ground, every touching bed and head joint a contact.

The load factors were computed independently from the matrices of GAMS MPECLib (with two
misprints of example 3 corrected, which makes it symmetric) and by a program on the rectangles.
They are given to five digits; the tolerance is half a unit of the last one.
"""

import json

import pytest

from drystone.statics.given import model_from_json
from drystone.statics.limit import lateral_resistance

A = [(0, 2), (2, 6), (6, 10), (10, 14), (14, 18), (18, 20)]
B = [(0, 4), (4, 8), (8, 12), (12, 16), (16, 20)]
P = [(0, 4), (4, 8), (8, 12), (12, 16)]
Q = [(0, 2), (2, 6), (6, 10), (10, 14), (14, 16)]
q = [(0, 2), (2, 6), (10, 14), (14, 16)]
p = [(0, 4), (4, 6), (10, 12), (12, 16)]
a = [(0, 4), (8, 12), (16, 20)]
b = [(0, 2), (2, 4), (8, 10), (10, 12), (16, 18), (18, 20)]
C = [(0, 2), (2, 6), (6, 10), (10, 12)]
D = [(0, 4), (4, 8), (8, 12)]
c = [(0, 4), (8, 12)]
d = [(0, 2), (2, 4), (8, 10), (10, 12)]

WALLS = {
    1: ([A, B] * 3, 33, 83, 0.64286),
    2: ([A, B] * 5, 55, 141, 0.58000),
    3: ([P, Q, P, q, p, q, p, q, P, Q, P], 46, 102, 0.40369),
    4: ([A, B, A, a, b, a, b, a, A, B, A], 55, 116, 0.33195),
    5: ([C, D, C, c, d, c, d, c, C, D, C, c, d, c, d, c, C, D, C], 61, 120, 0.23964),
}

FILES = {number: (*WALLS[number][1:],) for number in WALLS} | {6: (146, 345, 0.34782)}


def assert_published(model, blocks, contacts, alpha):
    assert (len(model.blocks), len(model.interfaces)) == (blocks, contacts)
    both = lateral_resistance(model)
    assert both.left.alpha == pytest.approx(alpha, abs=5e-6)
    assert both.right.alpha == pytest.approx(alpha, abs=5e-6)


@pytest.mark.parametrize("number", WALLS)
def test_from_the_courses(number):
    courses, *published = WALLS[number]
    rows = [
        [left, 1.75 * course, right - left, 1.75]
        for course, ranges in enumerate(courses)
        for left, right in ranges
    ]
    assert_published(model_from_json({"blocks_xywh": rows, "mu": 0.65}), *published)


@pytest.mark.parametrize("number", FILES)
def test_from_the_published_files(number, data_dir):
    data = json.loads((data_dir / "ferris" / f"ferris_ex{number}.json").read_text("utf-8"))
    assert_published(model_from_json(data), *FILES[number])
