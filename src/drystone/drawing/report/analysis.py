"""A wall that was analysed: pictures, and the report with the wall to look around in."""

import csv
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from importlib.metadata import version
from io import StringIO
from pathlib import Path
from typing import Literal

from drystone.drawing.assembly import scaled, scaled_resistance
from drystone.drawing.canvas import save
from drystone.drawing.outlines import wall_regions
from drystone.drawing.pictures.curves import plot_friction
from drystone.drawing.pictures.forces import plot_contacts, plot_forces
from drystone.drawing.pictures.mechanism import plot_mechanism, save_mechanism_animation
from drystone.drawing.report.html import write_report
from drystone.drawing.report.viewer_data import view_of_wall
from drystone.drawing.words import analysis, content
from drystone.drawing.words.analysis import Card, RangeCard
from drystone.kernels.polygons import area_and_centroid
from drystone.statics.loads import Loads
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import LimitResult, LimitStatus
from drystone.statics.sensitivity import friction_curve
from drystone.whole_files import write_whole

CITATION = (
    "drystone {version} (MIT licence). Limit analysis of rigid blocks as in Wang, dos Santos and "
    "Beyer (2024), An image-based stacking method for 2D dry-stone masonry walls; input sha256 "
    "{sha256}."
)


def write_analysis(folder: Path, card: RangeCard, loads: Loads, per_unit_m: float | None) -> None:
    """Write pictures into a folder that exists, of loads to both sides tables and report.html, too.

    What an earlier run left there belongs to another wall, and is taken out.  `per_unit_m` is
    metres in a unit of the model, where that is known.
    """
    for name in analysis.WRITTEN:
        (folder / name).unlink(missing_ok=True)
    shapes, model = card.wall.shapes, card.wall.model
    save(plot_contacts(shapes, model).figure, folder / "contacts.png")
    free = [not block.fixed for block in model.blocks]
    # Of a range alpha is in weights of the wall; a support that settles is none of it.
    weight = None if isinstance(card, Card) else float(abs(loads.live[free, 1].sum()))
    for side, end in zip(("left", "right"), card.ends.values(), strict=True):
        if end.forces is not None:
            drawn = plot_forces(shapes, model, end.forces, weight=weight)
            save(drawn.figure, folder / f"forces_{side}.png")
        if end.mechanism is None:
            continue
        falls = end.status is LimitStatus.UNSTABLE
        plain = falls or card.load_case.startswith(content.TILTING)
        load = "" if plain else card.load_case.split(" (")[0]
        if load and isinstance(card, Card):
            load += f" {content.side_words(card.load_case, side)}"
        moving = (shapes, end.mechanism, None if falls else end.direction, end.alpha)
        # The card names blocks by their ids.
        drawn = plot_mechanism(*moving, load=load, numbers=True)
        save(drawn.figure, folder / f"mechanism_{side}.png")
        gif = folder / f"mechanism_{side}.gif"
        save_mechanism_animation(gif, *moving, load=load, numbers=True)
    if isinstance(card, Card):
        write_tables(folder, model, [*card.ends.values()], per_unit_m)
        _write_report(folder, card, loads, per_unit_m)


