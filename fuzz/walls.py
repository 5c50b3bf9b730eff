"""Valid walls: block models, settings, and folders of plans with all that stands in them."""

import json
import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np

import drystone as ds
from drystone.io.wall_image import write_labels
from fuzz.mutate import Case
from fuzz.pictures import npys, photos, pngs, tiffs

_PLANS = (("paper", 5, None), ("best", 3, 500.0))
"""Method, seed of the stones, and scale of plans that have a wedge."""


def images() -> Sequence[Case]:
    """Return walls as label images."""
    return [
        *({"wall.png": data} for data in pngs()[:3]),
        *({"wall.tif": data} for data in tiffs()[:3]),
        {"wall.npy": npys()[1]},
    ]


def blocks() -> Sequence[Case]:
    """Return block models with polygons, boxes, friction, guides and interfaces."""
    square = [[0, 0], [4, 0], [4, 1], [0, 1]]
    above = [[1, 1], [5, 1], [5, 2.5], [1, 2]]
    rich = {
        "mu": 0.6, "mu_head": 0.5, "friction": [{"between": [1, 2], "mu": 0.7}],
        "blocks": [
            {"id": 1, "polygon": square, "density": 2.0, "fixed": False},
            {"id": 2, "polygon": above, "held": ["x"]},
            {"id": 5, "polygon": [[6, 0], [8, 0], [8, 3], [6, 3]], "fixed": True},
        ],
    }  # fmt: skip
    given = {
        "mu": 0.6,
        "blocks": [{"id": 1, "polygon": square}],
        "interfaces": [
            {"between": [1, 0], "points": [[0, 0], [4, 0]], "normal": [0, 1], "mu": 0.4}
        ],
    }
    boxes = {"blocks_xywh": [[0, 0, 4, 1.75], [2, 1.75, 4, 1.75], [4, 0, 4, 1.75]], "mu": 0.65}
    return [{"blocks.json": json.dumps(model).encode()} for model in (rich, given, boxes)]


def settings() -> Sequence[Case]:
    """Return the settings of plans, and some as people write them."""
    by_hand = (
        b'# a wall\nmu = 0.5\ngeometry = "exact"\nsampling = "full"\ntwo_sided = true\n'
        b"orientations = 15\n\n[search]\nbudget = 4\n\n[goal]\nF_LR = 0.8\n\n[settle]\n"
        b'method = "pivot"\n\n[placement]\nreach = "any"\n'
    )
    found = [case["settings.toml"] for case in plans()]
    return [{"settings.toml": data} for data in (*found, by_hand)]


@cache
def plans() -> Sequence[Case]:
    """Return folders of a plan on pixels, and of one on outlines in metres, with a photograph."""
    return [_planned(*plan) for plan in _PLANS]


def _planned(method: str, seed: int, px_per_m: float | None) -> Case:
    generated = ds.generate.fourier_stones(
        ds.generate.FourierSettings(count=5), np.random.default_rng(seed)
    )
    height, width = generated.source.height_px, generated.source.width_px
    labels = np.zeros((height, width), np.uint16)
    for stone in generated:
        rows, columns = stone.mask.shape
        top = height - stone.bottom_px - rows
        labels[top : top + rows, stone.left_px : stone.left_px + columns][stone.mask] = stone.id
    side = 1.3 * generated.total_area_px**0.5
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_labels(labels, folder / "stones.png")
        careless = ds.method_settings(method).updated({"settle": {"margin": 0.2, "trials": 0}})
        result = ds.plan_wall(
            ds.read_stones(folder / "stones.png"), round(side), round(0.7 * side), seed=1,
            method=method, settings=careless, scale=0.5, px_per_m=px_per_m,
            budget=1 if method == "best" else None,
        )  # fmt: skip
        ds.write_plan_folder(result, folder)
        files = {path.name: path.read_bytes() for path in sorted(folder.iterdir())}
    return {"plan.json": files.pop("plan.json"), **files, "photo.jpg": photos()[0]}
