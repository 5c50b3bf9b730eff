"""The report and the viewer as HTML; the Python of docs/viewer.md runs."""

import base64
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

import drystone as ds
from drystone.contacts.blocks import model_from_labels
from drystone.drawing import view_of_result, write_pictures, write_report
from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.report.html import Shown, viewer_page, viewer_script, viewer_style
from drystone.drawing.words.content import INDICES, assumptions, cards, number
from drystone.errors import InputError, Notice
from drystone.generate import BrickSettings, brick_stones, lay_out
from drystone.indices import INDEX_NAMES
from drystone.io.wall_image import write_labels
from drystone.model.plan import PlanMetrics
from drystone.statics.limit import lateral_resistance
from tests.drawing import examples
from tests.drawing.plans import analysed, planned
from tests.pages import printed
from tests.verify.exact_examples import exact_example

ALPHA = "\N{GREEK SMALL LETTER ALPHA}"
TIMES = "\N{MULTIPLICATION SIGN}"
VOID = {"meta", "link", "img", "input", "rect", "line", "polygon"}


class Page(HTMLParser):
    """Collects elements and text, and checks that elements close in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.elements, self.texts, self.scripts = [], [], [], []
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
        if self.open and self.open[-1] == "script":
            self.scripts.append(data)
        elif self.open and self.open[-1] != "style":
            self.texts.append(data.strip())

    def all(self, tag):
        return [attrs for name, attrs in self.elements if name == tag]

    @property
    def text(self):
        return " ".join(text for text in self.texts if text)

    @property
    def data(self):
        return json.loads(self.scripts[0])


def written_page(folder, view):
    """Return a report that was written to a folder without pictures."""
    return Page(write_report(folder / "report.html", view, pictures=folder).read_text("utf-8"))


def example_view(plan=None, wall=None):
    """Return the view of the wall made by hand, or of another one, with a plan that says more."""
    wall = wall or examples.wall()
    model = model_from_labels(wall.labels).model
    found = SimpleNamespace(
        plan=plan or examples.plan(),
        wall=wall,
        model=model,
        resistance=lateral_resistance(model, mechanism=True),
        seconds=3.456,
        notices=(Notice("W112", "3 specks in <i>PR</i> were left out.", "Nothing to do."),),
    )
    return view_of_result(found)


def test_the_report_says_every_step_result_input_and_notice_and_needs_no_other_file(tmp_path):
    write_pictures(tmp_path, examples.wall(), examples.CLUSTERS, resistance=examples.resistance())
    path = write_report(tmp_path / "report.html", example_view(), pictures=tmp_path)
    report = path.read_text("utf-8")
    page, steps = Page(report), examples.plan().steps
    assert [a["id"] for a in page.all("tr") if "id" in a] == [f"step-{s.step}" for s in steps]
    for stone in (*examples.CLUSTERS, examples.UNUSED):
        assert re.search(rf"\b{stone}\b", page.text)
    for said in (
        f"Push wedge {examples.WEDGE} in under the right end of stone 7 (step 3): 8 {TIMES} 4 px",
        "Stones left over: 9", "5 of 6 stones, ", "0.672", "4.25 %", f"84.0 {TIMES} 30.0 px",
        "no acceptable place was found five times in a row", "0" * 64, "W112", "3.46 s",
        "Load multiplier (adequacy factor) to the left", "upper bound", "placement.rule",
        "in three walls of masons, of other stones", "1 (32.0 px²)", "Geometry raster",
        "Stones touch where their pixels have edges or corners in common",
    ):  # fmt: skip
        assert said in page.text
    assert "contact tolerance" not in page.text
    # Names are escaped.
    for markup in ("<b>", "<script>alert", "<i>"):
        assert markup not in report
    for said in ("<b>PR.png", "<script>alert(1)</script>", "<i>PR</i>"):
        assert said in page.text
    assert page.data["title"] == "Dry-stone wall from <b>PR.png"
    images = page.all("img")
    for attrs, name in zip(images, ("picture.png", "mechanism_left.png"), strict=True):
        embedded = base64.b64decode(attrs["src"].removeprefix("data:image/png;base64,"))
        assert embedded == (tmp_path / name).read_bytes()
        assert attrs["alt"]
    rest = re.sub(r'src="[^"]*"', "", report).replace("http://www.w3.org/2000/svg", "")
    assert not re.search(r"https?:|url\((?!#)|@import", rest)
    assert all("src" not in attrs for attrs in page.all("script"))
    assert [a["href"] for a in page.all("link")] == ["data:,"]
    (policy,) = (a["content"] for a in page.all("meta") if "http-equiv" in a)
    assert policy.startswith("default-src 'none'; ")
    assert "no picture of a mechanism to the right" in page.text
    # Script and style cannot end their elements, and no markup is made of data.
    assert not re.search(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write", viewer_script())
    assert "</script" not in viewer_script()
    assert "</style" not in viewer_style()


def test_a_plan_on_outlines_says_so(tmp_path):
    made = exact_example()
    plan = made.plan
    page = written_page(tmp_path, example_view(plan, made.wall))
    assert "Geometry exact" in page.text
    assert "within the contact tolerance, 0.1 px of the image" in page.text
    assert "pixels have edges" not in page.text
    for (block, corners), part in zip(made.wall.outlines.blocks, page.data["parts"], strict=True):
        assert part["id"] == block
        np.testing.assert_allclose(part["points"][0], corners, atol=0.0006)
    for settle, reach in (({"contact_px": 0.25}, 0.25), ({}, 0.1)):
        other = replace(plan, settings={**plan.settings, "settle": settle})
        assert f"{reach} px of the image" in assumptions(other)[-1]


def test_missing_metrics_are_not_defined_a_missing_index_a_dash_and_metres_centimetres(tmp_path):
    missing = PlanMetrics(0.4, None, None, None, 0.1, 0.1, None, 0.3, 0.0)
    wall = examples.wall(px_per_m=50.0)
    plan = examples.plan(50.0, missing)
    values = {card.symbol or card.name: card.value for card in cards(plan)}
    for name in ("F_AV", "F_AH", "F_LR", f"{ALPHA} left"):
        assert values[name] == "not defined"
    assert values[f"{ALPHA} right"] == "0.300"
    assert [number(value) for value in (float("nan"), -1e-9)] == ["not defined", "0.000"]
    step = replace(plan.stone_steps[0], indices={**plan.stone_steps[0].indices, "LLC": None})
    # Bytes of a file name that are no UTF-8 end no report.
    notice = {"code": "W117", "message": "left aside: \udcdcbersicht.", "cure": ""}
    view = example_view(replace(plan, steps=(step, *plan.steps[1:])), wall) | {"notices": [notice]}
    text = write_report(tmp_path / "report.html", view, pictures=tmp_path).read_text("utf-8")
    assert "?bersicht" in text
    assert "?bersicht" in Shown(view).write(tmp_path / "view.html").read_text("utf-8")
    page = Page(text)
    assert page.texts.count("not defined") == 4
    assert "no picture of the wall" in page.text
    cells = re.findall(r"<td>(.*?)</td>", text.split('id="step-1"')[1].split("</tr>")[0])
    assert set(INDICES) == set(INDEX_NAMES)
    told = ["\N{EN DASH}" if i == "LLC" else number(step.indices[i]) for i in INDICES]
    assert cells[-2 - len(told) : -2] == told
    assert "<td>20.0</td><td>20.0</td>" in text


def test_a_wall_that_was_not_planned_has_a_table_of_blocks(tmp_path, monkeypatch):
    page = written_page(tmp_path, analysed(examples.wall().labels, title="found"))
    assert "Steps of construction" not in page.text
    assert "6 stones, " in page.text
    assert page.text.count("There is no picture of a mechanism") == 2
    # The program of the documents.
    monkeypatch.chdir(tmp_path)
    bricks = BrickSettings(count=3, height_px=10, aspect=2)
    write_labels(lay_out(brick_stones(bricks, np.random.default_rng(1))), Path("wall.png"))
    exec(printed("viewer.md", "python")[1], {})  # noqa: S102 - our own page
    assert "Wall in the garden" in Path("report.html").read_text("utf-8")


def test_the_viewer_alone_is_a_page_or_a_frame():
    shown = view_of_result(planned("paper"))
    page = Page(viewer_page(shown, {"chart": False}))
    assert page.data == json.loads(json.dumps(shown))
    (frame,) = Page(Shown(shown)._repr_html_()).all("iframe")
    assert frame["srcdoc"] == viewer_page(shown)
    frame = planned("paper")._repr_html_()
    assert frame.startswith('<iframe title="Dry-stone wall from ')
    assert "\n" not in frame
    assert ds.view(planned("paper"))._repr_html_() == frame


def test_viewer_and_sheet_refuse_a_photograph_alike(tmp_path):
    ds.write_plan_folder(planned(), tmp_path)
    path, source, unreadable = tmp_path / "photo.jpg", planned().plan.source, "cannot be read"
    for zoom, until, said in (
        (2, None, "something else"),
        (1, 10, unreadable),
        (1, -200, unreadable),
    ):
        Image.new("RGB", (zoom * source["width_px"], source["height_px"])).save(path)
        path.write_bytes(path.read_bytes()[:until])
        with pytest.raises(InputError, match=f"E189 .*{said}") as viewed:
            ds.view(tmp_path)
        with pytest.raises(InputError, match=f"E189 .*{said}") as printed:
            FORMATS["pdf"].files(ds.read_assembly(tmp_path), ExportSettings())
        assert str(viewed.value) == str(printed.value)
