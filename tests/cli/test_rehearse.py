"""`drystone rehearse`: table, JSON, picture, what is refused."""

import json

from PIL import Image


def test_a_wall_that_stands_is_rehearsed(settled, tmp_path, run):
    picture = tmp_path / "risk.png"
    ran = run("rehearse", settled, "--precision", "1.5%", "--runs", 4, "-o", picture)
    assert ran.code == 0
    assert ran.out.startswith(f"{settled}: whole in ")
    assert "judge                       exact settling" in ran.out
    with Image.open(picture) as drawn:
        assert drawn.width > 500
    assert run("rehearse", settled, "-o", picture).code == 2  # it is not replaced unasked


def test_errors_can_be_given_as_lengths(settled, run):
    asked = ("--precision", "2px,1.5deg", "--outline", "0.5px", "--runs", 4, "--json")
    report = run("rehearse", settled, *asked).json()
    assert report["errors"] == {"placement": 2.0, "angle_deg": 1.5, "outline": 0.5}
    assert report == run("rehearse", settled, *asked).json()
    assert report != run("rehearse", settled, *asked, "--seed", 1).json()
    # Friction does not change the other errors; hardly any lets stones slide off each other.
    assert report == run("rehearse", settled, *asked, "--mu", 0.58).json()
    assert report != run("rehearse", settled, *asked, "--mu", "0.05:0.06").json()


def test_the_rest_is_planned_again_after_every_stone(settled, run):
    asked = ("--closed-loop", "--runs", 2)
    report = run("rehearse", settled, *asked, "--json").json()
    assert (report["loop"], report["judge"]) == ("closed", "settling")
    assert report["whole"] == 2
    assert report == run("rehearse", settled, *asked, "--json").json()
    assert "fell on the way" in run("rehearse", settled, *asked).out


def test_a_wall_that_falls_as_it_is_planned_is_a_failed_check(settled_copy, run):
    files = settled_copy / "blocks.json", settled_copy / "plan.json"
    blocks, plan = (json.loads(file.read_text()) for file in files)
    last = blocks["blocks"][-1]
    last["polygon"] = [[x, y + 50.0] for x, y in last["polygon"]]
    (step,) = (step for step in plan["steps"] if step.get("stone") == last["id"])
    step["centroid"][1] += 50.0
    for file, value in zip(files, (blocks, plan), strict=True):
        file.write_text(json.dumps(value))
    ran = run("rehearse", settled_copy, "--runs", 1)
    assert ran.code == 5
    assert f"stone {last['id']} falls even where it is planned" in ran.out
