"""The documents say what the code does.

``python -m tests.test_documents`` from the root of the checkout writes the tables of
docs/settings.md anew from the docstrings of the settings, the meanings in docs/errors.md, and
docs/commands.md from the parser.
"""

import argparse
import dataclasses
import json
import os
import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import drystone
from drystone import generate
from drystone.cli.commands.settings import entries, explained_rows, plain_fields, planner_tables
from drystone.cli.parser import build_parser
from drystone.drawing.export.formats import FORMATS
from drystone.errors import CODES
from drystone.indices import INDEX_NAMES
from drystone.io.plan_json import plan_from_json, plan_schema
from drystone.io.read_settings import ReadSettings
from drystone.io.wall_image import write_labels
from drystone.model.settings import range_text
from drystone.planner.settings import METHODS
from drystone.selection.policies.registry import BUILT_IN, PAPER
from tests.pages import printed

ROOT = Path(__file__).resolve().parents[1]
MENU = sorted((ROOT / "docs").glob("*.md"))
PAGES = [*sorted(ROOT.glob("*.md")), *MENU, *sorted((ROOT / "docs" / "evidence").glob("*.md"))]
NAMES = [str(page.relative_to(ROOT)) for page in PAGES]

LINK = re.compile(r"\]\(([^)#\s]+)(#[^)\s]*)?\)")
CODE_FILE = re.compile(r"`([\w/]+\.(?:py|pyx|pxd))`")
TOCTREE = re.compile(r"^```\{toctree\}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CODE_ROW = re.compile(r"^\| ([EW]\d{3}) \| (.*?) \|", re.MULTILINE)
TABLE = re.compile(r"<!-- table (\w+) -->\n(.*?)<!-- end -->", re.DOTALL)

SOURCES = {
    "read": ReadSettings,
    "fourier": generate.FourierSettings,
    "polygon": generate.PolygonSettings,
    "brick": generate.BrickSettings,
    "rubble": generate.RubbleSettings,
}
"""Settings outside the planner, by the name of their table."""


def written_table(name):
    """Return a table of docs/settings.md as the code has it."""
    kind = SOURCES.get(name) or planner_tables()[name]
    if name in SOURCES:
        columns = {"default": kind()}
    else:
        columns = {
            f"`{method}`": settings if name == "planner" else getattr(settings, name)
            for method, settings in METHODS.items()
        }
    lines = [f"| name | {' | '.join(columns)} | meaning |", "|---" * (len(columns) + 2) + "|"]
    ends = {field.name: field.metadata for field in dataclasses.fields(kind)}
    for names, text in explained_rows(name, kind):
        ranges = dict.fromkeys(
            end for one in names if ends[one] for end in range_text(ends[one]).split(" and ")
        )
        said = " ".join([text, *(f"{one[0].upper()}{one[1:]}." for one in ranges)])
        values = [
            # TOML lacks None.
            ", ".join(
                f"`{json.dumps(getattr(settings, n))}`".replace("`null`", "none") for n in names
            )
            for settings in columns.values()
        ]
        lines.append(f"| {' | '.join([', '.join(f'`{n}`' for n in names), *values, said])} |")
    return "\n".join(lines) + "\n"


def rewritten(text):
    """Return docs/settings.md with every table as the code has it."""
    return TABLE.sub(lambda m: f"<!-- table {m[1]} -->\n{written_table(m[1])}<!-- end -->", text)


def with_meanings(text):
    """Return docs/errors.md with what every code means as the code has it."""
    return CODE_ROW.sub(lambda m: f"| {m[1]} | {CODES.get(m[1], m[2])} |", text)


def written_commands(_):
    """Return docs/commands.md as the parser has it; options that commands share stand once."""
    parsers = build_parser()._subparsers._group_actions[0].choices
    assert isinstance(parsers, dict)
    places = {}
    for name, parser in parsers.items():
        for row in _options(parser):
            places.setdefault(row, []).append(name)
    lines = [
        "# Command line",
        "Every command with its options, as `drystone COMMAND --help` prints them.",
        "`python -m tests.test_documents` writes this page. "
        "Exit codes and JSON: [files](plan-format.md#exit-codes).",
    ]
    for name, parser in parsers.items():
        own = [row for row in _options(parser) if len(places[row]) == 1]
        lines += [f"## drystone {name}", parser.description or "", *_table(own)]
    shared = [
        f"{row} {', '.join(names)} |"
        for row, names in places.items()
        if 1 < len(names) < len(parsers)
    ]
    every = [row for row, names in places.items() if len(names) == len(parsers)]
    lines += ["## Options of several commands", *_table(shared, " | of")]
    lines += ["## Options of every command", *_table(every)]
    return "\n\n".join(lines) + "\n"


def _table(rows, more=""):
    head = f"| option | what it does{more} |\n{'|---' * (2 + bool(more))}|"
    return ["\n".join([head, *rows])] if rows else []


def _options(parser):
    """Return a row of a table for each option that help shows."""
    layout, rows = parser._get_formatter(), []
    for action in parser._actions:
        if action.help != argparse.SUPPRESS and "-h" not in action.option_strings:
            text = layout._expand_help(action) if action.help else ""
            name = layout._format_action_invocation(action).replace("|", "\\|")
            text = " ".join(text.replace("|", "\\|").replace("<", "&lt;").split())
            rows.append(f"| `{name}` | {text} |")
    return rows


def command_lines(page):
    """Return the words of every drystone command in the shell blocks of a page.

    Of the README those in the text count too, when they have arguments.
    """
    lines = "\n".join(printed(page, "sh")).replace("\\\n", " ").splitlines()
    words = [shlex.split(line, comments=True) for line in lines]
    if page.name == "README.md":  # elsewhere in text they have placeholders
        text = page.read_text(encoding="utf-8")
        words += map(shlex.split, re.findall(r"`(drystone [^`]+ [^`]+ [^`]+)`", text))
    return [line[1:] for line in words if line and Path(line[0]).name == "drystone"]


WRITTEN = {"settings.md": rewritten, "errors.md": with_meanings, "commands.md": written_commands}
"""Pages of docs and what makes them anew."""


@pytest.mark.parametrize("page", WRITTEN)
def test_what_is_written_anew_is_that_of_the_code(page):
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    assert text == WRITTEN[page](text), "run python -m tests.test_documents"


def test_every_setting_and_code_is_explained():
    text = (ROOT / "docs" / "settings.md").read_text(encoding="utf-8")
    described = planner_tables() | SOURCES
    assert [name for name, _ in TABLE.findall(text)] == list(described)
    for kind in described.values():
        explained = entries(kind)
        assert list(explained) == [field.name for field in dataclasses.fields(kind)]
        assert all(explained[name][1] for name in plain_fields(kind))
    assert list(CODES) == sorted(CODES)
    assert all(said[-1] == "." and len(said.split()) < 26 for said in CODES.values())


@pytest.mark.parametrize("name", NAMES)
def test_every_command_line_is_understood(name):
    parser, shown = build_parser(), set()
    for words in command_lines(ROOT / name):
        if words not in (["--help"], ["--version"]):
            assert parser.parse_args(words).command == words[0]
            shown.add(words[0])
    basic = {"plan", "demo", "stones", "analyse", "measure", "check", "generate"}
    assert name != "README.md" or shown >= basic


def test_files_of_code_that_documents_name_are_there():
    named = {
        path
        for page in PAGES
        for path in CODE_FILE.findall(page.read_text(encoding="utf-8"))
        # A page with instructions names files by themselves.
        if "NAME" not in path and ("/" in path or page.name == "theory.md")
    }
    homes = [ROOT / name for name in ("", "src", "src/drystone", "src/drystone_lab")]
    assert len(named) > 20
    assert [one for one in named if not any((home / one).is_file() for home in homes)] == []


@pytest.mark.parametrize("name", ["README.md", *(n for n in NAMES if n.startswith("docs/for-"))])
def test_the_python_of_the_pages_for_users_runs(name, tmp_path, monkeypatch):
    sizes = generate.BrickSettings(count=6, height_px=10, aspect=2)
    made = generate.brick_stones(sizes, np.random.default_rng(1))
    write_labels(generate.lay_out(made), tmp_path / "stones.png")
    monkeypatch.chdir(tmp_path)
    programs = printed(ROOT / name, "python")
    assert programs or name != "README.md"
    for program in programs:
        exec(compile(program, name, "exec"), {})  # noqa: S102 - our own document


@pytest.mark.parametrize("name", NAMES)
def test_every_link_leads_to_a_file_and_its_heading(name):
    page = ROOT / name
    for target, heading in re.findall(r"\]\(([^)#\s]*)(#[^)\s]+)?\)", page.read_text("utf-8")):
        if "://" not in target:
            there = (page.parent / target) if target else page
            assert there.resolve().exists(), target
            if heading:
                titles = re.findall(r"^#+ (.+)$", there.read_text("utf-8"), re.MULTILINE)
                slugs = {re.sub(r"[^\w\- ]", "", t.lower()).replace(" ", "-") for t in titles}
                assert heading[1:] in slugs


def tree_of(page):
    """Return the entries of the tables of contents of a page."""
    trees = TOCTREE.findall(page.read_text(encoding="utf-8"))
    lines = [line for tree in trees for line in tree.splitlines()]
    return [line for line in lines if line and not line.startswith(":")]


def test_every_page_is_in_the_menu_or_among_the_evidence():
    index, evidence = MENU[0].parent / "index.md", MENU[0].parent / "evidence" / "index.md"
    menu, behind = tree_of(index), tree_of(evidence)
    assert len(menu) <= 20, "one purpose a page; what was measured goes to docs/evidence"
    entries = [*menu, *(os.path.normpath(f"evidence/{entry}") for entry in behind)]
    assert len(set(entries)) == len(entries)
    pages = {str(page.relative_to(index.parent))[:-3] for page in PAGES if page.parent != ROOT}
    assert {*entries, "index", "evidence/index"} == pages | {"auto_gallery/index"}
    for page, tree in ((index, [*menu, "evidence/index"]), (evidence, behind)):
        linked = {target for target, _ in LINK.findall(page.read_text(encoding="utf-8"))}
        missing = {f"{entry}.md" for entry in tree} - linked - {"auto_gallery/index.md"}
        assert not missing, "for those who read it on the code host"


@pytest.mark.parametrize("page", MENU, ids=[page.name for page in MENU])
def test_every_page_says_in_its_first_line_what_it_is_for(page):
    title, first = page.read_text(encoding="utf-8").split("\n\n")[:2]
    assert re.fullmatch("# .+", title)
    assert 5 <= len(re.split(r"[.:?](?:\s|$)", first)[0].split()) <= 30
    assert page.stem not in {"search", "genindex", "modindex"}, "Sphinx keeps these names"


def test_the_reference_names_all_that_is_public_and_the_theory_has_every_equation():
    text = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    described = re.findall(r"^\.\. auto\w+:: drystone\.(\w+)$", text, re.MULTILINE)
    assert sorted(described) == sorted(drystone.__all__)
    text = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    numbers = re.findall(r"\((\d+)[a-d]?(?:-[a-d])?(?:, (\d+))?\)", text)
    assert {int(n) for pair in numbers for n in pair if n} >= set(range(1, 31))


def test_what_has_a_name_has_its_place_in_the_pages():
    for page, names in (
        ("for-researchers.md", [PAPER, *BUILT_IN]),
        ("formats.md", FORMATS),
        ("plan-format.md", INDEX_NAMES),
    ):
        text = (ROOT / "docs" / page).read_text(encoding="utf-8")
        rows = " ".join(line for line in text.splitlines() if line.startswith("|"))
        assert {name for name in names if f"`{name}`" not in rows} == set()


def test_the_gallery_has_titles_and_is_short():
    scripts = {path.name: path.read_text() for path in ROOT.glob("docs/gallery/plot_*.py")}
    assert len(scripts) >= 4
    for name, text in scripts.items():
        assert re.match(r'"""\n(.+)\n=+\n\n', text), name
        assert len(text.splitlines()) < 80, name


def test_pictures_are_light_and_shown():
    shown = {
        os.path.normpath(page.parent / target)
        for page in PAGES
        for target, _ in LINK.findall(page.read_text(encoding="utf-8"))
    }
    pictures = list((ROOT / "docs" / "images").iterdir())
    assert {str(picture) for picture in pictures} <= shown
    for picture in pictures:
        assert picture.stat().st_size < 300_000
        with Image.open(picture) as image:
            # What moves is kept smaller: each of its frames counts.
            assert image.width >= (600 if picture.suffix == ".gif" else 800)


def test_every_property_of_a_plan_is_described_and_the_example_is_valid():
    page, names = ROOT / "docs" / "plan-format.md", set()
    text, schema = page.read_text(encoding="utf-8"), json.dumps(plan_schema())
    json.loads(schema, object_hook=lambda part: names.update(part.get("properties", ())) or part)
    assert "steps" in names
    assert {name for name in names if f"`{name}`" not in text} == set()
    (example,) = printed(page, "json")
    plan = plan_from_json(json.loads(example))
    assert [step.kind for step in plan.steps] == ["stone", "stone", "wedge"]


if __name__ == "__main__":
    for name, anew in WRITTEN.items():
        page = ROOT / "docs" / name
        page.write_text(anew(page.read_text(encoding="utf-8")), encoding="utf-8")
