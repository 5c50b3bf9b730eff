// The outline of the stone around a point, guessed from the colours of the photograph.
// A stone of one colour is what is like the point, for as many limits of likeness as possible.
// Of all others, rays leave the point in all directions.  On each, a place costs little where colours change across
// it, and much behind changes that the ray has crossed already.  The cheapest closed line that no
// two neighbouring rays leave far apart is found by dynamic programming.

import { area, centroid, flood, hullOf, outlineOf, shifted, simplified } from "./shapes.js";

const RAYS = 96;
const STEPS = 96;
const LARGEST_TURN = 3;
// What was tried on 60 stones of a photographed beach: crossing changes of colour costs little,
// bends cost more, and farther out is a little cheaper.
const CROSSING = 0.03;
const UNMARKED = 3;
const BEND = 3;
const FARTHER = 0.1;
const LEAST_CONTRAST = 6;
// Limits of likeness are half units of colour.  What was tried on the same beach, on gravel, on a
// brick wall and on a drawn one: nothing is lost where stones have patterns, from this width on.
const LIMITS = 160;
const WIDEST_FROM = 32;
const STABLE = 1.15;
const LEAST_PX = 120;
const RIM = 0.05;
const LEAST_SOLID = 0.8;

/**
 * Guess the stone at a pixel.
 *
 * @param {ImageData} image RGBA, row 0 at the top.
 * @param {number[]} seed [x, y] in px of the image.
 * @returns {number[][]|null} a ring in px of the image, or null when nothing stands out.
 */
export function proposed({ data, width, height }, seed) {
  if (!(seed[0] >= 0 && seed[1] >= 0 && seed[0] < width && seed[1] < height)) return null;
  const plain = alike(smoothed(data, width, height, 1), width, height, seed.map(Math.floor));
  if (plain) return plain;
  const colours = smoothed(data, width, height, 2);
  let middle = seed;
  let found = null;
  for (let round = 0; round < 3; round++) {
    const reach = found ? Math.min(1.9 * Math.sqrt(area(found.ring)), 0.75 * Math.max(width, height)) : 0.62 * Math.max(width, height);
    const next = around(colours, width, height, middle, reach);
    if (!next) break;
    found = next;
    middle = centroid(found.ring);
  }
  return found && found.contrast > LEAST_CONTRAST ? simplified(found.ring, 0.8) : null;
}

/** The ring of what has the colour of a pixel, if its size hardly hangs on what that means. */
function alike(colours, width, height, [column, row]) {
  const own = [0, 0, 0];
  let count = 0;
  for (let y = Math.max(0, row - 4); y <= Math.min(height - 1, row + 4); y++) {
    for (let x = Math.max(0, column - 4); x <= Math.min(width - 1, column + 4); x++, count++) {
      for (let c = 0; c < 3; c++) own[c] += colours[3 * (y * width + x) + c];
    }
  }
  const unlike = (i) => Math.min(LIMITS - 1, Math.round(2 * Math.hypot(...own.map((sum, c) => colours[3 * i + c] - sum / count))));
  const onRim = (i) => i % width === 0 || i % width === width - 1 || i < width || i >= width * (height - 1);
  // Each pixel gets the least limit with which a way leads to it.
  const limits = new Uint8Array(width * height).fill(255);
  const open = Array.from({ length: LIMITS }, () => []);
  const start = row * width + column;
  limits[start] = unlike(start);
  open[limits[start]].push(start);
  const areas = [];
  for (let [limit, size, rim] = [0, 0, 0]; limit < LIMITS && rim <= RIM * width; limit++) {
    while (open[limit].length) {
      const i = open[limit].pop();
      size += 1;
      if (onRim(i)) {
        rim += 1;
        continue;
      }
      for (const j of [i - 1, i + 1, i - width, i + width]) {
        if (limits[j] !== 255) continue;
        limits[j] = Math.max(limit, unlike(j));
        open[limits[j]].push(j);
      }
    }
    areas.push(rim <= RIM * width ? size : Infinity);
  }
  let best = [0, 0];
  for (let from = 0, to = 0; areas[from] < Infinity; from++) {
    if (areas[from] < LEAST_PX) continue;
    for (to = Math.max(to, from); areas[to + 1] <= STABLE * areas[from];) to += 1;
    if (to - from > best[1] - best[0]) best = [from, to];
  }
  if (best[1] - best[0] < WIDEST_FROM) return null;
  const limit = (best[0] + best[1]) / 2;
  const rest = limits.map((one, i) => (onRim(i) || one > limit ? 1 : 0));
  // What the ground does not reach is stone, too; then narrow bridges go.
  const ground = new Uint8Array(rest.length);
  flood(rest, width, height, 0, ground);
  const image = { mask: ground.map((one) => 1 - one), width, height, left: 0, top: 0, step: 1 };
  const ring = outlineOf(shifted(shifted(image, 2, false), 2, true));
  return ring && area(ring) > LEAST_SOLID * area(hullOf(ring)) ? simplified(ring, 0.8) : null;
}

