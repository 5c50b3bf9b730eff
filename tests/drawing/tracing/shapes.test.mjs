import assert from "node:assert/strict";
import test from "node:test";

import { area, centroid, contains, cut, filled, merged, outlineOf, sidesOf, simplified, snapped } from "../../../src/drystone/drawing/tracing/shapes.js";
import { proposed } from "../../../src/drystone/drawing/tracing/propose.js";
import * as sketch from "../../../src/drystone/drawing/tracing/sketch.js";

const square = (x, y, side = 10) => [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
const circle = (x, y, r, n = 80) => Array.from({ length: n }, (_, i) => [x + r * Math.cos((2 * Math.PI * i) / n), y + r * Math.sin((2 * Math.PI * i) / n)]);

function overlap(one, other) {
  const step = 0.5;
  const [a, b] = [filled([one], step), filled([other], step)];
  let [both, either] = [0, 0];
  const at = (image, u, v) => {
    const [x, y] = [u - image.left, v - image.top];
    return x >= 0 && y >= 0 && x < image.width && y < image.height ? image.mask[y * image.width + x] : 0;
  };
  const [left, top] = [Math.min(a.left, b.left), Math.min(a.top, b.top)];
  for (let v = top; v < Math.max(a.top + a.height, b.top + b.height); v++) {
    for (let u = left; u < Math.max(a.left + a.width, b.left + b.width); u++) {
      both += at(a, u, v) & at(b, u, v);
      either += at(a, u, v) | at(b, u, v);
    }
  }
  return both / either;
}

/** True when no edge of a ring crosses another one. */
function isSimple(ring) {
  const side = (a, b, p) => Math.sign((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]));
  const apart = (a, b, c, d) => side(a, b, c) * side(a, b, d) >= 0 || side(c, d, a) * side(c, d, b) >= 0;
  const next = (i) => ring[(i + 1) % ring.length];
  return ring.every((a, i) => ring.every((c, j) => apart(a, next(i), c, next(j))));
}

test("area, centroid and sides of a rectangle that is turned", () => {
  const turned = [[0, 0], [4, 3], [1, 7], [-3, 4]];
  assert.equal(area(turned), 25);
  assert.deepEqual(centroid(turned).map((v) => Math.round(1e9 * v) / 1e9), [0.5, 3.5]);
  const [long, short] = sidesOf([[0, 0], [8, 6], [5, 10], [-3, 4]]);
  assert.ok(Math.abs(long - 10) < 1e-9 && Math.abs(short - 5) < 1e-9);
});

test("a stroke across a stone makes two that fill it", () => {
  for (const stroke of [[[-5, 4], [15, 4]], [[5, -3], [6, 5], [4, 20]], [[-1, -1], [5, 6], [11, 11]]]) {
    const parts = cut(square(0, 0), stroke);
    assert.equal(parts.length, 2);
    assert.ok(Math.abs(parts.reduce((sum, part) => sum + area(part), 0) - 100) < 1e-9);
    for (const part of parts) assert.ok(isSimple(part));
  }
});

test("a stroke through both legs of a horseshoe makes three", () => {
  const shoe = [[0, 0], [30, 0], [30, 30], [20, 30], [20, 10], [10, 10], [10, 30], [0, 30]];
  const parts = cut(shoe, [[-5, 20], [40, 20]]);
  assert.deepEqual(parts.map((part) => Math.round(area(part))).sort((a, b) => a - b), [100, 100, 500]);
  // A stroke that ends inside, or passes by, cuts nothing.
  assert.equal(cut(square(0, 0), [[-5, 4], [5, 4]]).length, 1);
  assert.equal(cut(square(0, 0), [[-5, -4], [15, -4]]).length, 1);
});

test("the outline of filled pixels is the ring again", () => {
  for (const ring of [square(3, 4, 40), circle(50, 40, 30)]) {
    const again = simplified(outlineOf(filled([ring])), 0.7);
    assert.ok(overlap(ring, again) > 0.97, String(overlap(ring, again)));
    assert.ok(again.length < 40);
  }
});

test("merging closes a gap, and gives up where it is too wide", () => {
  const [one, other] = [square(0, 0, 40), square(43, 0, 40)];
  const both = merged([one, other], 20);
  assert.ok(Math.abs(area(both) - 83 * 40) < 0.03 * 83 * 40, String(area(both)));
  assert.ok(isSimple(both));
  assert.equal(merged([one, square(200, 0, 40)], 20), null);
});

test("snapping prefers corners to edges, and knows its reach", () => {
  const rings = [square(0, 0)];
  assert.deepEqual(snapped([9, 1], rings, 3), [10, 0]);
  assert.deepEqual(snapped([5, 1], rings, 3), [5, 0]);
  assert.equal(snapped([5, 5], rings, 3), null);
});

