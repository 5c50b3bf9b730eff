"""Every trial placement of a run at which the stone falls, turned and wedged (§3.7)."""

from dataclasses import dataclass, replace

from drystone.model.placement import Wedge
from drystone.stabilise.rotate import rotate_to_rest
from drystone.stabilise.stabilise import WedgeStock, make_stable
from drystone.stabilise.support import Pose, falling_side, support_polyline
from drystone_lab.pictures.support import Standing
from drystone_lab.reproduce.construction import Construction, Moment


@dataclass(frozen=True, eq=False)
class Unstable:
    """A stone that falls where the rule of placement puts it.

    Parameters
    ----------
    moment : Moment
        What is built.
    trial : Standing
        The stone there.
    turned : Standing or None
        Where it rests after turning; None when it meets the landscape before.
    pivots : int
        About how many points it was turned.
    wedged : Standing or None
        In its place on wedges; None when no wedge within the limits holds it.
    """

    moment: Moment
    trial: Standing
    turned: Standing | None
    pivots: int
    wedged: Standing | None

    @property
    def stone_id(self) -> int:
        """Id of the stone."""
        return self.trial.pose[0].stone.id

    @property
    def turn_deg(self) -> float | None:
        """How far it was turned, counter-clockwise, in [-180, 180)."""
        if self.turned is None:
            return None
        turn = self.turned.pose[0].angle_deg - self.trial.pose[0].angle_deg
        return float((turn + 180.0) % 360.0 - 180.0)

    @property
    def sign_agrees(self) -> bool:
        """Whether AB x AC says to which side the centre of mass is beyond A."""
        return (self.trial.cross < 0) == (self.trial.falls > 0)

    @property
    def hangs(self) -> bool:
        """Whether its centre of mass is below A."""
        return self.trial.mass[1] < self.trial.ends[0][1]


def unstable_trials(built: Construction) -> tuple[int, tuple[Unstable, ...]]:
    """Try every stone that is left before each step of a run.

    Returns
    -------
    trials : int
        How many were tried and had a position.
    unstable : tuple of Unstable
        Those that fall.
    """
    count, found = 0, []
    for moment in built.moments:
        for stone_id in moment.remaining:
            trial = moment.trial(stone_id)
            if trial is None:
                continue
            count += 1
            standing = _standing(moment, trial)
            if standing is not None and standing.falls:
                found.append(_treated(moment, standing))
    return count, tuple(found)


def _treated(moment: Moment, trial: Standing) -> Unstable:
    """Turn a stone that falls, and wedge it instead."""
    occupied, workshop = moment.wall.occupied, moment.workshop
    settings = moment.settings.stabilise
    rotation = rotate_to_rest(occupied, trial.pose, workshop.book, settings)
    turned = None if rotation.pose is None else _standing(moment, rotation.pose)
    wedging = replace(settings, method="wedge")
    first = max([workshop.stock.largest_id, *(wedge.id for wedge in moment.wall.wedges)]) + 1
    stock = WedgeStock(first, workshop.stock.mean_height_px)
    cut = make_stable(occupied, trial.pose, "left", workshop.book, stock, wedging).stabilised
    wedged = None if cut is None else _standing(moment, trial.pose, cut.wedges)
    return Unstable(moment, trial, turned, rotation.pivots, wedged)


def _standing(moment: Moment, pose: Pose, wedges: tuple[Wedge, ...] = ()) -> Standing | None:
    """Return a stone on what is there and its wedges; None when nothing supports it."""
    scene = moment.wall.occupied.copy()
    for wedge in wedges:
        scene[wedge.window] |= wedge.mask
    support = support_polyline(scene, *pose)
    if support is None:
        return None
    falls = falling_side(support, pose, moment.settings.stabilise)
    return Standing(pose, support, falls, wedges, len(scene))
