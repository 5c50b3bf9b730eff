"""`drystone craft`: masons' rules as checks that name stones and steps."""

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path

from drystone.cli.inputs import files_of_wall, refuse_inputs
from drystone.cli.numbers import finite, whole_from
from drystone.cli.output import prepare_files, print_json
from drystone.cli.reading import add_wall
from drystone.contacts.blocks import notice_of_pieces
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.craft import RULES, CraftReport, Finding, Limit, Masonry, look
from drystone.craft.look import UNSEEN
from drystone.errors import ExitCode, Notice, UsageError
from drystone.io.walls import GivenWall, read_wall

SHEET_DPI, SINGLE_DPI = 130, 150


def add(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a look at a wall."""
    add_wall(command)
    command.add_argument(
        "--cases", type=whole_from(0), default=3, metavar="N",
        help="how many places a rule names in the table (default 3); JSON has all",
    )  # fmt: skip
    command.add_argument(
        "--limit", action="append", type=_limit, default=[], metavar="RULE=GOOD:FAIR",
        dest="limits",
        help="last good and last fair number of a rule, such as laps=.1:.3; repeatable",
    )  # fmt: skip
    command.add_argument(
        "--wedges", nargs="+", action="extend", type=whole_from(1), default=[], metavar="ID",
        help="ids that are wedges, in a label image or block model",
    )  # fmt: skip


def _limit(text: str) -> tuple[str, float, float]:
    """Read a rule and its two limits."""
    name, equals, values = text.partition("=")
    good, colon, fair = values.partition(":")
    if not (equals and colon):
        raise argparse.ArgumentTypeError(f"{text!r} is not RULE=GOOD:FAIR")
    return name, finite(good), finite(fair)


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print what each rule finds; a broken rule is a result, not an error."""
    wall = read_wall(Path(arguments.wall_path), background=arguments.background)
    for notice in (*wall.notices, *_pieces(wall)):
        print(f"drystone: {notice}", file=sys.stderr)
    if wall.plan is not None and arguments.wedges:
        raise UsageError(
            "E138",
            "a plan says itself what its wedges are.",
            where="--wedges",
            cure="Leave it out; it is for a label image or a block model.",
        )
    masonry = masonry_of(wall, frozenset(arguments.wedges))
    limits = {name: Limit(good, fair) for name, good, fair in arguments.limits}
    report = look(masonry, limits)
    if arguments.output is not None:
        pictures = _pictures(report, Path(arguments.output))
        refuse_inputs(files_of_wall(Path(arguments.wall_path)), pictures.values())
        prepare_files([*pictures.values()], overwrite=arguments.overwrite)
        _draw(report, pictures)
    if arguments.json:
        print_json(report.report())
    else:
        _print(report, arguments)
    return ExitCode.DONE


def _pieces(wall: GivenWall) -> tuple[Notice, ...]:
    """Say of a wall of pixels whether its stones hang together (W304)."""
    if wall.labels is None or wall.blocks is not None:
        return ()
    return tuple(notice_of_pieces(wall.labels))


def masonry_of(wall: GivenWall, wedge_ids: frozenset[int] = frozenset()) -> Masonry:
    """Return a wall from a file as the rules look at it.

    Parameters
    ----------
    wall : GivenWall
        Label image, plan or block model.
    wedge_ids : frozenset of int
        Ids that are wedges besides those of a plan.

    Raises
    ------
    UsageError
        E191 for the id of a wedge that is not in the wall.
    """
    wedges = wall.wedge_ids | wedge_ids
    steps = _steps(wall)
    if wall.blocks is not None:
        outlines = polygons_from_json(wall.blocks)
        model, planned = model_from_json(wall.blocks), wall.plan is not None
        per_m = 1.0 if wall.plan is not None and wall.plan.px_per_m else None
        return Masonry(outlines, model, wedges, steps, cut=planned, per_m=per_m)
    assert wall.labels is not None  # noqa: S101 - a wall without blocks has an image
    return Masonry.from_labels(wall.labels, wedges, steps=steps, mu=wall.mu)


def _steps(wall: GivenWall) -> dict[int, int]:
    if wall.plan is None:
        return {}
    stones = {step.stone: step.step for step in wall.plan.stone_steps}
    return stones | {step.id: step.step for step in wall.plan.wedge_steps}


def _print(report: CraftReport, arguments: argparse.Namespace) -> None:
    masonry = report.masonry
    wedges = len(set(masonry.wedge_ids))
    also = f", {_many(wedges, 'wedge')}" if wedges else ""
    print(f"{arguments.wall_path}: {_many(len(masonry.stones), 'stone')}{also}")
    width = max(len(rule.title) for rule in RULES.values())
    for finding in report.findings.values():
        rule = finding.rule
        print(f"{rule.title:<{width}}  {finding.verdict:<10}  {_number(finding)}")
        if finding.note and finding.number is not None:
            print(f"{'':<{width}}    {finding.note}")
        for case in finding.cases[: arguments.cases]:
            named = ", ".join(masonry.name(stone) for stone in case.stones)
            print(f"{'':<{width}}    {named}: {case.words}")
        left = len(finding.cases) - arguments.cases
        if arguments.cases and left > 0:
            print(f"{'':<{width}}    and {left} more")
    print(UNSEEN)


def _many(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _number(finding: Finding) -> str:
    """Write the number of a rule with its limits."""
    if finding.number is None:
        return finding.note
    rule, limit = finding.rule, finding.limit
    sign = ">=" if rule.higher_is_better else "<="
    return (
        f"{finding.amount} (good {sign} {limit.good:g}, fair {sign} {limit.fair:g}): {rule.meaning}"
    )


def _pictures(report: CraftReport, folder: Path) -> dict[str, Path]:
    """Return where what is drawn: the sheet of all, and every rule by its name."""
    return {name: folder / f"{name}.png" for name in ("craft", *report.findings)}


def _draw(report: CraftReport, pictures: Mapping[str, Path]) -> None:
    from drystone.drawing.files import save  # noqa: PLC0415
    from drystone.drawing.pictures.craft import plot_craft, plot_finding  # noqa: PLC0415 - slow import

    save(plot_craft(report), pictures["craft"], dpi=SHEET_DPI)
    for name in report.findings:
        save(plot_finding(report, name).figure, pictures[name], dpi=SINGLE_DPI)
