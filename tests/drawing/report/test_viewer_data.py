"""The viewer's data against mechanics and geometry computed anew from the data alone."""

import base64
import io
import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import shapely
from PIL import Image

import drystone as ds
from drystone.contacts.given import model_from_json
from drystone.drawing import view_of_assembly, view_of_result, view_of_wall, write_report
from drystone.drawing.assembly import assembly_of_result, read_assembly
from drystone.drawing.palette import cluster_colour
from drystone.drawing.photo import VIEWER_PX, StonePhoto
from drystone.drawing.report.viewer_data import PATTERNS
from drystone.drawing.words.content import ResultCard, masons_words
from drystone.io.published import SETS
from drystone.kernels.polygons import turn
from drystone.model.plan import StoneStep
from drystone.statics.failing.mechanism import Names
from drystone.statics.limit import lateral_resistance
from tests.drawing.plans import analysed, planned
from tests.drawing.test_files import coordinates
from tests.polygons import box

CASES = [("best", None), ("paper", 100.0)]


@cache
def view(method="best", px_per_m=None):
    return view_of_result(planned(method, px_per_m))


def polygon(part):
    return shapely.Polygon(part["points"][0], part["points"][1:])


def unbalanced(shown, case, load):
    """Return the largest force and moment that is left on a block, in weights of the wall."""
    shapes = {part["id"]: polygon(part) for part in shown["parts"]}
    weight = sum(shape.area for shape in shapes.values())
    left = {i: np.array([load, -1.0, 0.0]) * shape.area / weight for i, shape in shapes.items()}
    for contact in shown["contacts"]:
        x, y = contact["normal"]
        for point, (n, t) in zip(contact["points"], contact["forces"][case], strict=True):
            fx, fy = n * x + t * y, n * y - t * x
            for block, sign in zip(contact["between"], (1.0, -1.0), strict=True):
                if block != 0:
                    along, up = np.array(point) - shapes[block].centroid.coords[0]
                    turning = (along * fy - up * fx) / max(shown["size"])
                    left[block] += sign * np.array([fx, fy, turning])
    return max(np.abs(one).max() for one in left.values())


def test_forces_are_in_equilibrium_with_weight_and_load():
    shown = view("best", 100.0)
    left, right = (shown["mechanisms"][side]["alpha"] for side in ("left", "right"))
    for case, load in (("left", -left), ("right", right), ("self", 0.0)):
        assert unbalanced(shown, case, load) < 2e-4
        for normal, along in np.concatenate([c["forces"][case] for c in shown["contacts"]]):
            assert abs(along) <= shown["mu"] * normal + 2e-6
    # The check sees a load that is not the one of the forces.
    assert unbalanced(shown, "right", 0.9 * right) > 2e-3


@pytest.mark.parametrize(("method", "px_per_m"), CASES)
def test_joints_do_what_the_velocities_say(method, px_per_m):
    shown = view(method, px_per_m)
    centres = {part["id"]: np.array(part["centroid"]) for part in shown["parts"]}

    def at(velocities, block, point):
        if block == 0 or str(block) not in velocities:
            return np.zeros(2)
        x, y, turning = velocities[str(block)]
        arm = point - centres[block]
        return np.array([x - turning * arm[1], y + turning * arm[0]])

    for side in ("left", "right"):
        velocities, seen = shown["mechanisms"][side]["velocity"], set()
        fastest = max(np.hypot(*v[:2]) for v in velocities.values())
        for contact in shown["contacts"]:
            x, y = contact["normal"]
            for place, kind in zip(contact["points"], contact["kinds"][side], strict=True):
                ours, theirs = (at(velocities, block, place) for block in contact["between"])
                opening, slip = (ours - theirs) @ [x, y], abs((ours - theirs) @ [y, -x])
                seen.add(kind)
                assert opening > -1e-3 * fastest
                if kind == "closed":
                    assert np.hypot(opening, slip) < 1e-3 * fastest
                if kind in ("sliding", "opening and sliding"):
                    assert slip > 5e-5 * fastest
                if kind in ("closed", "sliding"):
                    assert opening == pytest.approx(shown["mu"] * slip, abs=1e-3 * fastest)
        assert len(seen) > 1


