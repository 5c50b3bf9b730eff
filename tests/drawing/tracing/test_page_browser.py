"""The page of outlines in a browser: by mouse, by touch, by keys alone."""

import json
import re
import shutil
import subprocess
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely
from PIL import Image, ImageDraw

from drystone.drawing.tracing.page import write_outline_page
from drystone.photo.segment_doubts import Doubt
from tests.cli import test_pages as pages
from tests.cli.conftest import run  # noqa: F401 - a fixture

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")

WIDTH, HEIGHT = 800, 500


def stone(x, y, wide, high, seed, corners=11):
    rng = np.random.default_rng(seed)
    angles = np.sort(np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) * 2 * np.pi / corners
    radii = rng.uniform(0.85, 1.0, corners)
    across, up = radii * np.cos(angles), radii * np.sin(angles)
    return shapely.Polygon(np.column_stack([x + wide / 2 * across, y + high / 2 * up]))


LEFT, RIGHT = stone(120, 100, 130, 120, 1), stone(244, 100, 112, 120, 2)
MISSED = stone(620, 110, 150, 110, 3, corners=7)
OTHERS = [stone(130 + 180 * i, 350, 140, 120, 4 + i) for i in range(4)]
TRUTH = [LEFT, RIGHT, MISSED, *OTHERS]
SHADOW = stone(430, 180, 60, 50, 9)


def photograph():
    rng = np.random.default_rng(0)
    image = Image.new("RGB", (WIDTH, HEIGHT), (60, 105, 125))
    draw = ImageDraw.Draw(image)
    draw.polygon(list(SHADOW.exterior.coords), fill=(38, 66, 80))
    for each in TRUTH:
        draw.polygon(list(each.exterior.coords), fill=(150, 143, 130))
    noise = rng.normal(0, 5, (HEIGHT, WIDTH, 3))
    return np.clip(np.asarray(image) + noise, 0, 255).astype(np.uint8)


@pytest.fixture
def opened(visit, tmp_path):
    """Open the page with what was found: two stones as one, a shadow, the frame, and others."""
    both = shapely.union_all([LEFT, RIGHT]).buffer(9).buffer(-9)
    shapes = [both, SHADOW, shapely.box(5, 5, WIDTH - 5, HEIGHT - 5), *OTHERS]
    rings = {i: list(shape.exterior.coords)[:-1] for i, shape in enumerate(shapes, 1)}
    path = tmp_path / "outlines.html"
    doubt = Doubt("W175", (1,), (186.0, 100.0), "stone 1 may be two")
    about = {"title": "Stones", "name": "pile.jpg", "kind": "stones"}
    write_outline_page(path, photograph(), rings, **about, doubts=(doubt,))
    return lambda **context: visit(path, accept_downloads=True, **context)


def take(page, name):
    """Tap a tool; a browser may drop a tap that follows a swipe at once."""
    button = page.get_by_role("button", name=name, exact=True)
    for _ in range(20):
        button.tap()
        if button.get_attribute("aria-pressed") == "true":
            return
        time.sleep(0.1)
    raise AssertionError(name)


class View:
    """Where px of the photograph are on the screen while all of it is shown."""

    def __init__(self, page, width=WIDTH, height=HEIGHT):
        self.page = page
        self.box = page.locator("canvas").bounding_box()
        self.k = 0.98 * min(self.box["width"] / width, self.box["height"] / height)
        self.middle = width / 2, height / 2

    def __call__(self, x, y):
        left, top = self.box["x"] + self.box["width"] / 2, self.box["y"] + self.box["height"] / 2
        return left + self.k * (x - self.middle[0]), top + self.k * (y - self.middle[1])

    def drag(self, points):
        mouse = self.page.mouse
        mouse.move(*self(*points[0]))
        mouse.down()
        for point in points[1:]:
            mouse.move(*self(*point), steps=6)
        mouse.up()

    def swipe(self, points):
        client = self.page.context.new_cdp_session(self.page)

        def touch(kind, at):
            places = [] if at is None else [{"x": at[0], "y": at[1]}]
            client.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": places})

        touch("touchStart", self(*points[0]))
        for (x0, y0), (x1, y1) in pairwise(points):
            for share in np.linspace(0.2, 1.0, 5):
                touch("touchMove", self(x0 + share * (x1 - x0), y0 + share * (y1 - y0)))
        touch("touchEnd", None)

    def walk(self, x, y):
        """Move the cross there by arrow keys, from the middle of the canvas or where it is."""
        step = 0.02 * max(self.box["width"], self.box["height"])
        at = getattr(self, "cross", (self.box["width"] / 2, self.box["height"] / 2))
        to = self(x, y)
        to = to[0] - self.box["x"], to[1] - self.box["y"]
        place = list(at)
        for axis, (back, on) in enumerate((("ArrowLeft", "ArrowRight"), ("ArrowUp", "ArrowDown"))):
            way = to[axis] - at[axis]
            far, near = divmod(abs(way), step)
            for key, count, size in (("", int(far), step), ("Shift+", round(near), 1.0)):
                for _ in range(count):
                    self.page.keyboard.press(key + (on if way > 0 else back))
                place[axis] += np.sign(way) * count * size
        self.cross = tuple(place)


