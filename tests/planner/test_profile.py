"""Times by step and part add up."""

from contextlib import contextmanager, suppress

from drystone.planner.profile import Profile


def test_parts_belong_to_the_step_in_which_they_end():
    now = [0.0]
    profile = Profile(lambda: now[0])

    @contextmanager
    def part(name, seconds):
        with profile.part(name):
            now[0] += seconds
            yield

    with part("preparation", 2.0):
        pass
    profile.begin_step()
    for seconds in (1.0, 0.5):
        with part("placement", seconds):
            pass
    now[0] += 0.25
    profile.end_step(0, 7)
    profile.begin_step()
    # What fails is measured too.
    with suppress(ValueError), part("contacts", 4.0):
        raise ValueError
    profile.end_step(1, 3)
    # An attempt without an action counts outside of steps.
    profile.begin_step()
    with part("indices", 8.0):
        pass
    profile.begin_step()
    profile.end_without_action(4)
    first, second = profile.steps
    assert (first.stones, first.candidates, first.seconds) == (0, 7, 1.75)
    assert first.parts == {"placement": 1.5}
    assert (second.seconds, second.parts) == (4.0, {"contacts": 4.0})
    assert profile.candidates == 7 + 3 + 4
    totals = {"preparation": 2.0, "placement": 1.5, "contacts": 4.0, "indices": 8.0, "metrics": 0.0}
    assert {name: profile.total(name) for name in totals} == totals
