"""Write the report of a wall as one HTML file."""

import base64
from pathlib import Path

from drystone.drawing.files import MECHANISMS, PICTURE
from drystone.drawing.report.embedding import (
    POLICY,
    environment,
    json_in_html,
    viewer_script,
    viewer_style,
)
from drystone.drawing.report.viewer_data import View
from drystone.drawing.words import content
from drystone.whole_files import write_whole


def write_report(path: str | Path, view: View, *, pictures: str | Path | None = None) -> Path:
    """Write report.html: inputs, results with their meaning, the viewer, steps, settings (§2).

    The file needs no network and no other file: data, script and pictures are inside it.  Without
    JavaScript it shows pictures instead of the viewer and says all the same.  It has no date, so
    equal arguments give equal bytes.

    Parameters
    ----------
    path : str or Path
        The file to write.
    view : dict
        The wall: from `view_of_assembly`, `view_of_wall` or `view_of_result`.
    pictures : str or Path, optional
        Folder with picture.png, mechanism_left.png and mechanism_right.png; the report says which
        of them there are none of.

    Returns
    -------
    path : Path
        The file.

    Raises
    ------
    PlanError
        E206 when it cannot be written; an existing one is as it was.
    """
    path = Path(path)
    folder = None if pictures is None else Path(pictures)
    text = (
        environment()
        .get_template("template.html")
        .render(
            view=view,
            policy=POLICY,
            data=json_in_html(view),
            script=viewer_script(),
            style=viewer_style(),
            picture=_embedded(folder, PICTURE),
            mechanisms={side: _embedded(folder, name) for side, name in MECHANISMS.items()},
            unused=content.unused_stones(view["unused"]),
            number=content.number,
            digits=1 if view["unit"] == "px" else 3,
        )
    )
    write_whole(path, text.encode("utf-8", "replace"))
    return path


def _embedded(folder: Path | None, name: str) -> str | None:
    """Return a PNG as a data URL, or None when there is no such file."""
    if folder is None or not (folder / name).is_file():
        return None
    data = base64.b64encode((folder / name).read_bytes()).decode("ascii")
    return f"data:image/png;base64,{data}"
