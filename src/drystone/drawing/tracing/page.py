"""outlines.html: a photograph with outlines that a person corrects, or draws; one file, offline."""

import base64
import hashlib
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
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


@dataclass(frozen=True, eq=False)
class OutlinePage:
    """What the page begins with.

    Outlines are rings in px of the picture, x to the right, y DOWN; a ring is `proposed` while
    no person has accepted it.
    """

    title: str
    name: str  # of the picture's file
    picture: NDArray[np.uint8]  # (h, w, 3)
    kind: Literal["stones", "wall"]
    rings: Mapping[int, Sequence[tuple[float, float]]] = field(default_factory=dict)
    proposed: bool = False
    px_per_m: float | None = None
    doubts: Sequence[Doubt] = ()
    details: Mapping[str, Any] = field(default_factory=dict)
    """What else is saved with the outlines."""


def rings_of(stones: Iterable[Stone], height_px: int) -> dict[int, list[tuple[float, float]]]:
    """Return the outlines of stones in px of their picture, y down, as the page has them."""
    rings = {}
    for stone in stones:
        corners = stone.outline_within(_TOLERANCE_PX) + np.array(stone.centroid)
        rings[stone.id] = [(round(x, 2), round(height_px - y, 2)) for x, y in corners.tolist()]
    return rings


def write_outline_page(path: Path, page: OutlinePage) -> Path:
    """Write the page; the picture in it is reduced when it would be too large."""
    height, width = page.picture.shape[:2]
    shown = _embedded(page.picture)
    shapes = [
        {"label": str(number), "points": [list(point) for point in ring], "shape_type": "polygon"}
        for number, ring in page.rings.items()
    ]
    own = {"px_per_m": page.px_per_m, "proposed": list(page.rings) if page.proposed else []}
    file = {"shapes": shapes, "drystone": own}
    # A browser keeps what a person did under this key: not for other outlines of the photograph.
    key = hashlib.sha256(shown + json_in_html(file).encode()).hexdigest()[:16]
    data = {
        "title": page.title,
        "photo": {
            "name": page.name, "width": width, "height": height, "kind": page.kind,
            "details": dict(page.details), "key": key,
            "shown": f"data:image/jpeg;base64,{base64.b64encode(shown).decode('ascii')}",
        },
        "file": file,
        "doubts": [
            {"stones": list(doubt.stones), "at": list(doubt.at_px), "text": doubt.sentence}
            for doubt in page.doubts
        ],
    }  # fmt: skip
    script, style = joined([DOM, *(HERE / name for name in _MODULES)]), joined([HERE / "page.css"])
    text = rendered("page.html", data, title=page.title, script=script, style=style)
    write_whole(path, text.encode("utf-8"))
    return path


def _embedded(picture: NDArray[np.uint8]) -> bytes:
    """Return the picture as JPEG, halved until it is small enough."""
    image = Image.fromarray(picture)
    while True:
        file = io.BytesIO()
        image.save(file, "JPEG", quality=85)
        if file.tell() <= _MOST_BYTES:
            return file.getvalue()
        image = image.reduce(2)
