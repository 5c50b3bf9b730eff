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


NO_SIZE = ["5", "x5", "5x", "5x5x5", "ax5", "-5x5", "5kmx5km", "1e3x5", "infxinf", "0x10", "10x0"]


@pytest.mark.parametrize(("text", "px_per_m", "said"), [
    *((text, 100.0, "E127 --wall: .*wall") for text in NO_SIZE),
    # A comma that may be of thousands.
    ("1,400mmx400mm", 200.0, r"E127 --wall: .* may be 1400, or 1\."),
    ("1400x1,234mm", 200.0, r"E127 --wall: .* may be 1234, or 1\."),
    # Metres without their unit, and px beside them.
    ("1.4x0.4", None, "E127 --wall: .* has no unit.* 1.4mx0.4m"),
    ("12x2", 200.0, "E127 --wall: .* has no unit.* 12mx2m"),
    ("1.4mx0.4", 200.0, "E127 --wall: .* px one way"),
    ("280cmx80", 200.0, "E127 --wall: .* px one way"),
    ("280pxx400mm", 200.0, "E127 --wall: .* px one way"),
    ("1.4mx0.4m", None, "E131 --wall: .*--px-per-m"),
    ("280mmx40cm", None, "E131 --wall: .*--px-per-m"),
])  # fmt: skip
def test_what_is_no_size(text, px_per_m, said):
    with pytest.raises(UsageError, match=said):
        parse_wall(text, px_per_m)
