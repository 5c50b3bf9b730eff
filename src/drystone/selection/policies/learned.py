"""A learned value of each action; its weights come with the package (docs/evidence/learning.md)."""

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from drystone.errors import UsageError
from drystone.kernels.profiles import Floats
from drystone.selection.policies.choices import Largest, centre_distance_px, slope_rad
from drystone.selection.policy import Offer

SCHEMA = "drystone-values/1"
"""Of the file of weights; another number when the features or their meaning change."""

WEIGHTS = "learned.json"
"""The weights that the package comes with."""

FEATURES = (
    "LFR", "GDS", "NHR", "IWR", "IS", "LLC", "boundary", "bottom", "centroid", "top",
    "top_squared", "headroom", "sliver", "flush",
    "lying", "from_end", "end_sliver", "support", "off_centre", "slope", "turned", "wedges",
    "top_rank", "LFR_rank", "LLC_rank",
)  # fmt: skip
"""Of an offer (docs/evidence/learning.md).  SF and the size of the stone are not among them: they
hardly differ between the places of one stone, so stones that arrive teach nothing of them."""


@dataclass(frozen=True)
class ValueModel:
    """What a policy thinks of an action: the sum of its features, each times a weight."""

    weights: tuple[float, ...]  # one a feature, in the order of `FEATURES`
    trained: Mapping[str, Any]  # how they were found; nothing depends on it

    def __post_init__(self) -> None:
        if len(self.weights) != len(FEATURES) or not all(map(math.isfinite, self.weights)):
            raise ValueError(f"there must be {len(FEATURES)} weights, all of them finite")

    def values(self, offers: Sequence[Offer]) -> Floats:
        """Return the value of each of some offers that are compared with each other, (n,)."""
        return np.asarray(features(offers) @ np.array(self.weights), np.float64)

    def to_json(self) -> str:
        """Return the text of the file: the same for the same model."""
        content = {
            "schema": SCHEMA,
            "weights": dict(zip(FEATURES, self.weights, strict=True)),
            "trained": dict(self.trained),
        }
        return json.dumps(content | {"sha256": _digest(content)}, indent=1) + "\n"


def learned(model: ValueModel | None = None) -> Largest:
    """Return the policy of the largest value; by the model of the package when none is given.

    The paper says of Liu et al. (2018) and Menezes et al. (2021) that they formulate a reward and
    train a model by it.  Reward, model and training are ours; theirs choose the order of the
    stones too, while this one was trained on walls of stones that arrive one after the other
    (``drystone_lab.rl.train``).  Among several stones it compares their places, and knows nothing
    of which stone is better kept for later.
    """
    known = model or shipped_model()
    return Largest(lambda offers: known.values(offers)[:, None].tolist())


def features(offers: Sequence[Offer]) -> Floats:
    """Return what the value of an action depends on, (n, len(FEATURES)), each in [-1, 1].

    The offers are compared with each other.  Lengths are over those of the wall or the stone.  The
    last three are the share of the others that is lower, less tight or less able.
    """
    if not offers:
        return np.zeros((0, len(FEATURES)))
    own = np.array([_own(offer) for offer in offers])
    at = FEATURES.index
    ranks = [_rank(own[:, at(name)]) for name in ("top", "LFR", "LLC")]
    return np.asarray(np.clip(np.column_stack([own, *ranks]), -1.0, 1.0), np.float64)


def model_from_json(text: str, where: str) -> ValueModel:
    """Read the text of a file of weights, as of :meth:`ValueModel.to_json`.

    UsageError (E152): it is not such a file, of another version, or not as it was written.
    """
    try:
        content = dict(json.loads(text))
        digest = content.pop("sha256", None)
        if content.get("schema") != SCHEMA:
            raise _broken(f"is of version {content.get('schema')!r}, not {SCHEMA!r}", where)
        if digest != _digest(content):
            raise _broken("is not as it was written: its checksum is another", where)
        return ValueModel(
            tuple(float(content["weights"][name]) for name in FEATURES), content["trained"]
        )
    except (ValueError, TypeError, KeyError) as error:
        raise _broken(
            f"is not a file of weights ({type(error).__name__}: {error})", where
        ) from error


@cache
def shipped_model() -> ValueModel:
    """Return the model that the package comes with."""
    file = resources.files("drystone.selection.policies").joinpath(WEIGHTS)
    return model_from_json(file.read_text("utf-8"), WEIGHTS)


def _own(offer: Offer) -> tuple[float, ...]:
    """Return the features that do not depend on other offers."""
    indices = offer.indices
    wall_height, width = offer.wall_height_px, offer.width_px
    height, top = offer.top_px - offer.bottom_px, offer.top_px / wall_height
    off_centre, slope = centre_distance_px(offer), slope_rad(offer)
    size = math.sqrt(offer.area_px)
    above = (wall_height - offer.top_px) / size
    beside = min(offer.left_px, offer.wall_width_px - offer.right_px) / size
    return (
        indices.LFR,
        indices.GDS,
        indices.NHR,
        0.0 if indices.boundary else indices.IWR,
        indices.IS if indices.boundary else 0.0,
        min(1.0, indices.LLC or 0.0),
        float(indices.boundary),
        offer.bottom_px / wall_height,
        offer.centroid_px[1] / wall_height,
        top,
        top**2,
        min(1.0, above),
        _sliver(above),
        float(above < 0.15),  # it ends with the wall
        width / (width + height),
        offer.from_end_px / offer.wall_width_px,
        _sliver(beside),
        offer.support_width_px / width,
        1.0 if off_centre is None else off_centre / width,
        1.0 if slope is None else slope / (math.pi / 2),
        offer.turned_deg / 90.0,
        offer.wedges / 2.0,
    )


def _sliver(room: float) -> float:
    """Return how useless some room, in sizes of a stone, is for another: 1 where half of one fits.

    0 where there is none, and where a whole one fits.
    """
    return max(0.0, 1.0 - 2.0 * abs(room - 0.5))


def _rank(values: Floats) -> Floats:
    """Return which share of the others is smaller, by more than rounding; 0 for a single one."""
    smaller = values[None, :] < values[:, None] - 1e-9
    return np.asarray(smaller.sum(axis=1) / max(1, len(values) - 1), np.float64)


def _digest(content: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _broken(what: str, where: str) -> UsageError:
    cure = "Install the package again, or train again with `python -m drystone_lab.rl.train`."
    return UsageError("E152", f"the file of weights {what}.", where=where, cure=cure)
