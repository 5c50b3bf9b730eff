"""The viewer inside of HTML: its script, its style sheet and its data, in one file."""

import html
import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from drystone.drawing.report.viewer_data import View

HERE = Path(__file__).parent

POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"
"""The browser itself keeps a page with this from asking any host for anything."""


def environment() -> Environment:
    """Return the templates of reports."""
    return Environment(
        loader=FileSystemLoader(HERE),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


@cache
def viewer_script() -> Markup:
    """Return the ES module of the viewer, to stand in a script element."""
    return Markup((HERE / "viewer" / "viewer.js").read_text(encoding="utf-8"))  # noqa: S704


@cache
def viewer_style() -> Markup:
    """Return the style sheet of the viewer, to stand in a style element."""
    return Markup((HERE / "viewer" / "viewer.css").read_text(encoding="utf-8"))  # noqa: S704


def json_in_html(data: Any) -> Markup:
    r"""Write JSON for a script element: nothing in it can end the element.

    Examples
    --------
    >>> print(json_in_html({"path": "</script><img>"}))
    {"path":"\u003c/script>\u003cimg>"}
    """
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c"))  # noqa: S704


def viewer_page(view: View, options: Mapping[str, Any] | None = None) -> str:
    """Return a page with the viewer and nothing else.

    Options are those of the viewer's ``mount``: ``chart``, ``metrics``, ``about``, ``title``,
    ``step``.
    """
    return (
        environment()
        .get_template("viewer_page.html")
        .render(
            policy=POLICY,
            title=view["title"],
            data=json_in_html(view),
            options=json_in_html(dict(options or {})),
            script=viewer_script(),
            style=viewer_style(),
        )
    )


def viewer_frame(view: View, options: Mapping[str, Any] | None = None) -> str:
    """Return an element, in one line, that shows the viewer in a page of others: a notebook.

    The page in the frame has its own styles, and is as high as it needs to be.
    """
    page = html.escape(viewer_page(view, options)).replace("\n", "&#10;")
    title = html.escape(str(view["title"]))
    look = "width:100%;height:640px;border:0;color-scheme:normal"
    return f'<iframe title="{title}" style="{look}" srcdoc="{page}"></iframe>'
