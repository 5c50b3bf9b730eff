"""What cannot be is refused with a code, the place and the cure; nothing is printed or written."""

import json
import shlex

import numpy as np
import pytest
from PIL import Image

from drystone.io.wall_image import write_labels
from tests.craft.walls import painted, stack_bond

PLAN = "plan {rubble} --wall 70x30 --scale 1 --method paper -o {out}"
EXACT = "plan {rubble} --wall 70x30 --scale 1 --budget 1 -o {out}"
RASTER = "plan {rubble} --wall 70x30 --scale 1 --geometry raster -o {out}"
FROM = f"{EXACT} --from {{settled}}"
SMALL = "plan {bricks} --method paper -o {out}"
BRICKS = "generate brick -o {out}/x.png"
SHEET = "markers -o {out}/sheet.pdf"
PHOTO = "segment {photo} -o {out}"


@pytest.fixture(scope="module")
def places(rubble, bricks, finished, settled, tmp_path_factory):
    """Files by name: good ones, and a folder of things that are no stones, walls or plans."""
    folder = tmp_path_factory.mktemp("inputs")
    block = {"id": 1, "polygon": [[0, 0], [1, 0], [1, 4], [0, 4]]}
    for name, text in {
        "other": '{"a": 1}',
        "tower": json.dumps({"blocks": [block], "mu": 0.58}),
        "still": json.dumps({"blocks": [{**block, "fixed": True}]}),
        "cut": '{"schema": "drystone-',
    }.items():
        (folder / f"{name}.json").write_text(text, encoding="utf-8")
    write_labels(painted(stack_bond()), folder / "stack.png")
    Image.fromarray(np.full((120, 213, 3), 90, np.uint8)).save(folder / "photo.png")
    given = {"rubble": rubble, "bricks": bricks, "finished": finished, "settled": settled}
    names = ("tower.json", "stack.png", "photo.png")
    return given | {"in": folder} | {name.partition(".")[0]: folder / name for name in names}


