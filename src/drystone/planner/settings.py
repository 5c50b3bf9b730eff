"""All parameters that shape a plan, composed; and the named methods."""

import dataclasses
import types
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

from drystone.clusters import ClusterSettings
from drystone.errors import UsageError
from drystone.model.settings import check_finite, updated
from drystone.model.wedge_shape import WedgeSettings
from drystone.placement.settings import PlacementSettings
from drystone.planner.search_settings import GoalSettings, SearchSettings
from drystone.poses import orientation_step_deg
from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.policies.registry import PAPER, RULES
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.sampling import Sampling
from drystone.selection.scored import ScoreSettings
from drystone.settle.settings import SettleSettings
from drystone.stabilise.settings import StabiliseSettings

MOST_MU = 1e6
"""A larger coefficient of friction is none; forces are multiplied by it."""


@dataclass(frozen=True, kw_only=True)
class StopSettings:
    """When construction ends (Algorithm 1, line 27).

    Parameters
    ----------
    filling : float
        Filling ratio at which the design goal is reached.
    failures : int
        Consecutive failures that end construction.
    """

    filling: float = 0.99
    failures: int = 5

    def __post_init__(self) -> None:
        if not 0 < self.filling <= 1 or self.failures < 1:
            raise ValueError("filling must be in (0, 1], failures positive")


