"""Figs. 14 and 15: the base case PR and its failure mechanisms (§5.1)."""

from collections.abc import Sequence
from statistics import median

from drystone.contacts.blocks import model_from_labels
from drystone.drawing.pictures.mechanism import plot_mechanism
from drystone.model.wall import Labels
from drystone.statics.failing.mechanism import describe_mechanism
from drystone.statics.flow.nonassociative import NonassociativeResult, nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult, LimitStatus
from drystone_lab.pictures.groups import group_panels
from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce import summary
from drystone_lab.reproduce.base import PR, PaperWall
from drystone_lab.reproduce.drawn import titled_wall
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.trials import BASE, Trials, run_trials, seeds_of
from drystone_lab.table import Cell, Table

FULL_SEEDS, QUICK_SEEDS = 20, 5

PAPER = {"left": 0.79, "right": 0.71}
"""Load multipliers of §5.1, tilting towards that side."""

BOUND = (
    "A wall on flat ground slides as a whole when the load is mu times its weight, so alpha is at "
    "most mu = {mu:g} here. The paper's {left:g} and {right:g} are over mu already, as its LLC is, "
    "which it says to be between 0 and 1 (Eq. 11), or belong to a larger mu that it does not "
    "state; we compare them with alpha over mu."
)


def make(context: Context) -> Output:
    """Build the base case from several seeds."""
    return base_case(context, PR, seeds_of(context, FULL_SEEDS, QUICK_SEEDS))


def base_case(context: Context, wall: PaperWall, seeds: Sequence[int]) -> Output:
    """Build a wall from several seeds, and look at the first one's mechanisms.

    Parameters
    ----------
    context : Context
        Does the runs.
    wall : PaperWall
        Stones and size.
    seeds : sequence of int
        At least one.
    """
    (trials,) = run_trials(context, (wall,), {"variant": BASE}, seeds)
    mu = trials.specs[0].settings().mu
    drawn = trials.drawn(context)[0]
    labels, wedges = drawn.labels, frozenset(wedge.id for wedge in drawn.wedges)
    model = model_from_labels(labels, mu).model
    both = lateral_resistance(model, mechanism=True)
    without = nonassociative_resistance(model)
    pairs = ((both.left, without.left), (both.right, without.right))
    return Output(
        paper=(
            f"§5.1, Fig. 14: the base case PR; load multipliers {PAPER['left']:g} and "
            f"{PAPER['right']:g} for tilting to the left and right. Fig. 15: in the mechanism to "
            "the left a sliding stone rises, which is artificial dilation by the associative flow "
            "rule. How the wall was chosen from those of other seeds is not said.",
        ),
        ours=(
            BOUND.format(mu=mu, **PAPER),
            _distribution(trials, mu),
            *(_flow_rules(one, other, mu) for one, other in pairs),
        ),
        tables=(
            ("fig14_seeds", _seeds(trials, mu)),
            ("fig14", _summary(trials, mu)),
            ("fig15", _rules(model, pairs, wedges)),
        ),
        pictures=(_wall(context, trials), *_mechanisms(labels, pairs), _strips(trials, mu)),
        runs=trials.specs,
    )


def _over_mu(trials: Trials, side: str, mu: float) -> list[float]:
    return [value / mu for value in summary.figures_of(trials.outcomes, f"alpha_{side}")]


def _distribution(trials: Trials, mu: float) -> str:
    parts = []
    for side, papers in PAPER.items():
        found = _over_mu(trials, side, mu)
        if found:
            reached = sum(value >= papers for value in found)
            parts.append(
                f"to the {side} the median of alpha / mu is {median(found):.2f} ({min(found):.2f} "
                f"to {max(found):.2f}), and {reached} of {len(found)} walls reach the paper's "
                f"{papers:g}"
            )
    seeds = f"Of {len(trials.outcomes)} walls of consecutive seeds"
    return f"{seeds}, {'; '.join(parts)}. The wall that is drawn is the first, not the best."


def _flow_rules(one: LimitResult, other: NonassociativeResult, mu: float) -> str:
    if one.alpha is None:
        return f"To the {one.direction} the wall has no load multiplier: {one.status}."
    if other.alpha is None:
        rest = f"without dilatancy there is none: {other.status}"
    else:
        less = 1 - other.alpha / one.alpha if one.alpha else 0.0
        rest = f"without dilatancy it is {other.alpha / mu:.3f}, {less:.0%} less"
    return (
        f"To the {one.direction} alpha / mu of the drawn wall is {one.alpha / mu:.3f} by the "
        f"associative flow rule, the paper's; {rest}."
    )


