"""`drystone analyse`: the card, loads, contacts, gaps, scatter, failures."""

import csv
import hashlib
import json
import re
from dataclasses import replace

import numpy as np
import pytest

from drystone.cli.commands import analyse
from drystone.drawing.report import analysis
from drystone.io.wall_image import write_labels
from drystone.model.builder import HAND, BuilderErrors
from drystone.statics.lp.program import EquilibriumProgram
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from drystone_lab.statics_cases import WALLS
from tests.cli.conftest import contents, keys, listed
from tests.io import labelled
from tests.polygons import box_of as box
from tests.statics.walls import coursed


def written(path, *outlines, **content):
    """Write a block model of outlines, numbered from 1, or of something else."""
    blocks = [{"id": i, "polygon": corners} for i, corners in enumerate(outlines, start=1)]
    content = {"mu": 0.58} | ({"blocks": blocks} if outlines else {}) | content
    path.write_text(json.dumps(content, default=np.ndarray.tolist), encoding="utf-8")
    return path


@pytest.fixture
def tower(tmp_path):
    """A block 1 x 4, mu .58: it rocks at .25."""
    return written(tmp_path / "tower.json", box(0, 0, 1, 4))


def shown(folder):
    """What the report of an analysis holds."""
    report = (folder / "report.html").read_text(encoding="utf-8")
    return json.loads(report.split('type="application/json"')[1].split(">", 1)[1].split("<")[0])


def test_the_card_and_json_say_what_an_engineer_quotes(tower, run):
    said = run("analyse", tower).out
    for words in (
        "load to the left", "alpha = 0.2500", "without dilatancy", "adequacy factor",
        "Rocking of block 1 about its right toe.", "d alpha / d mu = 0.000", "no tension",
        "tilted by 14.0 degrees", "equilibrium to", "HiGHS simplex",
        hashlib.sha256(tower.read_bytes()).hexdigest()[:16],
    ):  # fmt: skip
        assert words in said
    report = run("analyse", tower, "--json").json()
    assert report["nonassociative"]["alpha_left"] == pytest.approx(0.25)
    assert report["nonassociative"]["status_right"] == "optimal"
    assert report["certificate"]["gap_left"] <= 1e-8
    assert report["sensitivity"] == pytest.approx({"left": 0, "right": 0}, abs=1e-9)
    assert "Rocking" in report["words"]["left"]
    assert report["joints"]["left"] == {"opening": [[1, 0]], "sliding": []}
    left_out = run("analyse", tower, "--json", "--associative-only").json()
    assert left_out["nonassociative"] is None
    one_way = run("analyse", tower, "--json", "--load", "gravity").json()
    found = keys(report, "certificate") | keys(one_way, "certificate") | {"scatter"}
    assert found | {"gaps", "chosen_px", "stands_from_px", "steady", "tried"} == listed("analyse")


def test_each_direction_has_its_own_lines(tmp_path, run):
    """An upper block shifted to the right falls there first."""
    path = written(tmp_path / "shifted.json", box(0, 0, 1, 1), box(0.2, 1, 1, 1), mu=0.9)
    said = run("analyse", path).out
    assert "tilted by 21.8 degrees" in said  # atan .4, of the weaker side
    assert "tilted by" not in run("analyse", path, "--load", "height").out
    left, right = said.split("load to the left")[1].split("load to the right")
    assert ("0.6000" in left.splitlines()[0], "left toe" in left) == (True, True)
    assert ("0.4000" in right.splitlines()[0], "right toe" in right) == (True, True)
    ranged = run("analyse", path, "--mu", ".2:.4", "--scatter", "3", "--json").json()
    assert ranged["mu"] == pytest.approx(0.3)  # the middle of the range


