// The outline of the stone around a point, guessed from the colours of the photograph.
// Rays leave the point in all directions.  On each, a place costs little where colours change across
// it, and much behind changes that the ray has crossed already.  The cheapest closed line that no
// two neighbouring rays leave far apart is found by dynamic programming.

import { area, centroid, simplified } from "./shapes.js";

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

/**
 * Guess the stone at a pixel.
 *
 * @param {ImageData} image RGBA, row 0 at the top.
 * @param {number[]} seed [x, y] in px of the image.
 * @returns {number[][]|null} a ring in px of the image, or null when nothing stands out.
 */
export function proposed({ data, width, height }, seed) {
  if (!(seed[0] >= 0 && seed[1] >= 0 && seed[0] < width && seed[1] < height)) return null;
  const colours = smoothed(data, width, height);
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

/** Lightness and two opponents of colour, averaged over 5 x 5 px. */
function smoothed(data, width, height) {
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
      for (let d = -2; d <= 2; d++) {
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
