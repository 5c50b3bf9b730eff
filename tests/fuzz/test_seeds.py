"""What is damaged is valid before."""

from contextlib import suppress
from random import Random

import pytest
from fuzz.driver import Source, place
from fuzz.formats import FORMATS
from fuzz.walls import plans

from drystone.errors import DrystoneError


@pytest.mark.parametrize("one", FORMATS, ids=lambda one: one.name)
def test_most_valid_files_are_read(one, tmp_path):
    """All but those that are there to be refused; with any of the settings, so some say no."""
    read, seeds = 0, one.seeds()
    assert seeds == one.seeds()
    for case in seeds:
        path = place(case, tmp_path / "case")
        for draw in range(12):
            with suppress(DrystoneError):
                one.run(path.parent if one.folder else path, Random(draw))
                read += 1
                break
    assert read >= len(seeds) / 2


def test_plans_have_all_that_is_read_of_them():
    raster, exact = plans()
    assert {"plan.json", "wall.png", "stones.png", "settings.toml", "photo.jpg"} <= raster.keys()
    assert exact.keys() - raster.keys() == {"blocks.json"}
    for case in (raster, exact):
        assert b'"kind": "wedge"' in case["plan.json"]


def test_an_execution_depends_on_its_number_and_the_seed_alone():
    some = [one for one in FORMATS if one.name in ("png", "coco", "dxf")]
    one, same, other = Source(some, 5), Source(some[::-1], 5), Source(some, 6)
    cases = [one.case("png", number)[0] for number in range(40)]
    assert cases == [same.case("png", number)[0] for number in range(40)]
    assert cases != [other.case("png", number)[0] for number in range(40)]
