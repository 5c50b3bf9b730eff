"""What a plan claims of its stones, actions and wall, computed again or built in an engine."""

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

from drystone.clusters import cluster_stones
from drystone.contacts.blocks import model_from_labels
from drystone.contacts.settled import model_of_outlines
from drystone.model.landscape import Landscape
from drystone.model.plan import Plan, PlanMetrics, StoneStep
from drystone.model.steps import Problem, piece_id, piece_name
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.physics.building import BuildUp
from drystone.physics.scatter import TiltResult
from drystone.planner.assemble import plan_metrics
from drystone.planner.build import Build
from drystone.planner.evaluate import action_indices
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Stock
from drystone.planner.sturdy import sturdy_model_of
from drystone.poses import PoseBook
from drystone.search.plan_result import other_resistances
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Direction, RigidBlockModel
from drystone.statics.result import LateralResistance, LimitStatus
from drystone.verify.replay import Replay, Stage

UNKNOWN = "the solver gave up, and it is not known whether the wall stands"

ALPHA_TOLERANCE = 1e-7
"""Between load multipliers claimed and found: two solvers' optima of one program."""


def wall_model(wall: Wall, settings: PlannerSettings) -> RigidBlockModel | None:
    """Return the model of a wall on its geometry; None when nothing stands on the ground."""
    if wall.outlines is None:
        if not (wall.labels[-1] > 0).any():
            return None
        return model_from_labels(wall.labels, settings.mu).model
    settle = settings.settle
    model = model_of_outlines(wall.outlines.blocks, settings.mu, settle.contact_px, settle.setback)
    grounded = any(interface.other == GROUND for interface in model.interfaces)
    return model if grounded else None


def differs(claimed: float | None, found: float | None, tolerance: float) -> bool:
    """Say whether two values are not the same, None being a value of its own."""
    if claimed is None or found is None:
        return claimed is not found
    return not abs(claimed - found) <= tolerance * max(1.0, abs(found))


def contradicted(name: str, claimed: float | None, found: float | None) -> str:
    """Say that a plan claims another value than was found; None is written null, as in JSON."""
    said = "null" if claimed is None else claimed
    if found is None:
        return f"{name} is {said} by the plan, but there is no such value."
    return f"{name} is {said} by the plan, {found} was found."


def check_sturdy(stage: Stage, settings: PlannerSettings) -> list[Problem]:
    """Say that a wall of outlines does not stand in its sturdy model (E237)."""
    outlines = stage.after.outlines
    if outlines is None:
        return []
    found = lateral_resistance(sturdy_model_of(outlines, settings.mu, settings.settle))
    if found.stable:
        return []
    if found.failed:
        return [Problem("E230", stage.last.step, f"{UNKNOWN} with less friction and contact.")]
    needs = "friction of upright faces, or friction or gaps at their limit, to stand."
    return [Problem("E237", stage.last.step, f"the wall needs {needs}")]


def check_stands(stage: Stage, resistance: LateralResistance | None) -> list[Problem]:
    """Say that a wall does not stand after a stone and its wedges, or carries else than claimed.

    With fewer wedges it need not stand.  No resistance: it hangs in the air.  E230: it does not
    stand, or the solver gave up; E231: another load multiplier is claimed.
    """
    last = stage.last
    if resistance is None:
        return [Problem("E230", last.step, "nothing of the wall stands on the ground.")]
    said = {LimitStatus.UNSTABLE: "the wall does not stand", LimitStatus.FAILED: UNKNOWN}
    sides = resistance.left, resistance.right
    falls = [
        f"{said[side.status]}: {side.direction} {side.status.value}."
        for side in sides
        if side.status in said
    ]
    if falls:
        return [Problem("E230", last.step, message) for message in falls]
    claims = zip(
        ("alpha_left", "alpha_right"), (last.alpha_left, last.alpha_right), sides, strict=True
    )
    return [
        Problem("E231", last.step, contradicted(name, claimed, side.alpha))
        for name, claimed, side in claims
        if differs(claimed, side.alpha, ALPHA_TOLERANCE)
    ]


TOLERANCE = 1e-9
"""Of everything but load multipliers; the same sums in the same order, so rounding only."""

ANGLE_TOLERANCE_DEG = 1e-6

_BY_STATICS = ("LLC", "F_LR", "alpha_")
"""How the names of what the limit analysis gives begin."""


