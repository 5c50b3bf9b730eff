"""Which walls of a search are kept."""

from collections.abc import Sequence
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from drystone.search.archive import MOST, STEPS, archived, score_of
from drystone.search.found import Solves
from drystone.search.goal import Figures
from drystone.search.packed import Packed
from tests.strategies import repeatable

PLAIN = Figures(stones=8, F_SF=0.8, F_LR=0.5, F_AV=20.0, F_AH=2.0, T_LEVEL=0.2, E_FLUSH=0.1)


def wall(merit: float = 1.0, **changes: float) -> Packed:
    return Packed((), replace(PLAIN, **changes), merit, Solves(), None)  # type: ignore[arg-type]


def test_a_wall_that_is_worse_in_every_figure_goes() -> None:
    good, bad = wall(), wall(F_SF=0.7, F_LR=0.4, F_AV=10.0, F_AH=3.0)
    assert archived((), [good, bad]) == (good,)
    assert archived((bad,), [good]) == (good,)
    assert archived((), [wall(-float("inf"))])[0].figures == PLAIN
    assert archived((), [replace_figures(good)]) == ()


def replace_figures(one: Packed) -> Packed:
    """An empty wall."""
    return Packed((), None, one.merit, Solves(), None)


def test_one_better_figure_keeps_a_wall_as_far_as_it_counts() -> None:
    for figure, step in STEPS.items():
        name = "F_LR" if figure == "carried" else figure
        better = wall(0.5, **{name: getattr(PLAIN, name) + step})
        alike = wall(0.5, **{name: getattr(PLAIN, name) + 0.3 * step})
        worse = wall(0.5, **{name: getattr(PLAIN, name) - step})
        plain = wall()
        assert archived((plain,), [better, alike, worse]) == (plain, better)
        # One of more merit that is better in no figure beats neither.
        assert archived((better,), [plain]) == (plain, better)
        assert archived((wall(0.4),), [better]) == (better,)


def test_of_alike_walls_the_one_of_more_merit_stays_then_the_first() -> None:
    first, second, better = wall(), wall(), wall(2.0)
    assert archived((first,), [second])[0] is first
    assert archived((first,), [better]) == (better,)


def test_walls_that_lack_pinned_stones_are_beaten_by_any_that_do_not() -> None:
    lacking, whole = wall(-9.0, missing=1), wall(0.5, F_SF=0.1, F_LR=0.0, F_AV=0.0, F_AH=9.0)
    assert archived((lacking,), [whole]) == (whole,)
    assert archived((), [lacking]) == (lacking,)


some_walls = st.lists(
    st.builds(
        lambda merit, sf, lr, av, ah: wall(merit, F_SF=sf, F_LR=lr, F_AV=av, F_AH=ah),
        st.floats(0, 20), st.floats(0, 1), st.floats(0, 2), st.floats(0, 60), st.floats(0, 9),
    ),
    max_size=30,
)  # fmt: skip


def beaten(one: Packed, by: Packed) -> bool:
    assert one.figures is not None
    assert by.figures is not None
    mine, yours = score_of(one.figures), score_of(by.figures)
    return by.merit >= one.merit and all(a >= b for a, b in zip(yours, mine, strict=True))


def rank(wall: Packed) -> tuple[float, tuple[int, ...]]:
    assert wall.figures is not None
    return wall.merit, score_of(wall.figures)


def naive(walls: Sequence[Packed]) -> list[Packed]:
    """Those that none beats; of those that beat each other the first."""
    kept = [
        wall
        for k, wall in enumerate(walls)
        if not any(
            beaten(wall, other) and (j < k or not beaten(other, wall))
            for j, other in enumerate(walls)
        )
    ]
    return sorted(kept, key=rank, reverse=True)[:MOST]


@repeatable(60)
@given(some_walls)
def test_those_that_none_beats_are_kept_and_no_others(walls: list[Packed]) -> None:
    kept = archived((), walls)
    assert list(kept) == naive(walls)
    assert archived(kept, []) == kept
    if walls:
        assert kept[0].merit == max(wall.merit for wall in walls)
