// Closed outlines as arrays of [x, y]: arithmetic without a page, so that it can be tested alone.
// Coordinates are px of the photograph, x to the right and y down.

import { boxOf } from "../report/viewer/dom.js";

/** Area in px²; the sign says which way round the corners go. */
export function signedArea(ring) {
  let twice = 0;
  for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
    twice += ring[j][0] * ring[i][1] - ring[i][0] * ring[j][1];
  }
  return twice / 2;
}

export function area(ring) {
  return Math.abs(signedArea(ring));
}

export function centroid(ring) {
  const whole = signedArea(ring);
  const [ox, oy] = ring[0];
  let [x, y] = [0, 0];
  for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
    const [ax, ay, bx, by] = [ring[j][0] - ox, ring[j][1] - oy, ring[i][0] - ox, ring[i][1] - oy];
    const cross = ax * by - bx * ay;
    x += (ax + bx) * cross;
    y += (ay + by) * cross;
  }
  return Math.abs(whole) < 1e-12 ? [ox, oy] : [ox + x / (6 * whole), oy + y / (6 * whole)];
}

export function contains(ring, [x, y]) {
  return crossings(ring, y).filter((end) => x < end).length % 2 === 1;
}

/** Where a ring crosses a height, ascending: by turns into it and out of it. */
function crossings(ring, y) {
  const ends = [];
  for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
    const [[ax, ay], [bx, by]] = [ring[i], ring[j]];
    if (ay > y !== by > y) ends.push(((bx - ax) * (y - ay)) / (by - ay) + ax);
  }
  return ends.sort((a, b) => a - b);
}

export function distance([ax, ay], [bx, by]) {
  return Math.hypot(ax - bx, ay - by);
}

/** The point of the segment a-b that is nearest to p. */
export function nearestOn(p, a, b) {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const length2 = dx * dx + dy * dy;
  const share = length2 ? Math.max(0, Math.min(1, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2)) : 0;
  return [a[0] + share * dx, a[1] + share * dy];
}

/** The nearest corner within reach, else the nearest point of an edge, else null. */
export function snapped(point, rings, reach) {
  let [best, least] = [null, reach];
  for (const ring of rings) {
    for (const corner of ring) {
      const away = distance(point, corner);
      if (away < least) [best, least] = [corner, away];
    }
  }
  if (best) return best;
  for (const ring of rings) {
    for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
      const on = nearestOn(point, ring[j], ring[i]);
      const away = distance(point, on);
      if (away < least) [best, least] = [on, away];
    }
  }
  return best;
}

/** Longest and shortest side of the smallest rectangle around a ring, turned in any way. */
export function sidesOf(ring) {
  const hull = hullOf(ring);
  let best = [Infinity, 0, 0];
  for (let i = 0, j = hull.length - 1; i < hull.length; j = i++) {
    const length = distance(hull[i], hull[j]);
    if (!length) continue;
    const [ux, uy] = [(hull[i][0] - hull[j][0]) / length, (hull[i][1] - hull[j][1]) / length];
    const along = hull.map(([x, y]) => x * ux + y * uy);
    const across = hull.map(([x, y]) => y * ux - x * uy);
    const [wide, high] = [along, across].map((one) => Math.max(...one) - Math.min(...one));
    if (wide * high < best[0]) best = [wide * high, Math.max(wide, high), Math.min(wide, high)];
  }
  return [best[1], best[2]];
}

