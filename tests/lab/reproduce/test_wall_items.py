"""The items about the walls of §5.1 and §5.2, on small generated walls."""

from dataclasses import replace
from itertools import product
from statistics import median
from types import SimpleNamespace

import numpy as np
import pytest

from drystone.model.placement import Wedge
from drystone.model.site import Site
from drystone.model.wall import Group, Wall
from drystone.planner.profile import StepTime
from drystone_lab.reproduce import noise, other_stones, times, ways
from drystone_lab.reproduce.other_stones import Brick, bricks_of, courses_of, head_joints
from drystone_lab.runs.spec import generated
from drystone_lab.timed_walls import TimedWall
from drystone_lab.walls import NOISY, Target
from tests.lab.reproduce.small_walls import of, on, outcome, rows

SEEDS = (1, 2)
RUBBLE = Target(
    "rubble", generated("rubble", 5, count=6, width_px=80, height_px=30, courses=2), 80, 30, 1.0
)
UNEVEN = replace(RUBBLE, source=replace(RUBBLE.source, seed=13))  # beta changes its walls
SHARP = replace(RUBBLE, name="sharp", source=replace(RUBBLE.source, seed=8), number=5)


COMPARED = {
    "beta": (UNEVEN, "beta", "0.9", ("placement.beta", 0.9), [4]),
    "fig16": (RUBBLE, "sampling", "full", ("sampling", "full"), [4, 6]),
    "fig20": (RUBBLE, "stabilise", "wedge", ("stabilise.method", "wedge"), [1]),
    "fig21": (RUBBLE, "built", "two-sided", ("two_sided", True), [2, 5]),
}
"""Of items, and of the table of that name: wall, column and name of a way, its setting, panels."""


@pytest.fixture(scope="module")
def made(here):
    return {name: on(name, wall).make(here) for name, (wall, *_) in COMPARED.items()}


def _outcomes(here, *changes, target=RUBBLE):
    return list(here.run([target.run(seed, *changes) for seed in SEEDS]))


def _values(outcomes, figure="F_SF"):
    return [outcome.figures[figure] for outcome in outcomes]


@pytest.mark.parametrize("name", COMPARED)
def test_a_row_has_the_median_of_the_walls_of_its_way(made, here, name):
    wall, column, way, change, panels = COMPARED[name]
    (row,) = [row for row in rows(made[name], name) if row[column] == way]
    filled = median(_values(_outcomes(here, change, target=wall)))
    assert row["F_SF median"] == pytest.approx(filled, abs=1e-4)
    assert [len(picture.figure.axes) for picture in made[name].pictures] == panels


def test_pairs_are_of_one_seed(made, here):
    base, other = (
        _values(_outcomes(here, ("placement.beta", beta), target=UNEVEN)) for beta in (0.7, 0.9)
    )
    pair = next(row for row in rows(made["beta"], "beta_pairs") if row["other beta"] == "0.9")
    worse = sum(a < b - 1e-9 for a, b in zip(base, other, strict=True))
    assert (pair["figure"], pair["better"], pair["worse"]) == ("F_SF", 0, worse)
    assert 0 < worse < len(SEEDS) == worse + pair["equal"]


def test_sampling(made, here):
    table = {row["sampling"]: row for row in rows(made["fig16"], "fig16")}
    full = _outcomes(here, ("sampling", "full"))
    counts = _values(full, "candidates")
    # Each step of the full batch tries all stones that are left.
    stones, placed = (full[0].figures[name] for name in ("stones", "placed"))
    assert min(counts) >= sum(stones - step for step in range(placed))
    assert table["full"]["candidates median"] == median(counts)
    ratio = median(counts) / table["variant"]["candidates median"]
    claims = [row["here"] for row in rows(made["fig16"], "claims")]
    assert f"full {ratio:.2f}" in claims[0]
    kinds = 1 if full[0].plan["steps"] == full[1].plan["steps"] else 2
    assert f"its seeds give {kinds} different walls" in claims[-1]


