"""The walls and the methods of the public benchmark.

Walls are fixed: sources, seeds, sizes and scales may not change without a new
:data:`SUITE_VERSION`, or figures of different releases and people could not be compared.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import entry_points
from types import MappingProxyType
from typing import Any

from drystone.errors import UsageError
from drystone.selection.policies.registry import BUILT_IN, GROUP, PAPER, RULES, no_policy, rule_of
from drystone_lab.runs.spec import STRIPS, Changes, RunSpec, flat, generated
from drystone_lab.walls import IR_FRAMED, NOISY, PR_560, PR_600, R_FRAMED, Target, chosen

SUITE_VERSION = 1
"""Of all suites together."""


_MASONS = tuple(
    replace(wall, name=wall.name.removesuffix(" framed"), suite="masons")
    for wall in (PR_560, PR_600, R_FRAMED, IR_FRAMED)
)
_NOISE = tuple(replace(wall, suite="noise") for wall in NOISY)


def _rounded(count: int, shape: str, width: float, height: float) -> Target:
    elongation = {"round": 0.0, "long": 0.2}[shape]
    source = generated("fourier", 1, count=count, D2=elongation)
    return Target(f"fourier {count} {shape}", source, width, height, 0.5, suite="fourier")


_FOURIER = (
    _rounded(20, "round", 408, 164),
    _rounded(20, "long", 412, 164),
    _rounded(60, "round", 708, 282),
    _rounded(60, "long", 714, 286),
    _rounded(120, "round", 1000, 400),
    _rounded(120, "long", 1010, 404),
)

_POLYGONS = tuple(
    Target(
        f"polygons {percent} %", generated("polygon", 2, count=40, noise=percent / 100),
        1172, 468, 0.25, suite="polygons",
    )
    for percent in (20, 50, 80)
)  # fmt: skip


def _rubble(count: int, courses: int, width: float, height: float) -> Target:
    source = generated(
        "rubble", 4, count=count, courses=courses, width_px=width, height_px=height, area_ratio=0.85
    )
    return Target(f"rubble {count}", source, width, height, 0.5, suite="rubble")


_RUBBLE = (_rubble(30, 4, 560, 160), _rubble(60, 6, 784, 228), _rubble(120, 8, 1120, 320))


def _bricks(name: str, count: int, aspect: float, halves: int, width: float) -> Target:
    source = generated("brick", 5, count=count, aspect=aspect, halves=halves, height_px=12)
    # Seven courses high, for bricks that fill six: 6 / 7 of the wall.
    return Target(name, source, width, 84, 1.0, suite="bricks")


_BRICKS = (
    _bricks("bricks 2:1", 30, 2.0, 0, 120),
    _bricks("bricks 3:1", 48, 3.0, 0, 288),
    _bricks("bricks 3:1 and halves", 32, 3.0, 8, 216),
)


def _sized(count: int, width: float, height: float) -> Target:
    source = generated("polygon", 3, count=count, noise=0.3, width_px=65, height_px=45)
    return Target(f"sizes {count}", source, width, height, 0.5, suite="sizes")


_SIZES = (
    _sized(20, 414, 166),
    _sized(50, 656, 262),
    _sized(100, 928, 370),
    _sized(200, 1312, 524),
    # As high as that of 100 and five times as long: in a wall of the others' shape a stone after
    # the 300th takes about twice as long to choose.
    _sized(500, 4640, 370),
)

ALL = "all"

_WALLS: Mapping[str, tuple[Target, ...]] = MappingProxyType(
    {
        "masons": _MASONS,
        "fourier": _FOURIER,
        "polygons": _POLYGONS,
        "rubble": _RUBBLE,
        "bricks": _BRICKS,
        "sizes": _SIZES,
        "noise": _NOISE,
    }
)

PUBLIC_SUITES: Mapping[str, str] = MappingProxyType(
    {
        "masons": "the published stones of Almeida et al. (2021), from which masons built",
        "fourier": "generated rounded stones, 20, 60 and 120, round and long",
        "polygons": "generated polygons, 40, noise 20, 50 and 80 %",
        "rubble": "generated rubble for courses, 30, 60 and 120",
        "bricks": "equal bricks, 2:1 and 3:1, and with halves",
        "sizes": "generated polygons of one kind, 20 to 500",
        "noise": "the published polygons of Thangavelu et al. (2018), noise 10 to 80 %",
        ALL: "all walls of these seven",
    }
)
"""What each is about.  Of generated stones there are .85 of the wall, within .01."""


def walls_of(suite: str, only: Sequence[str] = (), *, quick: bool = False) -> tuple[Target, ...]:
    """Return the walls of a suite, in order.

    >>> [wall.name for wall in walls_of("masons", ["PR"])]
    ['PR 560x160', 'PR 600x160']
    """
    walls = sum(_WALLS.values(), ()) if suite == ALL else _WALLS[suite]
    found = chosen(walls, only, suite)
    return found[:1] if quick else found


BEST = "best"

STRIP_SECONDS = 3
"""For each strip of the yardstick."""

ABOUT = {
    PAPER: "the paper's method as it is (Algorithm 2)",
    **dict.fromkeys(BUILT_IN, "the paper's method, but this policy chooses the stones"),
    BEST: "one pass of the default method, on outlines: no search",
    STRIPS: "no policy but a yardstick, F_SF alone: strips packed without gravity (extra `bench`)",
}
"""What each does; docs/for-researchers.md explains the policies."""


@dataclass(frozen=True)
class BenchMethod:
    """Somebody who builds walls."""

    name: str
    method: str
    changes: Changes = ()  # Settings that replace the method's

    def run(self, wall: Target, seed: int) -> RunSpec:
        """Return the run that builds a wall."""
        return wall.run(seed, *self.changes, method=self.method)


def known_methods() -> dict[str, str]:
    """Return what each method does by name, those of other packages last."""
    others = {entry.name for entry in entry_points(group=GROUP)} - {*ABOUT, *RULES}
    return ABOUT | dict.fromkeys(sorted(others), "a policy of another package that is installed")


def method_named(name: str, changes: Changes = ()) -> BenchMethod:
    """Return a method.

    >>> method_named("lowest", (("sampling", "full"),)).changes
    (('selection_rule', 'lowest'), ('sampling', 'full'))
    """
    if name == STRIPS:
        # No setting of a planner means anything to it.
        return BenchMethod(STRIPS, STRIPS, (("seconds", STRIP_SECONDS),))
    if name == BEST:
        own: Changes = (("search.budget", 1),)
        found = BenchMethod(name, "best", _merged(own, changes))
    else:
        if name not in (known := known_methods()):
            raise no_policy(name, tuple(known))
        rule = rule_of(name)
        own = () if name == PAPER else (("selection_rule", rule),)
        found = BenchMethod(name, "paper", _merged(own, changes))
    RunSpec(source=generated("brick", 0), method=found.method, changes=found.changes).settings()
    return found


def flat_changes(nested: Mapping[str, Any], where: str) -> Changes:
    """Return settings from a TOML file as changes of every method.

    >>> flat_changes({"sampling": "full", "placement": {"beta": 0.5}}, "full.toml")
    (('placement.beta', 0.5), ('sampling', 'full'))
    """
    for name in ("selection_rule", "ban", "pin"):
        if name in nested:
            raise UsageError(
                "E138",
                f"{name} cannot be the same for all methods and walls.",
                where=where,
                cure="Leave it out; --policy names who chooses the stones.",
            )
    return flat(nested)


def _merged(own: Changes, changes: Changes) -> Changes:
    return tuple((dict(own) | dict(changes)).items())