@dataclass(frozen=True, eq=False)
class Reference:
    """What claims are compared with."""

    stones: StoneSet
    settings: PlannerSettings
    book: PoseBook  # at the plan's working resolution
    clusters: dict[int, int]  # cluster of each stone
    stock: Stock  # sizes of the stones in their initial poses

    @classmethod
    def of(cls, stones: StoneSet, settings: PlannerSettings, scale: float) -> "Reference":
        """Compute it from the input stones."""
        book = PoseBook(scale)
        initial = [book.pose(stone, book.initial_angle(stone)) for stone in stones]
        stock = Stock.of(initial) if initial else Stock(0.0, 0.0, 0.0, 0.0)
        return cls(stones, settings, book, cluster_stones(stones, book, settings.clusters), stock)


def check_source(plan: Plan, stones: StoneSet) -> Iterator[Problem]:
    """Compare the stones with those that the plan was made from (E210, E211) and leaves (E216)."""
    claimed, source = plan.source, stones.source
    # No file has the bytes of an array that a program made; the stones are compared themselves.
    known = claimed["path"] and claimed["sha256"] and source.sha256
    if known and claimed["sha256"] != source.sha256:
        message = (
            f"the stones were read from other bytes (sha256 {source.sha256[:12]}...) than the "
            f"plan's ({claimed['sha256'][:12]}...)."
        )
        yield Problem("E210", None, message)
    facts = {"stones": len(stones), "width_px": source.width_px, "height_px": source.height_px}
    if source.files or "files" in claimed:
        facts["files"] = list(source.files)  # type: ignore[assignment]
    for name, found in facts.items():
        if claimed.get(name) != found:
            message = f"source.{name} is {claimed.get(name)} by the plan, found {found}."
            yield Problem("E211", None, message)
    placed = {step.stone for step in plan.stone_steps}
    left = [stone.id for stone in stones if stone.id not in placed]
    if sorted(plan.unused) != left:
        yield Problem("E216", None, f"unused is {list(plan.unused)} by the plan, found {left}.")


def check_choice(plan: Plan, settings: PlannerSettings) -> Iterator[Problem]:
    """Verify that the settings allow the stones that the steps place, in their order (E239)."""
    last = 0
    for step in plan.stone_steps:
        if step.stone in settings.ban:
            yield Problem("E239", step.step, f"stone {step.stone} is banned.")
        if settings.order == "given" and step.stone < last:
            message = f"stone {step.stone} comes after stone {last} in an order that is given."
            yield Problem("E239", step.step, message)
        last = max(last, step.stone)


def check_stone_claims(step: StoneStep, reference: Reference) -> Iterator[Problem]:
    """Verify what a step says of its stone: centroid (E225), cluster (E233), turning (E235)."""
    stone = reference.stones.by_id(step.stone)
    pairs = zip(step.source_centroid, stone.centroid, strict=True)
    if any(differs(claimed, found, TOLERANCE) for claimed, found in pairs):
        message = (
            f"source_centroid is {list(step.source_centroid)} by the plan, "
            f"found {list(stone.centroid)}."
        )
        yield Problem("E225", step.step, message)
    cluster = reference.clusters[step.stone]
    if step.cluster != cluster:
        message = f"cluster is {step.cluster} by the plan, found {cluster}."
        yield Problem("E233", step.step, message)
    wrong = _wrong_turning(step, reference)
    if wrong is not None:
        yield Problem("E235", step.step, wrong)


def check_indices(
    stage: Stage, resistance: LateralResistance, reference: Reference, units_per_px: float
) -> Iterator[Problem]:
    """Verify the indices of an action on the landscape before it (E232)."""
    step, claimed_height = stage.stone, stage.stone.course_height
    indices, course_height = action_indices(
        Landscape.of(stage.before, step.side),
        stage.group,
        resistance,
        None if claimed_height is None else claimed_height / units_per_px,
        reference.stock.narrowest_px,
    )
    if claimed_height is not None and course_height is None:
        message = f"course_height is {claimed_height} by the plan, but the stone has a neighbour."
        yield Problem("E232", step.step, message)
    for name, found in indices.as_dict().items():
        claimed = step.indices.get(name)
        if differs(claimed, found, ALPHA_TOLERANCE if name.startswith(_BY_STATICS) else TOLERANCE):
            yield Problem("E232", step.step, contradicted(name, claimed, found))


def recompute_metrics(plan: Plan, replay: Replay, model: RigidBlockModel | None) -> PlanMetrics:
    """Return the figures of merit of a wall that was rebuilt whole; no model is no stone."""
    model = model or RigidBlockModel((), (), replay.settings.mu)
    source_px = plan.px_per_m or 1.0
    # The size in the plan has more digits than that of the site, which is rounded.
    size = plan.width * source_px, plan.height * source_px
    site = replace(replay.site, source_px=size)
    build = Build(replace(replay.wall, site=site), model)
    resistance = lateral_resistance(model)
    others = other_resistances(build, resistance, replay.settings)
    return plan_metrics(build, resistance, others)