def test_wedges(here):
    output = on("fig19", RUBBLE, SHARP, seeds=1).make(replace(here, seed=2))
    table = rows(output, "fig19")
    assert table
    for wall in (RUBBLE, SHARP):
        (outcome,) = here.run([wall.run(2)])
        mine = [row for row in table if row["wall"] == wall.number]
        assert len(mine) == outcome.figures["wedges"]
        area = sum(row["area, px2"] for row in mine)
        assert area == pytest.approx(outcome.figures["wedge_area"])
        built = outcome.wall(wall.run(2), None)
        heights = [(built.labels == wedge.id).any(axis=1).sum() for wedge in built.wedges]
        assert [row["height, px"] for row in mine] == heights


def test_the_largest_wedges_are_shown_once():
    wall = Wall.empty(Site(200, 40))
    # By column and size; the second largest is seen beside the largest.
    for number, (column, size) in enumerate(((10, 2), (100, 6), (110, 5), (60, 4), (190, 3)), 1):
        wedge = Wedge(number, 0, np.ones((size, size), bool), 20, column)
        wall = Wall(wall.site, wall.labels, (*wall.groups, Group(None, (wedge,))))
    assert [wedge.id for wedge in ways.shown(wall)] == [2, 4, 5]


def test_stabilisation(made, here):
    table = {row["stabilise"]: row for row in rows(made["fig20"], "fig20")}
    assert list(table) == ["both", "rotation", "wedge", "none"]
    assert table["rotation"]["wedges median"] == table["none"]["wedges median"] == 0
    wedged = _outcomes(here, ("stabilise.method", "wedge"))
    shares = [100 * area / (80 * 30) for area in _values(wedged, "wedge_area")]
    assert table["wedge"]["wedges % of wall median"] == pytest.approx(median(shares), abs=1e-4)
    (ax,) = made["fig20"].pictures[0].figure.axes
    assert ax.get_xlabel().startswith("rubble: ")
    points = {line.get_gid(): line.get_xydata() for line in ax.lines}
    assert np.allclose(points["group-wedge"], np.column_stack([shares, _values(wedged)]))
    best = max(table, key=lambda way: table[way]["F_SF median"])
    assert f"largest with {best}" in rows(made["fig20"], "claims")[0]["here"]


def test_all_methods(here):
    source = replace(RUBBLE.source, seed=7)  # two sides are used by every way
    wall = replace(RUBBLE, name="PR", source=source, width=RUBBLE.width + 0.5)
    output = on("figB30-32", wall, seeds=1).make(here)
    table = rows(output, "figB30_32")
    assert len(table) == 8
    for row in table:
        sampling, side = row["method"].split(", ")
        two_sided = [("two_sided", True)] if side == "two-sided" else []
        (outcome,) = here.run([wall.run(here.seed, ("sampling", sampling), *two_sided)])
        assert row["F_SF"] == pytest.approx(outcome.figures["F_SF"], abs=1e-4)
        assert row["placed"] == outcome.figures["placed"]
    assert [(one.name, len(one.figure.axes)) for one in output.pictures] == [("figB31", 8)]


def test_noise(here):
    walls = (replace(SHARP, number=number, stand_in=True) for number in (30, 80))
    output = on("fig22-24", *walls).make(here)
    levels = {(row["noise, %"], row["rule"]): row for row in rows(output, "levels")}
    assert list(levels) == list(product((30, 80), ("paper", "random")))
    walls = rows(output, "walls")
    filled = [r["F_SF"] for r in walls if (r["noise, %"], r["rule"]) == (30, "paper")]
    assert levels[30, "paper"]["F_SF median"] == pytest.approx(median(filled), abs=1e-4)
    assert all(row["F_SF above 0.6"] is (row["F_SF"] > 0.6) for row in walls)
    claims = {row["the paper"]: row for row in rows(output, "claims")}
    always = claims["Below 60 % noise F_SF is always above 0.6."]
    assert always["agrees"] is all(value > 0.6 for value in filled)
    assert rows(output, "reference") == []
    assert [picture.name for picture in output.pictures] == ["fig22", "fig23", "fig24"]


def test_orientations_and_gains_told_from_chance(here):
    output = on("fig25", RUBBLE, seeds=1).make(here)
    few, many = rows(output, "walls")
    assert (few["orientations"], many["orientations"]) == ("quarter", "10deg")
    claim = rows(output, "claims")[0]
    assert f"{many['F_SF'] - few['F_SF']:+.3f} in the median" in claim["here"]
    assert claim["agrees"] is None  # one pair tells nothing
    for gains, agrees in (([0.1] * 6, True), ([0.0] * 6, False), ([-0.1] * 6, False),
                          ([0.1] * 4, None), ([], None)):  # fmt: skip
        assert noise.gain_of("filling", gains).holds is agrees