def test_loads(tower, tmp_path, run):
    angle = np.radians(5)
    rest, tilted = 0.25 * np.cos(angle), np.sin(angle)
    for options, alphas in (
        ("--tilt 5", (rest + tilted, rest - tilted)),
        ("--load height", (0.25, 0.25)),
        ("--dead 1@0.5,4:0,-2", (0.375, 0.375)),
        ("--load points --live 1@0,3:1,0", (2 / 3, 2 / 3)),
    ):
        asked = ("--json", "--associative-only", *options.split())
        report = run("analyse", tower, *asked).json()
        assert (report["alpha_left"], report["alpha_right"]) == pytest.approx(alphas)
    run("analyse", tower, "--dead", "1@0.5,4:0,-2", "-o", tmp_path / "out")
    assert "carries 0.375 times its own weight sideways" in shown(tmp_path / "out")["summary"]
    # Forces at points go as they are given, which is told first, and have no F_LR.
    asked = ("analyse", tower, "--load", "points", "--live", "1@1,4:1,-1", "--associative-only")
    said = run(*asked).out
    assert 0 < said.index("load as given") < said.index("load reversed")
    assert ("F_LR" in said, run(*asked, "--json").json()["F_LR"]) == (False, None)
    # One that no load brings down stands.
    ran = run("analyse", tower, "--load", "points", "--live", "1@0,3:0,-1", "--associative-only")
    assert (ran.code, ran.out.count("stands\n")) == (0, 1)
    assert ("unbounded" in ran.out, "W302" in ran.err) == (True, False)


def test_a_new_analysis_leaves_nothing_of_the_one_before_unless_it_is_refused(tower, run, tmp_path):
    out = tmp_path / "out"
    asked = ("analyse", tower, "--associative-only", "-o", out, "--overwrite")
    ran = run(*asked, "--scatter", "2", "--mu", ".4:.8", "--jobs", "2")
    assert (ran.code, "2 walls, seed 0, mu 0.4 to 0.8" in ran.out) == (0, True)
    before = contents(out)
    assert "scatter.png" in before
    assert run(*asked, "--dead", "9@0,0:1,0").code == 3
    assert contents(out) == before
    assert run(*asked, "--load", "gravity", "--dead", "1@0,3:.5,0").code == 0
    left = {path.name for path in out.iterdir()}
    assert not left & {"scatter.png", "friction.png", "report.html", "blocks.csv", "contacts.csv"}


def test_what_stands_only_by_friction_on_upright_faces_is_named(tmp_path, run):
    """A brick, 3, between two piers."""
    boxes = box(0, 0, 1, 4), box(2, 0, 1, 4), box(1, 1.5, 1, 1)
    jammed, out = written(tmp_path / "jammed.json", *boxes), tmp_path / "out"
    ran = run("analyse", jammed, "-o", out)
    assert (ran.code, "falls on a table" in ran.out) == (5, False)
    named = "stands only by friction on upright faces: block 3; let go, it can fall"
    for said in (
        f"own weight           {named}\n",
        "  without dilatancy  unstable: There are forces with which",
        "Falls by itself: block 3 slides along 1 and 2.",
    ):
        assert said in ran.out
    assert named in (out / "report.html").read_text(encoding="utf-8")
    for load in ("tilting", "height"):
        assert run("analyse", jammed, "-o", out, "--overwrite", "--load", load).code == 5
        report, falls = shown(out), "3 blocks, does not stand: let go, it can fall; block 3 slides"
        assert (report["stands"], report["summary"]) == (False, f"{falls} along 1 and 2.")
    found = run("analyse", jammed, "--json").json()
    assert (found["held_by_upright_faces"], found["status_left"]) == ([3], "optimal")
    for side in ("left", "right"):
        assert found["nonassociative"][f"status_{side}"] == "unstable"
        assert found["nonassociative"][f"alpha_{side}"] is None


def test_contacts_from_outlines(tmp_path, run):
    write_labels(coursed(3, 4, 90), tmp_path / "wall.png")
    asked = ("analyse", tmp_path / "wall.png", "--json")
    pixels = run(*asked).json()
    outlines = run(*asked, "--contacts", "outlines").json()
    assert outlines["F_LR"] == pytest.approx(pixels["F_LR"], rel=0.02)
    assert outlines["remarks"]["contacts"].startswith("from sub-pixel outlines, set back; F_LR 0.")
    # F_LR with other contacts would be of another friction or other loads.
    for more in ("--mu-head", "0.1"), ("--tilt", "5"):
        other = run(*asked, "--contacts", "outlines", "--associative-only", *more).json()
        assert other["remarks"]["contacts"] == "from sub-pixel outlines, set back"


