"""How Sphinx makes the pages: `make docs`."""

import re
import sys
from importlib.metadata import version as installed
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parent / "extensions"))

project = "drystone"
author = "The drystone developers"
project_copyright = author
release = version = installed("drystone")

extensions = [
    "mathml",
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "wall_viewer",
]
exclude_patterns = ["_build", "gallery"]

# The pages are read on the code host too: links between them are relative paths with headings,
# formulas are fenced blocks of the language "math".
myst_heading_anchors = 4
myst_fence_as_directive = ["math"]
html_math_renderer = "mathml"

autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_preserve_defaults = True
napoleon_google_docstring = False
napoleon_use_rtype = False
add_module_names = False
# Types in docstrings are words for people ("(h, w) integer array"), errors are named without their
# module, and a few references lead to rooms that the page about Python leaves out.
nitpick_ignore_regex = [
    ("py:(class|exc)", ".*"),
    ("py:(mod|func|attr)", r"drystone\.(search|selection|statics|model)\..*"),
    ("py:(func|attr)", "limit_load|stopped"),
]

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "auto_gallery",
    "abort_on_example_error": True,
    "capture_repr": ("_repr_html_",),
    "within_subsection_order": "FileNameSortKey",
    "download_all_examples": False,
    "show_signature": False,
    "write_computation_times": False,
    "min_reported_time": 1e9,
}

html_theme = "furo"
html_title = f"drystone {release}"
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_copy_source = False
html_show_search_summary = False  # a page from disk may not fetch others; the search itself works
html_show_sphinx = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#4961c2", "color-brand-content": "#4961c2"},
    "dark_css_variables": {"color-brand-primary": "#9eb6ff", "color-brand-content": "#9eb6ff"},
}


def setup(app: Sphinx) -> None:
    """Connect what prepares the text of pages and docstrings."""
    app.connect("source-read", _without_links_out)
    app.connect("autodoc-process-docstring", _without_design)


def _without_links_out(_: Sphinx, __: str, source: list[str]) -> None:
    """Name pages that lie beside the code and not here instead of linking to them."""
    pattern = r"\[([^\]]+)\]\(\.\./(\w+\.md)(?:#[^)]*)?\)"
    source[0] = re.sub(pattern, r"\1 (`\2` in the repository)", source[0])


def _without_design(*event: Any) -> None:
    """Leave out the sections of the design page, which is not part of the repository."""
    *_, lines = event
    lines[:] = [re.sub(r" \(DESIGN [\d.]+\)|; DESIGN [\d.]+", "", line) for line in lines]
