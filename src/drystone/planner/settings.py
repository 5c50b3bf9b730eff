"""All parameters that shape a plan, composed; and the named methods."""

import dataclasses
import types
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from drystone.clusters import ClusterSettings
from drystone.errors import UsageError
from drystone.model.settings import Ranged, check_finite, ranged, typed, updated
from drystone.model.wedge_shape import WedgeSettings
from drystone.placement.settings import PlacementSettings
from drystone.planner.search_settings import (
    UNLIMITED,
    CourseSettings,
    GoalSettings,
    LayingSettings,
    SearchSettings,
)
from drystone.poses import orientation_step_deg
from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.policies.registry import BUILT_IN, PAPER, RULES
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.sampling import Sampling
from drystone.selection.scored import ScoreSettings
from drystone.settle.settings import SettleSettings
from drystone.stabilise.settings import StabiliseSettings


@dataclass(frozen=True, kw_only=True)
class StopSettings(Ranged):
    """When construction ends (Algorithm 1, line 27).

    Parameters
    ----------
    filling : float
        Filling ratio at which the design goal is reached.
    failures : int
        Consecutive failures that end construction.
    """

    filling: float = ranged(0.99, above=0, most=1)
    failures: int = ranged(5, least=1)


@dataclass(frozen=True, kw_only=True)
class PlannerSettings(Ranged):
    """Every parameter of the planner.

    Parameters
    ----------
    geometry : {"raster", "exact"}
        Stones are their pixels at the working resolution, or settle on the outlines of the source
        image (DESIGN 4.9).
    orientations : str
        ``"quarter"``, ``"sf"``, or a step such as ``"10deg"``, from 0.5 to 360 (DESIGN 4.2).
    orientation_choice : {"candidates", "placement"}
        With several orientations: each is a candidate of its own, or the placement rule picks one
        per stone.
    sampling : {"variant", "shrinking", "uniform", "twofold", "full"}
        Which stones are tried in a step (§3.4, §5.1): ``"variant"``: one at random from each
        cluster, topped up at random to as many as there were clusters at first; ``"shrinking"``:
        the same, not topped up; ``"uniform"``: as many at random; ``"twofold"``: as variant, then
        all of the winner's cluster; ``"full"``: all that are left.
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
        Ids of stones, none of `ban`, that must be in the wall: they are preferred, and each that is
        missing counts 10 units of merit against a wall.
    clusters, placement, stabilise, settle, wedge, selection, policy, score
        Settings of the stages.
    search, courses, laying, goal, stop
        Settings of the search, of course plans and how they are laid, and of the end.
    """

    geometry: Literal["raster", "exact"] = "raster"
    orientations: str = "quarter"
    orientation_choice: Literal["candidates", "placement"] = "candidates"
    sampling: Sampling = "variant"
    selection_rule: str = "algorithm2"
    two_sided: bool = False
    mu: float = ranged(0.58, above=0, most=1e6)
    vary: float = ranged(0.0, least=0)
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
    courses: CourseSettings = field(default_factory=CourseSettings)
    laying: LayingSettings = field(default_factory=LayingSettings)
    goal: GoalSettings = field(default_factory=GoalSettings)
    stop: StopSettings = field(default_factory=StopSettings)

    def __post_init__(self) -> None:
        check_finite(self)
        super().__post_init__()
        orientation_step_deg(self.orientations)
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
        both = sorted(set(self.ban) & set(self.pin))
        if both:
            raise ValueError(f"ban and pin name the same stones: {', '.join(map(str, both))}")

    @property
    def by_policy(self) -> bool:
        """True when a policy chooses (:mod:`drystone.selection.policies`), not a rule of ours."""
        return self.selection_rule not in RULES

    def as_dict(self) -> dict[str, Any]:
        """Return nested dictionaries, as TOML and JSON write them.

        Without the settings of policies when none chooses, and without those of course plans, which
        are laid on outlines alone, on pixels.
        """
        values = dataclasses.asdict(self)
        if not self.by_policy:
            del values["policy"]
        if self.geometry == "raster":
            del values["courses"], values["laying"]
        return values | {"ban": list(self.ban), "pin": list(self.pin)}

    @typed
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
            sampling="full",
            two_sided=True,
            selection_rule="score",
            vary=0.3,
            placement=PlacementSettings(rule="snug", reach="above", tries=4, compare=True),
            stabilise=StabiliseSettings(margin=0.1, min_wedge_px=1),
            score=ScoreSettings(thickness=1.5, llc=4.0),
            search=SearchSettings(budget=UNLIMITED),
        ),
    }
)
"""Named settings: ``"paper"`` is the paper's greedy with its defaults, ``"best"`` the default."""


def method_settings(method: str) -> PlannerSettings:
    """Return the settings of a named method; raise UsageError (E124) for an unknown one."""
    if method not in METHODS:
        cure = f"Choose one of {', '.join(METHODS)}."
        if method in BUILT_IN:
            cure = f"It is a policy: --method paper --policy {method}. {cure}"
        raise UsageError("E124", f"there is no method {method!r}.", where="--method", cure=cure)
    return METHODS[method]
