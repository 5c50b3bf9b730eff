"""A small wall as a photograph shows it, and as a person traced that picture by eye."""

import json
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

WIDTH, HEIGHT, FOOT = 640, 440, 390
"""Of the photograph, px, and where the ground is in it."""

TRACED = (
    [(124, 780), (129, 625), (240, 611), (392, 617), (402, 700), (397, 780)],
    [(410, 780), (411, 700), (406, 626), (520, 632), (634, 633), (641, 780)],
    [(651, 780), (649, 636), (790, 619), (880, 628), (886, 780)],
    [(897, 780), (894, 655), (905, 629), (1040, 620), (1153, 632), (1160, 780)],
    [(140, 612), (147, 472), (263, 459), (281, 598), (240, 605)],
    [(293, 598), (273, 464), (390, 450), (522, 466), (531, 621), (400, 607)],
    [(542, 624), (535, 470), (680, 470), (781, 457), (789, 606), (650, 624)],
    [(800, 609), (793, 456), (900, 448), (983, 458), (991, 606), (900, 613)],
    [(1003, 607), (995, 461), (1100, 455), (1143, 485), (1145, 617), (1040, 606)],
    [(161, 458), (171, 300), (300, 288), (424, 304), (429, 440), (390, 438), (270, 448)],
    [(441, 443), (434, 304), (580, 284), (692, 299), (697, 460), (525, 455)],
    [(708, 458), (703, 301), (840, 294), (940, 320), (946, 437), (900, 437), (780, 443)],
    [(958, 440), (951, 322), (1040, 305), (1122, 317), (1125, 446), (1095, 444), (990, 449)],
)
"""As clicked by eye on the rendered picture, shown at twice its size; joints stay open."""


def photograph(path: Path) -> Path:
    """Render the wall: grey stones with dark joints under a sky, all with grain."""
    image = Image.new("RGB", (WIDTH, HEIGHT), (176, 198, 222))
    draw = ImageDraw.Draw(image)
    draw.polygon([(58, 392), (78, 140), (568, 140), (584, 392)], fill=(46, 42, 40))
    for corners in TRACED:
        draw.polygon([(x / 2, y / 2) for x, y in corners], fill=(150, 142, 130))
    grain = np.random.default_rng(35).normal(0.0, 9.0, (HEIGHT, WIDTH, 3))
    values = np.clip(np.asarray(image, float) + grain, 0, 255).astype(np.uint8)
    Image.fromarray(values).save(path, quality=90)
    return path


def labelme(path: Path) -> Path:
    """Write the trace as the page of outlines does, all of one class as people leave it."""
    shapes = [
        {
            "label": "stone",
            "points": [(x / 2, y / 2) for x, y in corners],
            "group_id": None,
            "shape_type": "polygon",
            "flags": {},
        }
        for corners in TRACED
    ]
    size = {"imageHeight": HEIGHT, "imageWidth": WIDTH}
    content = {"version": "5.5.0", "flags": {}, "shapes": shapes, "imagePath": "wall.jpg", **size}
    page = {"px_per_m": 200.0, "ground": [[60, FOOT], [590, FOOT]]}
    path.write_text(json.dumps(content | {"imageData": None, "drystone": page}))
    return path