def _write_report(folder: Path, card: Card, loads: Loads, per_unit_m: float | None) -> None:
    """Analyse the wall at usual coefficients of friction, draw that, and say all."""
    wall, resistance = card.wall, card.resistance
    shapes, model = wall.shapes, wall.model
    curve = friction_curve(model, loads)
    # The whole wall does on level ground of this friction; what is fixed may be a ramp.
    level = card.load_case == content.TILTING and not any(block.fixed for block in model.blocks)
    rubs = all(face.mu is None for face in model.faces.get(GROUND, ()))
    left, right = (content.side_words(card.load_case, side) for side in ("left", "right"))
    axes = plot_friction(curve, model.mu, slides_at_mu=level and rubs, sides=(left, right))
    save(axes.figure, folder / analysis.FRICTION)
    unit: Literal["px", "m", "units"] = "units" if wall.names.noun == "block" else "px"
    if per_unit_m is not None:
        unit, model = "m", scaled(model, per_unit_m)
        resistance = scaled_resistance(resistance, per_unit_m)
        outer = {
            region.id: max(region.loops, key=lambda loop: area_and_centroid(loop)[0])
            for region in wall_regions(shapes)
        }
        shapes = {block: loop * per_unit_m for block, loop in outer.items()}
    friction = [
        (f"with mu = {at.mu:g}", f"load multipliers: {left} {content.number(at.alpha_left)}, "
         f"{right} {content.number(at.alpha_right)}")
        for at in curve
        if at.alpha_left is not None or at.alpha_right is not None
    ] or [(f"with mu = {curve[0].mu:g} to {curve[-1].mu:g}", "no load multiplier")]  # fmt: skip
    rows = [*_full_names(card.rows()), *friction]
    cite = CITATION.format(version=version("drystone"), sha256=card.sha256)
    # What the strength of the associative analysis does not say.
    more = [
        content.ResultCard(
            f"{content.ALPHA} {side}",
            f"Without dilatancy, {content.side_words(card.load_case, side)}",
            content.number(end.alpha), "higher",
            f"Joints slide without opening (Coulomb). {end.message}",
        )
        for side, end in card.without.items()
    ]  # fmt: skip
    view = view_of_wall(
        shapes, model, resistance, title="Limit analysis of a wall", unit=unit, names=wall.names,
        cards=more, load_case=card.load_case, verdict=card.verdict,
    )  # fmt: skip
    view["inputs"] = [list(row) for row in (*rows, ("cite", cite))]
    view["notices"] = [asdict(notice) for notice in wall.notices]
    write_report(folder / analysis.REPORT, view, pictures=folder)


def _full_names(rows: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """Yield rows whose names say what they stand under, which the indents of the card do."""
    above = ""
    for name, value in rows:
        if name.startswith(" "):
            yield f"{above}, {name.strip()}", value
        else:
            above = name
            yield name, value


Cell = str | int | float


def write_tables(
    folder: Path, model: RigidBlockModel, ends: Sequence[LimitResult], per_unit_m: float | None
) -> None:
    """Write both tables into a folder that exists, of both directions.

    `per_unit_m` is metres in a unit of the model; None leaves lengths in its own unit.  Forces are
    in weights of the whole wall.  The normal points into `block`; `other` is 0 for the ground.
    """
    unit, factor = ("", 1.0) if per_unit_m is None else ("_m", per_unit_m)
    weight = sum(block.weight for block in model.blocks if not block.fixed) or 1.0
    head: list[Cell] = ["block", "other", f"x{unit}", f"y{unit}", "normal_x", "normal_y", "mu"]
    rows: list[list[Cell]] = [
        [face.block, face.other, x * factor, y * factor, *face.normal, model.friction(face)]
        for face in model.interfaces
        for x, y in face.points.tolist()
    ]
    for end in ends:
        if end.forces is not None:
            head += [f"{name}_force_{end.direction}" for name in ("normal", "tangential")]
            rows = [row + f for row, f in zip(rows, (end.forces / weight).tolist(), strict=True)]
    _write(folder / analysis.CONTACTS, [head, *rows])
    head = ["block", f"x{unit}", f"y{unit}", f"area{unit and '_m2'}", "share_of_weight"]
    rows = []
    for block in model.blocks:
        x, y = block.centroid
        share = 0.0 if block.fixed else block.weight / weight
        rows.append([block.id, x * factor, y * factor, block.area * factor**2, share])
    for end in ends:
        if end.mechanism is not None:
            head += [f"{name}_{end.direction}" for name in ("velocity_x", "velocity_y", "turning")]
            found = end.mechanism
            moves = dict(zip(found.block_ids, found.velocity.tolist(), strict=True))
            for row in rows:
                across, up, turning = moves.get(int(row[0]), (0.0, 0.0, 0.0))
                # Centroids move in units of the largest displacement; turns are per such a unit.
                row += [across, up, turning / factor]
    _write(folder / analysis.BLOCKS, [head, *rows])


def _write(path: Path, rows: Iterable[list[Cell]]) -> None:
    text = StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    write_whole(path, text.getvalue().encode())