test("a stone on plain ground is proposed where it lies", () => {
  const [width, height] = [200, 160];
  const data = new Uint8ClampedArray(4 * width * height);
  const stone = circle(90, 80, 40);
  let chance = 7;
  for (let i = 0; i < width * height; i++) {
    chance = (chance * 16807) % 2147483647;
    const inside = contains(stone, [(i % width) + 0.5, Math.floor(i / width) + 0.5]);
    const grey = (inside ? 150 : 70) + (chance % 13) - 6;
    data.set([grey, grey - (inside ? 10 : 0), grey - (inside ? 30 : -40), 255], 4 * i);
  }
  const ring = proposed({ data, width, height }, [100, 70]);
  assert.ok(overlap(ring, stone) > 0.93, String(ring && overlap(ring, stone)));
  assert.equal(proposed({ data: new Uint8ClampedArray(4 * 50 * 50).fill(90), width: 50, height: 50 }, [25, 25]), null);
});

test("a brick between narrow joints is proposed alone", () => {
  const [width, height] = [300, 200];
  const data = new Uint8ClampedArray(4 * width * height);
  for (let i = 0; i < width * height; i++) {
    const [x, y] = [i % width, Math.floor(i / width)];
    const joint = y % 30 < 4 || (x + 60 * (Math.floor(y / 30) % 2)) % 120 < 4;
    const grey = (joint ? 160 : 95) + ((7 * x + 13 * y) % 9);
    data.set([grey, grey, grey, 255], 4 * i);
  }
  const ring = proposed({ data, width, height }, [190, 80]);
  const brick = [[124, 64], [240, 64], [240, 90], [124, 90]];
  assert.ok(overlap(ring, brick) > 0.85, String(ring && overlap(ring, brick)));
});

test("two hundred edits are undone to the first state, byte by byte", () => {
  const photo = { name: "a.jpg", width: 900, height: 700, kind: "stones", details: {} };
  let state = sketch.stateOf({});
  for (let i = 0; i < 5; i++) state = sketch.withStone(state, square(100 * i, 50, 60));
  const history = new sketch.History(state);
  const first = JSON.stringify(sketch.fileOf(history.now, photo));
  const edits = [
    (s, i) => sketch.withStone(s, square(7 * i, 300 + i, 12)),
    (s) => sketch.withCut(s, [[-5, 80], [900, 81]]),
    (s) => sketch.withMerged(s, s.stones.slice(0, 2).map((stone) => stone.id), 200),
    (s) => sketch.withUse(s, s.stones[0].id, !s.stones[0].use),
    (s, i) => sketch.withNumber(s, s.stones[0].id, 1000 + i),
    (s) => sketch.withCorner(s, s.stones[0].id, 0, [1, 2]),
    (s) => ({ ...s, scale: { ends: [[0, 0], [300, 400]], length_m: 0.5 + s.next } }),
    (s) => sketch.withoutStones(s, [s.stones[s.stones.length - 1].id]),
  ];
  for (let i = 0; history.at < 200; i++) history.add(edits[i % edits.length](history.now, i));
  const last = JSON.stringify(sketch.fileOf(history.now, photo));
  for (let i = 0; i < 200; i++) history.undo();
  assert.equal(JSON.stringify(sketch.fileOf(history.now, photo)), first);
  for (let i = 0; i < 200; i++) history.redo();
  assert.equal(JSON.stringify(sketch.fileOf(history.now, photo)), last);
});

test("what is saved is read again as it was", () => {
  const photo = { name: "a.jpg", width: 90, height: 70, kind: "wall", details: { from_photo: null } };
  let state = sketch.withStone(sketch.withStone(sketch.stateOf({}), square(0, 0)), square(20, 0));
  state = { ...sketch.withUse(state, 2, false), scale: { ends: [[0, 0], [30, 40]], length_m: 0.25 }, ground: [[0, 9], [80, 10]] };
  const file = sketch.fileOf(state, photo);
  assert.equal(file.drystone.px_per_m, 200);
  assert.deepEqual(file.drystone.not_used, [2]);
  assert.deepEqual(sketch.stateOf(JSON.parse(JSON.stringify(file))), state);
  assert.equal(sketch.saidOf(file, state, "a.json"), "2 outlines were read from a.json.");
  const others = [{ shape_type: "circle", points: square(0, 0) }, { points: [[0, 0], [1, 1]] }];
  const more = { ...file, shapes: [...file.shapes, ...others] };
  assert.match(sketch.saidOf(more, sketch.stateOf(more), "a"), /^2 outlines .* 2 shapes were left out/);
  // Two stones never share a number.
  assert.deepEqual(sketch.withNumber(state, 1, 2).stones.map((stone) => stone.id), [2, 1]);
});