def saved(page):
    with page.expect_download() as waiting:
        page.keyboard.press("Control+s")
    return json.loads(Path(waiting.value.path()).read_bytes())


def says(page, words):
    """Wait until the line of counts says so."""
    playwright.expect(page.locator(".count")).to_contain_text(words)


def check(file, scale):
    """Every stone of the truth is there with IoU >= .95, and nothing else."""
    shapes = [shapely.Polygon(shape["points"]) for shape in file["shapes"]]
    assert len(shapes) == len(TRUTH)
    for truth in TRUTH:
        best = max(s.intersection(truth).area / s.union(truth).area for s in shapes)
        assert best >= 0.95
    assert file["drystone"]["px_per_m"] == pytest.approx(scale, rel=0.02)
    assert file["drystone"]["proposed"] == []
    assert (file["imageWidth"], file["imageHeight"]) == (WIDTH, HEIGHT)
    assert len({shape["label"] for shape in file["shapes"]}) == len(TRUTH)


GAP = [(187, 20), (187, 180)]
OUTLINE = [*MISSED.exterior.coords]


def test_corrected_with_the_mouse_and_read(opened, run, tmp_path):  # noqa: F811
    page = opened(viewport={"width": 1280, "height": 800})
    says(page, "7 stones")
    view = View(page)
    page.mouse.click(*view(420, 470))  # the ground: only the frame lies there
    page.keyboard.press("Delete")
    page.mouse.click(*view(430, 180))
    page.keyboard.press("Delete")
    says(page, "5 stones")
    page.reload()  # nothing is lost
    page.wait_for_selector("canvas")
    says(page, "5 stones")
    view = View(page)
    page.keyboard.press("c")
    view.drag(GAP)
    says(page, "6 stones")
    page.keyboard.press("d")
    view.drag(OUTLINE)
    says(page, "7 stones")
    page.keyboard.press("s")
    page.mouse.click(*view(100, 30))
    page.mouse.click(*view(500, 30))
    page.get_by_label("length").fill("50")
    page.keyboard.press("Enter")
    says(page, "800")
    file = saved(page)
    check(file, 800)
    (tmp_path / "outlines.json").write_text(json.dumps(file))
    read = run("stones", tmp_path / "outlines.json", "--json").json()
    assert (read["stones"], read["px_per_m"]) == (len(TRUTH), pytest.approx(800, rel=0.02))
    assert read["total_area_px"] == pytest.approx(sum(one.area for one in TRUTH), rel=0.03)


def test_corrected_with_fingers(opened):
    page = opened(viewport={"width": 820, "height": 1180}, has_touch=True, is_mobile=True)
    view = View(page)
    for x, y in ((420, 470), (430, 180)):
        page.touchscreen.tap(*view(x, y))
        page.get_by_role("button", name="Delete").tap()
    says(page, "5 stones")
    take(page, "Cut")
    view.swipe(GAP)
    take(page, "Propose")
    page.touchscreen.tap(*view(620, 110))
    says(page, "1 proposed")
    page.get_by_role("button", name="Accept", exact=True).tap()
    take(page, "Scale")
    page.touchscreen.tap(*view(100, 30))
    page.touchscreen.tap(*view(500, 30))
    page.get_by_label("length").fill("50")
    page.get_by_role("button", name="long").tap()
    check(saved(page), 800)


def test_corrected_with_keys_alone(opened):
    page = opened(viewport={"width": 1280, "height": 800})
    view = View(page)
    page.keyboard.press("n")
    playwright.expect(page.locator(".said")).to_have_text("Stone 1 may be two.")
    for _ in range(2):  # stone 2 is the shadow, 3 is the frame
        page.keyboard.press("n")  # stone 1 again
        page.keyboard.press("]")
        page.keyboard.press("Delete")
    says(page, "5 stones")
    page.keyboard.press("0")
    page.locator("canvas").focus()
    page.keyboard.press("Escape")
    page.keyboard.press("c")
    for point in (*GAP, GAP[-1]):
        view.walk(*point)
        page.keyboard.press("Enter")
    says(page, "6 stones")
    page.keyboard.press("d")
    for point in OUTLINE:
        view.walk(*point)
        page.keyboard.press("Enter")
    says(page, "7 stones")
    page.keyboard.press("s")
    for point in ((100, 30), (500, 30)):
        view.walk(*point)
        page.keyboard.press("Enter")
    page.keyboard.type("50")
    page.keyboard.press("Enter")
    check(saved(page), 800)