def test_noise_is_told_with_its_unit(tmp_path, tower, settled, metric, run):
    """Bricks of 60 x 20 px, and the errors that walls are rehearsed with."""
    labels, wall = coursed(3, 3, 60), tmp_path / "wall.png"
    write_labels(labels, wall)
    asked = ("--associative-only", "--scatter", 2)
    noise = ("--outline-noise", ".2", "--placement-noise", ".02")
    said = "outlines +- 0.2 px, placement +- 0.02 px"
    assert said in run("analyse", wall, *asked, *noise).out
    said = "outlines +- 0.2 lengths of the block model"
    assert said in run("analyse", tower, *asked, *noise).out
    sizes = [np.sqrt((labels == i).sum()) for i in np.unique(labels)[1:]]
    errors = BuilderErrors.of_precision(HAND, float(np.mean(sizes)))
    told = re.findall(r"\+- (\S+) px", run("analyse", wall, *asked, "--precision", "3%").out)
    assert list(map(float, told)) == pytest.approx([errors.outline, errors.placement], rel=0.02)
    assert run("analyse", wall, *asked, "--precision", "3").code == 2
    # A footing is no stone.
    footing = {"id": 1, "polygon": box(0, 0, 9, 9), "fixed": True}
    blocks = [footing, {"id": 2, "polygon": box(4, 9, 1, 1)}]
    footed = written(tmp_path / "footed.json", blocks=blocks)
    assert "placement +- 0.03 lengths" in run("analyse", footed, *asked, "--precision", "3%").out
    # The model of a plan in metres is in metres, noise in px of its source.
    asked, found = ("--associative-only", "--scatter", "8", "--placement-noise", "2"), []
    for folder in (settled, metric):
        assert "placement +- 2 px" in run("analyse", folder, *asked).out
        found.append(run("analyse", folder, *asked, "--json").json()["scatter"]["alpha_left"])
    assert found[1] == pytest.approx(found[0], rel=1e-3)
    assert max(found[0]) - min(found[0]) > 0.01


def test_a_failed_solve_is_saved_for_a_report(tower, tmp_path, run, monkeypatch):
    def failing(model, *_, **__):
        left, right = (LimitResult(LimitStatus.FAILED, d) for d in ("left", "right"))
        return LateralResistance(left, right, model.mu)

    monkeypatch.setattr(analyse, "lateral_resistance", failing)
    ran = run("analyse", tower, "--associative-only", "-o", tmp_path / "out")
    assert (ran.code, "E140" in ran.err) == (5, True)
    assert EquilibriumProgram.load(tmp_path / "out" / "drystone-failed.npz").block_ids == (1,)


def test_tables_have_every_contact_point_and_block(tmp_path, run):
    wall, folder = tmp_path / "wall.png", tmp_path / "out"
    write_labels(np.kron([[0, 3, 3, 0], [1, 1, 2, 2]], np.ones((10, 10))).astype(np.uint32), wall)
    report = run("analyse", wall, "-o", folder, "--json", "--ruler", "0,0,40,0=2m").json()
    contacts, rows = (
        list(csv.DictReader((folder / f"{name}.csv").read_text("utf-8").splitlines()))
        for name in ("contacts", "blocks")
    )
    blocks = {int(row["block"]): row for row in rows}
    assert len(contacts) == report["contacts"]
    for name, value in (("x_m", 1.0), ("y_m", 0.75), ("area_m2", 0.5)):
        assert float(blocks[3][name]) == pytest.approx(value)
    assert sum(float(row["share_of_weight"]) for row in rows) == pytest.approx(1)
    # What the ground carries upwards is the whole weight, and sideways alpha times it.
    ground = [row for row in contacts if row["other"] == "0"]
    for side, sign in (("left", -1.0), ("right", 1.0)):
        up = sum(float(row[f"normal_force_{side}"]) for row in ground)
        along = sum(float(row[f"tangential_force_{side}"]) for row in ground)
        assert up == pytest.approx(1)
        assert along == pytest.approx(-sign * report[f"alpha_{side}"])
    assert (folder / "friction.png").is_file()


def test_what_is_loose_without_dilatancy_is_named(tmp_path, tower, run):
    """Example 3 of Ferris and Tin-Loi fails at .3558 instead of .4037; a tall block does not."""
    rectangles = [list(row) for row in WALLS[2].rectangles]
    wall, out = written(tmp_path / "3.json", blocks_xywh=rectangles, mu=0.65), tmp_path / "out"
    said = run("analyse", wall, "-o", out).out
    assert ("alpha = 0.3558" in said, "moving then" in said) == (True, True)
    # With dilatancy it would be block 10 or, as both sides are the same, 13.
    assert re.search(r"weakest place: block [14]\.$", shown(out)["summary"])
    assert "moving then" not in run("analyse", tower).out


