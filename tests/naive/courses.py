"""Slow, obvious twin of drystone.kernels.courses: loops over columns, and all laid anew."""

import itertools
import math

from drystone.kernels.course_moves import Dice, changed
from drystone.kernels.courses import evaluate

UNITS, PX = 16, 32


def towards_zero(number, by):
    return int(math.copysign(abs(number) // by, number)) if number else 0


def all_terms(poses, plan, ground, rules):
    """Left ends, lowest points, slopes, profile, joints and terms of an arrangement."""
    level = [int(top) for top in ground.tops]
    joints = [tuple(map(int, joint)) for joint in ground.joints]
    starts = path_starts(ground.width)
    ways = {(j, s): int(ground.ways[j][s]) for j in range(len(joints)) for s in range(len(starts))}
    beds = [tuple(map(int, bed)) for bed in ground.beds]
    places, rows, at = [], [], 0
    for course, size in enumerate(plan.sizes.tolist()):
        stones = plan.order[at : at + size].tolist()
        at += size
        posed = [4 * stone + int(plan.turns[stone]) for stone in stones]
        terms = [0.0] * 17
        xs, room = positions(poses, posed, int(plan.gaps[course]), ground.width, rules)
        terms[4] = float(-min(0, room))
        new_level, peaks = list(level), []
        for pose, x in zip(posed, xs, strict=True):
            y, slope = rest(poses, pose, x, level, rules, terms)
            places.append((x, y, slope))
            own = top_of(poses, pose, x, y, slope, level, new_level)
            if max(own) > ground.height:
                terms[10] += max(own) - ground.height
                terms[11] += 1
            peaks += own
        terms[0] = float(sum(abs(b - a) for a, b in itertools.pairwise(peaks)))
        mean = towards_zero(sum(peaks), len(peaks))
        terms[2 if course == len(plan.sizes) - 1 else 1] = sum(abs(p - mean) for p in peaks)
        edges = open_ends(poses, posed, xs, ground.width)
        for one, two in itertools.product(edges[1:-1], joints[1:-1]):
            terms[3] += max(0.0, 1 - between(one, two) / rules.reach) ** 2
        for left, right in edges:
            free = sum(max(0, mean - level[c]) for c in range(left // UNITS, right // UNITS))
            terms[5] += (right - left) * free
        terms[12] = edges[0][1] - edges[0][0] + edges[-1][1] - edges[-1][0]
        terms[13] = sum(max(0.0, poses.height[pose] / poses.width[pose] - 1.0) for pose in posed)
        terms[12] += int(poses.faces[posed[0]][0]) + int(poses.faces[posed[-1]][1])
        new_ways = {}
        for (j, edge), (s, start) in itertools.product(enumerate(edges), enumerate(starts)):
            bare = between(edge, (start, start))
            steps = [ways[i, s] + between(edge, joints[i]) for i in range(len(joints))]
            new_ways[j, s] = min(steps) if joints else bare
        level, joints, ways = new_level, edges, new_ways
        beds.append((peaks[0], peaks[-1], int(terms[0])))
        rows.append(terms)
    rows.append(of_the_whole(poses, plan.order[at:].tolist(), level, joints, ways, beds, ground))
    rows[-1][16] = max(0.0, rules.target - rows[-1][16]) if starts else 0.0
    return places, level, joints, rows


def open_ends(poses, posed, xs, width):
    edges = [(0, xs[0])]
    for pose, x, left in zip(posed, xs, [*xs[1:], width], strict=True):
        right = x + int(poses.width[pose])
        edges.append((right, left) if right <= left else ((right + left) // 2,) * 2)
    return edges


def of_the_whole(poses, left_out, level, joints, ways, beds, ground):
    top = max(level)
    terms = [0.0] * 17
    terms[14] = sum(int(poses.area[stone]) for stone in left_out)
    half = PX // 2
    lengths = [
        min(
            abs(top - start - a) + abs(top - start - b) + (424 * ups >> 10)
            for a, b, ups in [*beds, (-half, -half, 0), (top + half, top + half, 0)]
        )
        for start in path_starts(top)
    ]
    terms[15] = percent(lengths, ground.width + 2 * PX)
    lengths = [
        min(ways[j, s] + between(joint, (start, start)) for j, joint in enumerate(joints))
        for s, start in enumerate(path_starts(ground.width))
    ]
    terms[16] = percent(lengths, top + 2 * PX)
    return terms


def percent(lengths, straight):
    few = sorted(lengths)[:5]
    return 100.0 * sum(few) / (len(few) * straight) if few else 0.0


def path_starts(side):
    side_px = math.ceil(side / PX) + 3
    return [px * PX - PX // 2 for px in range(10, side_px - 10, max(1, side_px // 10))]


def between(one, two):
    """How far two stretches are apart."""
    return max(one[0] - two[1], two[0] - one[1], 0)


def positions(poses, posed, gap, width, rules):
    """Stones pushed together from both ends."""
    apart = []
    for left, right in itertools.pairwise(posed):
        rights = poses.rights[poses.first_row[left] : poses.first_row[left + 1]].tolist()
        lefts = poses.lefts[poses.first_row[right] : poses.first_row[right + 1]].tolist()
        apart.append(max(a - b for a, b in zip(rights, lefts, strict=False)) + rules.joint)
    room = width - sum(apart) - int(poses.width[posed[-1]])
    xs = [sum(apart[:i]) for i in range(len(posed))]
    away = 2 * room // 5 if gap < 0 < room else 0
    from_left = range(gap if gap >= 0 else -1 - gap)
    xs = [x + (away if i in from_left else room - away) for i, x in enumerate(xs)]
    ends = [width - int(poses.width[pose]) for pose in posed]
    return [min(max(0, x), end) for x, end in zip(xs, ends, strict=True)], room


def columns_of(poses, pose, x, level):
    count = int(poses.first[pose + 1] - poses.first[pose])
    return min((x + UNITS // 2) // UNITS, len(level) - count), count


def rest(poses, pose, x, level, rules, terms):
    """Drop a stone, turn it on what it met on both sides, and count."""
    column, count = columns_of(poses, pose, x, level)
    middle = int(poses.middle[pose])
    under = [int(b) for b in poses.bottoms[poses.first[pose] : poses.first[pose + 1]]]
    need = [level[column + j] - under[j] for j in range(count)]
    if count == 1:
        return need[0], 0
    left, right = carriers(need, middle)
    slope = towards_zero((need[right] - need[left]) * 4096, right - left)
    slope = min(rules.steepest, max(-rules.steepest, slope))
    need = [n - math.floor(slope * (j - middle) / 4096) for j, n in enumerate(need)]
    left, right = carriers(need, middle)
    y = max(need)
    terms[6] += sum(y - n for n in need)
    terms[7] += abs(slope) * count // 4096
    terms[8] += abs(need[left] - need[right])
    terms[9] += max(0.0, rules.margin - min(middle - left, right + 1 - middle) / count)
    return y, slope


def carriers(need, middle):
    left = min(range(middle), key=lambda j: (-need[j], j))
    right = min(range(middle, len(need)), key=lambda j: (-need[j], -j))
    return left, right


def top_of(poses, pose, x, y, slope, level, new_level):
    column, count = columns_of(poses, pose, x, level)
    middle = int(poses.middle[pose])
    over = poses.tops[poses.first[pose] : poses.first[pose + 1]].tolist()
    for j in range(count):
        tip = y + over[j] + math.floor(slope * (j - middle) / 4096)
        new_level[column + j] = max(new_level[column + j], tip)
    return [
        y + int(peak) + math.floor(slope * (int(at) - middle) / 4096)
        for peak, at in zip(poses.peaks[pose], poses.part_at[pose], strict=True)
    ]


def annealed(poses, now, ground, rules, cooling):
    """The cheapest arrangement that is met, and its cost: each is laid anew, to the top."""
    dice, temperature = Dice(cooling.seed), cooling.temperature
    cost = sums(poses, now, ground, rules)[-1]
    best = now, cost
    for _ in range(cooling.evaluations):
        temperature *= cooling.factor
        plan, lowest = changed(now, dice, rules.courses)
        if lowest < 0:
            continue
        limit = cost - temperature * math.log((dice.below(4096) + 0.5) / 4096)
        old, new = sums(poses, now, ground, rules), sums(poses, plan, ground, rules)
        highest, doubted = len(new), False
        if len(old) == len(new):
            pairs = zip(courses_of(now), courses_of(plan), strict=True)
            highest = max((i for i, (a, b) in enumerate(pairs) if a != b), default=0)
        for course in range(max(lowest, highest), len(new) - 2):
            doubted |= new[course] - old[course] > limit - cost + cooling.doubt
        if new[-1] <= limit and not doubted:
            now, cost = plan, new[-1]
            if cost < best[1]:
                best = now, cost
    return best


def courses_of(plan):
    """Poses of each course, and its gap."""
    ends = [0, *itertools.accumulate(plan.sizes.tolist())]
    return [
        ([(s, int(plan.turns[s])) for s in plan.order[a:b].tolist()], gap)
        for (a, b), gap in zip(itertools.pairwise(ends), plan.gaps.tolist(), strict=True)
    ]


def sums(poses, plan, ground, rules):
    """What an arrangement costs up to each course, with what is left out; and in all."""
    *rows, whole = evaluate(poses, plan, ground, rules).terms.tolist()
    costs = [0.0, whole[14] * rules.weights[14]]
    for row in rows:
        costs[0] = 0.0
        for term, weight in zip(row, rules.weights, strict=True):
            costs[0] += term * weight
        costs.append(costs[-1] + costs[0])
    paths = whole[15] * rules.weights[15] + whole[16] * rules.weights[16]
    return [*costs[2:], costs[-1] + paths]
