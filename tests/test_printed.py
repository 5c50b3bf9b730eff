"""What a result looks like in a session: a line that says what it is, not its arrays."""

import drystone as ds
from drystone.errors import InputError, Notice
from drystone.model.plan import PlanMetrics
from drystone.model.stone import Source
from tests.planner.scenes import RUBBLE_SITE, rubble
from tests.statics.walls import brick_model


def test_stones_say_how_many_and_how_large():
    one, two = (ds.Stone(i, [[True] * 4] * i, name="a.png" * (i - 1)) for i in (1, 2))
    assert repr(one) == "<Stone 1: 4 x 1 px, area 4 px²>"
    assert repr(two) == "<Stone 2 (a.png): 4 x 2 px, area 8 px²>"
    assert repr(ds.StoneSet((one, two))) == "<StoneSet: 2 stones, area 12 px²>"
    read = ds.StoneSet((one,), Source("pile.png"), (Notice("W110", "odd."),))
    assert repr(read) == "<StoneSet of pile.png: 1 stones, area 4 px², 1 notices>"


def test_a_result_says_how_it_ended_and_its_figures():
    result = ds.plan_wall(rubble(), 100, 36, scale=1.0, seed=1, budget=1)
    stones, wedges = len(result.plan.stone_steps), len(result.wall.wedges)
    figures = str(result.metrics)
    assert figures.startswith(f"F_SF {result.metrics.F_SF:.3g}, F_AV {result.metrics.F_AV:.3g}, ")
    assert figures.endswith(f"E_FLUSH {result.metrics.E_FLUSH:.3g}")
    of = len(rubble())
    assert repr(result) == f"<PlanResult {result.status}: {stones} of {of} stones, {figures}>"
    assert repr(result.wall) == f"<Wall of 100 x 36 px: {stones} stones, {wedges} wedges>"
    assert repr(result.plan) == (
        "<Plan of a wall of 100 x 36 px, best, seed 1: "
        f"{stones} stones, {wedges} wedges, {figures}>"
    )
    blocks, interfaces = len(result.model.blocks), len(result.model.interfaces)
    said = f"<RigidBlockModel: {blocks} blocks, {interfaces} interfaces, mu 0.58>"
    assert repr(result.model) == said
    assert "alpha=" in repr(result.resistance)
    assert "array" not in repr(result.resistance)


def test_figures_that_are_not_known_are_not_zero():
    unknown = PlanMetrics(0.5, None, None, None, None, None, None, None, 0.0)
    assert str(unknown).startswith("F_SF 0.5, F_AV -, F_AH -, F_LR -, ")


def test_a_limit_analysis_says_its_factors_but_not_every_force():
    model = brick_model(3, 3, 1.0, 0.6)
    for both in (ds.lateral_resistance(model, mechanism=True), ds.nonassociative_resistance(model)):
        assert both.left.forces is not None
        assert f"alpha={both.left.alpha}" in repr(both)
        assert "array" not in repr(both)


def test_a_step_says_which_stone_goes_where():
    step = next(ds.Planner(rubble(), RUBBLE_SITE, seed=1).steps())
    placement = step.action.stabilised.placement
    x_px, y_px = placement.centroid(RUBBLE_SITE.height_px)
    said = (
        f"stone {step.stone_id} turned by {placement.posed.angle_deg:.1f} deg, "
        f"{len(step.action.stabilised.wedges)} wedges"
    )
    assert repr(step) == f"<Step 1: {said}, centroid at ({x_px:.1f}, {y_px:.1f}) px>"
    assert repr(step.action) == f"<Candidate: {said}>"


def test_names_of_files_do_not_move_the_cursor():
    name = "a\nb\x1b[2J\u2028c\x85é"
    for text in (Notice("W119", name, name), InputError("E100", name, where=name, cure=name)):
        assert str(text).isprintable()
        assert "é" in str(text)
