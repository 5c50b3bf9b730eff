"""Reading what `analyse` and `measure` are given: a label image, a plan, or a block model."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from drystone.errors import InputError, Notice
from drystone.io.plan_json import read_plan
from drystone.io.wall_image import read_wall_image
from drystone.model.plan import Plan
from drystone.model.wall import Labels
from drystone.statics.blocks import model_from_labels
from drystone.statics.given import model_from_json
from drystone.statics.model import RigidBlockModel


@dataclass(frozen=True, eq=False)
class GivenWall:
    """A wall from a file.

    Parameters
    ----------
    labels : (h, w) uint32 array or None
        None for a block model, which has no pixels.
    plan : Plan or None
        When the file was a plan; its image is the wall image beside it.
    blocks : mapping or None
        A block model as it was written.
    """

    labels: Labels | None
    plan: Plan | None = None
    blocks: dict[str, Any] | None = None

    @property
    def wedge_ids(self) -> frozenset[int]:
        """Labels that are wedges."""
        return frozenset(step.id for step in self.plan.wedge_steps) if self.plan else frozenset()

    def model(self, mu: float | None) -> tuple[RigidBlockModel, tuple[Notice, ...]]:
        """Return the rigid block model; `mu` None: that of the plan or block model, or .58."""
        if self.blocks is not None:
            given = self.blocks if mu is None else {**self.blocks, "mu": mu}
            return model_from_json(given), ()
        if mu is None:
            mu = float(self.plan.settings["mu"]) if self.plan else 0.58
        assert self.labels is not None  # noqa: S101 - a wall without blocks has an image
        image = model_from_labels(self.labels, mu)
        return image.model, image.notices


def read_wall(path: Path) -> GivenWall:
    """Read a label image, a plan.json (with the wall image beside it), or a block model."""
    if path.suffix.lower() != ".json":
        return GivenWall(read_wall_image(path))
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError("E132", f"cannot be read as JSON: {error}.", where=str(path)) from None
    if isinstance(content, dict) and ("blocks" in content or "blocks_xywh" in content):
        return GivenWall(None, blocks=content)
    plan = read_plan(path)
    images = [path.parent / name for name in ("wall.png", "wall.tif")]
    image = next((image for image in images if image.exists()), None)
    if image is None:
        raise InputError(
            "E133",
            "there is no wall.png beside the plan.",
            where=str(path),
            cure="Keep the files of a plan together, or give the label image itself.",
        )
    return GivenWall(read_wall_image(image), plan)
