"""Photographs beside a plan that cannot be used: the viewer and the build sheet refuse alike."""

from pathlib import Path

import pytest
from PIL import Image

import drystone as ds
from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.errors import InputError
from tests.drawing.report.walls import result, written


def unfitting(path: Path) -> None:
    source = result().plan.source
    Image.new("RGB", (2 * source["width_px"], source["height_px"])).save(path)


def broken(path: Path) -> None:
    path.write_bytes(b"no picture")


def cut_short(path: Path) -> None:
    source = result().plan.source
    Image.new("RGB", (source["width_px"], source["height_px"])).save(path)
    path.write_bytes(path.read_bytes()[:-200])


@pytest.mark.parametrize(
    ("spoil", "said"),
    [(unfitting, "something else"), (broken, "cannot be read"), (cut_short, "cannot be read")],
)
def test_both_refuse_alike(spoil, said: str, tmp_path: Path) -> None:
    folder = written(tmp_path)
    spoil(folder / "photo.jpg")
    refusals = []
    for use in (
        ds.view,
        lambda plan: FORMATS["pdf"].files(ds.read_assembly(plan), ExportSettings()),
    ):
        with pytest.raises(InputError, match=said) as caught:
            use(folder)
        refusals.append((caught.value.code, str(caught.value)))
    assert refusals[0] == refusals[1]
    assert refusals[0][0] == "E189"