def check_metrics(claimed: PlanMetrics, found: PlanMetrics) -> Iterator[Problem]:
    """Compare the figures of merit of the whole wall (E234)."""
    for field in fields(PlanMetrics):
        plan_says, value = getattr(claimed, field.name), getattr(found, field.name)
        tolerance = ALPHA_TOLERANCE if field.name.startswith(_BY_STATICS) else TOLERANCE
        # Plans of other hands need not claim these; without stones older ones say 0 of two.
        shape = field.name in ("T_LEVEL", "E_FLUSH")
        if plan_says is None and (field.default is None or shape):
            continue
        if plan_says == 0.0 and value is None and shape:
            continue
        # The least that is found: a plan may know of less, as other solvers lead elsewhere.
        if field.name.endswith("_coulomb") and value is not None and plan_says is not None:
            value = min(value, plan_says)
        if differs(plan_says, value, tolerance):
            yield Problem("E234", None, contradicted(field.name, plan_says, value))


def _wrong_turning(step: StoneStep, reference: Reference) -> str | None:
    """Say why angle, rotation moves and side cannot come from the settings; None when they can."""
    settings = reference.settings
    if step.side == "right" and not settings.two_sided:
        return "side is right by the plan, but its settings build from the left only."
    moves, limits = step.rotation_moves, settings.stabilise
    # About one point it only turns one way.
    most, high, low = limits.max_pivots, limits.max_turn_deg, limits.step_deg * (moves == 1)
    if settings.geometry == "exact":
        # A stone that turns as it settles counts as one that was moved once, however far.
        most, high, low = 1, settings.settle.max_turn_deg, 0.0
    most = most if limits.method in ("both", "rotation") else 0
    high = high if moves else 0.0
    if moves > most:
        return f"rotation_moves is {moves} by the plan, more than its settings allow."
    angles = reference.book.angles(reference.stones.by_id(step.stone), settings.orientations)
    turns = [abs((step.angle_deg - angle + 180.0) % 360.0 - 180.0) for angle in angles]
    if any(low - ANGLE_TOLERANCE_DEG <= t <= high + ANGLE_TOLERANCE_DEG for t in turns):
        return None
    return (
        f"angle_deg {step.angle_deg} after {moves} rotation moves is {min(turns):.6g} degrees from "
        f"the nearest orientation of the set {settings.orientations!r}."
    )


CONFIRMED = 0.85
"""A wall must come down no earlier in the engine than at this share of what its plan claims."""


def check_engine(
    plan: Plan, built: BuildUp, tilts: tuple[TiltResult, TiltResult] | None
) -> list[Problem]:
    """Verify that the engine does not contradict a plan, whose wall it built and may have tilted.

    E241: blocks fall in the wall as it is drawn.  E242: tilted, the wall comes down below
    `CONFIRMED` of a load multiplier that the plan claims.
    """
    problems = []
    if built.first_fall is not None:
        names = {piece_id(step): piece_name(step) for step in plan.steps}
        fallen = ", ".join(names[block] for block in built.fallen)
        message = f"in the engine blocks fall, the first after this stone and its wedges: {fallen}."
        problems.append(Problem("E241", plan.stone_steps[built.first_fall - 1].step, message))
    for tilt in tilts or ():
        alpha = claimed_alpha(plan, tilt.direction)
        found = 0.0 if tilt.fell_at_rest else tilt.high
        if alpha is not None and found is not None and found < CONFIRMED * alpha:
            message = (
                f"tilted to the {tilt.direction} the wall comes down by alpha = {found:.3f} in the "
                f"engine, {found / alpha:.0%} of the {alpha:.3f} that the plan claims; "
                f"{CONFIRMED:.0%} are wanted."
            )
            problems.append(Problem("E242", None, message))
    return problems


def claimed_alpha(plan: Plan, direction: Direction) -> float | None:
    """Return the load multiplier that a plan claims of a side, the smaller of both flow rules."""
    metrics = plan.metrics
    claims = [getattr(metrics, f"alpha_{direction}{rule}") for rule in ("", "_coulomb")]
    if metrics.F_LR_coulomb == 0.0:  # it can fall by itself: nothing is claimed
        claims.append(0.0)
    return min((claim for claim in claims if claim is not None), default=None)
