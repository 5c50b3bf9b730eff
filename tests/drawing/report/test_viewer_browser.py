"""The viewer driven in a browser: everything that a reader can do with it."""

import io
import json
import re
import time
from functools import cache

import numpy as np
import pytest
import shapely
from PIL import Image, ImageDraw

from drystone.drawing import view_of_result, write_report
from drystone.drawing.report.html import json_in_html, viewer_page, viewer_script, viewer_style
from tests.drawing.conftest import Heard
from tests.drawing.plans import analysed, planned


@pytest.fixture(scope="module")
def opened_once(browser, tmp_path_factory):
    """Open a page with a plan and a way to show it anew, which is quicker than opening it."""
    path = tmp_path_factory.mktemp("viewer") / "plan.html"
    text = (
        f"<style>{viewer_style()} body {{ margin: 8px }}</style><div id=wall></div>"
        f"<script type=module>{viewer_script()}\nconst data = {json_in_html(shown())};\n"
        "const place = document.getElementById('wall');\n"
        "window.again = (more) => { window.now?.destroy(); "
        "window.now = mount(place, data, {pageKeys: true, ...more}); };</script>"
    )
    path.write_text(f"<!DOCTYPE html><html><meta charset=utf-8>{text}", encoding="utf-8")
    heard, context = Heard(), browser.new_context()
    yield heard.page(context, path), heard
    context.close()


@pytest.fixture
def page(opened_once):
    """Return a page with the plan of `shown`, as it is when it has just been opened."""
    found, heard = opened_once
    found.set_viewport_size({"width": 1280, "height": 720})
    found.emulate_media(reduced_motion="no-preference")
    found.evaluate("document.activeElement.blur(); again(); scrollTo(0, 0)")
    yield found
    heard.check()