@dataclass(frozen=True, kw_only=True)
class PlannerSettings:
    """Every parameter of the planner.

    Parameters
    ----------
    geometry : {"raster", "exact"}
        Stones are their pixels at the working resolution, or settle on the outlines of the source
        image (DESIGN 4.9).
    orientations : str
        ``"sf"``, ``"quarter"``, or a step such as ``"10deg"`` (DESIGN 4.2).
    orientation_choice : {"candidates", "placement"}
        With several orientations: each is a candidate of its own, or the placement rule picks one
        per stone.
    sampling : {"variant", "uniform", "twofold", "full"}
        Which stones are tried in a step (§3.4, §5.1): ``"variant"``: one at random from each
        cluster; ``"uniform"``: as many as there were clusters at first, at random; ``"twofold"``:
        as variant, then all of the winner's cluster; ``"full"``: all that are left.
    selection_rule : str
        ``"algorithm2"``: the paper's filters and sums; ``"score"``: the least craft cost
        (:mod:`drystone.selection.scored`); or the name of a policy, with which a search's budget
        must be 1.
    two_sided : bool
        Build from both ends (Eq. 29).
    mu : float
        Coefficient of friction.
    vary : float
        Standard deviation of the logarithm of random factors, drawn from the seed, on the craft
        weights of a wall.
    skip_too_large : bool
        Leave out stones that fit into the wall in no orientation instead of refusing them.
    order : {"free", "given"}
        Which stone is next: any that is left, or the one with the smallest id; one that cannot be
        placed then is set aside for good.
    ban : tuple of int
        Ids of stones that are not used.
    pin : tuple of int
        Ids of stones that must be in the wall: they are preferred, and each that is missing counts
        10 units of merit against a wall.
    clusters, placement, stabilise, settle, wedge, selection, policy, score, search, goal, stop
        Settings of the stages.
    """

    geometry: Literal["raster", "exact"] = "raster"
    orientations: str = "sf"
    orientation_choice: Literal["candidates", "placement"] = "candidates"
    sampling: Sampling = "variant"
    selection_rule: str = "algorithm2"
    two_sided: bool = False
    mu: float = 0.58
    vary: float = 0.0
    skip_too_large: bool = False
    order: Literal["free", "given"] = "free"
    ban: tuple[int, ...] = ()
    pin: tuple[int, ...] = ()
    clusters: ClusterSettings = field(default_factory=ClusterSettings)
    placement: PlacementSettings = field(default_factory=PlacementSettings)
    stabilise: StabiliseSettings = field(default_factory=StabiliseSettings)
    settle: SettleSettings = field(default_factory=SettleSettings)
    wedge: WedgeSettings = field(default_factory=WedgeSettings)
    selection: SelectionSettings = field(default_factory=SelectionSettings)
    policy: PolicySettings = field(default_factory=PolicySettings)
    score: ScoreSettings = field(default_factory=ScoreSettings)
    search: SearchSettings = field(default_factory=SearchSettings)
    goal: GoalSettings = field(default_factory=GoalSettings)
    stop: StopSettings = field(default_factory=StopSettings)

    def __post_init__(self) -> None:
        check_finite(self)
        orientation_step_deg(self.orientations)
        if self.geometry not in ("raster", "exact"):
            raise ValueError(f"unknown geometry {self.geometry!r}")
        if self.sampling not in get_args(Sampling):
            raise ValueError(f"unknown sampling {self.sampling!r}")
        if self.orientation_choice not in ("candidates", "placement"):
            raise ValueError(f"unknown orientation choice {self.orientation_choice!r}")
        self._check_rule()
        if self.vary < 0:
            raise ValueError("vary must not be negative")
        if self.order not in ("free", "given"):
            raise ValueError(f"unknown order {self.order!r}")
        both = sorted(set(self.ban) & set(self.pin))
        if both:
            raise ValueError(f"ban and pin name the same stones: {', '.join(map(str, both))}")
        if not self.mu > 0:
            raise ValueError("mu must be positive")
        if self.mu > MOST_MU:
            raise ValueError(f"mu must be at most {MOST_MU:g}")

    def _check_rule(self) -> None:
        # Whether there is such a policy is asked where it chooses: a plan can be checked without
        # the package that its policy is of.
        if self.selection_rule in ("", PAPER):
            raise ValueError(
                f"unknown selection rule {self.selection_rule!r}; the paper's is 'algorithm2'"
            )
        if self.geometry == "raster" and self.search.budget > 1:
            raise ValueError(
                "better walls are looked for on outlines alone: "
                "geometry must be 'exact', or search.budget 1"
            )
        if self.by_policy and self.search.budget > 1:
            raise ValueError(
                f"the policy {self.selection_rule!r} builds a single wall: search.budget must be 1"
            )

    @property
    def by_policy(self) -> bool:
        """True when a policy chooses (:mod:`drystone.selection.policies`), not a rule of ours."""
        return self.selection_rule not in RULES

    @property
    def weighs_craft(self) -> bool:
        """True when a choice depends on craft costs (:mod:`drystone.selection.scored`)."""
        return self.selection_rule == "score" or self.placement.compare

    def as_dict(self) -> dict[str, Any]:
        """Return nested dictionaries, as TOML and JSON write them.

        Without the settings of policies when none chooses.
        """
        values = dataclasses.asdict(self)
        if not self.by_policy:
            del values["policy"]
        return values | {"ban": list(self.ban), "pin": list(self.pin)}

    def updated(self, changes: Mapping[str, Any]) -> "PlannerSettings":
        """Return settings with some values replaced.

        Parameters
        ----------
        changes : mapping
            Nested like :meth:`as_dict`; missing keys stay as they are.

        Raises
        ------
        UsageError
            E123: an unknown name, or a value out of range.
        """
        return updated(self, changes)


METHODS: Mapping[str, PlannerSettings] = types.MappingProxyType(
    {
        "paper": PlannerSettings(),
        "best": PlannerSettings(
            geometry="exact",
            orientations="quarter",
            sampling="full",
            two_sided=True,
            selection_rule="score",
            vary=0.3,
            placement=PlacementSettings(rule="snug", reach="above", tries=4, compare=True),
            stabilise=StabiliseSettings(margin=0.1, min_wedge_px=1),
            score=ScoreSettings(thickness=1.5, llc=4.0),
            search=SearchSettings(budget=16),
        ),
    }
)
"""Named settings: ``"paper"`` is the paper's greedy with its defaults, ``"best"`` the default."""


def method_settings(method: str) -> PlannerSettings:
    """Return the settings of a named method; raise UsageError (E124) for an unknown one."""
    if method not in METHODS:
        raise UsageError(
            "E124",
            f"there is no method {method!r}.",
            where="--method",
            cure=f"Choose one of {', '.join(METHODS)}.",
        )
    return METHODS[method]
