"""What a build sheet says of a stone: how to turn it, where it goes, what it rests on."""

import numpy as np

from drystone.drawing.assembly import Assembly, Part
from drystone.kernels.polygons import Points
from drystone.model.plan import Point
from drystone.statics.model import GROUND

AS_IT_LIES_DEG = 2.5  # nobody turns a stone by less
STEEP = 0.5  # share of a normal that is upright: what touches with more of it is below or above
CORNER = 0.03
"""Share of its width that a part has over another one when no more than corners of them meet."""


def turn_words(angle_deg: float) -> str:
    """Say how to turn a stone, the angle counter-clockwise as it is seen."""
    angle = shortest_turn(angle_deg)
    if abs(angle) < AS_IT_LIES_DEG:
        return "as it lies"
    if abs(angle) > 180.0 - AS_IT_LIES_DEG:
        return "half turn"
    if abs(abs(angle) - 90.0) < AS_IT_LIES_DEG:
        return f"quarter turn {'left' if angle > 0 else 'right'}"
    return f"turn {'left' if angle > 0 else 'right'} {abs(angle):.0f}\N{DEGREE SIGN}"


def shortest_turn(angle_deg: float) -> float:
    """Return an angle in (-180, 180]."""
    return 180.0 - (180.0 - angle_deg) % 360.0


def length_words(assembly: Assembly, *lengths: float) -> str:
    """Write lengths with their unit: cm, or px when there is no scale."""
    if assembly.unit == "m":
        return ", ".join(f"{100 * length:.1f}" for length in lengths) + " cm"
    return ", ".join(f"{length:.0f}" for length in lengths) + " px"


def size_words(assembly: Assembly, wedge: Part) -> str:
    """Write the size of what is cut: whole mm, or px."""
    width, height = np.ptp(wedge.corners, axis=0).tolist()
    if assembly.unit == "m":
        return f"{1000 * width:.0f} \N{MULTIPLICATION SIGN} {1000 * height:.0f} mm"
    return f"{width:.0f} \N{MULTIPLICATION SIGN} {height:.0f} px"


def left_foot(part: Part) -> Point:
    """Return the left end of a part's foot, which is the lowest 2 % of its height in the wall."""
    corners = part.corners
    low = corners[:, 1] <= corners[:, 1].min() + 0.02 * np.ptp(corners[:, 1])
    x, y = min(corners[low].tolist())
    return x, y


def beside(assembly: Assembly, part: Part) -> dict[str, list[int]]:
    """Return what a stone or wedge touches of what stands already, on each side of it.

    Parts are named by their steps, ascending; the ground is 0.  Wedges are among those that it is
    on; its own are not, they come after it.
    """
    sums: dict[int, Points] = {}
    for interface in assembly.model.faces.get(part.id, ()):
        towards = 1.0 if interface.block == part.id else -1.0
        other = interface.other if towards > 0 else interface.block
        # Contacts at a point have no length, and count a little.
        share = interface.length + 1e-6 * assembly.size[0]
        push = towards * share * np.array(interface.normal)
        sums[other] = sums.get(other, np.zeros(2)) + push
    found: dict[str, list[int]] = {"on": [], "right of": [], "left of": [], "under": []}
    for other, push in sums.items():
        if other == GROUND:
            found["on"].append(GROUND)
            continue
        neighbour = assembly.part(other)
        (a, b), (c, d) = ((p.corners[:, 0].min(), p.corners[:, 0].max()) for p in (part, neighbour))
        # How much of the narrower one is above or below the other one, 0 to 1.
        shared = (min(b, d) - max(a, c)) / min(b - a, d - c)
        x, y = push / max(float(np.hypot(*push)), 1e-300)
        side = "right of" if x > 0 else "left of"
        if shared > CORNER and abs(y) > STEEP:
            side = "on" if y > 0 else "under"
        # Nobody sets a stone by a wedge beside it.
        if neighbour.step < part.step and (side == "on" or neighbour.kind == "stone"):
            found[side].append(neighbour.step)
    return {side: sorted(steps) for side, steps in found.items() if steps}


def beside_words(assembly: Assembly, part: Part) -> str:
    """Say by steps what a stone rests on and stands beside, such as "on 3 and 5, right of 7"."""
    wedges, words = {wedge.step for wedge in assembly.wedges}, []
    for side, steps in beside(assembly, part).items():
        names = [f"wedge {step}" if step in wedges else str(step) for step in steps if step]
        *first, last = names or [""]
        listed = f"{', '.join(first)} and {last}" if first else last
        grounded = ["on the ground"] if GROUND in steps else []
        words.append(" and ".join([*grounded, *([f"{side} {listed}"] if names else [])]))
    return ", ".join(words)


def step_words(assembly: Assembly, part: Part) -> str:
    """Say what a step asks for."""
    if part.kind == "wedge":
        under = assembly.part(part.under or 0)
        return (
            f"Push wedge {part.id} in under the {wedge_place(assembly, part)} of stone {under.id} "
            f"(step {under.step}): {size_words(assembly, part)}."
        )
    across, up = (length_words(assembly, value) for value in part.centroid)
    beside = beside_words(assembly, part)
    return (
        f"Set stone {part.id} ({turn_words(part.angle_deg)}), its middle {across} from the left "
        f"end and {up} above the ground{beside and f'; {beside}'}."
    )


def wedge_words(assembly: Assembly, wedge: Part) -> str:
    """Say where a wedge goes, and how large it is."""
    place = wedge_place(assembly, wedge)
    return f"wedge {wedge.step}: {size_words(assembly, wedge)}, under its {place}"


def wedge_place(assembly: Assembly, wedge: Part) -> str:
    """Say under which part of its stone a wedge is: "left end", "middle" or "right end"."""
    stone = assembly.part(wedge.under or 0).corners[:, 0]
    share = (wedge.centroid[0] - stone.min()) / float(np.ptp(stone))
    if share < 1 / 3:
        return "left end"
    return "middle" if share <= 2 / 3 else "right end"
