"""build-sheet.pdf, read back with PDFium: words, pages, and lengths measured on them."""

from dataclasses import replace

import numpy as np
import pypdfium2
import pytest

from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.sheet import pages
from drystone.drawing.sheet.words import (
    beside,
    beside_words,
    left_foot,
    length_words,
    size_words,
    turn_words,
    wedge_words,
)
from drystone.io.plan_json import plan_digest
from drystone.statics.model import GROUND, Interface, RigidBlockModel
from tests.drawing.export.drawn_walls import assembly, photo_colour, photograph, runs

DPI = 150
PX_PER_MM = DPI / 25.4


def texts(path):
    with pypdfium2.PdfDocument(path) as document:
        return [page.get_textpage().get_text_range() for page in document]


def rendered(path, page, dpi=DPI):
    with pypdfium2.PdfDocument(path) as document:
        return np.asarray(document[page].render(scale=dpi / 72).to_pil().convert("RGB"), np.int16)


def test_a_sheet_is_to_scale_says_what_to_do_and_shows_the_photograph(tmp_path):
    """Twelve stones and a wedge, 1.2 m x .45 m."""
    made = assembly(columns=4, rows=3)
    wall = replace(made, photo=photograph(made, tmp_path / "photo.png"))
    settings = ExportSettings(title="Wall $4, $5", paper_scale=10.0)
    (path,) = FORMATS["pdf"].write(wall, tmp_path, settings)
    with pypdfium2.PdfDocument(path) as document:
        sizes = [tuple(side * 25.4 / 72 for side in page.get_size()) for page in document]
    # Two pages of 6 lines, and one with the fetch list and the wedge.
    assert np.array(sizes) == pytest.approx(np.array([(297, 210), *[(210, 297)] * 3]), abs=0.1)
    # The fill of the stones, which reach the frame, is as wide as the wall.
    first_page = rendered(path, 0)
    rows, columns = np.nonzero(np.abs(first_page - np.array([0xCF, 0xC8, 0xBB])).max(axis=2) <= 3)
    assert (np.ptp(columns) + 1) / PX_PER_MM == pytest.approx(wall.size[0] * 1000 / 10, abs=0.5)
    assert (np.ptp(rows) + 1) / PX_PER_MM == pytest.approx(wall.size[1] * 1000 / 10, abs=0.5)
    dark = (first_page.max(axis=2) < 140)[:, : first_page.shape[1] // 2]
    # Not the lines of the title block and the ground, which are longer.
    lengths = {int(run) for row in dark for run in runs(row)}
    assert any(abs(length / PX_PER_MM - 100.0) < 0.5 for length in lengths)

    # Title block, lines and fetch list.
    first, *lines, last = texts(path)
    for said in ("Wall $4, $5", "stones.png", "1.20 \N{MULTIPLICATION SIGN} 0.45 m", "1:10",
                 "drystone 0.1.0", plan_digest(wall.plan), "12, and 2 left over",
                 "page 1 of 4"):  # fmt: skip
        assert said in first
    words = " ".join("\n".join(lines).split())
    for said in (*(f"stone {part.id}" for part in wall.stones), "turn left 97°", "turn right 45°",
                 "half turn", "as it lies", "wedge 2: 150 \N{MULTIPLICATION SIGN} 30 mm,",
                 "on the ground, right of 1"):  # fmt: skip
        assert said in words
    # Centroid of the third stone: in the middle of a bevelled brick of 30 cm x 15 cm.
    assert "\N{RIGHTWARDS ARROW} 75.0 \N{UPWARDS ARROW} 7.5 cm" in words
    assert {str(part.step) for part in wall.stones} <= {*words.split()}
    # They lie in rows of four from the top left, in the order of their steps.
    assert [part.step for part in pages.in_photo_order(wall)] == [1, *range(3, 14)]
    rows = [line.split() for line in last.splitlines()]
    listed = [line[0] for line in rows if len(line) == 8 and line[-1] == "cm"]
    assert listed == [str(step) for step in (1, *range(3, 14))]
    assert "901, 902" in last
    assert "Wedges to cut" in last

    # Every line shows the photograph of its stone.
    image = rendered(path, 1, 100)
    column = image[:, round(31 / 25.4 * 100) : round(61 / 25.4 * 100)]
    for place, part in enumerate(list(wall.stones)[:6]):
        seen = np.abs(column - np.array(photo_colour(part.step))).max(axis=2) <= 6
        rows, _ = np.nonzero(seen)
        assert rows.size > 800, part.name
        middle = (12 + 19 + 34 * (place + 0.5)) / 25.4 * 100
        assert abs(np.median(rows) - middle) < 6


@pytest.mark.parametrize(("columns", "wished", "drawn"), [
    (4, 10.0, 10.0), (4, 5.0, 5.0), (9, 10.0, 20.0), (10, 8.0, 20.0), (20, 10.0, 25.0),
    (30, 10.0, 50.0), (4, 33.0, 33.0), (4, None, 5.0), (1, None, 2.0), (20, None, 25.0),
])  # fmt: skip
def test_the_next_usual_scale_is_taken_where_the_wall_does_not_fit(columns, wished, drawn):
    wall = assembly(columns=columns, rows=1)
    scale = pages.paper_scale(wall, wished)
    assert scale.denominator == drawn
    assert scale.mm_per_unit == pytest.approx(1000.0 / drawn)
    assert wall.size[0] * scale.mm_per_unit <= pages.DRAWING_MM[0]


def test_without_a_scale_nothing_is_to_scale(tmp_path):
    wall = assembly(px_per_m=None)
    (path,) = FORMATS["pdf"].write(wall, tmp_path, ExportSettings())
    words = texts(path)
    assert "NOT TO SCALE" in words[0]
    assert "180 px" in words[0]
    assert "1:10" not in words[0]
    assert "NOT TO SCALE" in words[-1]
    assert not any(" cm" in page or " mm," in page for page in words[1:])


@pytest.mark.parametrize("px_per_m", [200.0, None])
def test_no_words_of_the_first_page_lie_over_others_or_the_wall(px_per_m):
    # As high as its frame may be, with a title that is much too long.
    wall = assembly(columns=6, rows=5, px_per_m=px_per_m)
    width, height = wall.size
    scale = pages.Scale(None, min(pages.DRAWING_MM[0] / width, pages.DRAWING_MM[1] / height))
    settings = ExportSettings(title=300 * "W", paper_scale=1000.0 / scale.mm_per_unit)
    page = pages.BuildSheet(wall, settings, None).pages()[0]
    frame = next(patch for patch in page.ax.patches if patch.get_gid() == "frame")
    inside, paper = frame.get_window_extent(), page.ax.get_window_extent()
    # Numbers of steps alone have a halo, and stand in the frame.
    words = [text for text in page.ax.texts if text.get_text() and not text.get_path_effects()]
    boxes = [text.get_window_extent() for text in words]
    assert len(words) > 20
    for text, box in zip(words, boxes, strict=True):
        assert paper.x0 < box.x0 < box.x1 < paper.x1, text.get_text()
        assert not box.overlaps(inside), text.get_text()
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


@pytest.mark.parametrize(("angle_deg", "words"), [
    (0.0, "as it lies"), (-2.4, "as it lies"), (362.0, "as it lies"), (3.0, "turn left 3°"),
    (97.4, "turn left 97°"), (-97.4, "turn right 97°"), (262.6, "turn right 97°"),
    (91.0, "quarter turn left"), (-88.0, "quarter turn right"), (177.0, "turn left 177°"),
    (180.0, "half turn"), (-178.0, "half turn"),
    (-540.0, "half turn"),
])  # fmt: skip
def test_turns_are_the_short_way_round(angle_deg, words):
    assert turn_words(angle_deg) == words


def test_neighbours_are_those_that_stand_already():
    # Steps 1 (wedge: 2), 3, 4 on the ground, then 5, 6, 7 upon them.
    small = assembly()
    assert beside(small, small.parts[0]) == {"on": [GROUND]}
    assert beside(small, small.parts[6]) == {"on": [4], "right of": [6]}
    for step, words in (
        (1, "on the ground"),
        (2, "on the ground, under 1"),
        (5, "on 1"),
        (6, "on 3, right of 5"),
        # The wedge touches it too, and nobody sets a stone by a wedge beside it.
        (3, "on the ground, right of 1"),
    ):
        assert beside_words(small, small.parts[step - 1]) == words
    # It does not matter which part of a pair an interface names first.
    faces = []
    for face in small.model.interfaces:
        x, y = face.normal
        turned = replace(face, block=face.other, other=face.block, normal=(-x, -y))
        faces.append(face if face.other == GROUND else turned)
    other = replace(small, model=RigidBlockModel(small.model.blocks, tuple(faces)))
    assert [beside(other, part) for part in small.parts] == [
        beside(small, part) for part in small.parts
    ]
    # Stones side by side that meet at a corner are not upon each other.
    left, right, _, above = small.parts[2:6]

    def meeting(part, other, at, normal):
        face = Interface(part.id, other.id, np.array([at]), normal)
        return replace(small, model=RigidBlockModel(small.model.blocks, (face,)))

    for pair, x, y in (((right, left), 0.8, 0.6), ((left, right), -0.8, -0.6)):
        corner = meeting(*pair, (0.6, 0.15), (x, y))
        assert beside(corner, right) == {"right of": [left.step]}
    # A stone that a contact of the same slope carries over its width is on it.
    assert beside(meeting(above, left, (0.4, 0.15), (0.8, 0.6)), above) == {"on": [left.step]}


def test_sizes_and_places_have_units():
    small, px = assembly(), assembly(px_per_m=None)
    wedge = small.parts[1]
    assert wedge_words(small, wedge).endswith(" 30 mm, under its right end")
    assert length_words(small, 0.1234, 2.0) == "12.3, 200.0 cm"
    assert length_words(px, 12.3) == "12 px"
    assert size_words(px, px.parts[1]) == "30 \N{MULTIPLICATION SIGN} 6 px"
    # The left end of what is as low.
    assert left_foot(small.parts[2]) == pytest.approx((0.3, 0.0))
    assert pages.drawn_factor(small, wedge) == 1 / 5  # 150 mm x 30 mm in 44 mm x 25 mm
    fine = assembly(px_per_m=3000.0)
    assert pages.drawn_factor(fine, next(fine.wedges)) == 1.0  # 10 mm x 2 mm
