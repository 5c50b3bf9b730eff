// What a person draws over a photograph, and every state that it was in.  No page is needed here.
// States are never changed: an edit makes a new one that shares what stays.

import { area, contains, cut, merged } from "./shapes.js";

export const SCHEMA = "drystone-outlines/1";

/**
 * A state: {stones, scale, ground, next}.
 *
 * A stone is {id, ring, use, proposed}: its number, its corners in px of the photograph (x right,
 * y down), whether it may be built with, and whether it still is a proposal that nobody accepted.
 * scale is {px_per_m} or {ends, length_m}, or null; ground is two points, or null; next is the
 * number of the next stone.
 */
export function stateOf(file) {
  const own = file.drystone ?? {};
  const resting = new Set(own.not_used ?? []);
  const open = new Set(own.proposed ?? []);
  const taken = new Set();
  const stones = [];
  for (const shape of file.shapes ?? []) {
    if ((shape.shape_type ?? "polygon") !== "polygon" || shape.points.length < 3) continue;
    const number = Number(/^(?:stone\s*)?(\d+)$/i.exec(shape.label ?? "")?.[1] ?? 0);
    const id = number && !taken.has(number) ? number : 0;
    if (id) taken.add(id);
    stones.push({ id, ring: shape.points.map(([x, y]) => [x, y]), use: !resting.has(id), proposed: open.has(id) });
  }
  let next = Math.max(0, ...taken) + 1;
  for (const stone of stones) if (!stone.id) stone.id = next++;
  const scale = own.scale_line
    ? { ends: own.scale_line.ends, length_m: own.scale_line.length_m }
    : own.px_per_m ? { px_per_m: own.px_per_m } : null;
  return { stones, scale, ground: own.ground ?? null, next };
}

/** What is said of a file that became a state. */
export function saidOf(file, state, name) {
  const left = (file.shapes ?? []).length - state.stones.length;
  const more = left ? `, and ${left} shapes were left out that are no polygons` : "";
  return `${state.stones.length} outlines were read from ${name}${more}.`;
}

/** The file that is saved: labelme's, with more beside its own keys. */
export function fileOf(state, photo) {
  const ordered = [...state.stones].sort((a, b) => a.id - b.id);
  const numbers = (chosen) => ordered.filter(chosen).map((stone) => stone.id);
  const own = {
    schema: SCHEMA,
    kind: photo.kind,
    px_per_m: pxPerMetre(state),
    scale_line: state.scale?.ends ? state.scale : null,
    ground: state.ground,
    not_used: numbers((stone) => !stone.use),
    proposed: numbers((stone) => stone.proposed),
    ...photo.details,
  };
  const shapes = ordered.map((stone) => ({
    label: String(stone.id), points: stone.ring, group_id: null, description: "", shape_type: "polygon", flags: {}, mask: null,
  }));
  return {
    version: "5.5.0", flags: {}, shapes, imagePath: photo.name, imageData: null,
    imageHeight: photo.height, imageWidth: photo.width, drystone: own,
  };
}

/** px of the photograph in a metre, or null. */
export function pxPerMetre({ scale }) {
  if (!scale) return null;
  if (scale.px_per_m) return scale.px_per_m;
  const [[ax, ay], [bx, by]] = scale.ends;
  return Math.hypot(bx - ax, by - ay) / scale.length_m;
}

// --- edits: (state, ...) -> state; the same state when there is nothing to do --------------------

export function withStone(state, ring, { proposed = false } = {}) {
  if (ring.length < 3 || area(ring) < 1) return state;
  const stone = { id: state.next, ring, use: true, proposed };
  return { ...state, stones: [...state.stones, stone], next: state.next + 1 };
}

export function withoutStones(state, ids) {
  const stones = state.stones.filter((stone) => !ids.includes(stone.id));
  return stones.length === state.stones.length ? state : { ...state, stones };
}