def until(condition, seconds=10.0):
    """Wait; the page's policy forbids what Playwright would evaluate for it."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it never came"
        time.sleep(0.02)


@cache
def shown(method="paper"):
    return view_of_result(planned(method))


def seen(page):
    return page.eval_on_selector_all(
        ".ds-part",
        "all => all.filter(g => getComputedStyle(g).display !== 'none').map(g => +g.dataset.id)",
    )


def placed(step, method="paper"):
    return [part["id"] for part in shown(method)["parts"] if part["step"] <= step]


def slider(page):
    return page.get_by_label("Step of construction")


def test_slider_and_buttons_go_through_the_steps(page):
    last, said = shown()["steps"], page.locator(".ds-said")
    assert seen(page) == placed(last)
    card = page.locator(".ds-card").inner_text()
    assert card.startswith("It stands")
    assert shown()["summary"] in card
    slider(page).fill("3")
    assert seen(page) == placed(3)
    words = f"Step 3 of {last}: {shown()['parts'][2]['words']} Load multipliers then: left "
    assert said.inner_text().startswith(words)
    assert page.locator(".ds-counter").inner_text() == f"3 / {last}"
    slider(page).fill("0")
    assert seen(page) == []
    assert said.inner_text() == "Nothing is placed yet."
    # Buttons stop at the ends.
    back, on = "One step back", "One step forward"
    clicks = (
        (back, 0),
        (on, 1),
        ("Last step", last),
        (on, last),
        (back, last - 1),
        ("First step", 0),
    )
    for name, step in clicks:
        page.get_by_role("button", name=name, exact=True).click()
        assert seen(page) == placed(step)


def test_play_goes_on_by_itself_and_stops(page):
    page.evaluate("again({stepMs: 30})")
    play = page.get_by_role("button", name="Play")
    play.click()
    last = shown()["steps"]
    until(lambda: page.locator(".ds-counter").inner_text() == f"{last} / {last}")
    assert play.inner_text() == "Play"
    assert page.locator(".ds-said").get_attribute("aria-live") == "polite"
    slider(page).fill("2")
    page.evaluate("again({stepMs: 100000})")
    play.click()
    assert seen(page) == []
    assert page.locator(".ds-said").get_attribute("aria-live") == "off"
    page.get_by_role("button", name="Pause").click()
    assert play.is_visible()


def test_keys_are_those_of_what_has_the_focus(page):
    last = shown()["steps"]
    page.keyboard.press("ArrowLeft")  # nothing has the focus: the page's own key
    assert seen(page) == placed(last - 1)
    page.locator(".ds-stage").focus()
    for key, step in (("Home", 0), ("ArrowRight", 1), ("ArrowRight", 2), ("End", last)):
        page.keyboard.press(key)
        assert seen(page) == placed(step)
    page.keyboard.press("Home")
    page.keyboard.press("End")
    page.keyboard.press("ArrowDown")
    assert page.evaluate("document.activeElement.classList.contains('ds-part')")
    page.locator(".ds-stage").focus()
    page.keyboard.press(" ")
    assert page.get_by_role("button", name="Pause").is_visible()
    page.keyboard.press(" ")
    assert page.get_by_role("button", name="Play").is_visible()
    # Those of other fields are theirs.
    field = "Object.assign(document.createElement('input'), {id: 'other'})"
    page.evaluate(f"again(); document.body.append({field})")
    page.locator("#other").focus()
    for key in ("ArrowLeft", "Home", " ", "x"):
        page.keyboard.press(key)
    assert page.locator("#other").input_value() == " x"
    page.locator(".ds-index").focus()
    page.keyboard.press("ArrowDown")
    assert page.locator(".ds-index").input_value() == "SF"
    assert seen(page) == placed(last)
    page.evaluate("document.getElementById('other').remove()")


def test_a_stone_has_a_card(page):
    part = max(shown()["parts"], key=lambda part: abs(part["angle_deg"]))
    page.locator(f".ds-part[data-id='{part['id']}']").click()
    assert abs(part["angle_deg"]) > 1
    card = page.get_by_role("complementary", name="Stone card")
    text = card.inner_text()
    x, y = (f"{value:.1f}" for value in part["centroid"])
    for said in (f"Stone {part['id']}", f"step {part['step']} of", f"cluster {part['cluster']}",
                 f"{x} px from the left end, {y} px above the ground",
                 f"left {part['alpha_left']:.3f}", part["turn"]):  # fmt: skip
        assert said in text
    picture = f"Stone {part['id']} (step {part['step']}): {part['turn']}"
    assert card.get_by_role("img", name=picture).is_visible()
    card.get_by_text("Indices of this step").click()
    for name, value in part["indices"].items():
        assert f"{name}\t{value:.3f}" in card.inner_text()
    # Neighbours are links.
    slider(page).fill("1")
    neighbour = next(i for i in shown()["parts"][0]["neighbours"] if i)
    step = next(p["step"] for p in shown()["parts"] if p["id"] == neighbour)
    card.get_by_role("button", name=f"{neighbour} (step {step})", exact=True).click()
    assert card.locator(".ds-name").inner_text().endswith(f"Stone {neighbour}")
    assert seen(page) == placed(step)
    assert page.evaluate("+document.activeElement.dataset.id") == neighbour
    # A wedge says what it is under.
    wedge = next(part for part in shown()["parts"] if part["kind"] == "wedge")
    slider(page).fill(str(wedge["step"]))
    assert f"Wedge {wedge['id']}" in card.inner_text()
    assert re.search(rf"Under\s+{wedge['under']} \(step", card.inner_text())
    assert "to find or to cut" in card.locator(".ds-figure").text_content()


def test_the_photograph_lies_under_the_outline(visit, tmp_path):
    plan = planned().plan
    source = plan.source["width_px"], plan.source["height_px"]
    picture = Image.new("RGB", (4 * source[0], 4 * source[1]), "#007000")
    for part in shown("best")["parts"][1:3]:
        corners = [(4 * x, 4 * (source[1] - y)) for x, y in part["source"]]
        ImageDraw.Draw(picture).polygon(corners, fill="#c00000")
    picture.save(tmp_path / "photo.png")
    data = view_of_result(planned(), photo=tmp_path / "photo.png")
    # Turns of the plan are small: one stone is said to stand turned by 70 degrees more.
    straight, turned = data["parts"][1:3]
    straight["points"] = [(np.array(straight["source"]) - straight["source"][0]).tolist()]
    straight["angle_deg"] = 0.0
    more = shapely.affinity.rotate(shapely.Polygon(turned["points"][0]), 70, origin=(0, 0))
    turned["points"] = [list(map(list, more.exterior.coords[:-1]))]
    turned["angle_deg"] += 70.0
    page = visit(viewer_page(data), device_scale_factor=2)
    for part in (straight, turned):
        slider(page).fill(str(part["step"]))
        check_that_outlines_hold_the_stone(page.locator(".ds-card .ds-figure"))


def check_that_outlines_hold_the_stone(figure):
    """Both outlines of a stone, as it lies and as it stands, are red within, and green around."""
    seen = Image.open(io.BytesIO(figure.screenshot())).convert("RGB")
    wide = float(figure.get_attribute("viewBox").split()[2])
    colours, parts = np.asarray(seen, int), []
    across, down = np.meshgrid(np.arange(seen.width) + 0.5, np.arange(seen.height) + 0.5)
    for outline in figure.locator(".ds-over").all():
        pairs = re.findall(r"(-?[\d.]+) (-?[\d.]+)", outline.get_attribute("d"))
        drawn = shapely.Polygon(np.array(pairs, float) * seen.width / wide)
        parts += [(drawn.buffer(-6), True), (drawn.buffer(8) - drawn.buffer(4), False)]
    assert len(parts) == 4
    for within, red in parts:
        pixels = colours[shapely.contains_xy(within, across, down)]
        assert len(pixels) > 300
        assert ((pixels[:, 0] > pixels[:, 1]) == red).mean() > 0.95


def drawn_points(page):
    """Return the corners of every part at rest and as drawn, in units of the drawing, by id."""
    found = page.eval_on_selector_all(
        ".ds-part",
        """all => all.map(g => {
          const list = g.transform.baseVal.consolidate();
          const m = list ? list.matrix : {a: 1, b: 0, c: 0, d: 1, e: 0, f: 0};
          const rest = g.querySelector(".ds-shape").getAttribute("d").match(/-?[\\d.]+ -?[\\d.]+/g)
            .map(pair => pair.split(" ").map(Number));
          const now = rest.map(([x, y]) => [m.a * x + m.c * y + m.e, m.b * x + m.d * y + m.f]);
          return [g.dataset.id, rest, now];
        })""",
    )
    return {int(part): (np.array(rest), np.array(now)) for part, rest, now in found}


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_mechanism_moves_stones_as_its_velocities_say(page, side):
    page.locator(f".ds-choose-mechanism input[value={side}]").check()
    found = shown()["mechanisms"][side]
    x0, _, x1, y1 = shown()["box"]
    k = 1000.0 / (x1 - x0)
    moved = 0
    for amplitude in (0.1, 1.0):
        page.locator(".ds-amplitude").fill(str(amplitude))
        drawn = drawn_points(page)
        for part in shown()["parts"]:
            rest, now = drawn[part["id"]]
            velocity = found["velocity"].get(str(part["id"]))
            if velocity is None:
                assert (rest == now).all()
                continue
            # A finite turn about the centre of rotation that the velocity has.
            vx, vy, angle = np.array(velocity) * amplitude * found["scale"]
            centre = np.array(part["centroid"])
            corners = np.column_stack([rest[:, 0] / k + x0, y1 - rest[:, 1] / k])
            if abs(angle) > 1e-7:
                pole = centre + np.array([-vy, vx]) / angle
                turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
                expected = (corners - pole) @ turn.T + pole
            else:
                expected = corners + np.array([vx, vy])
            wanted = np.column_stack([(expected[:, 0] - x0) * k, (y1 - expected[:, 1]) * k])
            assert now == pytest.approx(wanted, abs=0.02)
            moved += 1
    assert moved >= 2
    assert found["words"] in page.locator(".ds-note").inner_text()
    page.locator(".ds-choose-mechanism input[value=none]").check()
    assert page.locator(".ds-part[transform]").count() == 0


def test_a_mechanism_is_animated_unless_less_motion_is_wanted(page):
    page.locator(".ds-choose-mechanism input[value=left]").check()
    moving = next(iter(shown()["mechanisms"]["left"]["velocity"]))
    where = f"document.querySelector('.ds-part[data-id=\"{moving}\"]').getAttribute('transform')"
    page.get_by_role("button", name="Animate").click()
    first = page.evaluate(where)
    until(lambda: page.evaluate(where) != first)
    page.get_by_role("button", name="Stop").click()
    page.emulate_media(reduced_motion="reduce")
    page.evaluate("again()")
    page.locator(".ds-choose-mechanism input[value=left]").check()
    assert page.get_by_role("button", name="Animate").is_disabled()


def test_contacts_are_drawn_of_what_is_placed_and_joints_show_what_they_do(page):
    page.get_by_label("Contacts").check()
    contacts, joints = shown()["contacts"], page.locator(".ds-stage .ds-joint")
    assert joints.count() == len(contacts)
    slider(page).fill("2")
    there = {0, *placed(2)}
    expected = [c for c in contacts if there.issuperset(c["between"])]
    assert 0 < len(expected) < len(contacts)
    assert joints.count() == len(expected)
    # Mechanisms and forces are those of the finished wall.
    page.locator(".ds-choose-mechanism input[value=right]").check()
    assert seen(page) == placed(shown()["steps"])
    page.get_by_label("What joints do").check()
    kinds = [kind for contact in contacts for kind in contact["kinds"]["right"]]
    marks = {
        "closed": "dot", "opening": "ring", "sliding": "triangle", "opening and sliding": "square",
    }  # fmt: skip
    for kind, mark in marks.items():
        assert page.locator(f".ds-stage .ds-mark-{mark}").count() == kinds.count(kind)
    assert "opening and sliding" in page.locator(".ds-tools .ds-legend").inner_text()
    slider(page).fill("2")
    page.locator(".ds-choose-forces input[value=left]").check()
    assert seen(page) == placed(shown()["steps"])
    slider(page).fill("2")
    assert page.locator(".ds-stage .ds-forces line").count() == 0
    assert "those of the finished wall" in page.locator(".ds-note").inner_text()


@pytest.mark.parametrize("case", ["self", "left", "right"])
def test_forces_have_the_direction_and_the_ratio_of_the_data(page, case):
    page.locator(f".ds-choose-forces input[value={case}]").check()
    lines = page.eval_on_selector_all(
        ".ds-stage .ds-forces line",
        "all => all.map(l => ['x1', 'y1', 'x2', 'y2'].map(n => +l.getAttribute(n)))",
    )
    drawn = np.array([[x2 - x1, y1 - y2] for x1, y1, x2, y2 in lines])
    totals = []
    for contact in shown()["contacts"]:
        x, y = contact["normal"]
        totals.append((np.array(contact["forces"][case]) @ [[x, y], [y, -x]]).sum(axis=0))
    largest = max(np.hypot(*total) for total in totals)
    totals = np.array([total for total in totals if np.hypot(*total) >= 1e-6 * largest])
    factor = np.hypot(*drawn.T).max() / largest
    assert drawn == pytest.approx(totals * factor, abs=0.3)
    page.locator(".ds-force-scale").fill("2")
    wide = "l => l.getAttribute('x2') - l.getAttribute('x1')"
    again = page.eval_on_selector(".ds-stage .ds-forces line", wide)
    assert again == pytest.approx(2 * drawn[0, 0], abs=0.4)
    assert f"{100 * largest:.1f} % of the wall's weight" in page.locator(".ds-tools").inner_text()


def test_the_chart_marks_the_step_and_has_a_table_as_results_have_words(page):
    chart = page.locator(".ds-chart")
    left = page.eval_on_selector(".ds-line-left", "l => l.getAttribute('points').split(' ').length")
    assert left == sum(part["alpha_left"] is not None for part in shown()["parts"])
    where = page.locator(".ds-now-line").get_attribute("x1")
    slider(page).fill("2")
    assert float(page.locator(".ds-now-line").get_attribute("x1")) < float(where)
    page.locator(".ds-index").select_option("LLC")
    assert page.locator(".ds-chart .ds-line-index").count() == 1
    assert "LLC ends at" in chart.get_attribute("aria-label")
    page.get_by_text("The same as a table").click()
    rows = page.locator(".ds-as-table tbody tr")
    until(lambda: rows.count() == shown()["steps"])  # browsers say that it is open a while later
    assert rows.nth(0).inner_text().split("\t")[2] == f"{shown()['parts'][0]['alpha_left']:.3f}"
    box = chart.bounding_box()
    page.mouse.click(box["x"] + box["width"] - 11, box["y"] + 40)
    assert seen(page) == placed(shown()["steps"])
    text = page.get_by_role("region", name="Results").inner_text()
    assert "Masons: 23.8 to 33.9 % in three walls of masons, of other stones." in text
    page.get_by_text("What it was made from, settings, assumptions").click()
    about = page.locator(".ds-about")
    until(lambda: "stabilise." in about.inner_text())
    assert "upper bound" in about.inner_text()


def test_light_dark_and_the_choice_between_them(visit):
    page = visit(viewer_page(shown()), color_scheme="dark")
    colour = "getComputedStyle(document.querySelector('.ds-view')).backgroundColor"
    dark = page.evaluate(colour)
    button = page.get_by_role("button", name="Theme")
    button.click()
    assert page.evaluate(colour) == dark
    button.click()
    assert button.inner_text() == "Theme: light"
    assert page.evaluate(colour) == "rgb(255, 255, 255)" != dark
    page.emulate_media(color_scheme="light")
    button.click()
    assert page.evaluate(colour) == "rgb(255, 255, 255)"


def test_the_build_view_goes_on_from_what_is_set(visit, tmp_path):
    """A card that fills the phone, the wall below, swipes, and ticks that the browser keeps."""
    phone = {"viewport": {"width": 390, "height": 844}, "has_touch": True}
    page = visit(write_report(tmp_path / "r.html", shown()).read_text("utf-8"), **phone)
    page.get_by_role("button", name="Build", exact=True).click()
    counter, last = page.locator(".ds-counter"), shown()["steps"]
    assert counter.inner_text() == f"1 / {last}, 0 done"
    page.get_by_label("Stone is set").click()  # and the next step is there
    assert counter.inner_text() == f"2 / {last}, 1 done"
    card, stage = (page.locator(name).bounding_box() for name in (".ds-card", ".ds-stage"))
    assert card["y"] + card["height"] <= stage["y"]
    assert stage["y"] + stage["height"] < 844
    assert not page.locator(".ds-tools").is_visible()
    for start, end, step in ((300, 60, 3), (60, 300, 2), (300, 280, 2)):
        page.mouse.move(start, 100)
        page.mouse.down()
        page.mouse.move(end, 110)
        page.mouse.up()
        assert counter.inner_text() == f"{step} / {last}, 1 done"
    text = page.locator(".ds-card").inner_text()
    part = shown()["parts"][1]
    assert part["turn"] in text
    assert part["beside"] in text
    page.goto(f"{page.url}#build")
    assert _again(page, counter, f"2 / {last}, 1 done")
    page.get_by_role("button", name="One step back").click()
    page.get_by_label("Stone is set").uncheck()
    page.get_by_role("button", name="Close").click()
    assert page.locator(".ds-tools").is_visible()
    assert seen(page) == placed(last)
    assert _again(page, counter, f"1 / {last}, 0 done")


def _again(page, counter, text):
    """Load the page until it shows a text: a busy browser writes what it keeps a little later."""
    for _ in range(20):
        page.reload()
        if counter.inner_text() == text:
            return True
        page.wait_for_timeout(100)
    return False


def test_nothing_is_wider_than_a_phone_and_everything_has_a_name_for_screen_readers(page):
    unnamed = page.evaluate(
        """() => [...document.querySelectorAll("button, input, select, [role=img], .ds-part")]
          .filter(e => !(e.getAttribute("aria-label") || e.textContent.trim() || e.labels?.length))
          .map(e => e.outerHTML.slice(0, 80))"""
    )
    assert unnamed == []
    tabs = page.eval_on_selector_all(".ds-part", "all => all.filter(g => g.tabIndex === 0).length")
    assert tabs == 1
    page.set_viewport_size({"width": 390, "height": 844})
    page.evaluate("again()")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    card, stage = (page.locator(name).bounding_box() for name in (".ds-card", ".ds-stage"))
    assert card["y"] > stage["y"] + stage["height"]
    page.locator(".ds-zoom").fill("3")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.evaluate("document.querySelector('.ds-stage').scrollWidth") > 900


def test_print_shows_the_whole_wall_and_no_controls(visit, tmp_path):
    pdfium = pytest.importorskip("pypdfium2")
    path = write_report(tmp_path / "report.html", shown())
    page = visit(path.read_text(encoding="utf-8"))
    slider(page).fill("2")
    assert page.locator(".steps tr.now").get_attribute("id") == "step-2"
    page.emulate_media(media="print")
    assert seen(page) == placed(shown()["steps"])
    for name in (".ds-transport", ".ds-controls", ".ds-card", ".ds-theme"):
        assert not page.locator(name).is_visible()
    file = tmp_path / "report.pdf"
    page.pdf(path=file, format="A4")
    document = pdfium.PdfDocument(file)
    text = [sheet.get_textpage().get_text_range() for sheet in document]
    assert "Dry-stone wall from" in text[0]
    assert "Lateral resistance" in text[0]
    assert any("Steps of construction" in one for one in text)
    drawn = text[0].split("step by step")[1].split("Load multipliers")[0].split()
    steps = {str(part["number"]) for part in shown()["parts"] if part["kind"] == "stone"}
    assert steps <= set(drawn)  # the numbers on the stones
    image = np.asarray(document[0].render(scale=0.5).to_pil().convert("RGB"), int)
    assert (np.ptp(image, axis=2) > 60).mean() > 0.02  # the stones are printed in colour
    document.close()


def test_without_scripts_the_report_still_says_all(visit, tmp_path):
    text = write_report(tmp_path / "r.html", shown()).read_text(encoding="utf-8")
    page = visit(text, java_script_enabled=False)
    assert "There is no picture of the wall." in page.locator("main").inner_text()
    assert page.locator(".steps tbody tr").count() == shown()["steps"]


def test_names_of_files_do_nothing(visit, tmp_path):
    evil = '"><img src=x onerror="window.hit=1"></script><script>window.hit=1</script>'
    data = json.loads(json.dumps(shown()))
    data["title"] = data["summary"] = data["forces_words"] = evil
    data["inputs"] = data["settings"] = [[evil, evil]]
    data["notices"] = [{"code": "W1", "message": evil, "cure": evil}]
    for part in data["parts"]:
        part.update(dict.fromkeys(("words", "turn", "beside", "side", "name", "colour"), evil))
        part["crop"] = {"data": "javascript:window.hit=1", "box": [0, 0, 1, 1]}
    for card in data["metrics"]:
        card.update(dict.fromkeys(("name", "value", "sentence", "masons"), evil))
    data["mechanisms"]["left"]["words"] = evil
    for text in (viewer_page(data), write_report(tmp_path / "r.html", data).read_text("utf-8")):
        page = visit(text)
        slider(page).fill("2")
        page.locator(".ds-choose-mechanism input[value=left]").check()
        page.locator("summary").last.click()
        assert evil in page.locator("body").inner_text()
        assert page.evaluate("window.hit") is None
        assert page.locator("img").count() == 0


def test_two_viewers_on_a_page_do_not_mix(visit):
    text = (
        f"<style>{viewer_style()}</style><div id=a></div><div id=b></div>"
        f"<script type=module>{viewer_script()}\n"
        f"const one = {json_in_html(shown())}, two = {json_in_html(shown('best'))};\n"
        "window.a = mount(document.getElementById('a'), one, {step: 2});\n"
        "window.b = mount(document.getElementById('b'), two);</script>"
    )
    page = visit(text)
    page.locator("#a").get_by_label("Step of construction").fill("4")
    page.locator("#b .ds-choose-mechanism input[value=left]").check()
    assert page.evaluate("[a.step, b.step]") == [4, shown("best")["steps"]]
    assert page.locator("#a .ds-part[transform]").count() == 0
    assert page.locator("#b .ds-part[transform]").count() > 0
    ids = page.eval_on_selector_all("[id]", "all => all.map(one => one.id)")
    assert len(ids) == len(set(ids))
    page.locator("#b .ds-stage").focus()
    page.keyboard.press("Home")
    assert page.evaluate("[a.step, b.step]") == [4, 0]
    page.evaluate("a.destroy()")
    assert page.locator(".ds-view").count() == 1


def test_the_frame_of_a_notebook_grows_to_its_content(visit):
    page = visit(f"<style>p {{color: red}}</style>{planned('paper')._repr_html_()}")
    frame = page.frame_locator("iframe")
    frame.get_by_label("Step of construction").fill("1")
    assert frame.locator(".ds-counter").inner_text().startswith("1 /")
    until(lambda: page.evaluate("document.querySelector('iframe').clientHeight") > 700)


def test_a_wall_that_was_not_planned_has_no_steps(visit):
    labels = np.zeros((40, 60), np.uint32)
    labels[20:, 5:25], labels[20:, 25:45], labels[:20, 15:35] = 7, 9, 12
    page = visit(viewer_page(analysed(labels)))
    assert page.get_by_label("Step of construction").count() == 0
    assert page.locator(".ds-chart").count() == 0
    page.locator(".ds-stage").focus()
    page.keyboard.press("ArrowRight")
    assert page.locator(".ds-card .ds-name").inner_text().endswith("Stone 7")
    # The image begins left of the wall, so x is not from the wall's end.
    assert "x 15.0 px, 10.0 px above the ground" in page.locator(".ds-card").inner_text()
    # Without steps, keys that go to steps are the page's.
    page.keyboard.press("Home")
    assert page.locator(".ds-said").inner_text() == "Stone 7."
    page.locator(".ds-choose-mechanism input[value=right]").check()
    assert page.locator(".ds-part[transform]").count() > 0


def test_marks_and_numbers_are_as_large_on_a_phone_and_of_a_tall_wall(visit):
    wall = analysed([[0, 0, 2, 1], [2, 0, 2, 1], [1, 1, 2, 1]])
    page = visit(viewer_page(wall), viewport={"width": 390, "height": 800})
    page.locator(".ds-kinds-on").check()
    marks = page.locator(".ds-stage .ds-mark")
    for width in (390, 1200):
        page.set_viewport_size({"width": width, "height": 800})
        until(lambda: 2.5 < marks.first.evaluate("one => one.getBoundingClientRect().height") < 8)

    # Numbers of a tall wall are as large as those of a long one.
    page = visit(viewer_page(analysed([[0, 0, 1, 2], [0, 2, 1, 2]])))
    high = page.locator(".ds-number").first.evaluate("one => one.getBoundingClientRect().height")
    assert 12 < high < 26
