"""A wall that was analysed: pictures, and the report with the wall to look around in."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Literal

from drystone.drawing.assembly.read import scaled, scaled_resistance
from drystone.drawing.files import save
from drystone.drawing.outlines import Loop, wall_regions
from drystone.drawing.pictures.curves import plot_friction
from drystone.drawing.pictures.forces import plot_contacts, plot_forces
from drystone.drawing.pictures.mechanism import plot_mechanism, save_mechanism_animation
from drystone.drawing.report.html import write_report
from drystone.drawing.report.viewer_data import view_of_wall
from drystone.drawing.words import content
from drystone.drawing.words.analysis import Card, ModelledWall, Shapes
from drystone.kernels.polygons import area_and_centroid
from drystone.statics.loads import Loads
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult, LimitStatus
from drystone.statics.sensitivity import AtFriction, friction_curve

FRICTION = "friction.png"

CITATION = (
    "drystone {version} (MIT licence). Limit analysis of rigid blocks as in Wang, dos Santos and "
    "Beyer (2024), An image-based stacking method for 2D dry-stone masonry walls; input sha256 "
    "{sha256}."
)


def write_analysis(
    path: Path,
    wall: ModelledWall,
    card: Card,
    per_unit_m: float | None,
    curve: Sequence[AtFriction],
) -> Path:
    """Write report.html of a wall that was analysed.

    Pictures of mechanisms that lie beside it are put into it.  `per_unit_m` is metres in a unit of
    the model, where that is known.
    """
    shapes, model, resistance = wall.shapes, card.model, card.resistance
    unit: Literal["px", "m", "units"] = "units" if wall.names.noun == "block" else "px"
    if per_unit_m is not None:
        unit = "m"
        shapes, model = in_metres(shapes, model, per_unit_m)
        resistance = scaled_resistance(resistance, per_unit_m)
    friction = [
        (f"with mu = {at.mu:g}", f"load multipliers: left {content.number(at.alpha_left)}, "
         f"right {content.number(at.alpha_right)}")
        for at in curve
        if at.alpha_left is not None or at.alpha_right is not None
    ] or [(f"with mu = {curve[0].mu:g} to {curve[-1].mu:g}", "no load multiplier")]  # fmt: skip
    rows = [*_full_names(card.rows()), *friction]
    cite = CITATION.format(version=card.version, sha256=card.sha256)
    view = view_of_wall(
        shapes, model, resistance, title="Limit analysis of a wall", unit=unit,
        noun=wall.names.noun, wedges=wall.names.wedges, steps=wall.names.steps,
        cards=_cards(card), inputs=[*rows, ("cite", cite)],
        notices=wall.notices, load_case=card.load_case, without_dilatancy=card.alphas_by_coulomb,
    )  # fmt: skip
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


def _full_names(rows: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """Yield rows whose names say what they stand under, which the indents of the card do."""
    above = ""
    for name, value in rows:
        if name.startswith(" "):
            yield f"{above}, {name.strip()}", value
        else:
            above = name
            yield name, value


def _cards(card: Card) -> Iterator[content.ResultCard]:
    """Yield what the strength of the associative analysis does not say."""
    both = card.nonassociative
    for result in () if both is None else (both.left, both.right):
        side, value = result.direction, content.number(result.alpha)
        said = f"Joints slide without opening (Coulomb). {result.message}"
        name = f"Without dilatancy, to the {side}"
        yield content.ResultCard(f"{content.ALPHA} {side}", name, value, "higher", said)


def draw_analysis(
    paths: list[Path], wall: ModelledWall, loads: Loads, ends: Sequence[LimitResult]
) -> None:
    """Draw the contacts, and forces, mechanism and its motion for both ends, left first."""
    save(plot_contacts(wall.shapes, wall.model).figure, paths[0])
    for end, files in zip(ends, (paths[1:4], paths[4:]), strict=True):
        for path in files:
            # One that an earlier run left would belong to another wall.
            path.unlink(missing_ok=True)
        mechanism, forces, motion = files
        if end.forces is not None:
            save(plot_forces(wall.shapes, wall.model, end.forces).figure, forces)
        if end.mechanism is None:
            continue
        falls = end.status is LimitStatus.UNSTABLE
        load = "" if falls or loads.name.startswith("tilting table") else loads.name.split(" (")[0]
        moving = (wall.shapes, end.mechanism, None if falls else end.direction, end.alpha)
        # The card names blocks by their ids.
        save(plot_mechanism(*moving, load=load, numbers=True).figure, mechanism)
        save_mechanism_animation(motion, *moving, load=load, numbers=True)


def draw_friction(folder: Path, model: RigidBlockModel, loads: Loads) -> tuple[AtFriction, ...]:
    """Analyse the wall at usual coefficients of friction, and draw that."""
    curve = friction_curve(model, loads)
    axes = plot_friction(curve, model.mu, slides_at_mu=loads.name == content.TILTING)
    save(axes.figure, folder / FRICTION)
    return curve
