"""The environment ``drystone/Wall-v0``: stones arrive, each is built where it is offered."""

from collections.abc import Mapping
from copy import copy, deepcopy
from dataclasses import asdict
from operator import index
from typing import Any, Literal, get_args

import gymnasium
import numpy as np
from gymnasium import spaces
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drystone.drawing.pictures.wall import plot_wall
from drystone.errors import UsageError
from drystone.metrics.shape import top_profile
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.selection.policies.learned import FEATURES, features
from drystone_lab.rl.episode import ARRIVING, DrawSettings, Episode, draw_wall

WallObservation = dict[str, NDArray[np.float32]]

STONE = ("area", "width", "height")
"""Of an offer, beside its features: of the stone over the wall's, the same for all its offers but
for how it lies."""


def observation(episode: Episode, offers: int, columns: int) -> WallObservation:
    """Return what is seen.

    ``"offers"``, (offers, F): a row an offer (:data:`FEATURES`, then :data:`STONE`), zeros where
    there is none.  ``"profile"``, (columns,): height of the wall's top from left to right over the
    height that it is to have, means of equal parts of its width.  ``"left"``, (2,): the share of
    the stones that have not arrived yet, and of the wall that is still to be filled.
    """
    fitting = max(1, len(episode.workshop.fitting))
    left = np.array([episode.waiting / fitting, 1.0 - episode.build.wall.filling])
    offered, wall = episode.offers, episode.build.wall
    rows = np.zeros((offers, len(FEATURES) + len(STONE)))
    if offered:
        stone = [
            (
                o.area_px / (o.wall_width_px * o.wall_height_px),
                o.width_px / o.wall_width_px,
                (o.top_px - o.bottom_px) / o.wall_height_px,
            )
            for o in offered
        ]
        rows[: len(offered)] = np.column_stack([features(offered), np.clip(stone, 0.0, 1.0)])
    heights = top_profile(wall.labels) / wall.site.height_px
    # Parts need not be whole columns of pixels: the mean is that of the integral between its ends.
    integral = np.concatenate([[0.0], np.cumsum(heights)])
    ends = np.linspace(0.0, wall.site.width_px, columns + 1)
    at_ends = np.interp(ends, np.arange(len(integral)), integral)
    profile = np.clip(np.diff(at_ends) / np.diff(ends), 0.0, 1.0)
    seen = {"offers": rows, "profile": profile, "left": np.clip(left, 0.0, 1.0)}
    return {name: values.astype(np.float32) for name, values in seen.items()}


Illegal = Literal["aside", "error"]

OPTIONS = ("stones", "site", "order")
"""What :meth:`WallEnv.reset` may be told."""