function around(colours, width, height, [cx, cy], reach) {
  const edge = new Float32Array(RAYS * STEPS);
  const cost = new Float32Array(RAYS * STEPS);
  const size = reach / STEPS;
  const at = (x, y, c) => colours[3 * (Math.max(0, Math.min(height - 1, Math.round(y))) * width + Math.max(0, Math.min(width - 1, Math.round(x)))) + c];
  for (let ray = 0; ray < RAYS; ray++) {
    const [ux, uy] = [Math.cos((2 * Math.PI * ray) / RAYS), Math.sin((2 * Math.PI * ray) / RAYS)];
    let crossed = 0;
    for (let k = 0; k < STEPS; k++) {
      const r = (k + 2) * size;
      let total = 0;
      for (let c = 0; c < 3; c++) {
        const [inner, outer] = [at(cx + (r - 1.5) * ux, cy + (r - 1.5) * uy, c), at(cx + (r + 1.5) * ux, cy + (r + 1.5) * uy, c)];
        total += (outer - inner) ** 2;
      }
      const [x, y] = [cx + r * ux, cy + r * uy];
      const step = x < 1 || y < 1 || x > width - 2 || y > height - 2 ? 0 : Math.sqrt(total);
      edge[ray * STEPS + k] = step;
      cost[ray * STEPS + k] = -step + CROSSING * crossed - FARTHER * k;
      crossed += Math.max(0, step - UNMARKED) * Math.min(1, size / 2);
    }
  }
  // Around twice: the second time begins where the first has ended.
  const from = new Int16Array(2 * RAYS * STEPS);
  let sums = new Float32Array(STEPS);
  for (let turn = 0; turn < 2 * RAYS; turn++) {
    const now = new Float32Array(STEPS);
    for (let k = 0; k < STEPS; k++) {
      let [best, back] = [Infinity, k];
      for (let j = Math.max(0, k - LARGEST_TURN); j <= Math.min(STEPS - 1, k + LARGEST_TURN); j++) {
        const value = sums[j] + BEND * (j - k) ** 2;
        if (value < best) [best, back] = [value, j];
      }
      now[k] = best + cost[(turn % RAYS) * STEPS + k];
      from[turn * STEPS + k] = back;
    }
    sums = now;
  }
  let k = sums.indexOf(Math.min(...sums));
  const radii = new Float32Array(RAYS);
  let contrast = 0;
  for (let turn = 2 * RAYS - 1; turn >= RAYS; turn--) {
    radii[turn - RAYS] = k;
    contrast += edge[(turn - RAYS) * STEPS + k] / RAYS;
    k = from[turn * STEPS + k];
  }
  const ring = Array.from(radii, (step, ray) => {
    const [r, angle] = [(step + 2) * size, (2 * Math.PI * ray) / RAYS];
    return [Math.max(0, Math.min(width, cx + r * Math.cos(angle))) + 0.5, Math.max(0, Math.min(height, cy + r * Math.sin(angle))) + 0.5];
  });
  return { ring, contrast };
}

/** Lightness and two opponents of colour, averaged over squares of half side `reach`. */
function smoothed(data, width, height, reach) {
  let planes = new Float32Array(3 * width * height);
  for (let i = 0, j = 0; j < planes.length; i += 4, j += 3) {
    const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
    planes[j] = 0.6 * (0.299 * r + 0.587 * g + 0.114 * b);
    planes[j + 1] = r - g;
    planes[j + 2] = 0.5 * (r + g) - b;
  }
  for (const [stride, count] of [[3, width], [3 * width, height]]) {
    const out = new Float32Array(planes.length);
    for (let i = 0; i < planes.length; i++) {
      const place = Math.floor(i / stride) % count;
      let [total, n] = [0, 0];
      for (let d = -reach; d <= reach; d++) {
        if (place + d < 0 || place + d >= count) continue;
        total += planes[i + d * stride];
        n += 1;
      }
      out[i] = total / n;
    }
    planes = out;
  }
  return planes;
}
