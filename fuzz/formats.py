"""Everything that drystone reads: valid files of it, and who reads them."""

from collections.abc import Callable, Sequence
from functools import cache
from importlib import import_module
from pathlib import Path
from random import Random

from drystone.cli.parser import build_parser
from drystone.cli.settings import recorded_method, settings_from
from drystone.drawing.export.formats import FORMATS as EXPORTERS
from drystone.io.photo_beside import photo_beside, photo_of
from drystone.io.photo_file import read_photo, read_photo_picture
from drystone.io.read_settings import ReadSettings
from drystone.io.read_stones import read_stones
from drystone.photo.segment_photo import segment_photo
from fuzz import drawings, pictures, walls
from fuzz.driver import Format
from fuzz.mutate import Case

_READINGS = (
    ReadSettings(),
    ReadSettings(pieces="keep-largest", holes="keep"),
    ReadSettings(unit="mm"),
    ReadSettings(pieces="split"),
    ReadSettings(mask=True),
    ReadSettings(px_per_m=300.0, max_image_mpx=30.0),
    ReadSettings(max_image_mpx=0.01),
    ReadSettings(background=7, skip=(9,)),
)
_OF_LABELS = (
    ReadSettings(keep=(1, 3)),
    ReadSettings(label=("stone",)),
    ReadSettings(image="a.jpg"),
)
_FEW_PX, _SEGMENTED = 20_000, 0.03
"""Stones are looked for in photographs of so few px only, and in few of them: it takes a second."""

_EXPORTS = ("csv", "geojson", "svg", "dxf", "poses", "obj", "stl", "urdf", "moveit")


def _files(seeds: Callable[[], Sequence[bytes]], ending: str) -> Callable[[], Sequence[Case]]:
    return lambda: [{f"a.{ending}": data} for data in seeds()]


def _stones(path: Path, rng: Random) -> None:
    read_stones(path, settings=rng.choice(_READINGS))


def _labelled(path: Path, rng: Random) -> None:
    read_stones(path, settings=rng.choice((*_READINGS, *_OF_LABELS)))


def _beside(path: Path, rng: Random) -> None:
    photo_of(path)
    read_stones(path, settings=rng.choice(_READINGS[:2]))


def _photo(path: Path, rng: Random) -> None:
    photo = read_photo(path)
    width, height = photo.size_px
    if width * height <= _FEW_PX and rng.random() < _SEGMENTED:
        segment_photo(photo.values, rng.choice((None, 100.0)))


def _settings(path: Path, rng: Random) -> None:
    method = rng.choice(("best", "paper"))
    words = ("plan", "a.png", "--wall", "9x9", "--method", method, "--settings", str(path))
    arguments = _parser().parse_args([*words, "-o", str(path.parent / "out")])
    settings_from(arguments)
    recorded_method(arguments)


_parser = cache(build_parser)


# Before there are limits, and once for all processes.
for _name in ("measure", "analyse", "craft", "check", "export"):
    import_module(f"drystone.cli.commands.{_name}")
for _name in _EXPORTS:
    import_module(f"drystone.drawing.export.{EXPORTERS[_name].module}")


def command(*words: object) -> None:
    """Run a command of drystone as its shell does, up to what it makes of errors."""
    arguments = _parser().parse_args(list(map(str, words)))
    try:
        arguments.run(arguments)
    except OSError as error:
        if error.errno is None:  # what the system says itself has a code (E141)
            raise


def _wall(path: Path, rng: Random) -> None:
    command(rng.choice(("measure", "craft", "craft", "measure", "analyse")), path, "--json")


def _drawn_walls() -> Sequence[Case]:
    seeds = {"json": (drawings.labelme, drawings.coco, drawings.geojson), "svg": (drawings.svg,)}
    return [
        {f"a.{ending}": data} for ending, made in seeds.items() for one in made for data in one()
    ]


def _drawn_wall(path: Path, rng: Random) -> None:
    some = rng.choice(((), ("--unit", "mm"), ("--pieces", "split"), ("--px-per-m", 300)))
    words = rng.choice((("craft",), ("analyse", "--associative-only"), ("measure",)))
    command(*words, path, "--json", *(() if words == ("craft",) and "--px-per-m" in some else some))


def _blocks(path: Path, rng: Random) -> None:
    command(rng.choice(("analyse", "craft")), path, "--json")


def _plan(folder: Path, rng: Random) -> None:
    what = rng.choice(("measure", "craft", "photo", "export", "analyse", "check"))
    if what == "photo":
        photo = photo_beside(folder)
        if photo is not None:
            read_photo_picture(photo, (48.0, 32.0))
    elif what == "check":
        command("check", folder, "--json", "--stones", folder / "stones.png")
    elif what == "export":
        some = rng.sample(_EXPORTS, 2)
        scale = rng.choice(((), ("--px-per-m", 500)))
        command("export", folder, "--json", "--to", *some, *scale, "-o", folder / "out")
    else:
        command(what, folder, "--json")


FORMATS = (
    *(
        Format(name, _files(seeds, ending), _stones, weight)
        for name, seeds, ending, weight in (
            ("png", pictures.pngs, "png", 40), ("tiff", pictures.tiffs, "tif", 40),
            ("gif", pictures.gifs, "gif", 40), ("bmp", pictures.bmps, "bmp", 40),
            ("jpeg", pictures.jpegs, "jpg", 40), ("npy", pictures.npys, "npy", 40),
            ("npz", pictures.npzs, "npz", 30), ("labelme", drawings.labelme, "json", 40),
            ("coco", drawings.coco, "json", 40), ("sam", drawings.sam, "json", 20),
            ("geojson", drawings.geojson, "json", 40),
            ("dxf", drawings.dxf, "dxf", 10), ("svg", drawings.svg, "svg", 20),
            ("obj", drawings.obj, "obj", 8), ("ply", drawings.ply, "ply", 8),
            ("stl", drawings.stl, "stl", 8),
        )
    ),
    Format("exports", _files(drawings.exports, "json"), _labelled, 40),
    Format("cvat", _files(drawings.cvat, "xml"), _labelled, 20),
    Format("yolo", _files(drawings.yolo, "txt"), _labelled, 20),
    Format("masks", pictures.folders, _stones, folder=True),
    Format("segmented", pictures.segmented, _beside, 40, folder=True),
    Format("photo", _files(pictures.photos, "jpg"), _photo, 20),
    Format("settings", walls.settings, _settings, 20),
    Format("wall", walls.images, _wall, 10),
    Format("drawn", _drawn_walls, _drawn_wall, 10),
    Format("blocks", walls.blocks, _blocks, 15),
    Format("plan", walls.plans, _plan, 8, folder=True),
)  # fmt: skip
