"""Sizes of walls, rulers, and how large a px is: options, and what the stones say themselves."""

import pickle
from argparse import ArgumentTypeError

import pytest

from drystone.cli.numbers import (
    area,
    parse_wall,
    picture_size_px,
    refuse_outside,
    ruler,
    scale_notice,
    scale_with,
)
from drystone.errors import UsageError
from drystone.model.stone import Source


def test_sizes_are_px_or_lengths():
    for text, px_per_m, size in (
        ("560X160.5", None, (560.0, 160.5)),
        ("1400mmx.4m", 200.0, (280.0, 80.0)),
        ("5pxx3.5px", None, (5.0, 3.5)),
        ("8x8", 200.0, (8.0, 8.0)),
        (" 140 x 40 cm", 200.0, (280.0, 80.0)),
        ("1,4mx0,400m", 200.0, (280.0, 80.0)),
        ("1,4 \N{MULTIPLICATION SIGN} ,4 m", 200.0, (280.0, 80.0)),
        ("4ftx1ft", 100.0, (121.92, 30.48)),
        ("48 x 12 in", 100.0, (121.92, 30.48)),
    ):
        assert parse_wall(text, px_per_m) == pytest.approx(size, abs=1e-9)


NO_SIZE = ["5", "x5", "5x", "5x5x5", "ax5", "-5x5", "5kmx5km", "1e3x5", "infxinf", "0x10", "10x0"]


@pytest.mark.parametrize(("text", "px_per_m", "said"), [
    *((text, 100.0, ".*wall") for text in NO_SIZE),
    # A comma that may be of thousands.
    ("1,400mmx400mm", 200.0, r".* may be 1400, or 1\."),
    ("1400x1,234mm", 200.0, r".* may be 1234, or 1\."),
    # Metres without their unit, and px beside them.
    ("1.4x0.4", None, ".* has no unit.* 1.4mx0.4m"),
    ("12x2", 200.0, ".* has no unit.* 12mx2m"),
    ("1.4mx0.4", 200.0, ".* px one way"),
    ("280pxx400mm", 200.0, ".* px one way"),
    ("1.4mx0.4m", None, ".*--px-per-m"),
])  # fmt: skip
def test_what_is_no_size(text, px_per_m, said):
    with pytest.raises(UsageError, match=f"{'E131' if '--px' in said else 'E127'} --wall: {said}"):
        parse_wall(text, px_per_m)


def test_areas_are_px_or_lengths_squared():
    square_cm = [*map(area, ("12cm2", "12 cm\N{SUPERSCRIPT TWO}", "1200mm2", "0.0012m2"))]
    assert square_cm == [(pytest.approx(12.0), "cm2")] * 4
    assert area("2in2") == (pytest.approx(12.9032), "cm2")
    assert area(".5ft2") == (pytest.approx(464.5152), "cm2")
    assert [area("300"), area("300 px")] == [(300.0, "px")] * 2
    for text in ("", "2in", "0cm2", "-1cm2", "1,200mm2", "2in3", "2px2"):
        with pytest.raises(ArgumentTypeError, match="such as 12cm2, 2in2 or 300"):
            area(text)


def test_a_ruler_is_a_length_between_two_points_and_keeps_them():
    text = "20,30,220,30=1.0m"
    for given, px_per_m in ((text, 200), ("0,0,300,400=250cm", 200), ("-1,0, 4,12=26mm", 500)):
        assert ruler(given) == pytest.approx(px_per_m)
    for given in ("", "1,2,3=1m", "1,2,3,4=1", "1,2,1,2=1m", "1,2,3,4=0m"):
        with pytest.raises(ArgumentTypeError):
            ruler(given)
    scale = scale_with(ruler(text), 200.0)
    for one in (scale, pickle.loads(pickle.dumps(scale))):  # noqa: S301 - its own bytes
        assert (one, one.ends_px) == (200.0, ((20.0, 30.0), (220.0, 30.0)))


def test_a_ruler_beyond_the_picture_is_refused():
    for text in ("20,30,2000,30=1m", "0,-1,9,9=1m", "5,61,9,9=1m", "-1,0,9,9=1m"):
        with pytest.raises(UsageError, match=r"E138.* outside the picture, which is 213 x 60 px"):
            refuse_outside(ruler(text), (213, 60))
        refuse_outside(ruler(text), (0, 0))  # how large it is nobody knows
    for scale in (ruler("0,0,213,60=1m"), 2000.0, None):  # from corner to corner
        refuse_outside(scale, (213, 60))
    for name, files, known in (
        ("stones.png", (), (213, 60)),
        ("stones.json", (), (0, 0)),  # how far the stones reach, and a ruler lies beside them
        ("masks.png", ("1.png",), (0, 0)),  # a folder, whatever it is called
    ):
        source = {"files": files, "width_px": 213, "height_px": 60}
        assert picture_size_px(Source(name, **source)) == known
        assert picture_size_px({"path": name, **source, "files": list(files)}) == known


def test_either_may_know_the_scale_and_who_says_another_is_named():
    assert scale_with(None, None) is None
    assert scale_with(200.0, None) == scale_with(None, 200.0) == 200.0
    assert scale_with(200.0, 200.3) == 200.0
    with pytest.raises(UsageError) as caught:
        scale_with(ruler("0,0,100,0=.1m"), 200.0, "plan")
    assert str(caught.value) == (
        "E131 --ruler: the plan says 200 px a metre, the option 1000. "
        "Leave the option out, or plan again with another scale."
    )
    with pytest.raises(UsageError, match=r"E131 .*, or correct the scale beside the stones\."):
        scale_with(200.0, 250.0)


def test_a_scale_that_makes_no_building_stones_is_asked_about():
    for px_per_m, said in ((25_000, "1.6 mm"), (10, "4 m"), (4_001, "10 mm"), (19.9, "2.01 m")):
        notice = scale_notice(40.0, px_per_m)
        assert (notice.code, f"is {said} long" in notice.message) == ("W123", True)
    assert all(scale_notice(40.0, usual) is None for usual in (None, 20.0, 200.0, 4_000.0))
