from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from drystone_lab import statics_cases
from drystone_lab.statics_cases import WALLS, WITH_FRICTION, WITHOUT_SLIDING, CaseRow, closed_forms
from drystone_lab.table import BenchSettings

PAGE = Path(__file__).resolve().parents[2] / "docs" / "evidence" / "validation.md"


@pytest.fixture(scope="module")
def tables():
    """A few of the cases; all are solved in ``tests/validation``."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(statics_cases, "closed_forms", lambda: closed_forms()[:10:3])
        patch.setattr(statics_cases, "WALLS", WALLS[:3])
        patch.setattr(statics_cases, "QUICK_ARCHES", (WITHOUT_SLIDING[0], *WITH_FRICTION[2::2]))
        return [table.records() for table in statics_cases.run(BenchSettings(quick=True))]


def test_closed_forms_walls_of_ferris_and_arches_hold(tables):
    *others, shifted = closed_forms()[:10:3]
    forms, (first, _, third), arches = tables
    assert [(row["case"], row["towards"], row["expected"]) for row in forms] == [
        *((case.name, "both", case.left) for case in others),
        (shifted.name, "-x", shifted.left), (shifted.name, "+x", shifted.right),
    ]  # fmt: skip
    for row in forms:
        expected = pytest.approx(row["expected"], abs=1e-6)
        assert row["alpha"] == expected
        # The quick version asks for both flow rules of every third one.
        both_rules = row["case"] in (others[0].name, shifted.name)
        assert row["without dilatancy"] == (expected if both_rules else None)
        assert row["certificate gap"] <= 1e-8
    assert (first["case"], third["case"]) == ("example 1, 33 blocks", "example 3, 46 blocks")
    assert (first["alpha"], third["alpha"]) == pytest.approx((0.64286, 0.40369), abs=5e-6)
    assert first["without dilatancy"] is None  # not asked for in the quick version
    assert 0.350 <= third["without dilatancy"] <= 0.361
    assert [each for each in WALLS if each.may_not_converge] == [WALLS[5]]
    found = [(row["voussoirs"], row["mu"], row["t/R"]) for row in arches]
    assert found[0] == (9, "no sliding", pytest.approx(0.10213, abs=1e-5))
    assert found[1] == (40, 0.35, pytest.approx(0.15182, abs=1e-5))
    assert found[2:] == [(40, 0.3, "none up to 0.4")]
    assert {row["verdict"] for table in tables for row in table} == {"pass"}


@pytest.fixture(scope="module")
def answers():
    """Answers for a wall of Ferris by both flow rules, which fit."""
    return [solve(WALLS[2].model).left for solve in (lateral_resistance, nonassociative_resistance)]


@pytest.mark.parametrize(
    ("wall", "found", "other", "said"),
    [
        ({}, {}, {}, "pass"),
        ({}, {"alpha": 0.40369 + 1.1e-5}, {}, "miss"),
        ({}, {"alpha": 0.40369 - 1.1e-5}, {}, "miss"),
        ({}, {"alpha": None, "certificate": None, "status": LimitStatus.FAILED}, {}, "miss"),
        ({}, {"certificate": SimpleNamespace(holds=False, gap=0.0)}, {}, "miss"),
        ({}, {}, {"alpha": 0.349}, "miss"),
        ({}, {}, {"alpha": 0.362}, "miss"),
        ({}, {}, {"alpha": None}, "miss"),
        ({}, {}, {"check": None}, "miss"),
        # Without dilatancy it is not above the associative factor.
        ({"nonassociative": (0.3, 0.5)}, {}, {"alpha": 0.40369}, "pass"),
        ({"nonassociative": (0.3, 0.5)}, {}, {"alpha": 0.4038}, "miss"),
        ({"may_not_converge": True}, {}, {"alpha": None, "check": None}, "pass"),
    ],
)
def test_a_wrong_factor_misses(answers, wall, found, other, said):
    case = replace(WALLS[2], **wall)
    ours, loose = replace(answers[0], **found), replace(answers[1], **other)
    assert statics_cases._row(case, ours, loose).verdict == said


@pytest.mark.parametrize("error", [1.3e-5, -1.3e-5])
def test_a_wrong_arch_misses(monkeypatch, error):
    monkeypatch.setattr(statics_cases, "stands", lambda _count, t, _mu: t > 0.2 + error)
    for expected, verdict in ((0.2, "miss"), (None, "miss"), (0.2 + error, "pass")):
        case = statics_cases.ArchCase(9, 0.6, expected)
        assert statics_cases._arch_row(case)[-1] == verdict


def test_the_page_shows_every_case():
    shown = PAGE.read_text("utf-8")
    for case in (*closed_forms(), *WALLS):
        lines = [line for line in shown.splitlines() if line.startswith(f"| {case.name} |")]
        assert lines
        assert all(line.endswith("| pass |") for line in lines)


def test_directions_with_different_factors_have_rows_of_their_own():
    left = CaseRow("case", 0.65, "-x", 0.4, 0.4, 0.0, 1e-9, "", 0.35, "pass")
    right = left._replace(towards="+x", difference=1e-7, gap=2e-9)
    assert list(statics_cases._together(left, right)) == [right._replace(towards="both")]
    for change in ({"without_dilatancy": 0.3501}, {"alpha": 0.4001}, {"verdict": "miss"}):
        other = right._replace(**change)
        assert list(statics_cases._together(left, other)) == [left, other]