@pytest.mark.parametrize(("method", "px_per_m"), CASES)
def test_parts_are_the_steps_of_the_plan(method, px_per_m):
    shown, plan = view(method, px_per_m), planned(method, px_per_m).plan
    assert (shown["unit"], shown["size"]) == (plan.length_unit, [plan.width, plan.height])
    assert [part["step"] for part in shown["parts"]] == [step.step for step in plan.steps]
    colours = {}
    for part, step in zip(shown["parts"], plan.steps, strict=True):
        assert polygon(part).is_valid
        assert part["neighbours"] == sorted(set(part["neighbours"]) - {part["id"]})
        if isinstance(step, StoneStep):
            assert part["id"] == step.stone
            assert part["angle_deg"] == pytest.approx(step.angle_deg, abs=6e-4)
            assert part["colour"] == cluster_colour(step.cluster)
            assert part["pattern"] in PATTERNS
            assert part["indices"] == pytest.approx(step.indices, abs=6e-5)
            colours.setdefault(part["cluster"], set()).add((part["colour"], part["pattern"]))
            # As it lies in the image, and turned by the angle: the same stone.
            lies = (np.array(part["source"]) - step.source_centroid) / (plan.px_per_m or 1.0)
            stands = shapely.Polygon(turn(lies, step.angle_deg) + step.centroid)
            assert stands.symmetric_difference(polygon(part)).area < 0.01 * stands.area
        else:
            assert part["words"].startswith(f"Push wedge {step.id} in under the ")
            holder = next(p for p in shown["parts"] if p["id"] == step.under)
            assert holder["wedges"] == [step.id]
            assert (part["number"], part["under"]) == (None, step.under)
    assert all(len(looks) == 1 for looks in colours.values())


def test_a_plan_in_memory_and_its_files_show_the_same(tmp_path):
    made = view("best", 100.0)
    text = json.dumps(view("paper"), allow_nan=False)
    assert json.loads(text) == view_of_result(planned("paper")) == view("paper")
    assert "-0.0," not in text
    assert len(text) < 60_000
    ds.write_plan_folder(planned("best", 100.0), tmp_path)
    read = view_of_assembly(read_assembly(tmp_path))
    for name in made.keys() - {"timings", "notices", "contacts", "mechanisms"}:
        ours, theirs = (sorted(v[name]) if name == "settings" else v[name] for v in (read, made))
        assert ours == theirs, name
    # Coordinates of blocks.json are rounded, so the solver may end elsewhere among equals.
    assert [c["between"] for c in read["contacts"]] == [c["between"] for c in made["contacts"]]
    for side in ("left", "right"):
        ours, theirs = (v["mechanisms"][side]["alpha"] for v in (read, made))
        assert ours == pytest.approx(theirs, abs=1e-4)


def test_a_plan_that_can_fall_when_it_is_let_go_does_not_stand():
    made = assembly_of_result(planned())
    metrics = replace(made.plan.metrics, F_LR_coulomb=0.0)
    shown = view_of_assembly(replace(made, plan=replace(made.plan, metrics=metrics)))
    assert shown["stands"] is False
    assert shown["summary"].endswith(" stones, does not stand: let go, it can fall.")


def test_what_is_not_planned_is_shown_too():
    labels = np.zeros((40, 60), np.uint32)
    labels[20:, 5:25], labels[20:, 25:45], labels[:20, 15:35] = 7, 9, 12
    cards = [ResultCard("F_AV", "Interlocking", "33.30 %", "higher", "words")]
    names = Names("stone", frozenset([12]))
    shown = analysed(labels, title="three <b>blocks</b>", cards=cards, names=names)
    assert shown["steps"] == 0
    assert shown["summary"].startswith("2 stones, stands; falls when tilted by 30 degrees; weakest")
    assert [(p["id"], p["kind"], p["number"]) for p in shown["parts"]] == [
        (7, "stone", 7), (9, "stone", 9), (12, "wedge", 12),
    ]  # fmt: skip
    assert shown["parts"][2]["neighbours"] == [7, 9]
    assert shown["parts"][0]["neighbours"] == [0, 9, 12]
    assert polygon(shown["parts"][0]).bounds == (5.0, 0.0, 25.0, 20.0)
    said = {card["name"]: card for card in shown["metrics"]}
    masons = "23.8 to 33.9 % in three walls of masons, of other stones"
    assert said["Interlocking"]["masons"] == masons
    # Blocks 20 by 20 rock when their load is above 1; friction lets them slide before.
    assert float(said["Lateral resistance"]["value"]) == pytest.approx(1.0, abs=1e-3)
    json.dumps(shown, allow_nan=False)
    # The same stones are said to be so.
    known = {file.name: file.sha256 for file in SETS["almeida"].files}
    for symbol, wall, words in (("F_AV", "PR", "29.5 %"), ("F_AV", "R", "33.9 %"),
                                ("F_AV", "IR", "23.8 %"), ("F_AH", "PR", "1.50 %")):  # fmt: skip
        same = f"{words} in the mason's own wall of these stones ({wall})"
        assert masons_words(symbol, known[f"almeida/{wall}.png"]) == same
    assert masons_words("F_LR", known["almeida/PR.png"]) is None