def test_rounded_stones(here):
    assert [len(wall.here(None).source.stones(None)) for wall in other_stones.KINDS] == [100] * 4
    kinds = [replace(RUBBLE, name=f"{kind} px") for kind in ("round, 1", "round, 1 to 2")]
    few = [replace(wall, name=wall.name.replace("round", "elliptic")) for wall in kinds]
    output = on("fig26-27", *kinds, *few).make(here)
    assert [row["kind"] for row in rows(output, "kinds")] == [w.name for w in (*kinds, *few)]
    assert [row["agrees"] for row in rows(output, "claims")] == [None] * 4  # too few walls
    assert [picture.name for picture in output.pictures] == ["fig26", "fig27"]
    # More walls tell a difference.
    for firsts, count, holds in (((0.5, 0.6), 5, True), ((0.6, 0.5), 5, False),
                                 ((0.5, 0.6), 3, None)):  # fmt: skip
        walls = [
            SimpleNamespace(
                wall=SimpleNamespace(name=shape),
                outcomes=[outcome(F_SF=one + k / 100, F_AV=one + k / 100) for k in range(count)],
            )
            for shape in other_stones.SHAPES
            for one in firsts
        ]
        assert next(other_stones.rounded_findings(walls)).holds is holds


def test_variants(here):
    walls = (replace(RUBBLE, name="free"), replace(RUBBLE, name="framed", width=84))
    found = ways.named_variants(here, ((walls[0], ways.NAMED), (walls[1], {})), 2)
    free = [("free", *way) for way in ({"paper": ()} | ways.NAMED).items()]
    told = [(one.wall.name, one.way, spec.changes) for one in found for spec in one.specs]
    assert told == [one for one in (*free, ("framed", "paper", ())) for _ in range(2)]


def test_resolutions_stones_and_clusters(here):
    output = of("fig29", RUBBLE, (0.5, 1.0)).make(replace(here, quick=True))
    assert [row["wall, px"] for row in rows(output, "walls")] == ["40 x 15", "80 x 30"]
    assert [name for name, _ in output.times] == ["claims", "released", "pixels"]
    assert [picture.name for picture in output.pictures] == ["fig29", "fig29-time"]
    output = of("growth", ((8, 12), (0.1,))).make(replace(here, quick=True))
    found = rows(output, "walls")
    assert [(row["sampling"], row["Q"]) for row in found] == [
        ("variant", 8), ("variant", 12), ("full", 8), ("full", 12), ("variant", 12)
    ]  # fmt: skip
    # The full batch tries all that are left in every step.
    full = found[2]
    stones = sum(8 - step for step in range(full["placed"]))
    assert 2 * stones < full["candidates"] <= 4 * (stones + 8)


def test_steps_by_part():
    steps = [
        StepTime(n, 4, 0.01, {"placement": 0.006, "stabilisation": 0.0001, "contacts": 0.001 * n})
        for n in range(1, 9)
    ]
    assert times.late_over_early([1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 3.0, 3.0]) == 3.0
    assert sum(times.shares(times.procedure_seconds(steps)).values()) == pytest.approx(1.0)
    wall = TimedWall(Site(280, 80), 0.5, tuple(steps))
    found = times.step_findings({"variant": wall, "full": wall})
    assert [one.holds for one in found] == [True, True, True, True, False]


def test_the_times_of_the_authors(data_dir, tmp_path):
    assert times.released(tmp_path, "variant") is None
    for name, count in (("variant", 812), ("full", 2112), ("0.5", 812), ("2.0", 812)):
        found = times.released(data_dir, name)
        assert found[:2] == (32, count)
    steps = tuple(StepTime(n, 4, 0.01, {"placement": 0.005, "indices": 0.005}) for n in range(9))
    wall = TimedWall(Site(280, 80), 0.5, steps)
    theirs, ours = times.released_rows(data_dir, {"variant": wall})
    assert (*theirs[:4], theirs[-1]) == ("variant", "authors", 32, 812, 286)
    assert ours == ("variant", "ours", 9, 36, 0.09, 0.5, 0.0, 0.5, None)


