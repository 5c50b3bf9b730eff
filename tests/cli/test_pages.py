"""The ways that the pages of an engineer and of a beginner print, followed as printed."""

import json
import re
import shlex

import numpy as np
from PIL import Image

from tests.cli.conftest import UNTRIED
from tests.pages import DOCS, printed

WIDTH, HEIGHT = 640, 440
"""Of the photograph of a wall, px."""

TRACED = (
    [(124, 780), (129, 625), (240, 611), (392, 617), (402, 700), (397, 780)],
    [(410, 780), (411, 700), (406, 626), (520, 632), (634, 633), (641, 780)],
    [(651, 780), (649, 636), (790, 619), (880, 628), (886, 780)],
    [(897, 780), (894, 655), (905, 629), (1040, 620), (1153, 632), (1160, 780)],
    [(140, 612), (147, 472), (263, 459), (281, 598), (240, 605)],
    [(293, 598), (273, 464), (390, 450), (522, 466), (531, 621), (400, 607)],
    [(542, 624), (535, 470), (680, 470), (781, 457), (789, 606), (650, 624)],
    [(800, 609), (793, 456), (900, 448), (983, 458), (991, 606), (900, 613)],
    [(1003, 607), (995, 461), (1100, 455), (1143, 485), (1145, 617), (1040, 606)],
    [(161, 458), (171, 300), (300, 288), (424, 304), (429, 440), (390, 438), (270, 448)],
    [(441, 443), (434, 304), (580, 284), (692, 299), (697, 460), (525, 455)],
    [(708, 458), (703, 301), (840, 294), (940, 320), (946, 437), (900, 437), (780, 443)],
    [(958, 440), (951, 322), (1040, 305), (1122, 317), (1125, 446), (1095, 444), (990, 449)],
)
"""A wall of 13 stones, as clicked by eye on a picture at twice its size; joints stay open."""


def lines_of(*asked):
    """The lines of all blocks of a kind."""
    return "".join(printed(*asked)).splitlines()


def photograph(path):
    """Save a picture of the size that was traced: what it shows is not looked at."""
    noise = np.random.default_rng(35).integers(0, 256, (HEIGHT, WIDTH, 3), np.uint8)
    Image.fromarray(noise).save(path)
    return path


def test_every_command_of_the_page_gives_what_it_says(tmp_path, monkeypatch, run):
    """A photograph lies beside the trace that the page of outlines writes."""
    photograph(tmp_path / "wall.jpg")
    shapes = [
        {"label": "stone", "points": [(x / 2, y / 2) for x, y in corners], "group_id": None,
         "shape_type": "polygon", "flags": {}}
        for corners in TRACED
    ]  # fmt: skip
    content = {
        "version": "5.5.0", "flags": {}, "shapes": shapes, "imagePath": "wall.jpg",
        "imageData": None, "imageHeight": HEIGHT, "imageWidth": WIDTH,
        "drystone": {"px_per_m": 200.0, "ground": [[60, 390], [590, 390]]},
    }  # fmt: skip
    (tmp_path / "outlines.json").write_text(json.dumps(content))
    monkeypatch.chdir(tmp_path)
    page, section = "for-engineers.md", "From a photograph of a wall"
    commands = [shlex.split(line)[1:] for line in lines_of(page, "sh", section)]
    assert [words[0] for words in commands] == [
        "trace", "stones", "analyse", "analyse", "stones", "measure",
    ]  # fmt: skip
    told = [run(*words) for words in commands]
    assert [one.code for one in told] == [0] * len(told), [one.err for one in told]
    assert (tmp_path / "trace" / "outlines.html").exists()
    assert "13 stones" in told[1].out
    assert "own weight           stands" in told[2].out
    assert set(lines_of(page, "text", section)) <= set(told[2].out.splitlines())
    assert "m wide" in told[2].out
    values = [re.search(r"^F_LR +(0\.\d+)", one.out, re.MULTILINE) for one in told[2:4]]
    assert values[0][1] == values[1][1]
    assert (tmp_path / "traced-analysis" / "report.html").exists()
    photo = run("analyse", "wall.jpg")
    assert (photo.code, "for-engineers.md#from-a-photograph-of-a-wall" in photo.err) == (3, True)


def test_the_photograph_becomes_a_wall_that_holds(tmp_path, monkeypatch, run):
    (tmp_path / "docs").symlink_to(DOCS)
    monkeypatch.chdir(tmp_path)
    lines = [line for line in lines_of("tutorial.md", "sh") if line.startswith("drystone")]
    segment, plan, check, *others = (shlex.split(line)[1:] for line in lines)
    assert [segment[0], plan[0], check[0]] == ["segment", "plan", "check"]
    assert [words[0] for words in others] == ["analyse", "craft", "export"]  # of what plan wrote
    # One wall shows that the way leads on; it may be a little low.
    plan += ["--budget", "1", *UNTRIED]
    told = [run(*words) for words in (segment, plan, check)]
    assert [told[0].code, told[1].code in (0, 4), told[2].code] == [0, True, 0]
    text = lines_of("tutorial.md", "text")
    ends = ("complete: ", "incomplete: ")
    found = text[: next(k for k, line in enumerate(text) if line.startswith(ends))]
    assert len(found) > 4
    assert set(found) <= set(told[0].out.splitlines())
    assert told[2].out.startswith("OK: wall/plan.json is valid")
