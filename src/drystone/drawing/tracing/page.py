"""outlines.html: a photograph with outlines that a person corrects, or draws; one file, offline."""

import base64
import hashlib
import io
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from drystone.drawing.report.html import DOM, joined, json_in_html, rendered
from drystone.model.stone import Stone
from drystone.photo.segment_doubts import Doubt
from drystone.whole_files import write_whole

HERE = Path(__file__).parent
_MODULES = ("shapes.js", "propose.js", "sketch.js", "page.js")
_TOLERANCE_PX = 1.0
"""Of outlines from pixels: a person moves their corners, so there are not too many."""
_MOST_BYTES = 5_500_000
"""Of the embedded picture: the page, which holds it in base64, stays below 8 MB."""


def rings_of(stones: Iterable[Stone], height_px: int) -> dict[int, list[tuple[float, float]]]:
    """Return the outlines of stones in px of their picture, y down, as the page has them."""
    rings = {}
    for stone in stones:
        corners = stone.outline_within(_TOLERANCE_PX) + np.array(stone.centroid)
        rings[stone.id] = [(round(x, 2), round(height_px - y, 2)) for x, y in corners.tolist()]
    return rings


def write_outline_page(
    path: Path,
    picture: NDArray[np.uint8],
    rings: Mapping[int, Sequence[tuple[float, float]]],
    *,
    title: str,
    name: str,
    kind: Literal["stones", "wall"],
    proposed: bool = False,
    px_per_m: float | None = None,
    doubts: Sequence[Doubt] = (),
    details: Mapping[str, Any] = MappingProxyType({}),
) -> None:
    """Write the page of an (h, w, 3) picture, which is reduced when it would be too large.

    Outlines are rings in px of the picture, x to the right, y DOWN; they are `proposed` while no
    person has accepted them.  `name` is that of the picture's file, `details` are saved with the
    outlines.
    """
    height, width = picture.shape[:2]
    shown = _embedded(picture)
    shapes = [
        {"label": str(number), "points": [list(point) for point in ring], "shape_type": "polygon"}
        for number, ring in rings.items()
    ]
    own = {"px_per_m": px_per_m, "proposed": list(rings) if proposed else []}
    file = {"shapes": shapes, "drystone": own}
    # A browser keeps what a person did under this key: not for other outlines of the photograph.
    key = hashlib.sha256(shown + json_in_html(file).encode()).hexdigest()[:16]
    data = {
        "title": title,
        "photo": {
            "name": name, "width": width, "height": height, "kind": kind,
            "details": dict(details), "key": key,
            "shown": f"data:image/jpeg;base64,{base64.b64encode(shown).decode('ascii')}",
        },
        "file": file,
        "doubts": [
            {"stones": list(doubt.stones), "at": list(doubt.at_px), "text": doubt.sentence}
            for doubt in doubts
        ],
    }  # fmt: skip
    script, style = joined([DOM, *(HERE / name for name in _MODULES)]), joined([HERE / "page.css"])
    text = rendered("page.html", data, title=title, script=script, style=style)
    write_whole(path, text.encode("utf-8"))


def _embedded(picture: NDArray[np.uint8]) -> bytes:
    image = Image.fromarray(picture)
    while True:
        file = io.BytesIO()
        image.save(file, "JPEG", quality=85)
        if file.tell() <= _MOST_BYTES:
            return file.getvalue()
        image = image.reduce(2)