def test_a_wall_that_falls_has_a_mechanism_without_a_load(tmp_path):
    shown = analysed([[0, 0, 2, 1], [1.5, 1, 4, 1]], names=Names("block"), unit="units")
    found = shown["mechanisms"]["left"]
    assert (found["status"], found["alpha"]) == ("unstable", None)
    assert found["words"].startswith("It does not stand under its own weight. ")
    assert found["velocity"]["2"][1] < 0
    assert all(contact["forces"] == {} for contact in shown["contacts"])
    assert (shown["metrics"], shown["stands"]) == ([], False)
    Image.new("RGB", (2, 2)).save(tmp_path / "mechanism_left.png")
    page = write_report(tmp_path / "report.html", shown, pictures=tmp_path).read_text("utf-8")
    page = page.split("<script", 1)[0]
    assert "Horizontal load" not in page
    assert "not defined" not in page
    assert page.count('<p class="alarm">2 blocks, does not stand: block 2 ') == 1
    assert page.count("<figure>") == 1  # one fall, and no second picture of it
    assert "in units; 0 is the ground" in page
    assert "<td>block</td>" in page


@pytest.mark.parametrize(("load_case", "said", "horizontal"), [
    ("tilting table", "Horizontal load to the left", True),
    ("tilting table, tilted by 5°", "Load along the base to the left", True),
    ("growing with height", "Horizontal load to the left", True),
    ("point loads (1@0.5,2:1,0)", "Live load reversed", False),
])  # fmt: skip
def test_only_a_tilting_table_is_called_one(load_case, said, horizontal):
    shown = analysed([[0, 0, 1, 2]], unit="units", load_case=load_case)
    assert shown["mechanisms"]["left"]["load"] == said
    plain = load_case == "tilting table"
    assert ("as on a tilting table" in shown["assumptions"][-1]) == plain
    assert load_case in shown["assumptions"][-1]
    assert shown["dead_load"] == ("dead load" if "tilted" in load_case else "own weight")
    assert f"under {shown['dead_load']} alone" in shown["forces_words"]
    cards = {card["symbol"]: card["sentence"] for card in shown["metrics"]}
    assert ("F_LR" in cards) == horizontal
    assert ("whole wall would slide" in cards.get("F_LR", "")) == plain
    alpha = cards["\N{GREEK SMALL LETTER ALPHA} left"]
    assert ("share of the wall's weight" in alpha) == horizontal


def test_what_is_fixed_and_what_has_its_own_friction_is_said():
    wall = {1: box(0, 0, 4, 1), 2: box(0, 1, 4, 3), 3: box(0, 3, 4, 4)}
    own = {1: {"fixed": True}, 2: {"held": ["turn"]}, 3: {"density": 2.4}}
    blocks = [{"id": i, "polygon": wall[i].tolist(), **own[i]} for i in wall]
    owned = model_from_json({"blocks": blocks, "friction": [{"between": [2, 1], "mu": 0.4}]})
    said = view_of_wall(wall, owned, lateral_resistance(owned, mechanism=True))["assumptions"]
    assert said[-3:-1] == ["Fixed like the ground: 1.", "Held by guides: 2 (turn)."]
    assert "of their own" in said[-1]
    (weights,) = [one for one in said if "weight is" in one]
    assert weights.endswith("; their weight is their area times their density.")


@pytest.mark.parametrize("zoom", [0.5, 1])  # smaller and larger than VIEWER_PX
def test_crops_show_their_stone(tmp_path, zoom):
    photo = StonePhoto(coordinates(round(400 * zoom), round(300 * zoom)), 400.0, 300.0)
    squares = {5: box(40, 200, 120, 240), 9: box(300, 0, 400, 100), 11: box(500, 0, 600, 100)}
    crops = photo.viewer_crops(squares)
    assert sorted(crops) == [5, 9]  # the last one is outside
    for stone, crop in crops.items():
        data = crop["data"].removeprefix("data:image/jpeg;base64,")
        piece = np.asarray(Image.open(io.BytesIO(base64.b64decode(data))), float)
        assert np.abs(piece - photo.crop(crop["box"], VIEWER_PX)).max() < 8  # the code is lossy
        assert (crop["box"][:2] <= squares[stone][0]).all()
        assert (squares[stone][2] <= crop["box"][2:]).all()
    source = planned().plan.source
    Image.new("RGB", (source["width_px"], source["height_px"])).save(tmp_path / "photo.jpg")
    with_photo = view_of_result(planned(), photo=tmp_path / "photo.jpg")["parts"]
    for part in with_photo:  # wedges are in no picture
        assert (part["crop"] is None) == (part["kind"] == "wedge")
    assert all(part["crop"] is None for part in view()["parts"])