def _seeds(trials: Trials, mu: float) -> Table:
    rows = []
    for spec, outcome in zip(trials.specs, trials.outcomes, strict=True):
        ends = [outcome.figures[f"alpha_{side}"] for side in PAPER]
        over = [None if alpha is None else alpha / mu for alpha in ends]
        numbers = [summary.rounded(value) for value in (*ends, *over)]
        placed = outcome.figures["placed"]
        rows.append((spec.seed, placed, *summary.metric_cells(outcome), *numbers))
    return Table(
        f"The base case {trials.wall.name} seed by seed",
        (
            "seed", "placed", *summary.METRICS, "alpha left", "alpha right", "alpha left / mu",
            "alpha right / mu",
        ),
        tuple(rows),
    )  # fmt: skip


def _summary(trials: Trials, mu: float) -> Table:
    cells = dict(zip(summary.COLUMNS, summary.summary(trials.outcomes), strict=True))
    for side, papers in PAPER.items():
        found = _over_mu(trials, side, mu)
        name = f"alpha {side} / mu"
        cells[f"{name} median"] = summary.rounded(median(found)) if found else None
        cells[f"{name} range"] = f"{min(found):.2f} to {max(found):.2f}" if found else None
        cells[f"{name} paper"] = papers
    return Table(
        f"The base case {trials.wall.name} over its seeds", tuple(cells), (tuple(cells.values()),)
    )


def _rules(
    model: RigidBlockModel,
    pairs: Sequence[tuple[LimitResult, NonassociativeResult]],
    wedges: frozenset[int],
) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for one, other in pairs:
        found = (one, "associative"), (other, "without dilatancy")
        for result, rule in found:
            over = None if result.alpha is None else summary.rounded(result.alpha / model.mu)
            rows.append(
                (
                    result.direction, rule, str(result.status), summary.rounded(result.alpha),
                    over, PAPER[result.direction] if result is one else None,
                    _words(model, result, wedges),
                )
            )  # fmt: skip
    return Table(
        "Load multipliers of the drawn wall by both flow rules",
        ("towards", "flow rule", "status", "alpha", "alpha / mu", "paper", "mechanism"),
        tuple(rows),
        ("Without dilatancy: Coulomb friction, the least of the solutions that were found.",),
    )


def _words(
    model: RigidBlockModel, result: LimitResult | NonassociativeResult, wedges: frozenset[int]
) -> str | None:
    if result.mechanism is None:
        return None
    falls = result.status is LimitStatus.UNSTABLE
    found = describe_mechanism(model, result.mechanism, falls=falls, noun="stone", wedges=wedges)
    return found.words


def _wall(context: Context, trials: Trials) -> Picture:
    title = f"{trials.wall.name}, seed {trials.specs[0].seed}"
    return Picture(
        "fig14",
        plot_walls([titled_wall(context, trials, title)], 1),
        "Numbers are steps of the plan, wedges (dark red) counted; stones of a colour are of one "
        "cluster.",
    )


def _mechanisms(
    labels: Labels, pairs: Sequence[tuple[LimitResult, NonassociativeResult]]
) -> list[Picture]:
    pictures = []
    for one, other in pairs:
        for result, name, rule in ((one, "", "associative"), (other, "_coulomb", "no dilatancy")):
            if result.mechanism is None:
                continue
            falls = result.status is LimitStatus.UNSTABLE
            ax = plot_mechanism(
                labels, result.mechanism, None if falls else result.direction, result.alpha
            )
            caption = f"Mechanism towards the {one.direction}, {rule}; colours are displacements "
            caption += "over the largest, grey lines the wall before."
            figure = ax.get_figure(root=True)
            assert figure is not None  # noqa: S101 - it was made for the axes
            pictures.append(Picture(f"fig15_{one.direction}{name}", figure, caption))
    return pictures


def _strips(trials: Trials, mu: float) -> Picture:
    sides = {side: _over_mu(trials, side, mu) for side in PAPER}
    metrics: dict[str, dict[str, Sequence[float | None]]] = {
        name: {trials.wall.name: trials.values(name)} for name in ("F_SF", "F_AV", "F_AH")
    }
    return Picture(
        "fig14_seeds",
        group_panels({"alpha / mu": sides, **metrics}, claims={"alpha / mu": PAPER}),
        f"{len(trials.outcomes)} seeds; lines are medians, crosses the paper's load multipliers, "
        "taken as alpha over mu.",
    )


ITEM = Item(
    "The base case PR and its failure mechanisms", "§5.1, Figs. 14 and 15", make,
    needs=(PR.source.name,),
)  # fmt: skip
