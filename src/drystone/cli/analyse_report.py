"""The report of `drystone analyse`: the card, the wall to look around in, what friction changes."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Literal

from drystone.cli.card import Card
from drystone.cli.modelling import Modelled, Shapes
from drystone.drawing.assembly.read import scaled
from drystone.drawing.outlines import Loop, wall_regions
from drystone.drawing.report import content, write_report
from drystone.drawing.report.view_statics import scaled_resistance
from drystone.drawing.report.viewer_data import view_of_wall
from drystone.kernels.polygons import area_and_centroid
from drystone.statics.friction_curve import AtFriction
from drystone.statics.model import RigidBlockModel

CITATION = (
    "drystone {version} (MIT licence), limit analysis of rigid blocks as in Wang, dos Santos and "
    "Beyer (2024), An image-based stacking method for 2D dry-stone masonry walls; input sha256 "
    "{sha256}."
)


def write_analysis(
    path: Path,
    wall: Modelled,
    card: Card,
    per_unit_m: float | None,
    curve: Sequence[AtFriction],
) -> Path:
    """Write report.html of a wall that was analysed.

    Parameters
    ----------
    path : Path
        The file; pictures of mechanisms that lie beside it are put into it.
    wall : Modelled
        What was looked at.
    card : Card
        What was found out.
    per_unit_m : float or None
        Metres in a unit of the model.
    curve : sequence of AtFriction
        Load multipliers over friction.
    """
    shapes, model, resistance = wall.shapes, card.model, card.resistance
    if per_unit_m is not None:
        shapes, model = in_metres(shapes, model, per_unit_m)
        resistance = scaled_resistance(resistance, per_unit_m)
    view = view_of_wall(
        shapes,
        model,
        resistance,
        title="Limit analysis of a wall",
        unit=_unit(wall, per_unit_m),
        noun=wall.noun,
        wedges=wall.wedge_ids,
        cards=_cards(card),
        inputs=[
            *_full_names(card.rows()),
            *_friction_rows(curve),
            ("cite", CITATION.format(version=card.version, sha256=card.sha256)),
        ],
        notices=wall.notices,
        load_case=card.load_case,
    )
    return write_report(path, view, pictures=path.parent)


def in_metres(
    shapes: Shapes, model: RigidBlockModel, per_unit_m: float
) -> tuple[Mapping[int, Loop], RigidBlockModel]:
    """Return the outer outlines of blocks and their model, in metres."""
    outer = {
        region.id: max(region.loops, key=lambda loop: area_and_centroid(loop)[0]) * per_unit_m
        for region in wall_regions(shapes)
    }
    return outer, scaled(model, per_unit_m)


def _unit(wall: Modelled, per_unit_m: float | None) -> Literal["px", "m", "units"]:
    if per_unit_m is not None:
        return "m"
    return "units" if wall.noun == "block" else "px"


def _full_names(rows: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """Yield rows whose names say what they stand under, which the indents of the card do."""
    above = ""
    for name, value in rows:
        if name.startswith(" "):
            yield f"{above}, {name.strip()}", value
        else:
            above = name
            yield name, value


def _cards(card: Card) -> Iterator[content.Card]:
    """Yield what the strength of the associative analysis does not say."""
    if card.nonassociative is None:
        return
    for result in (card.nonassociative.left, card.nonassociative.right):
        yield content.Card(
            f"{content.ALPHA} {result.direction}",
            f"Without dilatancy, to the {result.direction}",
            content.number(result.alpha),
            "higher",
            f"Joints slide without opening (Coulomb). {result.message}",
        )


def _friction_rows(curve: Sequence[AtFriction]) -> Iterator[tuple[str, str]]:
    for at in curve:
        left, right = content.number(at.alpha_left), content.number(at.alpha_right)
        yield f"with mu = {at.mu:g}", f"load multipliers: left {left}, right {right}"
