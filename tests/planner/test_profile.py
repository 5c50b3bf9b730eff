"""Times by step and part add up."""

import pytest

from drystone.planner.profile import Profile


def clocked():
    now = [0.0]
    return Profile(lambda: now[0]), now


def test_parts_belong_to_the_step_in_which_they_end():
    profile, clock = clocked()
    with profile.part("preparation"):
        clock[0] += 2.0
    profile.begin_step()
    with profile.part("placement"):
        clock[0] += 1.0
    with profile.part("placement"):
        clock[0] += 0.5
    clock[0] += 0.25
    profile.end_step(0, 7)
    profile.begin_step()
    with profile.part("contacts"):
        clock[0] += 4.0
    profile.end_step(1, 3)
    first, second = profile.steps
    assert (first.stones, first.candidates, first.seconds) == (0, 7, 1.75)
    assert first.parts == {"placement": 1.5}
    assert (second.seconds, second.parts) == (4.0, {"contacts": 4.0})
    assert profile.total("preparation") == 2.0
    assert profile.total("placement") == 1.5
    assert profile.total("metrics") == 0.0


def test_attempts_without_an_action_count_outside_of_steps():
    profile, clock = clocked()
    profile.begin_step()
    with profile.part("indices"):
        clock[0] += 1.0
    profile.begin_step()
    profile.end_without_action(4)
    assert profile.steps == []
    assert profile.candidates == 4
    assert profile.total("indices") == 1.0


def test_what_fails_is_measured_too():
    profile, clock = clocked()

    def fails():
        with profile.part("stabilisation"):
            clock[0] += 3.0
            raise ValueError

    with pytest.raises(ValueError):  # noqa: PT011 - its own
        fails()
    assert profile.total("stabilisation") == 3.0