export function hullOf(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (ordered) => {
    const chain = [];
    for (const p of ordered) {
      while (chain.length > 1 && turn(chain[chain.length - 2], chain[chain.length - 1], p) <= 0) chain.pop();
      chain.push(p);
    }
    chain.pop();
    return chain;
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

function turn(a, b, c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/** Where the open segments a-b and c-d cross: shares of both, or null. */
function crossing(a, b, c, d) {
  const [rx, ry, sx, sy] = [b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]];
  const cross = rx * sy - ry * sx;
  if (Math.abs(cross) < 1e-12) return null;
  const t = ((c[0] - a[0]) * sy - (c[1] - a[1]) * sx) / cross;
  const u = ((c[0] - a[0]) * ry - (c[1] - a[1]) * rx) / cross;
  return t >= 0 && t < 1 && u >= 0 && u < 1 ? [t, u] : null;
}

/**
 * Cut a ring along a stroke.  Returns the parts: the ring alone when the stroke does not cross it
 * from one side to the other.
 */
export function cut(ring, stroke) {
  const hits = [];
  for (let k = 0; k + 1 < stroke.length; k++) {
    for (let i = 0; i < ring.length; i++) {
      const found = crossing(stroke[k], stroke[k + 1], ring[i], ring[(i + 1) % ring.length]);
      if (found) hits.push({ on: k + found[0], at: i + found[1] });
    }
  }
  hits.sort((a, b) => a.on - b.on);
  for (let h = 0; h + 1 < hits.length; h++) {
    const way = between(stroke, hits[h].on, hits[h + 1].on);
    if (!contains(ring, midpoint(way))) continue;
    const [one, other] = [
      [...along(ring, hits[h].at, hits[h + 1].at), ...[...way].reverse()],
      [...along(ring, hits[h + 1].at, hits[h].at), ...way],
    ].map(withoutRepeats);
    if (Math.min(one.length, other.length) < 3 || Math.min(area(one), area(other)) < 1) continue;
    // What is left of the stroke may cut the parts again.
    const rest = stroke.slice(Math.floor(hits[h + 1].on) + 1);
    const onward = [pointAt(stroke, hits[h + 1].on + 1e-6), ...rest];
    return rest.length ? [...cut(one, onward), ...cut(other, onward)] : [one, other];
  }
  return [ring];
}

function pointAt(line, at) {
  const k = Math.min(Math.floor(at), line.length - 2);
  const share = at - k;
  return [0, 1].map((axis) => line[k][axis] * (1 - share) + line[k + 1][axis] * share);
}

function between(line, from, to) {
  return [pointAt(line, from), ...line.slice(Math.floor(from) + 1, Math.floor(to) + 1), pointAt(line, to)];
}

function midpoint(way) {
  const middle = Math.floor((way.length - 1) / 2);
  return [0, 1].map((axis) => (way[middle][axis] + way[middle + 1][axis]) / 2);
}

/** The corners of a ring strictly between two places of it. */
function along(ring, from, to) {
  const found = [];
  const n = ring.length;
  const last = to > from ? to : to + n;
  for (let i = Math.floor(from) + 1; i <= Math.floor(last); i++) found.push(ring[i % n]);
  return found;
}

function withoutRepeats(ring) {
  return ring.filter((p, i) => distance(p, ring[(i + ring.length - 1) % ring.length]) > 1e-9);
}

/** Fewer corners, none of the old ones farther than `most` from the new outline (Douglas-Peucker). */
export function simplified(ring, most) {
  if (ring.length < 4) return ring;
  let far = 1;
  for (let i = 1; i < ring.length; i++) if (distance(ring[0], ring[i]) > distance(ring[0], ring[far])) far = i;
  const there = simplifiedLine(ring.slice(0, far + 1), most);
  const back = simplifiedLine([...ring.slice(far), ring[0]], most);
  return [...there.slice(0, -1), ...back.slice(0, -1)];
}

export function simplifiedLine(line, most) {
  const kept = new Uint8Array(line.length);
  kept[0] = kept[line.length - 1] = 1;
  const open = [[0, line.length - 1]];
  while (open.length) {
    const [from, to] = open.pop();
    let [at, away] = [-1, most];
    for (let i = from + 1; i < to; i++) {
      const off = distance(line[i], nearestOn(line[i], line[from], line[to]));
      if (off > away) [at, away] = [i, off];
    }
    if (at < 0) continue;
    kept[at] = 1;
    open.push([from, at], [at, to]);
  }
  return line.filter((_, i) => kept[i]);
}

/** The pixels that rings cover, with a rim of 0 around: {mask, width, height, left, top, step}. */
export function filled(rings, step = 1, rim = 2) {
  const [x0, y0, x1, y1] = boxOf(rings.flat());
  const [left, top] = [Math.floor(x0 / step) - rim, Math.floor(y0 / step) - rim];
  const width = Math.ceil(x1 / step) + rim - left;
  const height = Math.ceil(y1 / step) + rim - top;
  const mask = new Uint8Array(width * height);
  for (const ring of rings) {
    for (let row = 0; row < height; row++) {
      const ends = crossings(ring, (top + row + 0.5) * step);
      for (let k = 0; k + 1 < ends.length; k += 2) {
        const from = Math.ceil(ends[k] / step - 0.5) - left;
        const to = Math.ceil(ends[k + 1] / step - 0.5) - left;
        mask.fill(1, row * width + Math.max(0, from), row * width + Math.max(0, to));
      }
    }
  }
  return { mask, width, height, left, top, step };
}

/** The outer outline of the largest piece of a mask, through the middles of the pixel edges. */
export function outlineOf({ mask, width, height, left, top, step }) {
  const seen = new Uint8Array(mask.length);
  let best = null;
  for (let start = 0; start < mask.length; start++) {
    if (!mask[start] || seen[start]) continue;
    const size = flood(mask, width, height, start, seen);
    if (!best || size > best.size) best = { start, size };
  }
  if (!best) return null;
  // Walk along the pixel edges with the piece on the right, from the upper left corner of its first pixel.
  const piece = new Uint8Array(mask.length);
  flood(mask, width, height, best.start, piece);
  const at = (x, y) => x >= 0 && y >= 0 && x < width && y < height && piece[y * width + x];
  const first = [best.start % width, Math.floor(best.start / width)];
  let [[x, y], [dx, dy]] = [first, [1, 0]];
  const ring = [];
  do {
    ring.push([(left + x + dx / 2) * step, (top + y + dy / 2) * step]);
    [x, y] = [x + dx, y + dy];
    // The pixels ahead, to the right and to the left of the way.
    const right = at(x + (dx - dy - 1) / 2, y + (dx + dy - 1) / 2);
    const ahead = at(x + (dx + dy - 1) / 2, y + (dy - dx - 1) / 2);
    if (!right) [dx, dy] = [-dy, dx];
    else if (ahead) [dx, dy] = [dy, -dx];
  } while (x !== first[0] || y !== first[1] || dx !== 1 || dy !== 0);
  return ring;
}

/** Mark the pixels that hang together with one (over edges); returns how many. */
export function flood(mask, width, height, start, seen) {
  const open = [start];
  seen[start] = 1;
  let size = 0;
  while (open.length) {
    const i = open.pop();
    const x = i % width;
    size += 1;
    for (const [j, there] of [[i - 1, x > 0], [i + 1, x + 1 < width], [i - width, i >= width], [i + width, i + width < mask.length]]) {
      if (there && mask[j] && !seen[j]) {
        seen[j] = 1;
        open.push(j);
      }
    }
  }
  return size;
}

/** One ring around several, gaps between them closed as narrowly as they allow; null if too wide. */
export function merged(rings, widest) {
  for (let reach = 1; ; reach = Math.ceil(reach * 1.5)) {
    const image = filled(rings, 1, reach + 2);
    const wide = shifted(shifted(image, reach, true), reach, false);
    for (let i = 0; i < wide.mask.length; i++) wide.mask[i] |= image.mask[i];
    const ring = outlineOf(wide);
    const alone = rings.every((one) => contains(ring, innerPoint(one)));
    if (alone) return simplified(ring, 0.7);
    if (reach > widest) return null;
  }
}

/** Grow (or shrink) a mask by a square of half side `reach`. */
export function shifted(image, reach, grow) {
  const { width, height } = image;
  const pass = (source, stride, count, lines, step) => {
    const result = new Uint8Array(source.length);
    for (let line = 0; line < lines; line++) {
      const base = line * step;
      for (const way of [1, -1]) {
        // The last place that still sees a pixel of the kind that spreads.
        let until = -1;
        for (let k = 0; k < count; k++) {
          const i = base + (way > 0 ? k : count - 1 - k) * stride;
          if (Boolean(source[i]) === grow) until = k + reach;
          if (k <= until) result[i] = 1;
        }
      }
    }
    return grow ? result : result.map((one) => 1 - one);
  };
  const rows = pass(image.mask, 1, width, height, width);
  return { ...image, mask: pass(rows, width, height, width, 1) };
}

/** A point inside of a ring: in the middle of its widest stretch at the height of its centroid. */
export function innerPoint(ring) {
  const y = centroid(ring)[1] + 1e-6;
  const ends = crossings(ring, y);
  let best = 0;
  for (let k = 0; k + 1 < ends.length; k += 2) if (ends[k + 1] - ends[k] > ends[best + 1] - ends[best]) best = k;
  return ends.length ? [(ends[best] + ends[best + 1]) / 2, y] : ring[0];
}
