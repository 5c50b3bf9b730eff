import base64
import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

from drystone.errors import Notice
from drystone.model.plan import PlanMetrics
from drystone.plotting import wall_outlines, write_pictures
from drystone.plotting.palette import cluster_colour
from drystone.report import write_report
from drystone.report.content import (
    assumptions,
    cards,
    flat_settings,
    number,
    rows,
    weaker_direction,
)
from drystone.report.player import drawing
from tests.plotting import examples
from tests.verify.exact_examples import exact_example

ALPHA = "\N{GREEK SMALL LETTER ALPHA}"
TIMES = "\N{MULTIPLICATION SIGN}"
VOID = {"meta", "link", "img", "input", "rect", "line", "polygon"}


class Page(HTMLParser):
    """Collects elements and text, and checks that elements close in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.elements, self.texts = [], [], []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("style", "script"):
            self.texts.append(data.strip())

    def all(self, tag):
        return [attrs for name, attrs in self.elements if name == tag]

    @property
    def text(self):
        return " ".join(text for text in self.texts if text)


@pytest.fixture
def pictures(tmp_path):
    folder = tmp_path / "pictures"
    folder.mkdir()
    write_pictures(
        folder, examples.wall(), examples.CLUSTERS, resistance=examples.resistance(), dpi=40
    )
    return folder


@pytest.fixture
def report(tmp_path, pictures):
    path = write_report(
        tmp_path / "report.html",
        plan=examples.plan(),
        pictures=pictures,
        notices=[Notice("W112", "3 specks in <i>PR</i> were left out.", "Nothing to do.")],
        timings={"planning": 3.456},
        outlines=wall_outlines(examples.wall()),
    )
    return path.read_text(encoding="utf-8")


def test_every_stone_and_step_is_in_the_table(report):
    page = Page(report)
    steps = examples.plan().steps
    assert [a["id"] for a in page.all("tr") if "id" in a] == [f"step-{s.step}" for s in steps]
    for stone in (*examples.CLUSTERS, examples.UNUSED):
        assert re.search(rf"\b{stone}\b", page.text)
    assert f"wedge {examples.WEDGE} under stone 300, 3.0 wide, 2.0 high" in page.text
    assert "Stones left over: 40" in page.text


def test_results_inputs_and_notices_are_said(report):
    text = Page(report).text
    for said in (
        "5 of 6 stones placed with 1 wedge",
        "no acceptable place was found five times in a row",
        "0.672",
        "4.25 %",
        "Load multiplier (adequacy factor) to the left",
        f"44.0 {TIMES} 20.0 px",
        "0" * 64,
        "W112",
        "3.46 s",
        "upper bound",
        "placement.rule",
        "1 (6.0 px²)",
    ):
        assert said in text


def test_what_stones_are_is_said(report):
    text = Page(report).text
    assert "Stones are their pixels at the working resolution" in text
    assert "Stones touch where their pixels have edges or corners in common" in text
    assert "contact tolerance" not in text


def test_a_plan_on_outlines_says_so(tmp_path):
    made = exact_example()
    metrics = replace(made.plan.metrics, F_LR=0.71, F_LR_half=0.512, F_LR_double=None)
    plan = replace(made.plan, metrics=metrics)
    pictures = tmp_path / "none"
    outlines = wall_outlines(made.wall)
    path = write_report(tmp_path / "one.html", plan=plan, pictures=pictures, outlines=outlines)
    page = Page(path.read_text(encoding="utf-8"))
    assert "Stones are their outlines" in page.text
    assert "within the contact tolerance, 0.1 px of the image" in page.text
    assert "0.512 and not defined at half and twice the contact tolerance." in page.text
    assert "pixels have edges" not in page.text
    # Drawn a thousand wide: the wall is 84 px wide and 30 px high.
    drawn = [a["points"] for a in page.all("polygon")]
    for (_, corners), points in zip(made.wall.outlines.blocks, drawn, strict=True):
        found = np.array([point.split(",") for point in points.split()], float)
        expected = (corners * (1, -1) + (0, 30)) * 1000 / 84
        np.testing.assert_allclose(found, expected, atol=0.06)
    settle = {**plan.settings["settle"], "contact_px": 0.25}
    other = replace(plan, settings={**plan.settings, "settle": settle})
    assert "0.25 px of the image" in assumptions(other)[-1]
    without = {name: value for name, value in plan.settings.items() if name != "settle"}
    assert "0.1 px of the image" in assumptions(replace(plan, settings=without))[-1]


def test_names_are_escaped(report):
    assert "<b>" not in report
    assert "<script>alert" not in report
    assert "<i>" not in report
    text = Page(report).text
    assert "<b>PR.png" in text
    assert "<script>alert(1)</script>" in text
    assert "<i>PR</i>" in text


def test_the_file_needs_nothing_else(report, pictures):
    page = Page(report)
    images = page.all("img")
    sources = [attrs["src"] for attrs in images]
    embedded = [base64.b64decode(s.removeprefix("data:image/png;base64,")) for s in sources]
    names = ("picture.png", "mechanism_left.png")
    assert embedded == [(pictures / name).read_bytes() for name in names]
    assert all(attrs["alt"] for attrs in images)
    assert not re.search(r"https?:|url\(|@import", re.sub(r'src="[^"]*"', "", report))
    assert all("src" not in attrs for attrs in page.all("script"))
    assert [a["href"] for a in page.all("link")] == ["data:,"]
    assert "no picture of a mechanism to the right" in page.text


def test_missing_metrics_are_not_defined_and_never_zero(tmp_path):
    missing = PlanMetrics(0.4, None, None, None, 0.1, 0.1, None, 0.3, 0.0)
    plan = examples.plan(metrics=missing)
    values = {card.symbol or card.name: card.value for card in cards(plan)}
    for name in ("F_AV", "F_AH", "F_LR", f"{ALPHA} left", "Weaker direction"):
        assert values[name] == "not defined"
    assert values[f"{ALPHA} right"] == "0.300"
    path = write_report(tmp_path / "report.html", plan=plan, pictures=tmp_path)
    page = Page(path.read_text(encoding="utf-8"))
    assert page.texts.count("not defined") == 5
    assert "no picture of the wall" in page.text
    assert not page.all("svg")


def test_same_arguments_same_bytes(tmp_path, pictures):
    plan, outlines = examples.plan(), wall_outlines(examples.wall())
    first, second = (
        write_report(tmp_path / name, plan=plan, pictures=pictures, outlines=outlines).read_bytes()
        for name in ("one.html", "two.html")
    )
    assert first == second


def test_steps_are_drawn_in_the_colours_of_their_clusters(report):
    page = Page(report)
    steps = examples.plan().steps
    groups = [a for a in page.all("g") if a["class"] == "shape"]
    assert [int(a["data-step"]) for a in groups] == [step.step for step in steps]
    fills = [a["fill"] for a in page.all("polygon")]
    expected = [cluster_colour(step.cluster) for step in examples.plan().stone_steps]
    assert fills[:-1] == expected
    assert "place stone 300" in groups[-2]["data-says"]
    assert "Load multipliers" not in groups[-2]["data-says"]
    assert "left 0.410, right 0.390" in groups[-1]["data-says"]
    (slider,) = page.all("input")
    assert slider["max"] == str(len(steps))


@pytest.mark.parametrize("px_per_m", [None, 50.0])
def test_drawing_is_a_thousand_wide_with_y_down(px_per_m):
    wall = examples.wall(px_per_m)
    plan = examples.plan(wall)
    units = wall.site.units_per_px
    square = np.array([[0, 0], [11, 0], [11, 22], [0, 22]]) * units
    drawn = drawing(plan, dict.fromkeys(examples.CLUSTERS, square))
    assert drawn.height == pytest.approx(1000 * 20 / 44, abs=0.05)
    first, wedge = drawn.shapes[0], drawn.shapes[-1]
    assert first.points == "0.0,454.5 250.0,454.5 250.0,-45.5 0.0,-45.5"
    # Centroid of stone 3: 7 px from the left, 4 px up.
    assert (first.x, first.y) == pytest.approx((1000 * 7 / 44, 1000 * 16 / 44), abs=0.06)
    # No outline was given for the wedge: the polygon of its step.
    assert wedge.kind == "wedge"
    assert wedge.points.split()[0] == "454.5,318.2"


def test_a_stone_without_outline_is_named():
    with pytest.raises(ValueError, match=r"no outline for the placed stones \[3, 5, 8, 12, 300\]"):
        drawing(examples.plan(), {})


def test_lengths_in_metres_have_millimetres():
    plan = examples.plan(examples.wall(px_per_m=50.0))
    first = next(iter(rows(plan)))
    assert first.cells[1:3] == ("0.140", "0.080")


def test_a_missing_index_is_not_defined():
    plan = examples.plan()
    step = replace(plan.stone_steps[0], indices={"SF": 0.9, "LLC": 0.5})
    (row,) = rows(replace(plan, steps=(step,)))
    assert row.cells[5:] == ("0.900", *["not defined"] * 5, "0.500")


@pytest.mark.parametrize(
    ("value", "text"),
    [(None, "not defined"), (float("nan"), "not defined"), (0.0, "0.000"), (-1e-9, "0.000")],
)
def test_numbers(value, text):
    assert number(value) == text


@pytest.mark.parametrize(
    ("left", "right", "weaker"),
    [(0.3, 0.4, "left"), (0.4, 0.3, "right"), (0.3, 0.3, "both alike"), (None, 0.3, "not defined")],
)
def test_weaker_direction(left, right, weaker):
    metrics = replace(examples.plan().metrics, alpha_left=left, alpha_right=right)
    assert weaker_direction(metrics) == weaker


def test_settings_are_flat_and_complete():
    settings = {"mu": 0.58, "a": {"b": {"c": [1, None]}, "d": True}}
    flat = dict(flat_settings(settings))
    assert {name: json.loads(value) for name, value in flat.items()} == {
        "mu": 0.58,
        "a.b.c": [1, None],
        "a.d": True,
    }