def test_cases_that_are_ranges(tower, tmp_path, run, monkeypatch):
    supports = [{"id": i, "polygon": box(x, 0, 1, 1), "fixed": True} for i, x in ((1, 0), (2, 3))]
    beam = [*supports, {"id": 3, "polygon": box(0, 1, 4, 1)}]
    bridge, out = written(tmp_path / "bridge.json", blocks=beam), tmp_path / "out"
    drawn, save = [], analysis.save
    monkeypatch.setattr(analysis, "save", lambda of, to: (drawn.append(of), save(of, to)))
    ran = run("analyse", bridge, "--settle", "2", "-o", out)
    # The support is none of the weight of the wall, which is one block.
    scales = [text.get_text() for figure in drawn for text in figure.axes[0].texts]
    assert "0.2 \u00d7 the mean weight of a block = 20 % of the wall's weight" in scales
    for said in (
        "settlement of block 2",
        "Shifting of block 2 along 3; block 3 rocks about its right toe, on 1.",
        "forces and mechanism give the same alpha",
    ):
        assert said in ran.out
    assert (out / "mechanism_left.png").exists()
    report = run("analyse", bridge, "--json", "--settle", "2").json()
    assert report["alpha_least"] == pytest.approx(1 / 3)
    assert report["certificate"]["gap_least"] <= 1e-8
    assert report["sha256"] == hashlib.sha256(bridge.read_bytes()).hexdigest()
    light = run("analyse", tower, "--json", "--load", "gravity", "--dead", "1@0,3:.5,0").json()
    assert light["alpha_least"] == pytest.approx(0.75)
    assert (light["alpha_greatest"], light["status_greatest"]) == (None, "unbounded")
    # A multiplier of nothing has no sign.
    found = analyse.load_range

    def just_below(*given, **named):
        ends = found(*given, **named)
        return replace(ends, least=replace(ends.least, alpha=-1e-17))

    monkeypatch.setattr(analyse, "load_range", just_below)
    assert "least alpha     alpha = 0.0000  load" in run("analyse", tower, "--load", "gravity").out


@pytest.mark.parametrize(
    ("shapes", "why"),
    [
        ([box(0, 10, 2, 1)], "nothing touches y = 0: the lowest block is at y = 10"),
        ([box(0, 0, 2, 1), box(0, 2, 2, 1)], "block 2 has nothing below that stands"),
        ([box(0, 0, 1, 1), box(0.8, 1, 1, 1)], "falls by itself: block 2 rocks and slides on 1"),
    ],
)
def test_what_does_not_stand_is_told_why_in_one_sentence(tmp_path, run, shapes, why):
    """On the card, in JSON, and where the report begins, which has no results then."""
    path = written(tmp_path / "falls.json", *shapes)
    ran, folder = run("analyse", path), tmp_path / "out"
    assert (ran.code, f"does not stand: {why}" in ran.out) == (5, True), ran.out
    assert ("W302" in ran.err) == ("below" in why or "y = 0" in why)
    told = run("analyse", path, "--json", "-o", folder).json()
    assert not told["stands"]
    assert why in told["why"][0].lower() + told["why"][1:]
    report = shown(folder)
    assert (report["metrics"], report["stands"]) == ([], False)
    assert report["summary"].endswith(f", does not stand: {why.removeprefix('falls by itself: ')}.")
    alarm = f'<p class="alarm">{report["summary"]}</p>'
    assert alarm in (folder / "report.html").read_text(encoding="utf-8")


