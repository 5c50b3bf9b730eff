"""What all formats have in common: names, bytes that repeat, scales, extras that are missing."""

import sys

import numpy as np
import pytest

from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.errors import UsageError
from tests.drawing import plans
from tests.drawing.export.drawn_walls import assembly
from tests.pages import printed

SETTINGS = ExportSettings()


@pytest.mark.parametrize("name", FORMATS)
def test_equal_walls_give_equal_bytes_under_the_names_that_are_told(name, tmp_path):
    if name == "mp4":
        pytest.importorskip("av")
    one, other = (assembly(columns=2, rows=1) for _ in range(2))
    if FORMATS[name].metric:  # there is none without a scale
        with pytest.raises(UsageError, match=r"E131 .*--px-per-m.*--ruler.*markers"):
            FORMATS[name].write(assembly(px_per_m=None), tmp_path, SETTINGS)
        assert not list(tmp_path.iterdir())
    paths = FORMATS[name].write(one, tmp_path, SETTINGS)
    files = FORMATS[name].files(other, SETTINGS)
    names = [path.relative_to(tmp_path).as_posix() for path in paths]
    assert names == list(files)
    folders = [one if "/" not in one else f"{one.partition('/')[0]}/" for one in names]
    assert tuple(dict.fromkeys(folders)) == FORMATS[name].writes
    for path, again in zip(paths, files.values(), strict=True):
        written = path.read_bytes()
        assert written == (again.encode() if isinstance(again, str) else again)
        assert b"CreationDate" not in written


def test_no_two_formats_write_one_file_and_none_one_of_the_plan():
    names = [name for one in FORMATS.values() for name in one.writes]
    assert len(set(names)) == len(names)
    assert not {"plan.json", "blocks.json", "wall.png", "report.html"} & set(names)


@pytest.mark.parametrize(("name", "module", "code", "extra"), [
    ("glb", "trimesh", "E182", "mesh"), ("parquet", "pyarrow", "E181", "io"),
    ("dxf", "ezdxf", "E185", "cad"), ("mp4", "av", "E186", "film"),
])  # fmt: skip
def test_an_extra_that_is_missing_is_named(name, module, code, extra, monkeypatch):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(UsageError, match=rf"{code} .*not installed.*drystone\[{extra}\]"):
        FORMATS[name].files(assembly(), SETTINGS)


def test_the_programs_of_the_page_run(tmp_path, monkeypatch, capsys):
    wall = plans.assembly("exact")
    for name in ("poses", "compas"):
        FORMATS[name].write(wall, tmp_path / "out", ExportSettings())
    monkeypatch.chdir(tmp_path)
    programs = printed("for-robotics.md", "py")
    assert len(programs) == 2
    names = {}
    for program in programs:
        exec(program, names)  # noqa: S102 - our own document
    told = capsys.readouterr().out.split()
    assert [word for word in told if "_" in word] == [part.name for part in wall.stones]
    standing = names["standing"]
    last = np.array([standing.vertex_coordinates(key) for key in standing.vertices()])
    count = len(wall.parts[-1].corners)
    assert last[:count, [0, 2]] == pytest.approx(wall.parts[-1].corners, abs=1e-9)