CASES = [
    # What is read is something else.
    ("plan {in}/nowhere.png --wall 9x9 -o {out}", 3, "E100", "nowhere"),
    ("analyse {in}/nowhere.json", 3, "E132", "nowhere"),
    ("analyse {in}/cut.json", 3, "E132", "cut"),
    ("analyse {in}/still.json", 3, "E303", "no free block"),
    ("measure {in}/other.json", 3, "E113", "A wall is a plan.json, a block model (blocks), a"),
    ("measure {tower}", 2, "E134", "Use `drystone analyse`"),
    ("measure {finished} --background 255", 2, "E118", ""),
    ("measure {finished} --mu 1e308", 3, "E302", "mu"),
    ("check {in}/nowhere.json", 3, "E202", "nowhere"),
    ("check {finished} --stones {in}/nowhere.png", 3, "E100", "nowhere"),
    ("export {in}/nowhere --to csv", 3, "E132", "or its folder"),
    # Options that nobody can mean.
    ("paln {stack}", 2, "E138", "Did you mean `drystone plan`?"),
    ("xyzzy {stack}", 2, "E138", "'xyzzy'. `drystone --help` lists the commands."),
    ("plan stones.png -o x", 2, "E138", "--wall"),
    ("plan x.png --ruler -1,0,9,0=1m", 2, "E138", "one that begins with a minus so: --ruler=-1."),
    ("plan x.png --wall -3x4", 2, "E138", "one that begins with a minus so: --wall=-1."),
    (f"{PLAN} --scale 0", 2, "E138", "--scale: '0'"),
    (f"{PLAN} --px-per-m -5", 2, "E138", "--px-per-m: '-5'"),
    (f"{PLAN} --px-per-m 1e-12", 2, "E138", "--px-per-m: with 1e-12 px in a metre"),
    (f"{PLAN} --jobs 0", 2, "E138", "--jobs: '0'"),
    (f"{EXACT} --budget 0", 2, "E138", "--budget"),
    (f"{EXACT} --bugdet 1", 2, "E138", "Did you mean `--budget`?"),
    (f"{PLAN} --orientations north", 2, "E122", "--orientations: 'north' is not a set"),
    (f"{PLAN} --method towers", 2, "E124", "--method paper --policy towers."),
    ("export x --to geojsn", 2, "E138", "Did you mean `geojson`?"),
    (f"{PLAN} --mu -1", 2, "E123", "--mu: mu must be in (0, 1e+06], not -1.0. Change mu."),
    (f"{PLAN} --budget 3", 2, "E123", "--budget: better walls are looked for on outlines"),
    (f"{EXACT} --placement snug", 2, "E138", "--placement would do nothing"),
    (f"{EXACT} --aim F_LR=.5", 2, "E138", "--aim would do nothing"),
    (f"{EXACT} --aim F_LR", 2, "E138", "F_LR=VALUE"),
    (f"{EXACT} --aim F_AH=0", 2, "E138", "--aim"),
    (f"{RASTER} --policy paper --time 2", 2, "E138", "--policy"),
    (f"{RASTER} --policy nobody", 2, "E146", "there is no policy 'nobody'. Choose one of paper,"),
    # Walls and stones.
    ("plan {rubble} --wall 1.4mx0.4m -o {out}", 2, "E131", "--px-per-m"),
    ("plan {rubble} --wall 1mx.4m --ruler 0,0,90000,0=1m -o {out}", 2, "E138", "outside"),
    # Paths that are none.
    ("analyse ''", 2, "E138", "argument WALL: the path is empty. `drystone analyse --help`"),
    ("rehearse ''", 2, "E138", "argument PLAN: the path is empty"),
    ("plan '' --wall 9x9 -o {out}", 2, "E138", "argument STONES: the path is empty"),
    ("stones {stack} -o ''", 2, "E138", "argument -o/--output: the path is empty"),
    (f"{SMALL} --wall 15x8 --scale 1 --skip-too-large", 2, "E126", "none of the 6 stones"),
    (f"{SMALL} --wall 60x20 --scale 1 --ban 1 2 3 4 5 6", 2, "E126", "or ban fewer stones."),
    (f"{PLAN} --ban 2 3 --pin 3", 2, "E123", "--ban and --pin: ban and pin name the same stones"),
    # Plans that a search cannot begin with.
    (f"{FROM} --wall 80x30", 2, "E144", "of another wall (70x30 px, not 80x30)."),
    (f"{FROM} --geometry raster --scale .5", 2, "E144", "Add --scale 1 --geometry exact."),
    (f"{FROM} --orientations sf", 2, "E144", "other orientations. Add --orientations quarter."),
    (f"{FROM} --pieces split", 2, "E144", "stones that were read otherwise"),
    (f"{FROM.replace('rubble', 'bricks')}", 2, "E144", ": it is of other stones. Give the stones"),
    (f"{EXACT} --from {{in}}", 3, "E202", ""),
    (f"{FROM} --resume", 2, "E138", ""),
    # Generators, markers and photographs.
    ("generate rubble -o {out}/x.png --count 0", 2, "E138", "--count: '0'"),
    (f"{BRICKS} --set cuont=1", 2, "E123", "Did you mean `count`?"),
    (f"{BRICKS} --set height_px", 2, "E135", "Known: count"),
    ("generate brick -o {out}/x.jpg", 2, "E139", ""),
    (f"{SHEET} --size 2inches", 2, "E174", "--size: '2inches' is not a length"),
    (f"{SHEET} --count 3", 2, "E174", ""),
    (f"{SHEET} --ids 2", 2, "E174", ""),
    ("markers -o {out}/sheet.png", 2, "E139", ""),
    (f"{PHOTO}/new", 3, "E175", "100 % of the photograph"),
    (f"{PHOTO} --aruco 50mm --px-per-m 100", 2, "E138", ""),
    (f"{PHOTO} --marker-ids 1", 2, "E138", "--marker-ids"),
    (f"{PHOTO} --check-line 97mm", 2, "E138", "--check-line"),
    (f"{PHOTO} --aruco A4 --check-line 97", 2, "E174", "--check-line: '97' is not a length"),
    (f"{PHOTO} --aruco A4 --check-line 97in", 2, "E174", "--check-line: a check line of"),
    (f"{PHOTO} --aruco 50", 2, "E174", "--aruco: '50' is not a length"),
    (f"{PHOTO} --min-area 5cm2", 2, "E131", ""),
    (f"{PHOTO} --ruler 20,30,2000,30=1.0m", 2, "E138", "the point 2000,30 is outside the picture"),
    # Analyses, craft and measures.
    ("analyse {tower} --dead 1:0,0", 2, "E138", ""),
    ("analyse {tower} --load points", 2, "E138", ""),
    ("analyse {tower} --load gravity --tilt 3", 2, "E138", ""),
    ("analyse {tower} --live 1@0,0:1,0", 2, "E138", ""),
    ("analyse {tower} --settle 1", 3, "E306", ""),
    ("analyse {tower} --mu .8:.4", 2, "E138", ""),
    ("analyse {tower} --close-gaps 3", 2, "E138", ""),
    ("analyse {tower} --contacts outlines", 2, "E138", ""),
    ("analyse {tower} --scatter 9 --tilt 3 --mu .4:.8", 2, "E138", ""),
    ("analyse {tower} --scatter 9 --mu .5", 2, "E138", "--mu LOW:HIGH, --outline-noise or --plac"),
    ("analyse {tower} --px-per-m 200 --ruler 0,0,1,0=1m", 2, "E138", ""),
    ("analyse {settled} --close-gaps 1", 2, "E138", "this plan is one of outlines"),
    ("craft {stack} --limit laps", 2, "E138", ""),
    ("craft {finished} --wedges 3", 2, "E138", "--wedges: a plan says itself what its wedges are."),
    ("measure {stack} --mu -1", 2, "E138", "--mu"),
    ("measure {stack} --px-per-m 100", 2, "E138", "--px-per-m: would do nothing"),
    ("measure {stack} --wall 20x40 --ruler 0,0,20,0=20cm", 2, "E138", "--ruler: would do nothing"),
    ("stones {stack} -o {out}/picture.txt", 2, "E139", ""),
    ("check {finished} --picture {out}/wall.jpg --stones {rubble}", 2, "E139", ""),
    # Rehearsals.
    ("rehearse {settled} --precision 5mm,1deg", 2, "E131", "--precision"),
    ("rehearse {settled} --precision much", 2, "E138", "'much'"),
    ("rehearse {settled} --outline 1%", 2, "E138", "--outline"),
    ("rehearse {settled} --mu 0", 2, "E138", "without friction"),
    ("rehearse {settled} -o {out}/risk.bmp", 2, "E139", ""),
    ("rehearse {finished}", 2, "E138", "on pixels again, with --geometry exact."),
    # Exports.
    ("export {finished}", 2, "E138", "--list names the formats"),
    ("export {finished} --to csv --thickness .3 -o {out}", 2, "E131", ""),
    ("export {finished} --to csv poses -o {out}", 2, "E131", "markers"),
    ("export {finished} --to projector --projector 0x480@9 -o {out}", 2, "E138", "--projector"),
    ("export {finished} --to obj --density 9 -o {out}", 2, "E138", "do nothing with --to obj."),
    ("export {finished} --to gif --ruler 0,0,9,0=1m -o {out}", 2, "E138", "--ruler: would do"),
    ("export {finished} --to csv gif --seconds-per-step 1000 -o {out}", 2, "E138", "--seconds-per"),
    ("export {finished} --to csv --ruler 0,0,9000,0=1m -o {out}", 2, "E138", "outside the picture"),
]  # fmt: skip