def test_gaps_are_looked_for_and_closed_and_that_is_said(tmp_path, run):
    """Two courses of three stones 20 x 10 px, with joints of 2 px."""
    labels, wall = np.zeros((22, 64), np.uint32), tmp_path / "wall.png"
    for stone, (row, left) in enumerate(((12, 0), (12, 22), (12, 44), (0, 11), (0, 33)), start=1):
        labels[row : row + 10, left : left + 20] = stone
    write_labels(labels, wall)
    bare = run("analyse", wall)
    assert (bare.code, "--close-gaps auto looks" in bare.err) == (5, True)
    told = run("analyse", wall, "--close-gaps", "auto", "--json").json()
    found = told["gaps"]
    chosen = found["chosen_px"]
    assert (told["stands"], found["steady"], found["stands_from_px"]) == (True, True, chosen)
    assert f"the same again: --close-gaps {chosen}px" in told["remarks"]["gaps"]
    assert [one["px"] for one in found["tried"] if not one["stands"]] == list(range(chosen))
    again = run("analyse", wall, "--close-gaps", f"{chosen}px", "--json").json()
    assert again["F_LR"] == told["F_LR"]
    # The friction of head joints, and the spread of F_LR with it, is that of the options.
    asked = ("analyse", wall, "--mu-head", "0", "--close-gaps", "2")
    closed = run(*asked, "--json").json()
    assert closed["F_LR"] > 0.5
    assert closed["remarks"]["head joints"] == "friction 0"
    said = f"F_LR {closed['F_LR']:.3f}".replace("0.", ".")
    assert closed["remarks"]["gaps"].startswith(said)
    assert "gaps up to 2 px closed" in closed["remarks"]["gaps"]
    settled = (*asked[:2], "--close-gaps", "settle")
    assert " 2 stones lowered by up to 2 px" in run(*settled).out
    labels[labels == 5] = 0
    write_labels(labels, wall)
    assert " 1 stone lowered by up to 2 px" in run(*settled).out
    labels[0:10, 33:53] = 5
    write_labels(labels, wall)
    one_way = ("--px-per-m", "100", "--load", "gravity", "--dead", "1@10,5:1,0")
    lines = run(*asked, *one_way).out
    assert all(f"\n{name} " in lines for name in ("friction", "gaps", "head joints", "size"))


@pytest.mark.parametrize("deep", [0.05, 0.2, 2.0])
def test_drawn_stones_that_lie_in_each_other_are_named(tmp_path, run, deep):
    """By no more than a tenth of a pixel they bear; else it is said why they do not."""
    boxes = box(20, 150, 100, 50), box(40, 100 + deep, 50, 50)
    path = labelled.written(tmp_path, "labelme", [("stone", one.tolist()) for one in boxes])
    ran = run("analyse", path, "--associative-only")
    assert (ran.code, "W308" in ran.err) == ((0, False) if deep < 0.1 else (5, True))
    assert (f"1 and 2 by {deep:.2g} px" in ran.err) == (deep > 0.1)
    assert run("analyse", path, "--close-gaps", "auto", "--associative-only").code == 0


def test_a_stone_in_the_air_stays_there_whatever_gaps_are_closed(tmp_path, run):
    labels, wall = np.zeros((90, 60), np.uint32), tmp_path / "air.png"
    labels[60:, :30], labels[60:, 30:], labels[:20, 10:50] = 1, 2, 3
    write_labels(labels, wall)
    ran = run("analyse", wall, "--close-gaps", "auto")
    assert (ran.code, "does not stand with gaps up to" in ran.out) == (5, True)
    assert "does not stand: stone 3 has nothing below that stands" in ran.out
    assert "--close-gaps auto" not in ran.err  # never in a circle
    assert "leave them out with --skip" in ran.err
    assert run("analyse", wall, "--skip", 3, "--associative-only").code == 0