export function withRing(state, id, ring) {
  return ring.length < 3 ? state : changed(state, id, { ring, proposed: false });
}

export function withNumber(state, id, number) {
  if (!Number.isInteger(number) || number < 1 || number === id) return state;
  // Two stones never share a number: the other one takes the old number.
  const stones = state.stones.map((stone) => {
    if (stone.id === id) return { ...stone, id: number };
    return stone.id === number ? { ...stone, id } : stone;
  });
  return { ...state, stones, next: Math.max(state.next, number + 1) };
}

export function withUse(state, id, use) {
  return changed(state, id, { use });
}

export function accepted(state, ids) {
  const stones = state.stones.map((stone) => (ids.includes(stone.id) && stone.proposed ? { ...stone, proposed: false } : stone));
  return stones.every((stone, i) => stone === state.stones[i]) ? state : { ...state, stones };
}

/** Make one stone of several; the first keeps its number.  The same state when they lie apart. */
export function withMerged(state, ids, widest) {
  const some = ids.map((id) => stoneOf(state, id)).filter(Boolean);
  if (some.length < 2) return state;
  const ring = merged(some.map((stone) => stone.ring), widest);
  if (!ring) return state;
  return withRing(withoutStones(state, ids.slice(1)), ids[0], ring);
}

/** Cut stones along a stroke; the largest part keeps the number. */
export function withCut(state, stroke, ids = state.stones.map((stone) => stone.id)) {
  let next = state.next;
  const stones = state.stones.flatMap((stone) => {
    const parts = ids.includes(stone.id) ? cut(stone.ring, stroke) : [stone.ring];
    if (parts.length < 2) return [stone];
    parts.sort((a, b) => area(b) - area(a));
    return parts.map((ring, i) => ({ ...stone, id: i ? next++ : stone.id, ring, proposed: false }));
  });
  return next === state.next ? state : { ...state, stones, next };
}

export function withCorner(state, id, corner, point) {
  const ring = stoneOf(state, id).ring.map((old, i) => (i === corner ? point : old));
  return withRing(state, id, ring);
}

export function withNewCorner(state, id, after, point) {
  return withRing(state, id, stoneOf(state, id).ring.toSpliced(after + 1, 0, point));
}

export function withoutCorner(state, id, corner) {
  return withRing(state, id, stoneOf(state, id).ring.toSpliced(corner, 1));
}

function changed(state, id, what) {
  const stones = state.stones.map((stone) => (stone.id === id ? { ...stone, ...what } : stone));
  return { ...state, stones };
}

// --- questions -----------------------------------------------------------------------------------

export function stoneOf(state, id) {
  return state.stones.find((stone) => stone.id === id) ?? null;
}

/** The smallest stone at a point, or null. */
export function stoneAt(state, point) {
  const there = state.stones.filter((stone) => contains(stone.ring, point));
  return there.sort((a, b) => area(a.ring) - area(b.ring))[0] ?? null;
}

/** Which of the doubts still speak of stones that are there, and unchanged since the beginning. */
export function openDoubts(state, first, doubts, seen) {
  return doubts.filter((doubt, i) => {
    if (seen.has(i)) return false;
    return doubt.stones.every((id) => stoneOf(state, id)?.ring === stoneOf(first, id)?.ring && stoneOf(state, id));
  });
}

// --- undo ----------------------------------------------------------------------------------------

/** All states so far; undo has no end. */
export class History {
  constructor(state) {
    this.states = [state];
    this.at = 0;
  }

  get now() {
    return this.states[this.at];
  }

  /** Go on to another state; returns whether it is another one. */
  add(state) {
    if (state === this.now) return false;
    this.states.length = this.at + 1;
    this.states.push(state);
    this.at += 1;
    return true;
  }

  undo() {
    if (this.at > 0) this.at -= 1;
  }

  redo() {
    if (this.at + 1 < this.states.length) this.at += 1;
  }
}
