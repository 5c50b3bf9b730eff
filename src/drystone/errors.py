"""Errors and notices: each has a code and says what is wrong, where, and what to do."""

import errno
import os
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from importlib import import_module
from typing import Any


class ExitCode(IntEnum):
    """What the command line returns to the shell."""

    DONE = 0
    USAGE = 2
    BAD_INPUT = 3
    INCOMPLETE = 4
    CHECK_FAILED = 5
    OWN_FAULT = 70
    INTERRUPTED = 130
    TERMINATED = 143


@dataclass(frozen=True)
class Notice:
    """Something the user should know that does not stop the work.

    Parameters
    ----------
    code : str
        Stable code, for example ``"W112"``; documented in ``docs/errors.md``.
    message : str
        What was found and where.
    cure : str
        What to do about it; empty when nothing needs doing.
    """

    code: str
    message: str
    cure: str = ""

    def __str__(self) -> str:
        return _in_one_line(f"{self.code} {self.message}" + (f" {self.cure}" if self.cure else ""))


def _in_one_line(text: str) -> str:
    """Take out what moves the cursor of a terminal: names in a text are those of files."""
    return "".join(c if c.isprintable() else " " for c in text)


class DrystoneError(Exception):
    """Base of all errors that a user can cause and cure.

    Parameters
    ----------
    code : str
        Stable code, for example ``"E104"``; documented in ``docs/errors.md``.
    what : str
        What is wrong and why it matters.
    where : str
        File, stone or option concerned.
    cure : str
        What to do.
    """

    exit_code = ExitCode.BAD_INPUT

    def __init__(self, code: str, what: str, *, where: str = "", cure: str = "") -> None:
        self.code = code
        self.what = what
        self.where = where
        self.cure = cure
        super().__init__(code, what)

    def __str__(self) -> str:
        where = f"{self.where}: " if self.where else ""
        cure = f" {self.cure}" if self.cure else ""
        return _in_one_line(f"{self.code} {where}{self.what}{cure}")


class InputError(DrystoneError):
    """A file or array cannot be read as what it should be."""


class LabelImageError(InputError):
    """An image is not a usable picture of stones."""


class UsageError(DrystoneError):
    """Options or parameters that make no sense together."""

    exit_code = ExitCode.USAGE


class OwnFaultError(DrystoneError):
    """What no user can cause: the last net of the command line says so."""

    exit_code = ExitCode.OWN_FAULT


class PlanError(DrystoneError):
    """A plan file is not valid or does not belong to these stones."""


def counted(count: int, noun: str) -> str:
    """Return a number and what it counts, which is one or several.

    Examples
    --------
    >>> counted(1, "stone"), counted(0, "stone")
    ('1 stone', '0 stones')
    """
    return f"{count} {noun}{'' if count == 1 else 's'}"


NO_ROOM = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC))
"""What the system says when the disk, or the user's share of it, is full."""


def meant(word: str, known: Iterable[str], before: str = "") -> str:
    """Ask whether the nearest known word, or last part of one, was meant; "" when none is near.

    >>> meant("bugdet", ["search.budget", "search.passes"])
    'Did you mean `search.budget`? '
    """
    from difflib import get_close_matches  # noqa: PLC0415 - costs start-up time

    names = {(name if "." in word else name.rpartition(".")[2]).lower(): name for name in known}
    near = get_close_matches(word.lower(), names, 1)
    return f"Did you mean `{before}{names[near[0]]}`? " if near else ""


def extra(module: str, does: str, where: str, name: str, code: str = "E305", cure: str = "") -> Any:
    """Return a package that is an extra, so it is loaded only when it is needed."""
    try:
        return import_module(module)
    except ImportError as error:
        what = f"{module.partition('.')[0]} is not installed, and it {does}."
        cure = f'Install it with `pip install "drystone[{name}]"`{cure}.'
        raise UsageError(code, what, where=where, cure=cure) from error


def not_written(error: OSError) -> PlanError:
    """Return the error with a code (E206) of a file that the system does not write."""
    what = f"the file cannot be written ({error.strerror or error})."
    cure = "Give a folder that exists, has room and may be written to."
    return PlanError("E206", what, where=os.fspath(error.filename or ""), cure=cure)


