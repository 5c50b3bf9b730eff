import json

import pytest

from benchmarks import table
from drystone.planner.profile import PARTS

WALL = {"elapsed": 2.0, "parts": dict.fromkeys(PARTS, 0.25), "steps": 3, "candidates": 12}


def entry(what, size, grows, seconds, twin=None, count=1, **facts):
    described = {"what": what, "size": size, "grows": grows, "twin": twin, "count": count}
    about = described | {"items": 0.0, "item": ""} | facts
    return {"stats": {"min": seconds, "mean": 9.9}, "extra_info": about}


def session(folder, kernels, *entries):
    path = folder / f"{kernels}.json"
    about = {"kernels": kernels, "numpy": "NumPy 2", "python_version": "3.11",
             "cpu": {"brand_raw": "CPU"}}  # fmt: skip
    path.write_text(json.dumps({"machine_info": about, "benchmarks": entries}), encoding="utf-8")
    return table.read_session(path)


@pytest.fixture
def first(tmp_path):
    memory = {"loaded": 80.0, "resident": 90.0, "traced": 3.25}
    return session(
        tmp_path, "compiled",
        entry("overlap", "10 x 10", 100.0, 0.008, count=8, items=500.0, item="words"),
        entry("overlap", "20 x 20", 400.0, 0.032, count=8),
        entry("overlap", "10 x 10", 100.0, 0.3, twin="loops"),
        entry("overlap", "10 x 10", 100.0, 0.1, twin="convolution"),
        entry("numbers added", table.FLOOR, 0.0, 1e-5, items=1000.0, item="numbers"),
        entry("wall, paper", "100 x 36", 0.0, 1.5, **WALL),
        entry("wall, paper", "100 x 36", 0.0, 30.0, twin="slow planner"),
        entry("peak memory of a plan", "paper", 0.0, 9.0, memory=memory),
    )  # fmt: skip


@pytest.fixture
def numpy(tmp_path):
    return session(
        tmp_path, "NumPy",
        entry("overlap", "10 x 10", 100.0, 0.004, count=1),
        entry("overlap", "20 x 20", 400.0, 0.008, count=1),
        entry("wall, paper", "100 x 36", 0.0, 3.0, **WALL),
    )  # fmt: skip


def test_functions_stand_beside_every_twin_of_their_size(first, numpy):
    rows = table.function_table(first, numpy).rows
    assert rows == (
        ("overlap", "10 x 10", "1 ms", "4 ms", "300 ms", "loops", "300", "4.0"),
        ("overlap", "10 x 10", "1 ms", "4 ms", "100 ms", "convolution", "100", "4.0"),
        ("overlap", "20 x 20", "4 ms", "8 ms", "-", "", "-", "2.0"),
        ("overlap", "exponent", "1.00", "0.50", "-", "", "-", "-"),
    )
    assert [row[3] for row in table.function_table(first, None).rows] == ["-"] * 4


def test_walls_stand_beside_the_slow_planner_and_the_rest_adds_up(first, numpy):
    assert table.wall_table(first, numpy).rows == (
        ("wall, paper", "100 x 36", "1.5 s", "3 s", "30 s", "slow planner", "20", "2.0"),
    )
    rows = table.part_table(first, numpy).rows
    assert [row[1] for row in rows] == ["compiled", "NumPy"]
    assert rows[0][2:4] == (3, 12)
    assert rows[0][4:] == ("250 ms",) * 8 + ("2 s",)
    assert len(table.part_table(first, None).rows) == 1
    assert table.memory_table(first).rows == (("paper", "80.0", "90.0", "3.2"),)


def test_times_have_three_digits_and_are_told_for_each_thing_that_must_be_touched(first, numpy):
    texts = {
        0.0: "0 s", 2.5e-6: "2.5 us", 3.21e-2: "32.1 ms", 98.76: "98.8 s", 1234.5: "1234 s",
        5e-10: "0.5 ns",
    }  # fmt: skip
    assert {seconds: table._time(seconds) for seconds in texts} == texts
    row, floor = table.limit_table(first, numpy).rows
    assert row == ("overlap", "10 x 10", "words", "500", "2 us", "8 us")
    assert floor == ("numbers added", table.FLOOR, "numbers", "1e+03", "10 ns", "-")
    assert table.limit_table(first, None).rows[0][-1] == "-"
