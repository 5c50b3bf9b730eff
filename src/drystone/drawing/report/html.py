"""A wall as HTML: the report, and the viewer alone or in a notebook.

Each is one file that needs nothing else.
"""

import base64
import html
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from drystone.drawing.assembly import read_assembly
from drystone.drawing.pictures.wall import MECHANISMS, PICTURE
from drystone.drawing.report.viewer_data import ViewerData, view_of_assembly, view_of_result
from drystone.drawing.words import content
from drystone.search.plan_result import PlanResult
from drystone.whole_files import write_whole

HERE = Path(__file__).parent
DOM = HERE / "viewer" / "dom.js"

POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"
"""The browser itself keeps a page with this from asking any host for anything."""


def write_report(path: str | Path, view: ViewerData, *, pictures: str | Path | None = None) -> Path:
    """Write report.html: inputs, results with their meaning, the viewer, steps, settings (§2).

    The file needs no network and no other file: data, script and pictures are inside it.  Without
    JavaScript it shows pictures instead of the viewer and says all the same.  It has no date, so
    equal arguments give equal bytes.

    `view` is from `view_of_assembly`, `view_of_wall` or `view_of_result`; `pictures` is a folder
    with picture.png, mechanism_left.png and mechanism_right.png, and the report names those that
    are missing.  E206 when it cannot be written; an existing one is as it was then.
    """
    path = Path(path)
    folder = None if pictures is None else Path(pictures)
    text = rendered(
        "template.html",
        view,
        view=view,
        title=view["title"],
        picture=_embedded(folder, PICTURE),
        mechanisms={side: _embedded(folder, name) for side, name in MECHANISMS.items()},
        unused=", ".join(map(str, view["unused"])) or "none",
        number=content.number,
        unit="cm" if view["unit"] == "m" else view["unit"],
        # Of metres the centimetres.
        length=lambda value: content.number(
            100.0 * value if view["unit"] == "m" else value, 3 if view["unit"] == "units" else 1
        ),
        falls=all(end["status"] == "unstable" for end in view["mechanisms"].values()),
    )
    write_whole(path, text.encode("utf-8", "replace"))
    return path


def viewer_page(view: ViewerData, options: Mapping[str, Any] | None = None) -> str:
    """Return a page with the viewer and nothing else.

    Options are those of the viewer's ``mount``: ``chart``, ``metrics``, ``about``, ``title``,
    ``step``.
    """
    chosen = json_in_html(dict(options or {}))
    return rendered("viewer_page.html", view, title=view["title"], options=chosen)


def rendered(template: str, data: Any, **more: Any) -> str:
    """Return a page, whose script and style are those of the viewer when no others are given."""
    templates = templates_in(HERE, HERE.parent / "tracing")
    own = {"data": json_in_html(data), "script": viewer_script(), "style": viewer_style()}
    return templates.get_template(template).render(own | more, policy=POLICY)


def templates_in(*folders: Path) -> Environment:
    """Return the templates of folders, in which nothing that is missing is passed over."""
    return Environment(
        loader=FileSystemLoader(folders), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip


def _embedded(folder: Path | None, name: str) -> str | None:
    if folder is None or not (folder / name).is_file():
        return None
    data = base64.b64encode((folder / name).read_bytes()).decode("ascii")
    return f"data:image/png;base64,{data}"


@cache
def viewer_script() -> Markup:
    """Return the ES module of the viewer, to stand in a script element."""
    return joined([DOM, HERE / "viewer" / "viewer.js"])


def joined(modules: Iterable[Path]) -> Markup:
    """Join modules into one, in which nothing is imported."""
    text = "\n".join(module.read_text(encoding="utf-8") for module in modules)
    return Markup(re.sub(r"^import [^;]*;$|^export ", "", text, flags=re.MULTILINE))  # noqa: S704


@cache
def viewer_style() -> Markup:
    """Return the style sheet of the viewer, to stand in a style element."""
    return joined([HERE / "viewer" / "viewer.css"])


def json_in_html(data: Any) -> Markup:
    """Write JSON for a script element: nothing in it can end the element."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c"))  # noqa: S704


@dataclass(frozen=True)
class Shown:
    """A wall that shows itself at the end of a notebook's cell.

    Parameters
    ----------
    data : dict
        Plain JSON of the schema "drystone-view/1".
    """

    data: ViewerData = field(repr=False)

    def _repr_html_(self) -> str:
        # An element in one line; the page in the frame has its own styles, and is as high as it
        # needs to be.
        page = html.escape(viewer_page(self.data)).replace("\n", "&#10;")
        title = html.escape(str(self.data["title"]))
        look = "width:100%;height:640px;border:0;color-scheme:normal"
        return f'<iframe title="{title}" style="{look}" srcdoc="{page}"></iframe>'

    def write(self, path: str | Path) -> Path:
        """Write the viewer as one HTML file that needs no network and no other file."""
        path = Path(path)
        write_whole(path, viewer_page(self.data).encode("utf-8", "replace"))
        return path


def view(wall: PlanResult | str | Path) -> Shown:
    """Show a plan: a result of planning, or the files of an earlier one.

    Parameters
    ----------
    wall : PlanResult, str or Path
        From :func:`drystone.plan_wall`, or a plan.json or its folder.

    Raises
    ------
    InputError
        E132, E133 for files that are no plan or do not belong together.
    """
    if isinstance(wall, PlanResult):
        return Shown(view_of_result(wall))
    return Shown(view_of_assembly(read_assembly(wall)))
