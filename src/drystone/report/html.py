"""Write the report of a plan as one HTML file."""

import base64
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from numpy.typing import NDArray

from drystone.errors import Notice
from drystone.model.plan import Plan
from drystone.plotting.files import MECHANISMS, PICTURE
from drystone.report import content
from drystone.report.player import drawing


def write_report(
    path: str | Path,
    *,
    plan: Plan,
    pictures: str | Path,
    notices: Sequence[Notice] = (),
    timings: Mapping[str, float] | None = None,
    outlines: Mapping[int, NDArray[np.float64]] | None = None,
) -> Path:
    """Write report.html: inputs, results with their meaning, pictures, steps, settings (§2).

    The file needs no network and no other file: pictures are inside it.  It has no date, so equal
    arguments give equal bytes.

    Parameters
    ----------
    path : str or Path
        The file to write.
    plan : Plan
        The plan.
    pictures : str or Path
        Folder with picture.png, mechanism_left.png and mechanism_right.png; the report says which
        of them there are none of.
    notices : sequence of Notice
        What reading the stones and planning had to decide.
    timings : mapping of str to float, optional
        Seconds of each part of the work.
    outlines : mapping of int to (n, 2) float array, optional
        Polygons of the placed stones in the wall frame, plan's units, by id; with them the report
        shows the construction step by step.

    Returns
    -------
    path : Path
        The file.

    Raises
    ------
    ValueError
        When outlines are given and a placed stone has none.
    """
    folder, path = Path(pictures), Path(path)
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    text = environment.get_template("template.html").render(
        plan=plan,
        title=f"Dry-stone wall from {plan.source.get('path') or 'stones'}",
        inputs=content.inputs(plan),
        summary=content.summary(plan),
        cards=content.cards(plan),
        picture=_embedded(folder / PICTURE),
        mechanisms={side: _embedded(folder / name) for side, name in MECHANISMS.items()},
        alphas={"left": plan.metrics.alpha_left, "right": plan.metrics.alpha_right},
        indices=content.INDICES,
        rows=tuple(content.rows(plan)),
        unused=content.unused_stones(plan.unused),
        notices=notices,
        timings=timings or {},
        settings=tuple(content.flat_settings(plan.settings)),
        assumptions=content.assumptions(plan),
        number=content.number,
        drawing=None if outlines is None else drawing(plan, outlines),
    )
    path.write_text(text, encoding="utf-8", newline="\n")
    return path


def _embedded(picture: Path) -> str | None:
    """Return a PNG as a data URL, or None when there is no such file."""
    if not picture.is_file():
        return None
    return "data:image/png;base64," + base64.b64encode(picture.read_bytes()).decode("ascii")
