"""How stones are bonded: joints that run on, crosses, one over two, and laps."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from drystone.craft.finding import Case, Evidence
from drystone.craft.joints import Chain
from drystone.craft.masonry import Masonry
from drystone.statics.joints import is_head_joint, loose_blocks
from drystone.statics.model import GROUND


def bond_faults(masonry: Masonry) -> float:
    """Count the faults against the four rules of bond, for each stone of a wall.

    0 for a sound bond, about 2 for a stack bond.  The sum, over the number of stones, of

    * the courses that upright joints go through beyond the first (running joints),
    * the points at which four stones meet (cross joints),
    * the stones above the foot and between the ends that rest on one stone only (one over two),
    * what laps over joints fall short of a quarter of the stone's width, over this quarter.
    """
    stones = len(masonry.stones)
    if not stones:
        return 0.0
    running = sum(chain.courses - 1 for chain in masonry.chains)
    crosses = len(cross_joints(masonry).cases)
    single = len(one_over_two(masonry).cases)
    short = sum(1.0 - lap.value / masonry.settings.lap for lap in laps(masonry).cases)
    return (running + crosses + single + short) / stones


def running_joints(masonry: Masonry) -> Evidence:
    """Find the joints that go through two courses or more."""
    every = masonry.chains
    if not every:
        return Evidence(None, note="There are no upright joints.")
    height = masonry.mean_height
    running = [chain for chain in every if chain.courses > 1]
    running.sort(key=lambda one: (-one.courses, -round(one.height / height, 6), one.line[0, 0]))
    whole = sum(joint.length for chain in every for joint in chain.joints)
    long = sum(joint.length for chain in running for joint in chain.joints)
    figures = {
        "longest joint, mean stone heights": max(chain.height for chain in every) / height,
        "joints through two courses": float(sum(chain.courses == 2 for chain in running)),
        "joints through three or more": float(sum(chain.courses > 2 for chain in running)),
        "share of the length of all upright joints": long / whole,
    }
    cases = tuple(
        Case(
            tuple(dict.fromkeys(chain.left + chain.right)),
            float(chain.courses),
            f"{chain.courses} courses, {chain.height / height:.1f} mean stone heights",
            (chain.line,),
            at_fault=0,
        )
        for chain in running
    )
    return Evidence(float(max(chain.courses for chain in every)), cases, figures)


def cross_joints(masonry: Masonry) -> Evidence:
    """Find points at which an upright joint crosses a bed joint, a plus instead of a T."""
    if not masonry.heads:
        return Evidence(None, note="There are no upright joints.")
    cases = [case for chain in masonry.chains for case in _crosses(masonry, chain)]
    cases.sort(key=lambda case: case.value)
    number = 10.0 * len(cases) / len(masonry.stones)
    return Evidence(number, tuple(cases), {"points": float(len(cases))})


def _crosses(masonry: Masonry, chain: Chain) -> Iterator[Case]:
    """Yield where both sides of a chain change at nearly the same height."""
    height = masonry.mean_height
    reach = masonry.settings.offset * height + 2.0 * masonry.rows.spacing
    begin = 0
    while begin + 1 < len(chain.joints):
        lower = chain.joints[begin]
        end = _other_sides(chain, begin, reach)
        if end is None:
            begin += 1
            continue
        upper, begin = chain.joints[end], end
        four = (lower.first, lower.second, upper.first, upper.second)
        top, bottom = lower.points[-1], upper.points[0]
        apart = abs(float(bottom[0] - top[0])) / height
        words = f"{apart:.2f} mean stone heights from joint to joint"
        middle = 0.5 * (top + bottom)
        plus = tuple(np.array([middle - arm, middle + arm]) for arm in 0.3 * height * np.eye(2))
        yield Case(four, round(apart, 9), words, plus, 0)


def _other_sides(chain: Chain, begin: int, reach: float) -> int | None:
    """Return the next joint between two other stones; None when there is none within reach."""
    one, passed = chain.joints[begin], 0.0
    for place, other in enumerate(chain.joints[begin + 1 :], begin + 1):
        if one.first != other.first and one.second != other.second:
            return place
        passed += other.length
        if passed > reach:
            return None
    return None


def one_over_two(masonry: Masonry) -> Evidence:
    """Find stones that rest on one stone only.

    Stones of the foot rest on the ground and are left out, and so are those at the ends of the
    wall, where every other stone of a sound bond lies flush on one.
    """
    left, right = masonry.ends
    inner = [i for i in masonry.stones if i not in left | right]
    judged = [i for i in inner if i not in masonry.on_ground]
    if not judged:
        return Evidence(None, note="There is no stone above the foot and between the ends.")
    below = {i: tuple(one[0] for one in masonry.supports[i]) for i in masonry.stones}
    carried = [sum(i in under for under in below.values()) for i in inner]
    carrying = [count for count in carried if count]
    figures: dict[str, float | None] = {
        "stones judged": float(len(judged)),
        "share of the stones that carry that carry two or more": (
            float(np.mean([count > 1 for count in carrying])) if carrying else None
        ),
        "share that touches two or more below": _by_contact(masonry, judged),
    }
    cases = []
    for i in judged:
        if len(below[i]) < 2:
            words = "the first rests on the second only" if below[i] else "rests on no stone"
            cases.append(Case((i, *below[i]), float(len(below[i])), words))
    cases.sort(key=lambda case: (case.value, case.stones))
    return Evidence(1.0 - len(cases) / len(judged), tuple(cases), figures)


def _by_contact(masonry: Masonry, judged: list[int]) -> float | None:
    """Return the share that bears on two by the contacts of the model.

    A wedge counts as what it lies on.  None without a model, and for a drawn wall, whose stones
    do not all touch.
    """
    model = masonry.model
    if model is None or loose_blocks(model):
        return None
    below: dict[int, set[int]] = {block.id: set() for block in model.blocks}
    for face in model.interfaces:
        if not is_head_joint(face):
            upper, lower = face.block, face.other
            if face.normal[1] < 0:
                upper, lower = lower, upper
            below.setdefault(upper, set()).add(lower)
    wedges = set(masonry.wedge_ids)
    for i in judged:
        for wedge in below.get(i, set()) & wedges:
            below[i] |= below.get(wedge, set())
    ignored = wedges | {GROUND}
    return float(np.mean([len(below.get(i, set()) - ignored) > 1 for i in judged]))


def laps(masonry: Masonry) -> Evidence:
    """Find short laps.

    The lap is the distance from the joint between two stones that a stone rests on to the nearer
    side of that stone, over its width.
    """
    every = []
    for stone in masonry.stones:
        x0, y0, x1, _ = masonry.boxes[stone]
        for left, right in pairwise(masonry.supports[stone]):
            x = 0.5 * (left[2] + right[1])
            lap = round(max(0.0, min(x - x0, x1 - x)) / (x1 - x0), 6)
            line = np.array([[x, y0], [x0 if x - x0 < x1 - x else x1, y0]])
            words = f"the first laps the joint of the others by {100 * lap:.0f} % of its width"
            every.append(Case((stone, left[0], right[0]), lap, words, (line,)))
    if not every:
        return Evidence(None, note="No stone covers a joint.")
    values = np.array([lap.value for lap in every])
    least = masonry.settings.lap - 1e-9
    figures = {
        "laps": float(len(every)),
        "mean lap": float(values.mean()),
        "share of at least a third": float(np.mean(values >= 1.0 / 3.0 - 1e-9)),
    }
    cases = sorted((lap for lap in every if lap.value < least), key=lambda one: one.value)
    return Evidence(float(np.mean(values < least)), tuple(cases), figures)