@pytest.mark.parametrize(("line", "exit_code", "code", "said"), CASES, ids=[c[0] for c in CASES])
def test_what_cannot_be_is_refused(line, exit_code, code, said, places, tmp_path, run):
    out = tmp_path / "out"
    ran = run(*(word.format(out=out, **places) for word in shlex.split(line)))
    assert (ran.code, ran.out) == (exit_code, "")
    *notices, last = ran.err.splitlines()
    assert last.startswith(f"drystone: {code} ")
    assert said in last
    assert last.endswith((".", ")", "?", "`"))
    assert all(notice.startswith("drystone: W") for notice in notices)
    assert not out.exists()


def test_settings_that_cannot_be_are_blamed_on_their_file(rubble, tmp_path, run):
    toml, out = tmp_path / "mine.toml", tmp_path / "out"
    wall = ("--wall", "70x30", "--scale", "1", "--geometry", "raster")
    for text, code, said in (
        (None, "E128", "Give a TOML file, such as the settings.toml"),
        ("mu = -1.0", "E123", "{}: mu must be in (0, 1e+06], not -1.0. Change mu."),
        ("bugdet = 1", "E123", "{}: there is no setting 'bugdet'. Did you mean `search.budget`?"),
        ("[stop]\nfilling = 2.0", "E123", "{} [stop]: filling must be in (0, 1]"),
        ("[stop]\nfailures = 'five'", "E123", "{}: stop.failures must be a whole number, not"),
        ("orientations = 'north'", "E122", "{}: 'north' is not a set of orientations."),
        ("mu = 1e308", "E123", "{}: mu must be a finite number up to 1e12"),
        ("selection_rule = 'nobody'\n[search]\nbudget = 1\n", "E146", "{}: there is no policy"),
        ("selection_rule = 'lowest'\n", "E123", "{}: the policy 'lowest' builds"),
        ("mu = ", "E128", "{}: is not valid TOML"),
        ("mu = " + "[" * 100_000, "E128", ""),
        ("mu = 0.5 #" + " " * 1_000_000, "E128", ""),
    ):
        if text is not None:
            toml.write_text(text, encoding="utf-8")
        ran = run("plan", rubble, *wall, "--settings", toml, "-o", out)
        assert (ran.code, ran.err.count("\n")) == (3 if code == "E128" else 2, 1)
        assert ran.err.startswith(f"drystone: {code} ")
        assert said.format(toml) in ran.err
        assert not out.exists()
