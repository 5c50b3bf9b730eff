"""`drystone check --physics`: the wall of a plan in a rigid-body engine."""

from collections.abc import Sequence

from drystone.cli.progress import counting_bar
from drystone.drawing.words.checked import PhysicsCard
from drystone.model.plan import Plan
from drystone.physics.building import build_up, tilt_of
from drystone.verify.lengths import plan_settings
from drystone.verify.outlines import Group
from drystone.verify.report import CheckReport


def physics_of(
    plan: Plan, groups: Sequence[Group], report: CheckReport, *, quiet: bool
) -> PhysicsCard | None:
    """Build the wall of a plan in the engine and tilt it.

    Parameters
    ----------
    plan : Plan
        The plan.
    groups : sequence of Group
        Its polygons.
    report : CheckReport
        What the limit analysis says of the wall, and how deep outlines overlap by the plan.
    quiet : bool
        Show no progress.

    Returns
    -------
    PhysicsCard or None
        None when some step of the plan places nothing, so that there is no such wall.

    Raises
    ------
    UsageError
        E305 when pymunk is not installed.
    """
    if sum(map(len, groups)) < len(plan.steps):
        return None
    settings, _ = plan_settings(plan)
    with counting_bar("stones in the engine", len(groups), quiet=quiet) as on_group:
        built = build_up(groups, settings.mu, on_group=on_group)
    return PhysicsCard(plan, built, tilt_of(built), report.metrics, report.overlap_depth)