def test_the_report_holds_the_card_and_needs_nothing_else(tmp_path, run):
    """Two stones on the ground, one on both, and one that floats 3 px above it."""
    labels, wall, folder = np.zeros((43, 60), np.uint32), tmp_path / "drawn.png", tmp_path / "out"
    labels[31:, :30], labels[31:, 30:], labels[19:31, 15:45], labels[4:16, 15:45] = 1, 2, 3, 4
    write_labels(labels, wall)
    ran = run("analyse", wall, "--px-per-m", "200", "--load", "tilt", "--mu", "0.6")
    assert "W305 1 stone has fewer than two contact points: 4. The narrowest gap" in ran.err
    assert ("3 px (15 mm)" in ran.err, "--close-gaps auto" in ran.err) == (True, True)
    assert ("does not stand" in ran.out, "0.3 m wide, 0.195 m high" in ran.out) == (True, True)
    dead = ("--dead", "3@30,20:0,-2")
    asked = ("analyse", wall, "--close-gaps", "3px", "--px-per-m", "200", *dead, "-o", folder)
    closed = run(*asked)
    assert ("own weight           stands" in closed.out, "W305" in closed.err) == (True, False)
    report = shown(folder)
    rows = dict(report["inputs"])
    assert (report["unit"], [part["id"] for part in report["parts"]]) == ("m", [1, 2, 3, 4])
    assert rows["own weight"] == "stands"
    assert rows["load case"] == "tilting table, dead forces (3@30,20:0,-2)"
    assert rows["with mu = 0.4"].startswith("load multipliers: to the left 0.")
    assert hashlib.sha256(wall.read_bytes()).hexdigest() in rows["cite"]
    text = (folder / "report.html").read_text(encoding="utf-8")
    assert "://" not in text.replace("http://www.w3.org/", "")
    assert ("tilted by" in closed.out, "E129" in run(*asked).err) == (False, True)


def test_friction_of_blocks_that_do_not_touch_is_named(tmp_path, run):
    pairs = [{"between": pair, "mu": 0.4} for pair in ([1, 0], [2, 1], [0, 2])]
    path = written(tmp_path / "b.json", box(0, 0, 1, 1), box(0, 1, 1, 1), friction=pairs)
    said = run("analyse", path).err
    assert "W306 blocks do not touch, so their friction is left aside: 0 and 2. Correct" in said


@pytest.fixture
def drawn(monkeypatch):
    """Figures that an analysis draws, which are not written."""
    figures = []
    monkeypatch.setattr(analysis, "save", lambda figure, _: figures.append(figure))
    monkeypatch.setattr(analysis, "save_mechanism_animation", lambda *_, **__: None)
    monkeypatch.setattr(analysis, "write_report", lambda *_, **__: None)
    return figures


def test_pictures_say_which_way_forces_at_points_go(tower, tmp_path, run, drawn):
    asked = ("--associative-only", "--load", "points", "--live", "1@1,4:1,0")
    run("analyse", tower, *asked, "-o", tmp_path / "out")
    said = [text.get_text() for figure in drawn for text in figure.axes[0].texts]
    for way in ("as given", "reversed"):
        assert way in drawn[-1].axes[0].get_legend_handles_labels()[1]
        assert f"point loads {way}, $\\alpha$ = 0.500" in said


@pytest.mark.parametrize(("friction", "own", "f_lr"), [
    ({}, None, 1.0),
    ({(2, 1): 0.2}, "1 of 2 joints, mu = 0.2", 1.0),
    ({(1, 0): 0.2}, "1 of 2 joints, mu = 0.2", 1.0),
    ({(2, 1): 0.2, (1, 0): 0.45}, "2 of 2 joints, mu = 0.2 to 0.45", None),
])  # fmt: skip
def test_friction_of_their_own_is_said_and_that_no_joint_takes_an_option(
    tmp_path, run, drawn, friction, own, f_lr
):
    """Two beds without a head joint.  The whole wall slides at mu where the ground has no other."""
    pairs = [{"between": between, "mu": mu} for between, mu in friction.items()]
    path = written(tmp_path / "own.json", box(0, 0, 4, 1), box(0, 1, 4, 1), friction=pairs)
    asked = ("analyse", path, "--associative-only", "--mu", "0.1")
    ran = run(*asked, "--mu-head", "0.3", "--json", "-o", tmp_path / "out")
    idle = "--mu-head or --mu" if f_lr is None else "--mu-head"
    assert f"W309 no joint takes its friction from {idle}. Joints keep" in ran.err
    told = ran.json()
    assert told["remarks"] == ({"own friction": own} if own else {})
    assert told["F_LR"] == (f_lr and pytest.approx(told["alpha_left"] / 0.1))
    (axes,) = (one for figure in drawn for one in figure.axes if one.get_ylabel())
    sliding = "the whole wall slides" in axes.get_legend_handles_labels()[1]
    assert sliding == ((1, 0) not in friction)
    ran = run(*asked)
    assert (("not defined: every joint has" in ran.out), "W309" in ran.err) == (f_lr is None,) * 2
    assert "W309" not in run(*asked[:3]).err
    ran = run(*asked[:3], "--mu", ".3:.9", "--scatter", "2")
    assert ("E138 --mu: samples would not differ" in ran.err) == (f_lr is None)


