"""The viewer in a page: the directive ``wall-viewer`` plans a small wall when pages are made."""

from functools import cache
from typing import Any

import numpy as np
from docutils import nodes
from docutils.parsers.rst import Directive
from sphinx.application import Sphinx

import drystone as ds


def setup(app: Sphinx) -> dict[str, Any]:
    """Add the directive to Sphinx."""
    app.add_directive("wall-viewer", WallViewer)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


class WallViewer(Directive):
    """Shows a wall of ten made stones, as a notebook does."""

    def run(self) -> list[nodes.Node]:
        """Return the frame with the viewer."""
        return [nodes.raw("", _frame(), format="html")]


@cache
def _frame() -> str:
    rubble = ds.generate.RubbleSettings(
        count=10, width_px=130, height_px=50, courses=3, area_ratio=0.86
    )
    stones = ds.generate.rubble_stones(rubble, np.random.default_rng(4))
    settings = ds.method_settings("best").updated({"search": {"budget": 4}})
    result = ds.plan_wall(stones, 130, 50, seed=1, settings=settings)
    return ds.view(result)._repr_html_()
