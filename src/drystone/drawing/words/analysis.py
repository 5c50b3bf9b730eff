"""What `drystone analyse` says: a card that an engineer can quote, or JSON."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from math import atan, degrees, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.drawing.words.content import number
from drystone.errors import Notice
from drystone.model.wall import Labels
from drystone.statics.failing.mechanism import Failure, Names, Noun, describe_mechanism
from drystone.statics.flow.nonassociative import (
    NonassociativeResistance,
    NonassociativeResult,
    nonassociative_resistance,
)
from drystone.statics.loads import Loads
from drystone.statics.lp.extremes import Solver
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus, LoadRange
from drystone.statics.sensitivity import friction_sensitivity
from drystone.statics.squeeze import held_by_upright_faces

CLEARLY_LESS = 0.99
"""Share of the associative load multiplier; above it the mechanisms are mostly the same."""

ASSUMPTIONS = (
    "2D, rigid blocks, no tension, no crushing, Coulomb friction at the ends of every contact"
)


Shapes = Labels | Mapping[int, NDArray[np.float64]]


@dataclass(frozen=True, eq=False)
class ModelledWall:
    """A wall as blocks and contacts, and what it looks like.

    `noun` is what a block is called; `remarks` are lines for the card, such as what closing gaps
    changes.
    """

    model: RigidBlockModel
    shapes: Shapes
    noun: Noun
    wedge_ids: frozenset[int] = frozenset()
    notices: tuple[Notice, ...] = ()
    remarks: Mapping[str, str] = field(default_factory=dict)

    def failures(self, results: Iterable[LimitResult | NonassociativeResult]) -> dict[str, Failure]:
        """Describe the mechanisms that are known, by direction."""
        return {
            result.direction: describe_mechanism(
                self.model,
                result.mechanism,
                falls=result.status is LimitStatus.UNSTABLE,
                noun=self.noun,
                wedges=self.wedge_ids,
            )
            for result in results
            if result.mechanism is not None
        }


@dataclass(frozen=True, eq=False)
class Card:
    """Everything that was found out about a wall.

    `failures` are how it fails by direction, `loose` what moves without dilatancy where that is at
    a clearly smaller load, `sensitivity` d alpha / d mu.  `upright` are blocks that friction on
    upright faces alone holds under the dead load; None where the wall does not stand, or nothing
    is known.  `sha256` is that of the input file.
    """

    model: RigidBlockModel
    load_case: str
    resistance: LateralResistance
    nonassociative: NonassociativeResistance | None
    failures: Mapping[str, Failure]
    loose: Mapping[str, Failure]
    upright: tuple[int, ...] | None
    names: Names
    sensitivity: Mapping[str, float]
    sha256: str
    version: str
    remarks: Mapping[str, str]

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        both = self.resistance
        rows = [
            ("load case", self.load_case),
            ("own weight", self._standing()),
            *self._of_side(both.left),
            *self._of_side(both.right),
            ("F_LR", self._ratio()),
        ]
        alphas = [end.alpha for end in (both.left, both.right) if end.alpha is not None]
        if self.stands and alphas and self.load_case == "tilting table":
            angle = degrees(atan(min(alphas)))
            rows.append(("falls on a table", f"tilted by {angle:.1f} degrees, by associated flow"))
        return [*rows, *self.remarks.items(), *_last_rows(self, both.left, both.right)]

    def report(self) -> dict[str, Any]:
        """Return the same as what `--json` prints (DESIGN 2)."""
        both = self.resistance
        return {
            **_alphas(both.left, both.right),
            "F_LR": both.value,
            "held_by_upright_faces": None if self.upright is None else list(self.upright),
            "mu": self.model.mu,
            "blocks": len(self.model.blocks),
            "contacts": self.model.contact_count,
            "nonassociative": None if self.nonassociative is None else self._without_dilatancy(),
            "certificate": _certificate(both.left, both.right),
            "sensitivity": dict(self.sensitivity),
            "load_case": self.load_case,
            "mechanism": {
                result.direction: {
                    str(block): [float(v) for v in velocity]
                    for block, velocity in zip(
                        result.mechanism.block_ids, result.mechanism.velocity, strict=True
                    )
                }
                for result in (both.left, both.right)
                if result.mechanism is not None
            },
            "words": {direction: failure.words for direction, failure in self.failures.items()},
            "joints": {
                direction: _moving_joints(self.model, failure)
                for direction, failure in self.failures.items()
            },
            "remarks": dict(self.remarks),
            "sha256": self.sha256,
            "version": self.version,
        }

    @property
    def stands(self) -> bool:
        """True when the dead load is carried, as far as both flow rules know."""
        return self.resistance.stable and not self._can_fall

    @property
    def _can_fall(self) -> bool:
        """Whether a fall without dilatancy was found."""
        without = self.nonassociative
        ends = () if without is None else (without.left, without.right)
        return LimitStatus.UNSTABLE in [end.status for end in ends]

    def _standing(self) -> str:
        """Say whether the dead load alone is carried, and by what."""
        if self.resistance.failed:
            return "not known: no answer could be certified"
        if not self.resistance.stable:
            return "does not stand"
        said = "stands"
        if self.upright is None:
            said += "; not known whether without friction on upright faces"
        elif self.upright:
            said += f" only by friction on upright faces: {self.names.listed(self.upright)}"
        if self._can_fall:
            return f"{said}; let go, it can fall"
        if self.upright and self.nonassociative is not None:
            return f"{said}; let go, nothing was found to fall"
        return said

    def _of_side(self, result: LimitResult) -> list[tuple[str, str]]:
        """Tell the load to one side, and under it what belongs to this side."""
        side = result.direction
        rows = [(f"load to the {side}", _alpha(result))]
        if self.nonassociative is not None:
            without: NonassociativeResult = getattr(self.nonassociative, side)
            words = without.message[:1].lower() + without.message[1:].rstrip(".")
            rows.append(("  without dilatancy", _alpha(without, words)))
        if side in self.loose:
            rows.append(("    moving then", self.loose[side].words))
        if side in self.failures:
            rows.append(("  mechanism", self.failures[side].words))
        if side in self.sensitivity:
            rows.append(("  sensitivity", f"d alpha / d mu = {self.sensitivity[side]:.3f}"))
        return rows

    def _ratio(self) -> str:
        said = f"{number(self.resistance.value)}  min(alpha) / mu, mu = {self.model.mu:g}"
        if self.nonassociative is not None and self.nonassociative.value is not None:
            said += f"; without dilatancy {self.nonassociative.value:.3f}"
        return said

    def _without_dilatancy(self) -> dict[str, Any]:
        assert self.nonassociative is not None  # noqa: S101 - asked for only then
        left, right = self.nonassociative.left, self.nonassociative.right
        return {
            **_alphas(left, right),
            "message_left": left.message,
            "message_right": right.message,
            "answers_left": list(left.answers),
            "answers_right": list(right.answers),
            "words": {direction: failure.words for direction, failure in self.loose.items()},
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
    model, both = wall.model, (resistance.left, resistance.right)
    without = None if associative_only else nonassociative_resistance(model, loads=loads)
    # What moves without dilatancy is of interest where it needs clearly less load.
    loose = [] if without is None else [
        result for result, bound in zip((without.left, without.right), both, strict=True)
        if result.alpha is None or bound.alpha is None or result.alpha < CLEARLY_LESS * bound.alpha
    ]  # fmt: skip
    return Card(
        model=model,
        load_case=loads.name,
        resistance=resistance,
        nonassociative=without,
        failures=wall.failures(both),
        loose=wall.failures(loose),
        upright=held_by_upright_faces(model, loads, solver=solver) if resistance.stable else None,
        names=Names(wall.noun, wall.wedge_ids),
        sensitivity={
            result.direction: friction_sensitivity(model, result, loads).of_model(model)
            for result in both
            if result.success
        },
        sha256=sha256,
        version=version("drystone"),
        remarks=wall.remarks,
    )


@dataclass(frozen=True, eq=False)
class RangeCard:
    """A case whose answer is a range of alpha; parameters as for :class:`Card`."""

    found: LoadRange
    mu: float
    load_case: str
    failures: Mapping[str, Failure]
    sha256: str
    version: str
    remarks: Mapping[str, str]

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        rows = [("load case", self.load_case), ("friction", f"mu = {self.mu:g}")]
        for name, end in (("least", self.found.least), ("greatest", self.found.greatest)):
            rows.append((f"{name} alpha", _alpha(end)))
            if end.direction in self.failures:
                rows.append(("  mechanism", self.failures[end.direction].words))
        last = _last_rows(self, self.found.least, self.found.greatest)
        return [*rows, *self.remarks.items(), *last]

    def report(self) -> dict[str, Any]:
        """Return the same as what `--json` prints."""
        least, greatest = self.found.least, self.found.greatest
        return {
            "load_case": self.load_case,
            "status_least": str(least.status),
            "status_greatest": str(greatest.status),
            "alpha_least": least.alpha,
            "alpha_greatest": greatest.alpha,
            "mu": self.mu,
            "certificate": _certificate(least, greatest, ("least", "greatest")),
            "words": {
                name: self.failures[end.direction].words
                for name, end in (("least", least), ("greatest", greatest))
                if end.direction in self.failures
            },
            "remarks": dict(self.remarks),
            "sha256": self.sha256,
            "version": self.version,
        }


def _moving_joints(model: RigidBlockModel, failure: Failure) -> dict[str, list[list[int]]]:
    """Name the pairs of blocks whose contacts open, and those whose contacts slide."""
    kinds = iter(failure.contact_kinds)
    found: dict[str, set[tuple[int, int]]] = {"opening": set(), "sliding": set()}
    for interface in model.interfaces:
        for _ in interface.points:
            kind = next(kinds)
            for name, pairs in found.items():
                if name in kind:
                    pairs.add((interface.block, interface.other))
    return {name: [list(pair) for pair in sorted(pairs)] for name, pairs in found.items()}


def _alphas(
    left: LimitResult | NonassociativeResult, right: LimitResult | NonassociativeResult
) -> dict[str, Any]:
    return {
        "status_left": str(left.status),
        "status_right": str(right.status),
        "alpha_left": left.alpha,
        "alpha_right": right.alpha,
    }


def _alpha(
    result: LimitResult | NonassociativeResult, words: str = "load multiplier, adequacy factor"
) -> str:
    if result.alpha is None:
        return f"{result.status}: {result.message}"
    # One that rounds to nothing has no sign.
    return f"alpha = {round(result.alpha, 4) + 0.0:.4f}  {words}"


def _last_rows(
    card: "Card | RangeCard", one: LimitResult, other: LimitResult
) -> list[tuple[str, str]]:
    return [
        ("certificate", _certified(one, other)),
        ("assumptions", ASSUMPTIONS),
        ("input", f"sha256 {card.sha256[:16]}, drystone {card.version}"),
    ]


def _certificate(
    one: LimitResult, other: LimitResult, names: tuple[str, str] = ("left", "right")
) -> dict[str, float | None]:
    ends = (one.certificate, other.certificate)
    known = [c for c in ends if c is not None]
    gaps = [None if c is None else c.gap for c in ends]
    return {
        f"gap_{names[0]}": gaps[0],
        f"gap_{names[1]}": gaps[1],
        "residual": max((c.residual for c in known), default=None),
        "violation": max((c.violation for c in known), default=None),
        "inadmissible": max((c.inadmissible for c in known), default=None),
        "slack": max((c.slack for c in known if c.slack is not None), default=None),
    }


def _certified(one: LimitResult, other: LimitResult) -> str:
    """Say how well the answers are proved."""
    known = [r.certificate for r in (one, other) if r.certificate is not None]
    if len(known) < 2:
        return "none"
    solvers = " and ".join(dict.fromkeys(r.solver for r in (one, other)))
    if any(c.fall_work is not None for c in known):
        return f"a mechanism on which the dead load does work, by {solvers}"
    residual = max(c.residual for c in known)
    gaps = [c.gap for c in known if c.gap is not None and isfinite(c.gap)]
    gap = f", forces and mechanism give the same alpha to {max(gaps):.0e}" if gaps else ""
    return f"equilibrium to {residual:.0e}{gap}, by {solvers}"
