"""One over two, two over one: stones that rest on two, and carry two."""

import numpy as np

from drystone.craft.finding import Case, Finding, Limit, Rule
from drystone.craft.masonry import Masonry
from drystone.statics.joints import is_head_joint, loose_blocks
from drystone.statics.model import GROUND

RULE = Rule(
    "one_over_two",
    "one over two",
    "One stone on two, and two stones on one.",
    "Adcock 1994, principle 1; the paper, section 2 (each block in contact with several others)",
    "share of the stones between the ends and above the foot that rest on two or more",
    higher_is_better=True,
    limit=Limit(0.8, 0.6),
)


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Find stones that rest on one stone only.

    Stones of the foot rest on the ground and are left out, and so are those at the ends of the
    wall, where every other stone of a sound bond lies flush on one.

    Parameters
    ----------
    masonry : Masonry
        Any wall.
    limit : Limit
        Of the number.

    Examples
    --------
    >>> import numpy as np
    >>> brick = np.array([[0, 0], [2, 0], [2, 1], [0, 1]])
    >>> places = [(0, 0), (2, 0), (4, 0), (0, 1), (2, 1), (4, 1)]
    >>> stack = Masonry({i: brick + place for i, place in enumerate(places, 1)})
    >>> found = find(stack)
    >>> found.number, found.cases[0].stones
    (0.0, (5, 2))
    """
    left, right = masonry.ends
    inner = [i for i in masonry.stones if i not in left | right]
    judged = [i for i in inner if i not in masonry.on_ground]
    if not judged:
        note = "There is no stone above the foot and between the ends."
        return Finding(RULE, limit, None, "not judged", note=note)
    below = {i: tuple(one[0] for one in masonry.supports[i]) for i in masonry.stones}
    single = [i for i in judged if len(below[i]) < 2]
    number = 1.0 - len(single) / len(judged)
    carried = {i: sum(i in under for under in below.values()) for i in inner}
    carrying = [count for count in carried.values() if count]
    figures: dict[str, float | None] = {
        "stones judged": float(len(judged)),
        "share of the stones that carry that carry two or more": (
            float(np.mean([count > 1 for count in carrying])) if carrying else None
        ),
        "share that touches two or more below": _by_contact(masonry, judged),
    }
    cases = tuple(Case((i, *below[i]), float(len(below[i])), _words(below[i])) for i in single)
    verdict = RULE.verdict(number, limit)
    return Finding(RULE, limit, number, verdict, tuple(sorted(cases, key=_worst)), figures)


def _worst(case: Case) -> tuple[float, tuple[int, ...]]:
    return case.value, case.stones


def _words(below: tuple[int, ...]) -> str:
    return "the first rests on the second only" if below else "rests on no stone"


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
