"""A small wall as a photograph shows it, and as a person traced that picture by eye."""

import json

import numpy as np
import shapely
from PIL import Image, ImageDraw, ImageFilter

WIDTH, HEIGHT, FOOT = 640, 440, 390
"""Of the photograph, px, and where the ground is in it."""

# Corners, px, y down; joints are some px wide, and the last course is level with nothing.
STONES = (
    [(62, 390), (66, 312), (120, 305), (196, 309), (201, 352), (198, 390)],
    [(205, 390), (207, 352), (203, 311), (262, 318), (318, 316), (321, 390)],
    [(326, 390), (324, 318), (398, 309), (441, 314), (444, 390)],
    [(449, 390), (447, 330), (452, 313), (520, 309), (577, 316), (580, 390)],
    [(70, 307), (74, 236), (131, 229), (141, 300), (121, 300)],
    [(146, 299), (136, 231), (196, 224), (262, 233), (266, 312), (200, 304)],
    [(271, 313), (267, 234), (340, 236), (391, 227), (395, 304), (322, 312)],
    [(400, 304), (396, 228), (450, 223), (492, 229), (496, 304), (450, 308)],
    [(501, 304), (497, 230), (548, 227), (571, 240), (573, 310), (522, 304)],
    [(80, 231), (86, 150), (150, 143), (212, 152), (215, 221), (196, 219), (133, 224)],
    [(220, 222), (217, 152), (290, 140), (346, 149), (349, 231), (264, 228)],
    [(354, 230), (351, 150), (420, 146), (470, 160), (474, 219), (450, 218), (391, 222)],
    [(479, 221), (475, 161), (520, 152), (561, 158), (563, 228), (548, 222), (496, 225)],
)


def photograph(path):
    """Render the wall: stones in shades, with grain and dark joints, grass, sky, a staff."""
    random = np.random.default_rng(35)
    image = Image.new("RGB", (WIDTH, HEIGHT), (176, 198, 222))
    draw = ImageDraw.Draw(image)
    draw.rectangle((0, FOOT - 4, WIDTH, HEIGHT), fill=(96, 122, 62))
    draw.polygon([(58, 392), (78, 140), (568, 140), (584, 392)], fill=(46, 42, 40))
    for corners in STONES:
        grey = int(random.integers(120, 175))
        draw.polygon(_rounded(corners), fill=(grey, grey - 8, grey - 20))
    draw.rectangle((606, 190, 614, 390), fill=(250, 250, 250))  # a metre of staff
    for y in range(190, 390, 40):
        draw.rectangle((606, y, 614, y + 19), fill=(200, 30, 30))
    grain = random.normal(0.0, 9.0, (HEIGHT, WIDTH, 1)) + _clouds(random)
    values = np.clip(np.asarray(image, float) + grain, 0, 255).astype(np.uint8)
    Image.fromarray(values).filter(ImageFilter.GaussianBlur(0.8)).save(path, quality=90)
    return path


def _rounded(corners):
    shape = shapely.Polygon(corners).buffer(-6).buffer(6)
    return [(float(x), float(y)) for x, y in shape.exterior.coords]


def _clouds(random):
    small = Image.fromarray(
        random.normal(0.0, 14.0, (HEIGHT // 12, WIDTH // 12)).astype(np.float32)
    )
    return np.asarray(small.resize((WIDTH, HEIGHT), Image.Resampling.BICUBIC))[..., None]


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


def labelme(path):
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
