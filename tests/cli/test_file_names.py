"""Names of files that are no UTF-8 do not end the work after it is done."""

import os
import sys

import numpy as np
import pytest
from PIL import Image


@pytest.mark.skipif(sys.platform in {"win32", "darwin"}, reason="names are Unicode there")
def test_a_plan_of_masks_among_which_there_is_such_a_file(tmp_path, run):
    masks, out = tmp_path / "masks", tmp_path / "out"
    masks.mkdir()
    for number in range(4):
        mask = np.pad(np.full((10, 20), 255, np.uint8), 3)
        Image.fromarray(mask).save(masks / f"{number}.png")
    (masks / os.fsdecode(b"\xdcbersicht.txt")).write_bytes(b"")
    ran = run("plan", masks, "--wall", "40x20", "--scale", "1", "--method", "paper", "-o", out)
    assert ran.code in (0, 4)
    assert "W117" in (out / "report.html").read_text("utf-8")
