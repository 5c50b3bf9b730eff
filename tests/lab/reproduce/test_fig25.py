"""Few and many orientations: pairs of one seed."""

from drystone_lab.reproduce.fig25 import ORIENTATIONS, Twins, findings, make
from drystone_lab.reproduce.findings import agreeing
from drystone_lab.reproduce.noise_sets import generated_set
from tests.lab.reproduce.made_outcomes import outcome
from tests.lab.reproduce.small_walls import context, rows

WALL = generated_set(30, 6, 0.05)


def twins(few, many):
    outcomes = [tuple(outcome(F_SF=v, F_LR=v) for v in values) for values in (few, many)]
    return Twins(WALL, {}, dict(zip(ORIENTATIONS, outcomes, strict=True)))


def test_both_walls_of_a_seed_are_planned(tmp_path):
    output = make(context(tmp_path), {30: WALL}, 1)
    assert [row["orientations"] for row in rows(output, "walls")] == ["sf", "10deg"]
    assert {row["seed"] for row in rows(output, "walls")} == {1}
    assert [run.settings().orientations for run in output.runs] == ["sf", "10deg"]
    assert all(run.settings().two_sided for run in output.runs)
    ((_, seconds),) = output.times
    assert seconds.records()[0]["10deg, s"] > seconds.records()[0]["sf, s"]
    assert [p.name for p in output.pictures] == ["fig25", "fig25-figures"]
    assert len(output.pictures[0].figure.axes) == 2
    ticks = [tick.get_text() for tick in output.pictures[1].figure.axes[0].get_xticklabels()]
    assert ticks == ["30 % gen.\nsf", "30 % gen.\n10deg"]
    assert "noise 30 % (generated)" in output.ours[0]


def test_gains_are_of_equal_seeds():
    one = twins([0.5, 0.6, None], [0.7, 0.5, 0.9])
    assert [round(gain, 6) for gain in one.gains("F_SF")] == [0.2, -0.1]


def test_six_gains_of_six_are_significant_and_five_of_six_are_not():
    low = [0.5] * 6
    every = findings([twins(low, [0.6] * 6)])
    assert [one.holds for one in every] == [True, True]
    assert agreeing(every) == "Of 2 claims of the paper that can be told, 2 agree."
    assert "higher in 6 and lower in 0 of 6" in every[0].found
    # One-sided sign test: (1 + 6) / 64.
    most = findings([twins(low, [0.6] * 5 + [0.4])])
    assert [one.holds for one in most] == [False, False]
    assert "p 0.11" in most[0].found


def test_a_few_pairs_tell_nothing():
    assert [one.holds for one in findings([twins([0.5] * 4, [0.9] * 4)])] == [None, None]
    assert [one.holds for one in findings([twins([None], [0.9])])] == [None, None]
