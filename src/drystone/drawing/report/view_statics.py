"""Contacts, forces and mechanisms as the viewer wants them."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.drawing.pictures.mechanism import motion_of
from drystone.model.wall import Labels
from drystone.statics.failing.mechanism import Failure, describe_mechanism
from drystone.statics.failing.wording import Noun
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus

Floats = NDArray[np.float64]
Shapes = Labels | Mapping[int, Floats]

FALLS = "It does not stand under its own weight."
UNKNOWN = "The analysis has no answer that could be certified."
ENDLESS = "No load in this direction brings it down."


@dataclass(frozen=True, eq=False)
class Statics:
    """A wall's contacts and its limit analysis.

    Parameters
    ----------
    shapes : (h, w) integer array, or mapping of int to (n, 2) float array
        What the blocks look like, in the frame of the model.
    model : RigidBlockModel
        Blocks and interfaces.
    resistance : LateralResistance
        Of this model; with mechanisms and forces where it has them.
    noun : {"stone", "block"}
        What a block is called.
    wedges : collection of int
        Blocks that are wedges.
    """

    shapes: Shapes
    model: RigidBlockModel
    resistance: LateralResistance
    noun: Noun = "stone"
    wedges: Collection[int] = ()

    @property
    def sides(self) -> dict[str, LimitResult]:
        """Both directions by name."""
        return {"left": self.resistance.left, "right": self.resistance.right}

    def failures(self) -> dict[str, Failure]:
        """Describe the mechanisms that are known."""
        return {
            side: describe_mechanism(
                self.model,
                result.mechanism,
                falls=result.status is LimitStatus.UNSTABLE,
                noun=self.noun,
                wedges=self.wedges,
            )
            for side, result in self.sides.items()
            if result.mechanism is not None
        }


def scaled_resistance(resistance: LateralResistance, factor: float) -> LateralResistance:
    """Return a limit analysis in another unit of length, `factor` of them in an old one.

    Weights are areas, so forces grow by its square; the largest displacement of a mechanism stays
    1, so what turns does so slower in finer units.
    """
    return replace(
        resistance,
        left=_scaled(resistance.left, factor),
        right=_scaled(resistance.right, factor),
    )


def _scaled(result: LimitResult, factor: float) -> LimitResult:
    mechanism, forces = result.mechanism, result.forces
    if mechanism is not None:
        velocity = mechanism.velocity * np.array([1.0, 1.0, 1.0 / factor])
        mechanism = replace(mechanism, velocity=velocity)
    return replace(
        result, mechanism=mechanism, forces=None if forces is None else forces * factor**2
    )


def forces_by_case(resistance: LateralResistance) -> dict[str, Floats]:
    """Return normal and tangential forces of the load cases "self", "left", "right" that have them.

    Under its own weight alone a wall has many states of forces.  One is given: the mixture of
    those at the two limit loads in which the live loads cancel, which is in equilibrium and
    within friction as both are.
    """
    left, right = resistance.left, resistance.right
    found = {
        side: result.forces
        for side, result in (("left", left), ("right", right))
        if result.forces is not None
    }
    if len(found) == 2 and left.alpha is not None and right.alpha is not None:
        total = left.alpha + right.alpha
        share = right.alpha / total if total > 0 else 0.5
        found = {"self": share * found["left"] + (1 - share) * found["right"], **found}
    return found


def contacts(statics: Statics, failures: Mapping[str, Failure], digits: int) -> list[Any]:
    """Return where blocks touch, what the joints carry, and what they do in the mechanisms.

    Parameters
    ----------
    statics : Statics
        The wall.
    failures : mapping
        Its mechanisms, described, by side.
    digits : int
        Of lengths.

    Returns
    -------
    contacts : list of dict
        ``between`` (the normal points into the first), ``points``, ``normal``, ``forces`` by load
        case ([normal, tangential] at every point as shares of the weight of all free blocks; the
        tangent of a normal (x, y) is (y, -x)), ``kinds`` by side.
    """
    cases = forces_by_case(statics.resistance)
    weight = sum(block.weight for block in statics.model.blocks if not block.fixed) or 1.0
    made, start = [], 0
    for interface in statics.model.interfaces:
        at = slice(start, start + len(interface.points))
        start = at.stop
        made.append(
            {
                "between": [interface.block, interface.other],
                "points": rounded(interface.points, digits),
                "normal": rounded(interface.normal, 5),
                "forces": {case: rounded(f[at] / weight, 6) for case, f in cases.items()},
                "kinds": {side: list(f.contact_kinds[at]) for side, f in failures.items()},
            }
        )
    return made


def mechanisms(
    statics: Statics,
    failures: Mapping[str, Failure],
    centroids: Mapping[int, tuple[float, float]],
) -> dict[str, Any]:
    """Return how the wall fails to each side.

    Parameters
    ----------
    statics, failures
        As for :func:`contacts`.
    centroids : mapping of int to (float, float)
        Points of the blocks that velocities are given of.

    Returns
    -------
    mechanisms : dict
        By side: ``status``, ``alpha``, ``words``, ``velocity`` by id (to the right, up, turning
        counter-clockwise, rad; None when there is no mechanism) and ``scale``, by which
        velocities become displacements of a size that is seen.
    """
    return {
        side: {
            "status": str(result.status),
            "alpha": _rounded(result.alpha, 6),
            "words": _words(result, failures.get(side)),
            **_motion(statics, result, centroids),
        }
        for side, result in statics.sides.items()
    }


def _words(result: LimitResult, failure: Failure | None) -> str:
    said = {
        LimitStatus.UNSTABLE: FALLS,
        LimitStatus.FAILED: UNKNOWN,
        LimitStatus.UNBOUNDED: ENDLESS,
    }.get(result.status, "")
    return " ".join(part for part in (said, failure.words if failure else "") if part)


def _motion(
    statics: Statics, result: LimitResult, centroids: Mapping[int, tuple[float, float]]
) -> dict[str, Any]:
    mechanism = result.mechanism
    if mechanism is None:
        return {"velocity": None, "scale": 0.0}
    shown = motion_of(statics.shapes, mechanism).displacement
    largest = float(np.abs(mechanism.velocity).max(initial=0.0))
    scale = float(np.abs(shown).max(initial=0.0)) / largest if largest else 0.0
    known = {block.id: np.array(block.centroid) for block in statics.model.blocks}
    velocity = {}
    for block, (vx, vy, turning) in zip(mechanism.block_ids, mechanism.velocity, strict=True):
        # A mechanism has the velocity of the block's own centroid.
        arm_x, arm_y = np.array(centroids[block]) - known[block]
        twist = (vx - turning * arm_y, vy + turning * arm_x, turning)
        if any(abs(value) > 1e-9 for value in twist):
            velocity[str(block)] = [float(f"{value:.7g}") for value in twist]
    return {"velocity": velocity, "scale": float(f"{scale:.7g}")}


def rounded(values: Any, digits: int) -> Any:
    """Return numbers as nested lists of few digits; never -0."""
    return (np.round(np.asarray(values, float), digits) + 0.0).tolist()


def _rounded(value: float | None, digits: int) -> float | None:
    return None if value is None else round(value, digits) + 0.0
