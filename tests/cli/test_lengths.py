"""Sizes of walls on the command line."""

import pytest

from drystone.cli.numbers import parse_wall
from drystone.errors import UsageError


@pytest.mark.parametrize(
    ("text", "px_per_m", "size"),
    [
        ("560x160", None, (560.0, 160.0)),
        ("560X160.5", 200.0, (560.0, 160.5)),
        ("560pxx160px", None, (560.0, 160.0)),
        (" 560 x 160 ", None, (560.0, 160.0)),
        ("1.4mx0.4m", 200.0, (280.0, 80.0)),
        ("140cmx40cm", 200.0, (280.0, 80.0)),
        ("1400mmx.4m", 200.0, (280.0, 80.0)),
        ("5pxx3.5px", None, (5.0, 3.5)),
        ("8x8", 200.0, (8.0, 8.0)),
        ("140x40cm", 200.0, (280.0, 80.0)),
        ("140 x 40 cm", 200.0, (280.0, 80.0)),
        ("1,4mx0,4m", 200.0, (280.0, 80.0)),
        ("1,4mx0,400m", 200.0, (280.0, 80.0)),
        ("1,4 \N{MULTIPLICATION SIGN} ,4 m", 200.0, (280.0, 80.0)),
        ("560x160px", None, (560.0, 160.0)),
        ("4ftx1ft", 100.0, (121.92, 30.48)),
        ("48 x 12 in", 100.0, (121.92, 30.48)),
    ],
)
def test_sizes(text, px_per_m, size):
    assert parse_wall(text, px_per_m) == pytest.approx(size, abs=1e-9)


@pytest.mark.parametrize(
    "text", ["5", "x5", "5x", "5x5x5", "ax5", "-5x5", "5kmx5km", "1e3x5", "infxinf", "0x10", "10x0"]
)
def test_what_is_no_size(text):
    with pytest.raises(UsageError) as caught:
        parse_wall(text, 100.0)
    assert caught.value.code == "E127"
    assert caught.value.where == "--wall"


@pytest.mark.parametrize("text", ["1,400mmx400mm", "1400x1,234mm"])
def test_a_comma_that_may_be_of_thousands_is_asked_about(text):
    with pytest.raises(UsageError, match=r"may be 1(400|234), or 1\.") as caught:
        parse_wall(text, 200.0)
    assert caught.value.code == "E127"


@pytest.mark.parametrize("px_per_m", [None, 200.0])
@pytest.mark.parametrize(("text", "cure"), [("1.4x0.4", "1.4mx0.4m"), ("12x2", "12mx2m")])
def test_metres_without_their_unit_are_asked_about(text, cure, px_per_m):
    with pytest.raises(UsageError, match="has no unit") as caught:
        parse_wall(text, px_per_m)
    assert caught.value.code == "E127"
    assert cure in caught.value.cure


@pytest.mark.parametrize("text", ["1.4mx0.4", "280cmx80", "280pxx400mm"])
def test_px_beside_metres_are_refused(text):
    with pytest.raises(UsageError, match="px one way") as caught:
        parse_wall(text, 200.0)
    assert caught.value.code == "E127"


@pytest.mark.parametrize("text", ["1.4mx0.4m", "280mmx40cm"])
def test_metres_need_a_scale(text):
    with pytest.raises(UsageError) as caught:
        parse_wall(text, None)
    assert caught.value.code == "E131"
    assert "--px-per-m" in caught.value.cure
