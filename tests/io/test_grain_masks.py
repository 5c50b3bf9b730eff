"""Files of the programs that find stones in hard pictures (docs/photographs.md)."""

import json

import numpy as np
import pytest
import tifffile
from PIL import Image

from drystone.io.read_stones import read_stones

LABELS = np.zeros((60, 90), np.int32)
LABELS[5:25, 5:30] = 1
LABELS[5:25, 30:55] = 2  # touches the first
LABELS[30:55, 40:80] = 70_000  # more than 16 bits


def imagegrains(path):
    tifffile.imwrite(path / "photo_mask.tif", LABELS)
    return path / "photo_mask.tif"


def cellpose(path):
    small = np.where(LABELS > 9, 3, LABELS).astype(np.uint16)
    Image.fromarray(small).save(path / "photo_cp_masks.png")
    return path / "photo_cp_masks.png"


def segmenteverygrain(path):
    def ring(left, top, right, bottom):
        return [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]]

    boxes = ((5, 5, 30, 25), (30, 5, 55, 25), (40, 30, 80, 55))
    features = [
        {"type": "Feature", "properties": {},
         "geometry": {"type": "Polygon", "coordinates": [ring(*map(float, box))]}}
        for box in boxes
    ]  # fmt: skip
    text = json.dumps({"type": "FeatureCollection", "features": features})
    (path / "photo_grains.geojson").write_text(text, encoding="utf-8")
    return path / "photo_grains.geojson"


def segment_anything(path):
    masks = [
        {"segmentation": (LABELS == k).tolist(), "area": int((LABELS == k).sum()),
         "predicted_iou": 0.9, "stability_score": 0.95}
        for k in (1, 2, 70_000)
    ]  # fmt: skip
    (path / "photo.json").write_text(json.dumps(masks), encoding="utf-8")
    return path / "photo.json"


@pytest.mark.parametrize("write", [imagegrains, cellpose, segmenteverygrain, segment_anything])
def test_every_stone_of_another_program_is_read(write, tmp_path):
    stones = read_stones(write(tmp_path))
    assert [stone.area_px for stone in stones] == [500, 500, 1000]