def test_what_is_shown_is_what_there_is(opened):
    """Photograph and stones are painted anew when they change, and the line over them always."""
    page = opened(viewport={"width": 720, "height": 480})
    view, canvas = View(page), page.locator("canvas")
    page.keyboard.press("d")

    def shown():
        page.evaluate("() => new Promise((done) => requestAnimationFrame(() => done()))")
        return canvas.screenshot()

    seen = [shown()]
    page.mouse.move(*view(300, 250))
    page.mouse.down()
    for at in ((500, 250), (520, 400)):
        page.mouse.move(*view(*at), steps=4)
        seen.append(shown())  # a longer line
    page.mouse.up()
    seen.append(shown())  # a stone of three corners, chosen
    page.keyboard.press("Delete")
    assert shown() == seen[0]
    page.keyboard.press("Escape")
    page.keyboard.press("v")
    page.mouse.click(*view(130, 350))
    seen.append(shown())  # another one is chosen
    page.keyboard.press("u")
    seen.append(shown())  # nobody builds with it
    page.keyboard.press("Escape")
    for _ in range(4):  # more than was done
        page.keyboard.press("Control+z")
    assert page.get_by_role("button", name="Undo").is_disabled()
    page.mouse.move(*view(600, 460))
    page.mouse.down()
    page.mouse.move(*view(660, 440), steps=3)
    seen.append(shown())  # all of it is moved
    page.mouse.up()
    page.keyboard.press("0")
    assert shown() == seen[0]
    assert len(set(seen)) == len(seen)


def test_a_stone_that_is_redrawn_or_numbered_keeps_its_number(opened):
    page = opened(viewport={"width": 1280, "height": 800})
    view = View(page)
    page.mouse.click(*view(130, 350))
    page.get_by_label("number").fill("99")
    page.keyboard.press("Enter")
    page.get_by_label("build with it").uncheck()
    file = saved(page)
    assert file["drystone"]["not_used"] == [99]
    ring = next(s["points"] for s in file["shapes"] if s["label"] == "99")
    assert shapely.Polygon(ring).equals(OTHERS[0])
    page.keyboard.press("r")
    corners = [(90, 320), (170, 325), (165, 380), (95, 375)]
    for point in (*corners, corners[0]):
        page.mouse.click(*view(*point))
    shapes = {shape["label"]: shape["points"] for shape in saved(page)["shapes"]}
    assert len(shapes) == len(file["shapes"])
    assert shapely.Polygon(shapes["99"]).symmetric_difference(shapely.Polygon(corners)).area < 150


def test_a_wall_is_traced_and_analysed(visit, run, tmp_path):  # noqa: F811
    wall, folder = pages.photograph(tmp_path / "wall.jpg"), tmp_path / "wall"
    assert run("trace", wall, "-o", folder).code == 0
    page = visit(folder / "outlines.html", accept_downloads=True)
    view = View(page, pages.WIDTH, pages.HEIGHT)
    page.keyboard.press("d")
    for corners in pages.TRACED:
        for x, y in (*corners, corners[0]):
            page.mouse.click(*view(x / 2, y / 2))
    says(page, "13 stones")
    page.keyboard.press("g")
    for point in ((60, 389.5), (590, 389.5)):
        page.mouse.click(*view(*point))
    page.keyboard.press("s")
    for point in ((610, 190), (610, 390)):
        page.mouse.click(*view(*point))
    page.get_by_label("length").fill("1")
    page.get_by_label("unit").select_option("m")
    page.keyboard.press("Enter")
    says(page, "px a metre")
    file, path = saved(page), folder / "outlines.json"
    path.write_text(json.dumps(file))
    shapes = [shapely.Polygon(shape["points"]) for shape in file["shapes"]]
    for shape, corners in zip(shapes, pages.TRACED, strict=True):
        truth = shapely.Polygon(np.array(corners) / 2)
        assert shape.intersection(truth).area / shape.union(truth).area > 0.93
    ran = run("analyse", path, "--close-gaps", "auto", "--associative-only")
    assert ran.code == 0, ran.err
    assert re.search(r"own weight +stands.*^F_LR +0\.[4-9]", ran.out, re.MULTILINE | re.DOTALL)
    assert "2.59 m wide, 1.24 m high" in ran.out
    assert "The ground was drawn: the wall is turned by 0.00 degrees" in ran.err


def test_axe_has_no_serious_finding(opened):
    page = opened(viewport={"width": 1280, "height": 800})
    axe = pytest.importorskip(
        "axe_playwright_python.sync_playwright", reason="axe-playwright-python is not installed"
    ).Axe()
    page.keyboard.press("n")
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        found = axe.run(page).response["violations"]
        assert [one["id"] for one in found if one["impact"] in ("serious", "critical")] == []


def test_the_modules_alone():
    node = shutil.which("node")
    if node is None:
        pytest.skip("no Node on this machine: the arithmetic of the page is tested with it")
    script = Path(__file__).with_name("shapes.test.mjs")
    ended = subprocess.run([node, "--test", script], capture_output=True, text=True, check=False)  # noqa: S603
    assert ended.returncode == 0, ended.stdout