def test_generated_stones_stand_in_for_published_ones_and_are_no_references(data_dir, tmp_path):
    counts = {wall.number: len(wall.source.stones(data_dir)) for wall in NOISY[1::3]}
    assert counts == {20: 23, 50: 27, 80: 18}
    for wall in NOISY[1::3]:
        assert wall.here(data_dir) is wall
        assert (wall.said, wall.width) == ("published", 0)
        made = wall.here(tmp_path)
        assert (made.name, made.number, made.scale) == (wall.name, wall.number, wall.scale)
        assert made.said == "generated: not in the data folder"
        stones = made.source.stones(None)
        assert stones.total_area_px / (made.width * made.height) == pytest.approx(0.696, abs=2e-3)
    wall = NOISY[1]
    assert noise.reference_of(wall.here(None), data_dir) is None
    assert noise.reference_of(wall, None) is None
    found = noise.reference_of(wall, data_dir).metrics
    assert found.stones == 23
    assert found.F_SF == pytest.approx(0.659, abs=5e-4)


def test_a_reference_is_measured_on_all_of_its_image_with_its_gaps_closed():
    labels = np.zeros((60, 120), np.uint32)  # a slab on two stones
    labels[40:, :40], labels[40:, 80:], labels[20:40] = 1, 2, 3
    found = noise.measured(labels, 0.5)
    assert found.metrics.stones == 3
    assert found.metrics.F_SF == pytest.approx((2 * 40 * 20 + 120 * 20) / (60 * 120))
    assert found.metrics.F_LR is not None
    assert found.resistances == pytest.approx([found.metrics.F_LR] * 4)
    labels[:40] = np.roll(labels[:40], -8, axis=0)  # and 8 px above them
    found = noise.measured(labels, 0.5)
    open_, _, twice, thrice = found.resistances
    assert open_ is twice is found.metrics.F_LR is None
    assert thrice is not None


def course(foot, *lefts, width=20, height=10):
    return [Brick(left, left + width, foot, foot + height, True) for left in lefts]


def test_a_running_bond_is_crossed_and_bricks_out_of_line_are_in_no_course():
    low, stack = course(0, 0, 20, 40), course(10, 0, 20, 40)
    assert courses_of(low + stack, 10, 20).joints == 4
    # Joints of four px apart are not crossed, of five they are.
    for upper, crossed in ((stack, 0), (course(10, 10, 30, 50), 4), (course(10, 4, 24), 1),
                           (course(10, 5, 25), 3)):  # fmt: skip
        assert courses_of(low + upper, 10, 20).crossed == crossed
    upright, turned = Brick(0, 10, 0, 20, True), Brick(30, 50, 0, 10, False)
    found = courses_of([upright, turned, *course(3, 60), *course(10, 80)], 10, 20)
    assert (found.lying, found.in_course, found.courses) == (2, 1, 1)
    assert found.joints == 0
    # A hole is no joint, and the last course needs a brick beside its joints.
    assert head_joints(course(0, 0, 24, 64)) == [22.0]
    assert courses_of(course(0, 0, 20), 10, 20).joints == 0


def test_planned_bricks_are_read_off_their_wall(here):
    output = of("figB34", (72, 2)).make(here)
    found = rows(output, "walls")
    ways = [(row["built from"], row["aspect"]) for row in found]
    assert ways == list(product(("one side", "two sides"), (2.0, 3.0)))
    assert [run.width for run in output.runs] == [72, 72, 72, 72]
    # Runs have one aspect after the other, rows one side.
    for run, row in zip(output.runs, (found[0], found[2], found[1], found[3]), strict=True):
        wall = here.wall(run)
        boxes = bricks_of(wall)
        assert row["placed"] == row["lying"] == len(boxes) == 144 // (12 * row["aspect"])
        for box, placement in zip(boxes, wall.placements, strict=True):
            pixels = wall.labels[::-1] == placement.stone_id
            assert pixels[box.bottom : box.top, box.left : box.right].all()
            assert pixels.sum() == (box.top - box.bottom) * (box.right - box.left)
    colours = [
        {patch.get_facecolor() for patch in ax.patches if str(patch.get_gid()).startswith("stone")}
        for ax in output.pictures[0].figure.axes
    ]
    assert [len(each) for each in colours] == [6, 4, 6, 4]