CODES = {
    "E100": "The file or folder does not exist or cannot be read.",
    "E101": "The ids are damaged: blurred, anti-aliased, interpolated, or stored as a JPEG.",
    "E102": "The picture looks like a photo: many values, few neighbours alike.",
    "E103": "Stones are in several pieces, and the others are 2 % of the stone or more.",
    "E104": "No stones: one value all over, no pixel, only specks, or all skipped.",
    "E105": "The value that fills the borders is not the background of the settings.",
    "E106": "The file is empty, damaged or cut short.",
    "E107": "The format is none of those that are read, or a variant of it that would lose ids.",
    "E108": "Values that cannot be ids.",
    "E109": "Several pages, frames or planes where one picture is needed.",
    "E110": "Too much work or memory.",
    "E111": "A folder without pictures, or a file in it that is not a mask of one stone.",
    "E112": "`stones.json`, which says what is known of a photograph, is damaged.",
    "E113": "A JSON file that is none of labelme, COCO, SAM or GeoJSON, or cut short.",
    "E114": "An entry of a file of outlines that cannot be used.",
    "E115": "Annotations of several images in one file, and none or another one is named.",
    "E116": "A drawing, map or mesh that does not say its unit, or which axis is up.",
    "E117": "The size of `stones.png` is not the one that `stones.json` was written for.",
    "E118": "An option that does not fit what is read.",
    "E119": "A reading setting that means nothing.",
    "E120": "Stones fit into the wall in no orientation; all are listed.",
    "E121": "At the working resolution the wall has no pixel, or more than the memory holds.",
    "E122": "No set of orientations, of `--orientations` or a settings file.",
    "E123": "A setting that does not exist, of the wrong type, or out of range.",
    "E124": "No method of this name.",
    "E125": "The scale is not above 0 and at most 1.",
    "E126": "There are no stones to build with.",
    "E127": "`--wall` is not a wall size.",
    "E128": "The settings file cannot be read, is larger than 1 MB, or is not valid TOML.",
    "E129": "Something is in the way of what would be written, or would be written over.",
    "E130": "The generator cannot make stones with these settings.",
    "E131": "A length, pose or mass in metres, and no scale is known; or two scales that differ.",
    "E132": "A JSON file (block model or plan) cannot be read or is not valid JSON.",
    "E133": "The wall image or the block model beside a plan is missing, or of another wall.",
    "E134": "A block model has no pixels, so it cannot be measured.",
    "E135": "`--set` is not followed by `NAME=VALUE`.",
    "E136": "`--resume` asks for another plan than the one that was begun.",
    "E137": "The ids are so large that none are left for wedges, whose ids are larger.",
    "E138": "The options cannot be understood.",
    "E139": "The ending of an output file is none that is written.",
    "E140": "No solver of the limit analysis found an answer that can be certified.",
    "E141": "The operating system refuses to read or write: no right to, a path too long.",
    "E142": "The memory is not large enough.",
    "E143": "`DRYSTONE_KERNELS` asks for kernels that do not exist or were not compiled.",
    "E144": "A given wall (`--from`, `begin`, `built`) is of something else than is planned.",
    "E145": "`--ban` or `--pin` (or the settings) name a stone that does not exist.",
    "E146": "There is no policy of this name; the message lists those that there are.",
    "E147": "The policy of another package cannot be loaded, failed, or chose what is not there.",
    "E148": "The table of `bench search --runs` is another kind of file, or was cut off.",
    "E149": "Another run of drystone works in the folder, or writes to the database.",
    "E150": "gymnasium is not installed, of which walls for reinforcement learning are.",
    "E151": "An action of `drystone/Wall-v0` that there is not.",
    "E152": "A file of weights of the policy `learned` cannot be used.",
    "E154": "A command of another package cannot be loaded.",
    "E155": "A fault of drystone itself (exit code 70), and none of the input.",
    "E160": "A file of a published set has other contents than the one that was released.",
    "E161": "A file of a published set cannot be downloaded.",
    "E162": "pooch, which downloads published sets, is not installed.",
    "E170": "Fewer than two markers can be used.",
    "E171": "The same marker twice.",
    "E172": "The markers disagree.",
    "E173": "The horizon, or ground that is very far away, is in the photograph.",
    "E174": "A sheet of markers that cannot be printed or a layout that cannot be.",
    "E175": "No stones were found in the photograph.",
    "E176": "No even ground was found in the photograph: no colour fills a fifth of it.",
    "E180": "The outline of a stone or wedge crosses or touches itself.",
    "E181": "pyarrow is not installed, and it writes Parquet.",
    "E182": "trimesh is not installed, and it writes GLB.",
    "E183": "The id, the mask or the drawn outline of a `Stone` cannot be used.",
    "E185": "ezdxf is not installed, and it writes DXF.",
    "E186": "PyAV is not installed, and it writes MP4.",
    "E187": "The wall, with a margin, is larger than the picture of the projector.",
    "E189": "The photograph beside the plan cannot be read, or has another shape.",
    "E190": "Limits of `drystone craft` for a rule that there is not, or the wrong way round.",
    "E191": "Wedges are named by an id that is not in the wall.",
    "E192": "A wall is too long or too high to be judged by the craft rules.",
    "E195": "`Planner.observe` is told of a stone that there is not.",
    "E196": "What was measured is not a picture of the ids of the wall.",
    "E197": "A measured pose is no `MeasuredPose`, no number, or not in the wall.",
    "E198": "A stone was measured where it overlaps others, and there is no room near it.",
    "E199": "A stone is named as lost, and measured in the wall.",
    "E201": "A stone is asked for that is not among those read.",
    "E202": "The plan cannot be read, or the stones that it was made from are not beside it.",
    "E203": "The plan is not valid JSON; it may be cut short.",
    "E204": "It is not a plan, or of a version that is not read here.",
    "E205": "The plan is not as its JSON Schema says.",
    "E206": "The file cannot be written, or the disk is full.",
    "E207": "The search cannot go on from its `checkpoint.json`, or from `state`.",
    "E210": "The stones come from a file of other contents than the plan's.",
    "E211": "Number of stones, size of the image or names of the files are not those of the plan.",
    "E212": "The plan places a stone that is not among those read.",
    "E213": "An id is used twice, or a wedge has an id that is not larger than every stone's.",
    "E214": "The steps are out of order.",
    "E215": "The wall of the plan is too small or too large to be an image.",
    "E216": "The list of unused stones is not what the steps leave over.",
    "E217": "Settings of the plan cannot be used.",
    "E220": "A stone or wedge leaves the wall, or fills no pixel of it.",
    "E221": "A stone or wedge overlaps others.",
    "E222": "The polygon of a wedge has no pixels, or is not the outline of them.",
    "E223": "A wedge does not touch its stone from below, or stands on nothing.",
    "E224": "A wedge is smaller or larger than the settings allow.",
    "E225": "The centroid in the source image is not that of the stone's pixels.",
    "E230": "The wall does not stand after this step, or nothing of it stands on the ground.",
    "E231": "The load multipliers after this step are not those claimed.",
    "E232": "An index of the step (SF, LFR, GDS, NHR, IWR, IS, LLC) is not what is claimed.",
    "E233": "The cluster is not the one claimed.",
    "E234": "A figure of merit of the wall is not what is claimed.",
    "E235": "The stone is turned otherwise than claimed, or than the settings allow.",
    "E236": "wall.png is not the wall that the plan builds.",
    "E237": "On exact geometry: the wall does not stand firmly after this step.",
    "E238": "`blocks.json` is not the block model of a plan on exact geometry.",
    "E239": "The settings do not allow a stone where the plan places it.",
    "E240": "On exact geometry: the outline of a stone is not that of its pixels, holes filled.",
    "E241": "With `--physics`: blocks fall while the wall is built in the order of the plan.",
    "E242": "With `--physics`: tilted, the wall comes down before the load that the plan claims.",
    "E301": "The array is not a picture of ids.",
    "E302": "The coefficient of friction is negative, no number, or above 1e300.",
    "E303": "The block model is not as it should be.",
    "E304": "Blocks overlap, or reach below the ground.",
    "E305": "A package that is an extra is not installed.",
    "E306": "A load case names a missing or a fixed block, or a support that is not fixed.",
    "E307": "A load that grows with height, and no free block lies above the ground.",
    "E308": "A load is nothing, no number, or far too small or large beside the blocks' weight.",
    "E318": "Settings of the scatter that make no sense.",
    "E401": "The outcome of a run that is kept in a folder is damaged.",
    "E402": "The process that did a run died, for want of memory for example.",
    "E403": "Dask is not installed, and `--dask` asks for a cluster.",
    "E404": "No Dask scheduler answers, it has no workers, or the connection was lost.",
    "E405": "The scheduler or a worker of a Dask cluster has another version of drystone, or none.",
    "W110": "A stone may be two touching stones.",
    "W111": "Small pieces of stones were left out, or became stones of their own.",
    "W112": "Holes were filled, or left open.",
    "W113": "Specks were left out.",
    "W114": "The picture was read as a binary mask.",
    "W115": "Colours were read as ids; says by which rule.",
    "W116": "`skip` or `keep` names an id that no stone has, nor a piece that became one.",
    "W117": "Files in a folder of masks that are not pictures.",
    "W118": "A mask in a folder is stone to all its edges.",
    "W119": "What a file of outlines left to decide.",
    "W120": "Pinned stones are not in the wall, which therefore counts as incomplete.",
    "W121": "Stones of the plan that was begun with are not where they were.",
    "W122": "A process of a search died, for want of memory for example.",
    "W123": "With this scale the median stone is less than 1 cm or more than 2 m long.",
    "W124": "As measured, the wall does not stand after some stones, by the planner's contacts.",
    "W125": "What is done after a search was cut short.",
    "W126": "The wall that was built already does not stand after some stones.",
    "W127": "Stones are taken to be elsewhere than they were measured, by a tenth of their size.",
    "W128": "The time limit (`--time`) struck inside the first wall.",
    "W129": "`checkpoint.json` cannot be used, and was set aside.",
    "W130": "What is planned so far cannot be kept beside the plan that is being made.",
    "W131": "The time limit struck before as many walls were built as were asked for.",
    "W135": "What the file or its value says is nothing became background.",
    "W136": "Few blended pixels at edges were repaired.",
    "W170": "Markers were left out.",
    "W171": "Markers were left out that are smaller than 40 px or seen at too flat an angle.",
    "W172": "The scale is in doubt.",
    "W173": "The photograph, label image or wall was turned as its orientation says.",
    "W174": "16 bits a channel were scaled to 8, or transparency was ignored.",
    "W175": "A neck in a stone of a photograph, with its place and width.",
    "W176": "Stones at the edge of the photograph, or areas at a marker, were left out.",
    "W177": "A part of a stone has the colour of shaded ground, or was taken for shadow.",
    "W178": "A stone hardly differs from the ground along a part of its outline.",
    "W179": "Stones of an unusual size, or one along the line of `--ruler`.",
    "W180": "In a folder of an export lie files that are not of it.",
    "W181": "A plan was written into a folder with exports of an earlier one.",
    "W182": "Shapes in a photograph that differ from the ground were not taken for stones.",
    "W183": "All that was found in a photograph is in doubt.",
    "W184": "The scale is that of markers of another family than `drystone markers` prints.",
    "W301": "The wall was put on the ground: rows below its stones were left out.",
    "W302": "The wall does not stand, and blocks are not connected with the ground.",
    "W303": "While planning, the solver gave up on some candidates, which were passed over.",
    "W304": "Pixels of a stone lie apart from it; all pixels of an id are one rigid block.",
    "W305": "Stones have fewer than two contact points.",
    "W306": "A block model gives the friction of blocks that do not touch.",
    "W307": "A block model has keys that mean nothing.",
    "W308": "Drawn stones lie in each other, deeper than edges bear.",
    "W309": "An option gives a friction that no joint takes.",
    "W310": "A force acts far from its block.",
}
"""Every code, and what it means in one sentence; docs/errors.md has more, and the cures."""