class WallEnv(gymnasium.Env[WallObservation, np.int64]):
    """Build a wall from stones that arrive in a random order.

    An action says which of the places offered for the stone that has arrived it is built in.  A
    stone for which no place is offered is put aside for good, and the next arrives within the
    same step.  The wall is finished when it is full or no stone is left; it is never truncated.
    Where no place is offered from the start, any action ends the episode for a reward of 0.

    The reward is what the merit of the wall grows by (:mod:`drystone.search.goal`, weights in
    ``settings.goal``): while it grows by filling and resistance alone, with the last stone by all
    that makes up its merit.  So the rewards of an episode sum up to the merit of the finished
    wall, 0 for an empty one.

    A deep copy goes on by itself and shares the stones with the first.

    `draw` says what stones are drawn for an episode, unless :meth:`reset` is given some, `settings`
    how places are found (:data:`drystone_lab.rl.episode.ARRIVING` when missing).  At most `offers`
    places are offered, the lowest of them: the number of actions.  `columns` are those of the top
    profile that is seen.  `illegal` is what an action does that :meth:`action_masks` does not
    allow: with "aside" the stone is put aside for a reward of 0 (of the wall's joints and edges,
    when it was the last), with "error" E151 is raised.  With the `render_mode` "rgb_array"
    :meth:`render` draws the wall.

    Examples
    --------
    >>> import gymnasium, drystone_lab.rl
    >>> env = gymnasium.make("drystone/Wall-v0")
    >>> seen, info = env.reset(seed=1)
    >>> seen["offers"].shape, int(env.unwrapped.action_masks().sum())
    ((8, 28), 8)
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 4}  # noqa: RUF012 - as its base class

    def __init__(
        self,
        *,
        draw: DrawSettings | None = None,
        settings: PlannerSettings | None = None,
        offers: int = 8,
        columns: int = 32,
        illegal: Illegal = "aside",
        render_mode: str | None = None,
    ) -> None:
        if offers < 1 or columns < 1:
            raise _refused("offers and columns must be positive")
        if illegal not in get_args(Illegal):
            raise _refused(f"illegal is {illegal!r}, which is none of {get_args(Illegal)}")
        if render_mode not in (None, "rgb_array"):
            raise _refused(f"render_mode is {render_mode!r}, which is neither 'rgb_array' nor None")
        self.draw = draw or DrawSettings()
        self.settings = settings or ARRIVING
        self.render_mode = render_mode
        shape = (offers, len(FEATURES) + len(STONE))
        space: Any = spaces.Dict(
            {
                "offers": spaces.Box(-1.0, 1.0, shape, np.float32),
                "profile": spaces.Box(0.0, 1.0, (columns,), np.float32),
                "left": spaces.Box(0.0, 1.0, (2,), np.float32),
            }
        )
        self.observation_space = space  # a Dict does not know of what its values are
        self.action_space = spaces.Discrete(offers)
        self._offers, self._columns = offers, columns
        self._illegal = illegal
        self._episode: Episode | None = None
        self._ended = False

    def reset(
        self, *, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[WallObservation, dict[str, Any]]:
        """Begin a wall.

        Options: ``"stones"`` (a StoneSet) with ``"site"`` (a Site) instead of stones that are
        drawn; and ``"order"``, ids in the order of arrival, random when missing.  E123: other
        options, or an order that is none; E126: there are no stones; E201: an id is no stone's.
        """
        super().reset(seed=seed)
        stones, site, order = self._given(options or {})
        workshop = Workshop.prepare(stones, site, self.settings)
        self._episode = Episode(workshop, order, self.settings, self._offers)
        self._ended = False
        return self._told(illegal=False)

    def step(self, action: np.int64) -> tuple[WallObservation, float, bool, bool, dict[str, Any]]:
        """Build the stone that has arrived; see :class:`gymnasium.Env`.

        E151: there is no such action, the episode is over, or with ``illegal="error"`` the place is
        not offered.
        """
        episode = self.episode
        if self._ended:
            raise _no_action("the wall is finished", "Call `reset`.")
        if not self.action_space.contains(action):
            raise _no_action(f"{action!r} is none of {self.action_space}", "Give one of these.")
        if episode.over:  # `reset` cannot say that an episode is over before it began
            self._ended = True
            seen, info = self._told(illegal=True)
            return seen, 0.0, True, False, info
        legal = int(action) < len(episode.offers)
        if not legal and self._illegal == "error":
            raise _no_action(
                f"{int(action)} is not among the {len(episode.offers)} places offered",
                "Ask `action_masks` which are.",
            )
        before = episode.potential
        episode.take(int(action) if legal else None)
        self._ended = episode.over
        seen, info = self._told(illegal=not legal)
        return seen, episode.potential - before, self._ended, False, info

    def action_masks(self) -> NDArray[np.bool_]:
        """Return which actions are allowed, (offers,): none when the wall is finished.

        The name is the one that MaskablePPO of sb3-contrib asks for.
        """
        return np.arange(self._offers) < len(self.episode.offers)

    def render(self) -> NDArray[np.uint8] | None:
        """Draw the wall with what it carries above, (400, 800, 3) RGB; None without a mode."""
        if self.render_mode is None:
            gymnasium.logger.warn(
                "The wall is drawn with render_mode='rgb_array', which was not asked for."
            )
            return None
        figure = Figure(figsize=(8.0, 4.0), dpi=100)
        canvas: Any = FigureCanvasAgg(figure)
        ax = figure.add_axes((0.05, 0.14, 0.9, 0.76))
        episode = self.episode
        title = (
            f"{len(episode.build.actions)} stones built, {episode.aside} put aside, "
            f"{episode.waiting} to come; F_SF {episode.build.wall.filling:.2f}, "
            f"F_LR {episode.carried:.2f}"
        )
        plot_wall(episode.build.wall, episode.workshop.clusters, ax, title=title)
        canvas.draw()
        return np.array(np.asarray(canvas.buffer_rgba())[..., :3])

    def __deepcopy__(self, memo: dict[int, Any]) -> "WallEnv":
        other = copy(self)
        # The workshop of an episode has compiled parts that nothing can copy; it may be shared.
        other._episode = None if self._episode is None else self._episode.copy()  # noqa: SLF001
        for name in ("action_space", "observation_space", "_np_random"):  # all draw numbers
            setattr(other, name, deepcopy(getattr(self, name), memo))
        memo[id(self)] = other
        return other

    @property
    def episode(self) -> Episode:
        """The wall, and what is offered: for policies that see offers and not arrays."""
        if self._episode is None:
            raise _no_action("no wall was begun", "Call `reset` first.")
        return self._episode

    def _given(self, options: Mapping[str, Any]) -> tuple[StoneSet, Site, list[int] | None]:
        """Return stones, site and order: those given, or drawn."""
        unknown = sorted(set(options) - set(OPTIONS))
        if unknown:
            raise _refused(f"reset knows no option {', '.join(map(repr, unknown))}")
        stones, site, order = (options.get(name) for name in OPTIONS)
        if stones is None and site is None and order is None:
            return *draw_wall(self.draw, self.np_random), None
        if not isinstance(stones, StoneSet) or not isinstance(site, Site):
            raise _refused("reset needs both a StoneSet and a Site, or draws both")
        if order is None:
            ids = [stone.id for stone in stones]
            return stones, site, [ids[k] for k in self.np_random.permutation(len(ids)).tolist()]
        try:
            ids = [stones.by_id(index(stone_id)).id for stone_id in order]
        except TypeError as error:
            raise _refused(f"order is {order!r}, which is not a sequence of ids") from error
        if not ids or len(set(ids)) < len(ids):
            raise _refused("no stone arrives" if not ids else "a stone arrives twice")
        return stones, site, ids

    def _told(self, *, illegal: bool) -> tuple[WallObservation, dict[str, Any]]:
        """Return what is seen, and what is said beside; all figures when the wall is finished."""
        episode = self.episode
        info: dict[str, Any] = {
            "stone": episode.stone_id or 0,
            "placed": len(episode.build.actions),
            "aside": episode.aside,
            "illegal": illegal,
            "action_mask": self.action_masks().astype(np.int8),
            "F_SF": episode.build.wall.filling,
            "F_LR": episode.carried,
        }
        if episode.over:
            figures = episode.figures
            info["merit"] = episode.merit
            info["metrics"] = {} if figures is None else asdict(figures)
        return observation(episode, self._offers, self._columns), info


def _refused(what: str) -> UsageError:
    cure = "docs/evidence/learning.md lists what there is."
    return UsageError("E123", f"{what}.", where="drystone/Wall-v0", cure=cure)


def _no_action(what: str, cure: str) -> UsageError:
    return UsageError("E151", f"{what}.", where="drystone/Wall-v0", cure=cure)
