"""`drystone craft`: masons' rules as checks that name stones and steps."""

import argparse
from pathlib import Path

from drystone.cli.inputs import files_of_wall, refuse_inputs
from drystone.cli.numbers import finite, whole_from
from drystone.cli.output import note, prepare_files, print_json
from drystone.cli.progress import busy
from drystone.cli.reading import add_wall, reading_from
from drystone.contacts.blocks import notices_of
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.contacts.outlines import model_of_traced
from drystone.craft.finding import Limit
from drystone.craft.look import RULES, UNSEEN, CraftReport, look
from drystone.craft.masonry import Masonry
from drystone.errors import ExitCode, UsageError, counted
from drystone.io.walls import GivenWall, read_wall

SHEET_DPI, SINGLE_DPI = 130, 150


def add(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a look at a wall."""
    add_wall(command)
    # fmt: off
    option = command.add_argument
    option("--cases", type=whole_from(0), default=3, metavar="N",
           help="places to name for each rule (default 3); --json has all")
    option("--limit", action="append", type=_limit, default=[], metavar="RULE=GOOD:FAIR",
           dest="limits",
           help="limits of a rule, such as laps=0.1:0.3; repeatable")
    option("--explain", action="store_true", help="say what each rule measures, and its limits")
    option("--wedges", nargs="+", action="extend", type=whole_from(1), default=[], metavar="ID",
           help="ids of wedges, if the wall is not a plan")


def _limit(text: str) -> tuple[str, Limit]:
    name, equals, values = text.partition("=")
    good, colon, fair = values.partition(":")
    if not (equals and colon):
        raise argparse.ArgumentTypeError(f"{text!r} is not RULE=GOOD:FAIR")
    return name, Limit(finite(good), finite(fair))


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print what each rule finds; a broken rule is a result, not an error."""
    path = Path(arguments.wall_path)
    wall = read_wall(path, reading_from(arguments))
    note(*wall.notices)
    if wall.labels is not None and wall.blocks is None and wall.outlines is None:
        note(*notices_of(wall.labels))
    if wall.plan is not None and arguments.wedges:
        cure = "Leave it out; it is for a label image or a block model."
        what = "a plan says itself what its wedges are."
        raise UsageError("E138", what, where="--wedges", cure=cure)
    with busy("looking at the wall", quiet=arguments.json, after_s=2.0):
        report = look(_masonry_of(wall, frozenset(arguments.wedges)), dict(arguments.limits))
    if arguments.output is not None:
        names = ("craft", *report.findings)
        pictures = [Path(arguments.output) / f"{name}.png" for name in names]
        refuse_inputs(files_of_wall(path), pictures)
        prepare_files(pictures, overwrite=arguments.overwrite)
        from drystone.drawing.canvas import save  # noqa: PLC0415 - slow, as the next
        from drystone.drawing.pictures.craft import plot_craft, plot_finding  # noqa: PLC0415

        save(plot_craft(report), pictures[0], dpi=SHEET_DPI)
        for name, picture in zip(report.findings, pictures[1:], strict=True):
            save(plot_finding(report, name).figure, picture, dpi=SINGLE_DPI)
    if arguments.json:
        print_json(report.report())
    else:
        _print(report, arguments)
    return ExitCode.DONE


def _masonry_of(wall: GivenWall, wedge_ids: frozenset[int]) -> Masonry:
    """Return a wall from a file as the rules look at it; E191 for a wedge that is not in it."""
    wedges, plan = wall.wedge_ids | wedge_ids, wall.plan
    steps = {} if plan is None else plan.step_by_id
    if wall.blocks is not None:
        outlines, model = polygons_from_json(wall.blocks), model_from_json(wall.blocks)
        per_m = 1.0 if plan is not None and plan.px_per_m else None
        return Masonry(outlines, model, wedges, steps, cut=plan is not None, per_m=per_m)
    if wall.outlines is not None:
        return Masonry(wall.outlines, model_of_traced(wall.outlines, wall.mu), wedges)
    assert wall.labels is not None  # noqa: S101 - a wall without blocks has an image
    return Masonry.from_labels(wall.labels, wedges, steps=steps, mu=wall.mu)


def _print(report: CraftReport, arguments: argparse.Namespace) -> None:
    masonry = report.masonry
    wedges = len(set(masonry.wedge_ids))
    also = f", {counted(wedges, 'wedge')}" if wedges else ""
    print(f"{arguments.wall_path}: {counted(len(masonry.stones), 'stone')}{also}")
    width = max(len(rule.title) for rule in RULES.values())
    for finding in report.findings.values():
        said = finding.note if finding.number is None else finding.amount
        if finding.number is not None and arguments.explain:
            rule, limit = finding.rule, finding.limit
            sign = ">=" if rule.higher_is_better else "<="
            said += f" (good {sign} {limit.good:g}, fair {sign} {limit.fair:g}): {rule.meaning}"
        print(f"{finding.rule.title:<{width}}  {finding.verdict:<10}  {said}")
        if finding.note and finding.number is not None:
            print(f"{'':<{width}}    {finding.note}")
        for case in finding.cases[: arguments.cases]:
            named = ", ".join(masonry.name(stone) for stone in case.stones)
            print(f"{'':<{width}}    {named}: {case.words}")
        left = len(finding.cases) - arguments.cases
        if arguments.cases and left > 0:
            print(f"{'':<{width}}    and {left} more")
    print(UNSEEN)
