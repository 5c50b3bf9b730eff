"""What a test knows to be there."""

from typing import TypeVar

Thing = TypeVar("Thing")


def not_none(thing: Thing | None) -> Thing:
    """Give a thing back; a test fails where there is none."""
    assert thing is not None
    return thing
