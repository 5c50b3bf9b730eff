"""The stone stacking algorithm (Algorithm 1)."""

from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from drystone.errors import UsageError
from drystone.model.settings import typed
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.planner.attempt import Attempt
from drystone.planner.build import Build, Candidate, Solves
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.evaluate import Evaluator
from drystone.planner.events import Callbacks, Step, Stopped
from drystone.planner.observe import Measurement, Observation, observed, without
from drystone.planner.profile import Profile
from drystone.planner.replay import differences, judged, refuse
from drystone.planner.settings import PlannerSettings
from drystone.planner.vary import WEIGHT_DRAWS, varied
from drystone.planner.workshop import Workshop


@typed
class Planner:
    """Plans one wall; drive it with :meth:`steps`.

    Parameters
    ----------
    stones : StoneSet
        To build with.
    site : Site
        Where, and at which working resolution.
    seed : int
        Of the random samples; each step's are drawn from (seed, step, failures), so a plan can be
        resumed from any step.
    settings : PlannerSettings
        All parameters.
    executor : concurrent.futures.Executor, optional
        Evaluates candidates; must share memory, such as a thread pool.  The result does not
        depend on it.
    callbacks : Callbacks, optional
        Told of every :class:`Step`.
    workshop : Workshop, optional
        The same stones, site and settings, prepared before.
    profile : Profile, optional
        To go on with; told where the time goes.

    Examples
    --------
    >>> import drystone as ds
    >>> bricks = ds.generate.BrickSettings(count=3, height_px=10, aspect=2)
    >>> stones = ds.generate.brick_stones(bricks, np.random.default_rng(1))
    >>> planner = ds.Planner(stones, ds.Site(60, 10))
    >>> len(list(planner.steps()))
    3
    """

    def __init__(
        self,
        stones: StoneSet,
        site: Site,
        *,
        seed: int = 0,
        settings: PlannerSettings | None = None,
        executor: Executor | None = None,
        callbacks: Callbacks | None = None,
        workshop: Workshop | None = None,
        profile: Profile | None = None,
    ) -> None:
        if seed < 0:
            what = f"{seed} is not a seed."
            raise UsageError("E138", what, where="--seed", cure="Give 0 or more.")
        self.seed = seed
        self.settings = settings or PlannerSettings()
        self.profile = profile or Profile()
        with self.profile.part("preparation"):
            self.workshop = workshop or Workshop.prepare(stones, site, self.settings)
        self.executor = executor
        # Every wall has weights of its own, all its steps the same.
        rng = np.random.default_rng([seed, WEIGHT_DRAWS])
        spread = self.settings.vary
        self._weighted = varied(self.settings, spread, rng) if spread else self.settings
        self._keep = self.settings.search.budget > 1  # a search goes back to states before
        self.build = self._empty()
        self.stopped: Stopped | None = None
        self.solves = Solves()
        self.callbacks = callbacks or Callbacks()

    def steps(self, until: Deadline = NEVER) -> Iterator[Step]:
        """Place stone after stone (Algorithm 1), yielding each step as it is decided.

        After the last step :attr:`stopped` says why construction ended.  Leaving the loop early
        keeps what is built; calling `steps` again goes on from there.  Between two steps the wall
        may be measured (:meth:`observe`).

        Parameters
        ----------
        until : Deadline
            Looked at for every candidate.

        Raises
        ------
        TimeIsUp
            It has struck; as after leaving the loop, what is built is kept.
        """
        self.stopped = None
        attempt = self._attempt(until)
        failures = 0  # zeta
        aside: set[int] = set()
        while (stopped := self._why_stop(failures, aside, attempt)) is None:  # lines 5 and 27
            rng = np.random.default_rng([self.seed, len(self.build.actions), failures])
            action = self._choose(attempt, rng, aside)  # lines 6-17
            if action is None:
                failures += 1  # lines 23-26: resample
                continue
            self.solves += attempt.solves
            self.build = self.build.add(action, keep=self._keep)  # lines 18-22
            step = Step(len(self.build.actions), action, self.build, attempt.candidates)
            self.profile.end_step(step.number - 1, step.candidates)
            self.callbacks.on_step(step)
            yield step
            # After it: the wall may have been measured meanwhile.
            attempt, failures = self._attempt(until), 0
        self.solves += attempt.solves
        self.profile.end_without_action(attempt.candidates)
        self.stopped = stopped

    @property
    def finished(self) -> Stopped | None:
        """Why there is nothing to place any more; None where it has to be tried."""
        return self._why_stop(0, set())

    def _choose(
        self, attempt: Attempt, rng: np.random.Generator, aside: set[int]
    ) -> Candidate | None:
        """Return the next action; a stone that is next and cannot be placed is set aside."""
        left = self._left(aside)
        if self.settings.order == "given":
            action = attempt.choose(rng, left[:1])
            aside.update(left[:1] if action is None else ())
            return action
        pinned = [i for i in left if i in self.settings.pin]
        if pinned and self.settings.selection_rule != "score":
            # No cost prefers them there: neither Algorithm 2 nor a policy knows of pins.
            return attempt.choose(rng, pinned) or attempt.choose(rng)
        return attempt.choose(rng)

    def _left(self, aside: set[int]) -> tuple[int, ...]:
        """Return the stones that may be placed next: in a given order those after the last."""
        left = self.workshop.remaining(self.build)
        if self.settings.order == "free":
            return left
        last = max((action.stone_id for action in self.build.actions), default=-1)
        return tuple(i for i in left if i > last and i not in aside)

    def _attempt(self, until: Deadline) -> Attempt:
        self.profile.begin_step()
        return Attempt(
            self.workshop, self._weighted, self.build, self.executor, self.profile, until
        )

    def _empty(self) -> Build:
        exact, mean_area_px = self.settings.geometry == "exact", self.workshop.stock.mean_area_px
        return Build.empty(self.workshop.site, self.settings.mu, mean_area_px, exact=exact)

    def _why_stop(
        self, failures: int, aside: set[int], attempt: Attempt | None = None
    ) -> Stopped | None:
        """Say why construction ends here; None when it goes on."""
        stop = self.settings.stop
        if self.build.wall.filling > stop.filling:
            return Stopped("filled", f"filling above {stop.filling}")
        if not self.workshop.remaining(self.build):
            banned = len(set(self.settings.ban))
            left = len(self.workshop.stones) - len(self.build.actions) - banned
            which = [text for text, there in (("are not banned", banned), ("fit", left)) if there]
            those = f" that {' and '.join(which)}" if which else ""
            return Stopped("stones", f"all stones{those} placed")
        if self.settings.order == "given":
            if self._left(aside):
                return None
            return Stopped("failures", "no stone is left that was not tried in its turn")
        # There is nothing to resample when all stones were tried.
        if failures >= stop.failures or (failures and self.settings.sampling == "full"):
            declined = attempt is not None and attempt.declined
            took_none = "the policy took none of the places it was offered"
            return Stopped(
                "failures", took_none if declined else "no stone that is left can be placed"
            )
        return None

    def restore(self, wall: Wall, course_heights_px: Mapping[int, float]) -> None:
        """Go on from a wall, on the planner's site and of its stones, that is built already.

        `course_heights_px` is the height that Eq. 8 compared with, for stones that began a course.
        UsageError (E144): it is of something else than what this planner builds.
        """
        workshop = self.workshop
        refuse(differences(wall, workshop.stones, workshop.site, self.settings), "wall")
        evaluator = Evaluator(self.settings, workshop.stock, self.profile)
        build = self._empty()
        for group in wall.groups:
            action = judged(build, group, course_heights_px, evaluator)
            build = build.add(action, keep=self._keep)
        self.build = build
        self.stopped = None  # that was of another wall

    @typed
    def observe(self, measured: Measurement, *, lost: Iterable[int] = ()) -> Observation:
        """Go on from the wall as it was really built.

        Stones are put where they were measured, in their order of placement, those that were not
        planned last; where some do not stand so, or are far off, and others were not planned, it
        is tried from below as well.  Measured poses are never exact: a stone that would overlap
        others, float or fall is brought apart from them and lowered until it rests, from where it
        was measured; one that was planned on wedges gets a wedge that fits there.  A stone that is
        where it was planned stays as it is if the wall stands so; when all are, nothing changes,
        otherwise :attr:`stopped` is None again.

        Parameters
        ----------
        measured : mapping of int to MeasuredPose, or (h, w) integer array
            Where every stone in the wall is (``drystone.planner.measured``): stones that are
            missing are free again, others than planned are taken over.
        lost : iterable of int
            Stones that cannot be used any more: broken, or out of reach.

        Returns
        -------
        observation : Observation
            How far the wall is from the plan, and whether it stands; W124, W127.

        Raises
        ------
        InputError
            E195: there is no such stone; E196: the picture is none of the wall; E197: a pose is
            not in the wall, or a stone is seen in part only; E198: a stone overlaps others and
            has no room nearby.  Nothing has changed then.
        UsageError
            E199: a stone is lost and in the wall.

        Examples
        --------
        >>> import drystone as ds
        >>> from drystone.planner.measured import MeasuredPose
        >>> bricks = ds.generate.BrickSettings(count=3, height_px=10, aspect=2)
        >>> stones = ds.generate.brick_stones(bricks, np.random.default_rng(1))
        >>> planner = ds.Planner(stones, ds.Site(60, 10))
        >>> step = next(planner.steps())
        >>> x, y = step.action.stabilised.placement.centroid(10)
        >>> seen = planner.observe({step.stone_id: MeasuredPose(x + 1.0, y, 0.0)})
        >>> seen.largest_px, seen.stands
        (1.0, True)
        """
        lost = tuple(lost)
        ids = self.workshop.wedge_ids.union(wedge.id for wedge in self.build.wall.wedges)
        self.workshop = replace(self.workshop, wedge_ids=ids)
        build, observation = observed(
            self._empty(), self.build, measured, lost, self.workshop, self.settings
        )
        if lost:
            self.workshop, self.settings = without(observation.lost, self.workshop, self.settings)
            ban, pin = self.settings.ban, self.settings.pin
            self._weighted = replace(self._weighted, ban=ban, pin=pin)
        if lost or build is not self.build:
            self.stopped = None  # that was of another wall, or of more stones
        self.build = build
        return observation
