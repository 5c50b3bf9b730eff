"""What `drystone analyse` says: cards that an engineer can quote, or JSON."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from importlib.metadata import version
from math import atan, degrees, inf, isfinite
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from drystone.contacts.gaps import GapSweep
from drystone.drawing.words.content import FALLS, TILTING, is_horizontal, number, side_words
from drystone.errors import Notice, counted
from drystone.io.walls import GivenWall, on_ground
from drystone.model.wall import Labels
from drystone.statics.failing.mechanism import Failure, Names, describe_mechanism
from drystone.statics.flow.nonassociative import (
    NonassociativeResistance,
    NonassociativeResult,
    nonassociative_resistance,
)
from drystone.statics.flow.release import held_by_upright_faces
from drystone.statics.joints import loose_blocks
from drystone.statics.loads import Loads
from drystone.statics.lp.extremes import Solver
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from drystone.statics.scatter.scatter import Scatter
from drystone.statics.sensitivity import friction_sensitivity

CLEARLY_LESS = 0.99
"""Share of the associative load multiplier; above it the mechanisms are mostly the same."""

CONTACTS, BLOCKS = "contacts.csv", "blocks.csv"
FRICTION, REPORT, SCATTER = "friction.png", "report.html", "scatter.png"
WRITTEN = (
    "contacts.png", "mechanism_left.png", "forces_left.png", "mechanism_left.gif",
    "mechanism_right.png", "forces_right.png", "mechanism_right.gif", CONTACTS, BLOCKS, FRICTION,
    REPORT, SCATTER,
)  # fmt: skip
"""What ``-o`` writes, by what there is; not every run writes all."""

ASSUMPTIONS = (
    "2D, rigid blocks, no tension, no crushing, Coulomb friction at the ends of every contact"
)

Shapes = Labels | Mapping[int, NDArray[np.float64]]
STONES = Names("stone")


@dataclass(frozen=True, eq=False)
class ModelledWall:
    """A wall as blocks and contacts, and what it looks like.

    `remarks` are lines for the card, such as what closing gaps changes; `joints` is what is known
    of them: all, or what a drawing shows, whose gaps can be closed.
    """

    model: RigidBlockModel
    shapes: Shapes
    names: Names = STONES
    notices: tuple[Notice, ...] = ()
    remarks: Mapping[str, str] = field(default_factory=dict)
    joints: Literal["known", "drawn", "outlines", "swept"] = "known"
    sweep: GapSweep | None = None

    def failures(self, results: Iterable[LimitResult | NonassociativeResult]) -> dict[str, Failure]:
        """Describe the mechanisms that are known, by direction."""
        found: dict[str, Failure] = {}
        for one in results:
            if one.mechanism is not None:
                falls, names = one.status is LimitStatus.UNSTABLE, self.names
                told = describe_mechanism(self.model, one.mechanism, falls=falls, names=names)
                found[one.direction] = told
        return found

    def why_it_falls(self, failures: Mapping[str, Failure]) -> str:
        """Say in a sentence why a wall does not stand."""
        if not on_ground(self.model):
            shapes = self.shapes.values() if isinstance(self.shapes, Mapping) else ()
            lowest = min((float(shape[:, 1].min()) for shape in shapes), default=0.0)
            return f"Nothing touches y = 0: the lowest {self.names.noun} is at y = {lowest:g}."
        if loose := loose_blocks(self.model):
            have = "has" if len(loose) == 1 else "have"
            said = self.names.listed(loose)
            return f"{said[0].upper()}{said[1:]} {have} nothing below that stands."
        words = (failure.words for failure in failures.values())
        return next(words, "Its own weight is not carried.")


@dataclass(frozen=True, eq=False)
class RangeCard:
    """A case whose answer is a range of alpha.

    `wall` has the model that was analysed, `ends` are the answers by their names, and `sha256` is
    that of the input file.
    """

    wall: ModelledWall
    load_case: str
    ends: Mapping[str, LimitResult]
    sha256: str

    @cached_property
    def failures(self) -> dict[str, Failure]:
        """How the wall fails, by direction."""
        return self.wall.failures(self.ends.values())

    @property
    def failed(self) -> bool:
        """True when no answer could be certified."""
        return LimitStatus.FAILED in [end.status for end in self.ends.values()]

    @property
    def stands(self) -> bool:
        """True when the dead load is carried with some alpha."""
        return LimitStatus.UNSTABLE not in [end.status for end in self.ends.values()]

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        rows = [("load case", self.load_case), ("friction", f"mu = {self.wall.model.mu:g}")]
        for name, end in self.ends.items():
            rows.append((f"{name} alpha", _alpha(end)))
            if end.direction in self.failures:
                rows.append(("  mechanism", self.failures[end.direction].words))
        return rows + self._last_rows()

    def report(self) -> dict[str, Any]:
        """Return the same as what `--json` prints."""
        words = {name: self.failures.get(end.direction) for name, end in self.ends.items()}
        return {
            "load_case": self.load_case,
            **_alphas(self.ends),
            "mu": self.wall.model.mu,
            "certificate": _certificate(self.ends),
            "words": {name: failure.words for name, failure in words.items() if failure},
            **self._source(),
        }

    def _last_rows(self) -> list[tuple[str, str]]:
        return [
            *self.wall.remarks.items(),
            ("certificate", _certified([*self.ends.values()])),
            ("assumptions", ASSUMPTIONS),
            ("input", f"sha256 {self.sha256[:16]}, drystone {version('drystone')}"),
        ]

    def _source(self) -> dict[str, Any]:
        remarks = dict(self.wall.remarks)
        return {"remarks": remarks, "sha256": self.sha256, "version": version("drystone")}


@dataclass(frozen=True, eq=False)
class Card(RangeCard):
    """Everything that was found out about a wall under loads to the left and to the right.

    `loose` is what moves without dilatancy where that is at a clearly smaller load, `sensitivity`
    d alpha / d mu.  `upright` are blocks that friction on upright faces alone holds under the dead
    load; None where the wall does not stand, or nothing is known.
    """

    resistance: LateralResistance
    nonassociative: NonassociativeResistance | None
    loose: Mapping[str, Failure]
    upright: tuple[int, ...] | None
    sensitivity: Mapping[str, float]

    @property
    def why(self) -> str:
        """Why the wall does not stand, in a sentence; empty when it does, or nobody knows."""
        known = self.resistance.stable or self.failed
        return "" if known else self.wall.why_it_falls(self.failures)

    @property
    def without(self) -> dict[str, NonassociativeResult]:
        """The answers without dilatancy, by direction; none where they were not asked for."""
        found = self.nonassociative
        return {} if found is None else {"left": found.left, "right": found.right}

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        rows = [("load case", self.load_case), ("own weight", self._standing())]
        sideways = is_horizontal(self.load_case)
        for side, result in sorted(self.ends.items(), reverse=not sideways):
            rows += self._of_side(side, result)
        ratio = f"{number(self.resistance.value)}  min(alpha) / mu, mu = {self.wall.model.mu:g}"
        if self.wall.model.mu_idle:
            ratio = f"{number(None)}: every joint has a friction of its own"
        elif self.nonassociative is not None and self.nonassociative.value is not None:
            ratio += f"; without dilatancy {self.nonassociative.value:.3f}"
        if sideways:
            rows.append(("F_LR", ratio))
        alphas = [end.alpha for end in self.ends.values() if end.alpha is not None]
        if self.stands and alphas and self.load_case == "tilting table":
            angle = degrees(atan(min(alphas)))
            rows.append(("falls on a table", f"tilted by {angle:.1f} degrees, by associated flow"))
        return rows + self._last_rows()

    def report(self) -> dict[str, Any]:
        """Return the same as what `--json` prints (DESIGN 2)."""
        moving = {s: end.mechanism for s, end in self.ends.items() if end.mechanism is not None}
        return {
            **_alphas(self.ends),
            "F_LR": self.resistance.value if is_horizontal(self.load_case) else None,
            "stands": None if self.failed else self.stands,
            "why": self.why,
            "held_by_upright_faces": None if self.upright is None else list(self.upright),
            "mu": self.wall.model.mu,
            "blocks": len(self.wall.model.blocks),
            "contacts": self.wall.model.contact_count,
            "nonassociative": self._without_dilatancy(),
            "certificate": _certificate(self.ends),
            "sensitivity": dict(self.sensitivity),
            "load_case": self.load_case,
            "mechanism": {
                side: dict(zip(map(str, found.block_ids), found.velocity.tolist(), strict=True))
                for side, found in moving.items()
            },
            "words": {side: failure.words for side, failure in self.failures.items()},
            "joints": {
                side: _moving_joints(self.wall.model, failure)
                for side, failure in self.failures.items()
            },
            **self._source(),
        }

    @property
    def stands(self) -> bool:
        """True when the dead load is carried, as far as both flow rules know."""
        return self.resistance.stable and not self._can_fall

    @property
    def verdict(self) -> tuple[bool | None, str]:
        """Whether it stands, and in words what brings it down: see :func:`judge_wall`."""
        wall, names = self.wall, self.wall.names
        count = sum(block.id not in names.wedges for block in wall.model.blocks)
        return judge_wall(
            counted(count, names.noun), wall, self.resistance, load_case=self.load_case,
            without_dilatancy={
                side: inf if end.status is LimitStatus.UNBOUNDED else end.alpha
                for side, end in self.without.items()
            },
            loose=self.loose, can_fall=self._can_fall,
        )  # fmt: skip

    @property
    def _can_fall(self) -> bool:
        """Whether a fall without dilatancy was found."""
        return LimitStatus.UNSTABLE in [end.status for end in self.without.values()]

    def _standing(self) -> str:
        """Say whether the dead load alone is carried, and by what."""
        if self.failed:
            return "not known: no answer could be certified"
        if not self.resistance.stable:
            return f"does not stand: {self.why[:1].lower()}{self.why[1:].rstrip('.')}"
        said = "stands"
        if self.upright is None:
            said += "; not known whether without friction on upright faces"
        elif self.upright:
            said += f" only by friction on upright faces: {self.wall.names.listed(self.upright)}"
        if self._can_fall:
            return f"{said}; let go, it can fall"
        if self.upright and self.nonassociative is not None:
            return f"{said}; let go, nothing was found to fall"
        return said

    def _of_side(self, side: str, result: LimitResult) -> list[tuple[str, str]]:
        """Tell the load to one side, and under it what belongs to this side."""
        rows = [(f"load {side_words(self.load_case, side)}", _alpha(result))]
        if self.without:
            without = self.without[side]
            words = without.message[:1].lower() + without.message[1:].rstrip(".")
            rows.append(("  without dilatancy", _alpha(without, words)))
        if side in self.loose:
            rows.append(("    moving then", self.loose[side].words))
        if side in self.failures:
            rows.append(("  mechanism", self.failures[side].words))
        if side in self.sensitivity:
            rows.append(("  sensitivity", f"d alpha / d mu = {self.sensitivity[side]:.3f}"))
        return rows

    def _without_dilatancy(self) -> dict[str, Any] | None:
        if not self.without:
            return None
        return {
            **_alphas(self.without),
            **{f"message_{side}": end.message for side, end in self.without.items()},
            **{f"answers_{side}": list(end.answers) for side, end in self.without.items()},
            "words": {side: failure.words for side, failure in self.loose.items()},
        }


def analysis_of(
    wall: ModelledWall,
    loads: Loads,
    resistance: LateralResistance,
    sha256: str = "",
    *,
    associative_only: bool = False,
    solver: Solver = "auto",
) -> Card:
    """Find out what there is to say of a wall beside its load multipliers.

    `resistance` is under the loads, with mechanisms; `solver` as in
    :func:`drystone.statics.limit.lateral_resistance`.
    """
    model, both = wall.model, {"left": resistance.left, "right": resistance.right}
    without = None if associative_only else nonassociative_resistance(model, loads=loads)
    # What moves without dilatancy is of interest where it needs clearly less load.
    loose = [] if without is None else [
        result for result, bound in zip((without.left, without.right), both.values(), strict=True)
        if result.alpha is None or bound.alpha is None or result.alpha < CLEARLY_LESS * bound.alpha
    ]  # fmt: skip
    return Card(
        wall=wall,
        load_case=loads.name,
        ends=both,
        sha256=sha256,
        resistance=resistance,
        nonassociative=without,
        loose=wall.failures(loose),
        upright=held_by_upright_faces(model, loads, solver=solver) if resistance.stable else None,
        sensitivity={
            side: friction_sensitivity(model, result, loads)
            for side, result in both.items()
            if result.success
        },
    )


def _moving_joints(model: RigidBlockModel, failure: Failure) -> dict[str, list[list[int]]]:
    """Name the pairs of blocks whose contacts open, and those whose contacts slide."""
    pairs = [(face.block, face.other) for face in model.interfaces for _ in face.points]
    told = [*zip(pairs, failure.contact_kinds, strict=True)]
    return {
        name: [list(pair) for pair in sorted({pair for pair, kind in told if name in kind})]
        for name in ("opening", "sliding")
    }


def _alphas(ends: Mapping[str, LimitResult] | Mapping[str, NonassociativeResult]) -> dict[str, Any]:
    found = {f"status_{name}": str(end.status) for name, end in ends.items()}
    return found | {f"alpha_{name}": end.alpha for name, end in ends.items()}


def _alpha(
    result: LimitResult | NonassociativeResult, words: str = "load multiplier, adequacy factor"
) -> str:
    if result.alpha is None:
        return f"{result.status}: {result.message}"
    # One that rounds to nothing has no sign.
    return f"alpha = {round(result.alpha, 4) + 0.0:.4f}  {words}"


def _certificate(ends: Mapping[str, LimitResult]) -> dict[str, float | None]:
    found = {name: end.certificate for name, end in ends.items()}
    known = [one for one in found.values() if one is not None]
    return {
        **{f"gap_{name}": None if one is None else one.gap for name, one in found.items()},
        "residual": max((c.residual for c in known), default=None),
        "violation": max((c.violation for c in known), default=None),
        "inadmissible": max((c.inadmissible for c in known), default=None),
        "slack": max((c.slack for c in known if c.slack is not None), default=None),
    }


def _certified(ends: Sequence[LimitResult]) -> str:
    """Say how well the answers are proved."""
    known = [end.certificate for end in ends if end.certificate is not None]
    if len(known) < 2:
        return "none"
    solvers = " and ".join(dict.fromkeys(end.solver for end in ends))
    if any(c.fall_work is not None for c in known):
        return f"a mechanism on which the dead load does work, by {solvers}"
    residual = max(c.residual for c in known)
    gaps = [c.gap for c in known if c.gap is not None and isfinite(c.gap)]
    gap = f", forces and mechanism give the same alpha to {max(gaps):.0e}" if gaps else ""
    return f"equilibrium to {residual:.0e}{gap}, by {solvers}"


@dataclass(frozen=True, eq=False)
class ScatterCard:
    """What the shaken walls carry, with the :func:`noise_unit` in which the noise was given."""

    scatter: Scatter
    unit: tuple[str, float]

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        found, counts = self.scatter, self.scatter.counts
        rows = [("scatter", self._shaken())]
        both = (("min alpha", found.alpha_quantiles), ("F_LR", found.value_quantiles))
        for name, quantiles in both:
            if quantiles is not None:
                low, middle, high = (f"{value:.3f}" for value in quantiles)
                rows.append((f"  {name}", f"median {middle} (5 % to 95 %: {low} to {high})"))
        share = found.falling_share
        if share is not None:
            said = f"{counted(counts[LimitStatus.UNSTABLE], 'wall')}, {100 * share:.3g} %"
            which = "have a limit" if counts[LimitStatus.UNBOUNDED] else "stand"
            rows.append(("  do not stand", f"{said}; the figures above are of those that {which}"))
        for status, name in ((LimitStatus.UNBOUNDED, "unbounded"), (LimitStatus.FAILED, "failed")):
            if counts[status]:
                rows.append((f"  {name}", f"{counts[status]} walls, without a number"))
        return rows

    def report(self) -> dict[str, Any]:
        """Return the same as JSON, with every sample."""
        found, value = self.scatter, self.scatter.value
        return {
            "samples": found.settings.samples,
            "seed": found.seed,
            "mu": found.mu.tolist(),
            "status": [str(status) for status in found.status],
            "alpha_left": found.alpha_left.tolist(),
            "alpha_right": found.alpha_right.tolist(),
            "F_LR": None if value is None else value.tolist(),
            "alpha_5_50_95": found.alpha_quantiles,
            "F_LR_5_50_95": found.value_quantiles,
        }

    def _shaken(self) -> str:
        made, (unit, lengths) = self.scatter.settings, self.unit
        parts = [f"{made.samples} walls, seed {self.scatter.seed}"]
        if made.mu is not None:
            parts.append(f"mu {made.mu[0]:g} to {made.mu[1]:g}")
        for name, noise in (("outlines", made.outline_noise), ("placement", made.placement_noise)):
            if noise:
                parts.append(f"{name} +- {noise / lengths:g} {unit}")
        return ", ".join(parts)


def noise_unit(wall: GivenWall) -> tuple[str, float]:
    """Return the unit of ``--outline-noise`` and ``--placement-noise``: px where there are any.

    Its name, and how many lengths of the model it is.  Px are those of the source image: a plan
    on outlines in metres has a model in metres, one on pixels has one in working px.
    """
    if wall.blocks is None:
        return "px", 1.0 if wall.plan is None else wall.plan.working_scale
    if wall.plan is None:
        return "lengths of the block model", 1.0
    px_per_m = wall.plan.px_per_m if wall.plan.length_unit == "m" else None
    return "px", 1.0 / (px_per_m or 1.0)


def judge_wall(
    subject: str,
    wall: ModelledWall,
    resistance: LateralResistance,
    *,
    load_case: str = TILTING,
    without_dilatancy: Mapping[str, float | None] = MappingProxyType({}),
    loose: Mapping[str, Failure] = MappingProxyType({}),
    can_fall: bool = False,
) -> tuple[bool | None, str]:
    """Say whether a wall stands, and in words what brings it down; not known is None.

    `subject` says how large it is, such as "28 of 30 stones".
    `without_dilatancy` are load multipliers by Coulomb's law, by direction, None where they are not
    known: the least of all is what the wall is told to carry, under loads that are not sideways the
    least as they are given: reversed they are other loads.  `loose` and `can_fall` are those of
    :class:`Card`: what moves then, and whether the wall falls when it is let go.
    """
    if resistance.failed:
        return None, f"{subject}; not known whether it stands: no answer could be certified"
    failures = wall.failures((resistance.left, resistance.right))
    if not resistance.stable:
        return False, f"{subject}, {FALLS}: {_clause(wall.why_it_falls(failures))}"
    if can_fall:
        # To the side that has a load multiplier it does not fall by itself.
        falling = [one for side, one in loose.items() if without_dilatancy.get(side) is None]
        how = "".join(f"; {_clause(failure.words)}" for failure in falling[:1])
        return False, f"{subject}, {FALLS}: let go, it can fall{how}"
    both = [(end.alpha, str(end.direction)) for end in (resistance.left, resistance.right)]
    both += [(alpha, direction) for direction, alpha in without_dilatancy.items()]
    known = [(alpha, side) for alpha, side in both if alpha is not None and isfinite(alpha)]
    open_sides = [side for side, alpha in without_dilatancy.items() if alpha is None]
    reverse = ""
    if not is_horizontal(load_case):
        other = [alpha for alpha, direction in known if direction == "left"]
        known = [one for one in known if one[1] == "right"]
        open_sides = [side for side in open_sides if side == "right"]
        reverse = f"; reversed, {min(other):.3f} times" if other else ""
    if not known:
        any_load = f"carries any multiple of the live load ({load_case}){reverse}"
        words = any_load if reverse else "no load of this kind brings it down"
        if open_sides:
            words = f"no limit was found for the live load ({load_case}){reverse}"
        return True, f"{subject}, stands; {words}"
    alpha, direction = min(known)
    words = f"{subject}, stands; {_load(alpha, load_case)}{reverse}"
    if failure := loose.get(direction, failures.get(direction)):
        words += f"; weakest place: {_weakest_place(wall, failure)}"
    return True, words


def _clause(words: str) -> str:
    """Return why a wall falls without the capital, the full stop and that it does."""
    why = words.removeprefix("Falls by itself: ").rstrip(".")
    return why[:1].lower() + why[1:]


def _load(alpha: float, load_case: str) -> str:
    """Say what brings a wall down."""
    if load_case != TILTING:
        of = "its own weight sideways" if is_horizontal(load_case) else "the live load"
        return f"carries {alpha:.3f} times {of} ({load_case})"
    angle = degrees(atan(alpha))
    return f"falls when tilted by {angle:.{0 if angle >= 10.0 else 1}f} degrees"


def _weakest_place(wall: ModelledWall, failure: Failure) -> str:
    """Name what moves first where it turns about or slides: as the words of the failure begin."""
    if not failure.groups:
        return "not known"
    first = failure.groups[0]
    if first.toe is None and GROUND in first.against:
        return "the joint with the ground"
    return wall.names.listed(first.blocks if first.toe is None else [first.toe.block])