def test_forces_far_from_their_block_are_named_with_the_unit_of_points(tmp_path, run):
    """The same wall in px, in metres that are read as px, and as a block model in metres."""
    labels, picture = np.ones((60, 80), np.uint32), tmp_path / "wall.png"
    labels[:20, :40], labels[:20, 40:] = 2, 0
    write_labels(labels, picture)
    shapes = box(0, 0, 8, 4), box(0, 4, 4, 2)
    drawn = labelled.written(tmp_path, "dxf", [("s", one * (1000, -1000)) for one in shapes])
    model = written(tmp_path / "wall.json", *shapes)
    to_scale = ("--px-per-m", 10)
    for path, more, box_at, unit in (
        (picture, (), "stone 2: x 0 to 40, y 40 to 60", "px, y up"),
        (drawn, to_scale, "stone 2: x 0 to 40, y 40 to 60", "px, 10 to a metre, y up"),
        (model, (), "block 2: x 0 to 4, y 4 to 6", "lengths of the block model, y up"),
    ):
        size = 4 if path == model else 40
        for x, far in ((size, False), (1.05 * size, False), (1.1 * size, True), (size / 9, True)):
            y = size if x > size / 2 else 11 * size
            ran = run(
                "analyse", path, *more, "--associative-only", "--load", "points",
                "--live", f"2@{x:g},{y:g}:1,0",
            )  # fmt: skip
            said = (
                f"W310 forces act far from their blocks: 2@{x:g},{y:g} ({box_at}). Give points in"
            )
            assert (f"{said} {unit}" in ran.err, "W310" in ran.err) == (far, far), ran.err


@pytest.mark.parametrize("command", ["analyse", "craft"])
def test_keys_that_a_block_model_does_not_have_are_named(command, settled, tmp_path, run):
    odd = {"densty": 9, "name": "a"}, {"densty": 9, "Fixed": True}
    blocks = [{"id": 1 + i, "polygon": box(2 * i, 0, 1, 1)} | one for i, one in enumerate(odd)]
    pair = {"between": [1, 0], "mu": 0.4, "nu": 1}
    more = {"mue": 0.9, "comment": 1, "_mine": 2, "friction": [pair], "blocks": blocks}
    said = run(command, written(tmp_path / "b.json", **more)).err
    assert said.count("W307") == 1
    assert (
        "keys that a block model does not have: 'mue', 'densty' (blocks, entry 1), 'Fixed' (blocks,"
        " entry 2), 'nu' (friction, entry 1). Did you mean `mu`? Did you mean `density`?"
    ) in " ".join(said.split())
    said = run(command, written(tmp_path / "c.json", box(0, 0, 1, 1), rho=1)).err
    assert "does not have: 'rho'. Keys of your own: comment, meta, name, or _KEY." in said
    said = run(command, written(tmp_path / "d.json", box(0, 0, 1, 1), px_per_m=100)).err
    assert "does not have: 'px_per_m'. `drystone analyse --px-per-m` takes units in" in said
    assert "W307" not in run(command, settled / "blocks.json").err


def test_the_friction_of_head_joints_in_the_options_wins_over_that_of_the_file(tmp_path, run):
    pair = box(0, 0, 1, 2), box(1, 0, 1, 2)
    model = written(tmp_path / "pair.json", *pair, mu=0.9, mu_head=0.9)
    asked = ("analyse", model, "--json", "--associative-only")
    oiled, given = run(*asked, "--mu-head", "0").json(), run(*asked).json()
    assert oiled["alpha_right"] < given["alpha_right"] - 1e-3


def test_the_order_in_which_a_file_has_blocks_and_joints_changes_nothing(settled, tmp_path, run):
    """Without dilatancy the search would go another way."""
    content = json.loads((settled / "blocks.json").read_text())
    turned = {**content, **{key: content[key][::-1] for key in ("blocks", "interfaces")}}
    assert turned != content
    model = tmp_path / "turned.json"
    model.write_text(json.dumps(turned))
    given, other = (
        run("analyse", path, "--json").json() for path in (settled / "blocks.json", model)
    )
    assert other["nonassociative"] == given["nonassociative"]
    assert other["joints"] == given["joints"]
