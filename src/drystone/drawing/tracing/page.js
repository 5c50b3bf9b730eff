// The page: a photograph, the outlines over it, and what a hand, a pen or keys do to them.

import { boxOf, make } from "../report/viewer/dom.js";
import { area, centroid, distance, sidesOf, simplified, simplifiedLine, snapped } from "./shapes.js";
import { proposed } from "./propose.js";
import {
  History, SCHEMA, accepted, fileOf, openDoubts, pxPerMetre, saidOf, stateOf, stoneAt, stoneOf,
  withCorner, withCut, withMerged, withNewCorner, withNumber, withRing, withStone, withUse, withoutCorner,
  withoutStones,
} from "./sketch.js";

const REACH_PX = 10;
const TOUCH_REACH_PX = 22;
const SNAP = 0.6;
const DRAG_PX = 6;
const TREMBLE_PX = 1.2;
const WIDEST_GAP = 0.25;
const PROPOSAL_PX = 420;
const TOOLS = {
  select: { key: "v", name: "Select", help: "Tap a stone. Drag its corners; drag a small dot to add one." },
  draw: { key: "d", name: "Draw", help: "Tap corner by corner, and the first one again; or drag around the stone." },
  redraw: { key: "r", name: "Redraw", help: "Choose a stone first, then draw it anew: it keeps its number." },
  cut: { key: "c", name: "Cut", help: "Drag a stroke across a stone; or tap along it, and tap the last point again." },
  propose: { key: "p", name: "Propose", help: "Tap inside a stone: its outline is guessed, dashed until you accept it." },
  scale: { key: "s", name: "Scale", help: "Tap both ends of something you know the length of." },
  ground: { key: "g", name: "Ground", help: "Tap two points of the ground that the wall stands on." },
};
const UNITS = { cm: 0.01, mm: 0.001, m: 1, in: 0.0254, ft: 0.3048 };

/**
 * Show the page inside of an element.
 *
 * @param {Element} element where to put it.
 * @param {object} data {title, photo: {name, width, height, kind, details, key, shown}, file, doubts}:
 *   shown is the picture itself as a data URL, perhaps reduced; file is what stateOf reads.
 */
export function mount(element, data) {
  return new Page(element, data);
}

/** Put other nodes into a box; the button of the same name keeps the focus. */
function refill(box, nodes) {
  const name = box.contains(document.activeElement) ? document.activeElement.textContent : null;
  box.replaceChildren(...nodes);
  if (name !== null) [...box.querySelectorAll("button")].find((one) => one.textContent === name)?.focus();
}

class Page {
  constructor(element, data) {
    this.data = data;
    this.first = stateOf(data.file);
    this.history = new History(this.first);
    this.seen = new Set();
    this.tool = this.first.stones.length ? "select" : "draw";
    this.chosen = [];
    this.corner = null;
    this.line = [];
    this.drag = null;
    this.fingers = new Map();
    this.cursor = null;
    this.doubt = -1;
    this.waiting = false;
    this.build(element);
    this.restore();
    this.fit();
    this.refresh();
    window.addEventListener("beforeunload", (event) => {
      if (!this.kept) event.preventDefault();
    });
  }

  get drawing() {
    return this.tool === "draw" || this.tool === "redraw";
  }

  get state() {
    return this.history.now;
  }

  // --- building ----------------------------------------------------------------------------------

  build(element) {
    const { data } = this;
    const button = (name, key, does, more = {}) =>
      make("button", { type: "button", title: key ? `${name} (${key})` : name, click: does, ...more }, name);
    this.count = make("p", { class: "count", "aria-live": "polite" });
    this.buttons = Object.fromEntries(
      Object.entries(TOOLS)
        .filter(([name]) => name !== "ground" || data.photo.kind === "wall")
        .map(([name, { name: said, key }]) => [name, button(said, key.toUpperCase(), () => this.take(name), { "aria-pressed": "false" })]),
    );
    this.acceptButton = button("Accept all", "A", () => this.accept(this.state.stones.map((stone) => stone.id)));
    this.undoButton = button("Undo", "Ctrl+Z", () => this.undo());
    this.redoButton = button("Redo", "Ctrl+Y", () => this.redo());
    const open = make("input", { type: "file", accept: ".json,application/json", hidden: true, change: () => this.open(open.files[0]) });
    this.canvas = make("canvas", {
      tabindex: 0, role: "application", "aria-label": `${data.title}: photograph with outlines. Arrow keys move the cross, Enter taps.`,
    });
    this.said = make("p", { class: "said", role: "status" });
    this.card = make("section", { class: "card", "aria-label": "Chosen stones" });
    this.doubtBox = make("section", { class: "doubts", "aria-label": "Doubts" });
    this.list = make("ul", { class: "stones" });
    this.all = make("details", { toggle: () => this.fillList() }, make("summary", {}, "All stones"), this.list);
    this.still = make("canvas");
    const actions = [
      button("Merge", "M", () => this.merge()), button("Delete", "Del", () => this.remove()),
      this.acceptButton, this.undoButton, this.redoButton,
      button("Whole", "0", () => { this.fit(); this.draw(); }), button("+", "+", () => this.zoom(1.4)), button("−", "-", () => this.zoom(1 / 1.4)),
    ];
    this.several = make("input", { type: "checkbox" });
    element.append(
      make("header", {},
        make("div", {}, make("h1", {}, data.title), this.count),
        make("div", { class: "files" }, button("Open", "", () => open.click()), open,
          button("Save", "Ctrl+S", () => this.save(), { class: "main" }),
          button("Light / dark", "", () => this.turnTheme()))),
      make("nav", { "aria-label": "Tools" },
        make("div", { role: "group", "aria-label": "Tools" }, Object.values(this.buttons)),
        make("div", { role: "group", "aria-label": "Actions" }, actions),
        make("label", {}, this.several, " choose several")),
      make("main", {},
        make("div", { class: "stage" }, this.canvas, this.said),
        make("aside", {}, this.card, this.doubtBox,
          this.all,
          make("details", {}, make("summary", {}, "Keys"), this.keys()))),
    );
    this.image = new Image();
    this.image.addEventListener("load", () => this.reduce());
    this.image.src = data.photo.shown;
    for (const name of ["pointerdown", "pointermove", "pointerup", "pointercancel"]) {
      this.canvas.addEventListener(name, (event) => this.pointer(event));
    }
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 400), this.placeOf(event));
    }, { passive: false });
    this.canvas.addEventListener("blur", () => { this.cursor = null; this.draw(); });
    document.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.resize()).observe(this.canvas);
  }

  keys() {
    const rows = [
      ...Object.values(TOOLS).map((tool) => [tool.key.toUpperCase(), `${tool.name}. ${tool.help}`]),
      ["Arrows, Enter", "Move the cross over the photograph (Shift: finely), and tap there. Enter twice ends a line."],
      ["Esc", "Let go of a line, or of what is chosen."],
      ["N, B, F", "Next and previous doubt; it is fine as it is."],
      ["[ and ]", "Previous and next stone."],
      ["M, Del, A, U", "Merge, delete, accept (all when none is chosen), build with it or not."],
      ["Ctrl+Z, Ctrl+Y, Ctrl+S", "Undo, redo, save."],
      ["+, -, 0", "Zoom; whole photograph."],
    ];
    return make("dl", {}, rows.flatMap(([key, said]) => [make("dt", {}, key), make("dd", {}, said)]));
  }

  // --- keeping -----------------------------------------------------------------------------------

  get place() {
    return `${SCHEMA}:${this.data.photo.kind}:${this.data.photo.key}`;
  }

  keep() {
    try {
      const kept = { file: fileOf(this.state, this.data.photo), seen: [...this.seen] };
      window.localStorage.setItem(this.place, JSON.stringify(kept));
      this.kept = true;
    } catch {
      // A browser may refuse storage, or have none left: then closing asks.
      this.kept = false;
      this.tell("This browser keeps nothing for pages like this one: save before you close it.");
    }
  }

  restore() {
    this.kept = true;
    let kept = null;
    try {
      kept = JSON.parse(window.localStorage.getItem(this.place) ?? "null");
    } catch {
      this.kept = false;
    }
    if (!kept) return;
    this.history.add(stateOf(kept.file));
    this.seen = new Set(kept.seen);
    this.tell("This goes on where it was left. Undo leads back to the beginning.");
  }

  save() {
    const open = this.state.stones.filter((stone) => stone.proposed).length;
    const text = JSON.stringify(fileOf(this.state, this.data.photo));
    const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: "application/json" })), download: "outlines.json" });
    link.click();
    window.setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    this.keep();
    this.tell(open ? `Saved as outlines.json. ${open} proposals are not accepted, and are not stones.` : "Saved as outlines.json.");
  }

  async open(file) {
    if (!file) return;
    try {
      const content = JSON.parse(await file.text());
      const { width, height } = this.data.photo;
      if ((content.imageWidth ?? width) !== width || (content.imageHeight ?? height) !== height) throw new Error("it is of another picture");
      const state = stateOf(content);
      this.go(state, saidOf(content, state, file.name));
    } catch (error) {
      this.tell(`${file.name} cannot be read: ${error.message}`);
    }
  }

  // --- going on ----------------------------------------------------------------------------------

  /** Go on to another state, and say what was done. */
  go(state, said) {
    if (!this.history.add(state)) return false;
    this.after(said);
    return true;
  }

  after(said) {
    this.chosen = this.chosen.filter((id) => stoneOf(this.state, id));
    this.corner = null;
    this.keep();
    if (said) this.tell(said);
    this.refresh();
  }

  undo() {
    this.history.undo();
    this.after("Undone.");
  }

  redo() {
    this.history.redo();
    this.after("Done again.");
  }

  merge() {
    const rings = this.chosen.map((id) => stoneOf(this.state, id).ring);
    if (rings.length < 2) return this.tell("Choose two stones or more: tap them with Shift, or with “choose several”.");
    const widest = WIDEST_GAP * Math.sqrt(Math.max(...rings.map(area)));
    const id = this.chosen[0];
    if (this.go(withMerged(this.state, this.chosen, widest), `Merged into stone ${id}.`)) this.choose([id]);
    else this.tell("These stones lie too far apart to be one.");
  }

  remove() {
    if (this.corner !== null && this.chosen.length === 1) {
      return this.go(withoutCorner(this.state, this.chosen[0], this.corner), "The corner is gone.");
    }
    if (!this.chosen.length) return this.tell("Choose a stone first.");
    const said = `Deleted: ${this.chosen.join(", ")}.`;
    return this.go(withoutStones(this.state, this.chosen), said);
  }

  accept(ids) {
    this.go(accepted(this.state, ids), "Accepted.");
  }

  propose(point) {
    const { photo } = this.data;
    // The neighbourhood of the point, reduced: as large as what is seen, and never the whole of a large photograph.
    const shown = this.canvas.clientWidth / this.k;
    const side = Math.min(Math.max(photo.width, photo.height), Math.max(60, 0.7 * shown));
    const [left, top] = [0, 1].map((axis) => Math.max(0, Math.min(point[axis] - side / 2, [photo.width, photo.height][axis] - side)));
    const [wide, high] = [Math.min(side, photo.width - left), Math.min(side, photo.height - top)];
    const step = Math.max(wide, high) / PROPOSAL_PX;
    const part = make("canvas", { width: Math.round(wide / step), height: Math.round(high / step) });
    const factor = this.image.naturalWidth / photo.width;
    const context = part.getContext("2d", { willReadFrequently: true });
    context.drawImage(this.image, left * factor, top * factor, wide * factor, high * factor, 0, 0, part.width, part.height);
    const ring = proposed(context.getImageData(0, 0, part.width, part.height), [(point[0] - left) / step, (point[1] - top) / step]);
    if (!ring) return this.tell("Nothing stands out there. Draw the stone, or zoom to it and tap again.");
    const id = this.state.next;
    const found = ring.map(([x, y]) => [left + x * step, top + y * step].map(rounded));
    if (this.go(withStone(this.state, found, { proposed: true }), `Stone ${id} is proposed: accept it with A, or undo.`)) this.choose([id]);
  }

  finish(line, freehand) {
    const tool = this.tool;
    this.line = [];
    const within = TREMBLE_PX / this.k;
    if (this.drawing) {
      const ring = (freehand ? simplified(line, within) : line).map((p) => p.map(rounded));
      if (tool === "redraw") {
        const [one, ...more] = this.chosen;
        if (one === undefined || more.length) return this.tell(TOOLS.redraw.help);
        return this.go(withRing(this.state, one, ring), `Stone ${one} is drawn anew.`);
      }
      const id = this.state.next;
      if (this.go(withStone(this.state, ring), `Stone ${id} is drawn.`)) this.choose([id]);
    } else if (tool === "cut") {
      const stroke = freehand ? simplifiedLine(line, within) : line;
      const ids = this.chosen.length ? this.chosen : undefined;
      if (!this.go(withCut(this.state, stroke, ids), "Cut.")) this.tell("The stroke does not cross a stone from one side to the other.");
    } else if (tool === "scale") {
      this.askLength(line);
    } else if (tool === "ground") {
      const ground = line.map((p) => p.map(rounded)).sort((a, b) => a[0] - b[0]);
      if (ground[1][0] - ground[0][0] > 1) this.go({ ...this.state, ground }, "The ground is drawn.");
      else this.tell("The ground goes from left to right.");
    }
    this.draw();
  }

  askLength(ends) {
    const length = make("input", { type: "number", min: "0", step: "any", required: true, "aria-label": "length" });
    const unit = make("select", { "aria-label": "unit" }, Object.keys(UNITS).map((name) => make("option", {}, name)));
    const form = make("form", {
      submit: (event) => {
        event.preventDefault();
        const length_m = Number(length.value) * UNITS[unit.value];
        if (!(length_m > 0)) return;
        this.go({ ...this.state, scale: { ends, length_m } }, "The scale is known.");
        this.canvas.focus();
      },
    }, make("label", {}, "This line is ", length), unit, make("button", { class: "main" }, "long"));
    this.card.replaceChildren(form);
    length.focus();
  }

  // --- choosing ----------------------------------------------------------------------------------

  choose(ids) {
    this.chosen = ids;
    this.corner = null;
    this.refresh();
  }

  step(by) {
    const ids = this.state.stones.map((stone) => stone.id).sort((a, b) => a - b);
    if (!ids.length) return;
    const at = ids.indexOf(this.chosen[0]);
    const id = ids[(at + by + ids.length) % ids.length];
    this.choose([id]);
    this.look(boxOf(stoneOf(this.state, id).ring));
    this.tell(this.sayStone(stoneOf(this.state, id)));
  }

  get doubts() {
    return openDoubts(this.state, this.first, this.data.doubts, this.seen);
  }

  /** The doubt that was looked at last, while it is open. */
  get lookedAt() {
    return this.doubts.find((doubt) => doubt === this.data.doubts[this.doubt]);
  }

  nextDoubt(by) {
    const [all, open] = [this.data.doubts, this.doubts];
    if (!open.length) return this.tell("No doubt is left.");
    let at = Math.max(this.doubt, by > 0 ? -1 : 0);
    do at = (at + by + all.length) % all.length;
    while (!open.includes(all[at]));
    this.doubt = at;
    const doubt = all[at];
    const rings = doubt.stones.map((id) => stoneOf(this.state, id).ring).flat();
    const reach = 0.03 * Math.max(this.data.photo.width, this.data.photo.height);
    const [x, y] = doubt.at;
    this.choose(doubt.stones);
    this.look(boxOf([...rings, [x - reach, y - reach], [x + reach, y + reach]]));
    return this.tell(doubt.text);
  }

  settle(doubt) {
    this.seen.add(this.data.doubts.indexOf(doubt));
    this.after("It is fine as it is.");
    this.nextDoubt(1);
  }

  // --- pointers ----------------------------------------------------------------------------------

  placeOf(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  toPhoto([u, v]) {
    return [(u - this.left) / this.k, (v - this.top) / this.k];
  }

  toScreen([x, y]) {
    return [x * this.k + this.left, y * this.k + this.top];
  }

  pointer(event) {
    const at = this.placeOf(event);
    const reach = event.pointerType === "touch" ? TOUCH_REACH_PX : REACH_PX;
    if (event.type === "pointerdown") {
      this.canvas.focus({ preventScroll: true });
      this.canvas.setPointerCapture(event.pointerId);
      this.fingers.set(event.pointerId, at);
      if (this.fingers.size === 2) {
        this.drag = null;
        this.line = this.drawing || this.tool === "cut" ? [] : this.line;
      } else if (this.fingers.size === 1) {
        this.begin(at, reach, event);
      }
    } else if (event.type === "pointermove") {
      const before = this.fingers.get(event.pointerId);
      this.cursor = null;
      if (this.fingers.size === 2 && before) this.pinch(event.pointerId, at);
      else if (this.drag) {
        const moves = event.getCoalescedEvents?.() ?? [];
        for (const one of moves.length ? moves : [event]) this.dragTo(this.placeOf(one), reach);
      } else this.hover(at);
      if (before) this.fingers.set(event.pointerId, at);
    } else {
      this.fingers.delete(event.pointerId);
      if (event.type === "pointerup" && this.drag) this.end(at, reach, event);
      this.drag = null;
    }
    const lineOnly = this.drag ? this.drag.kind === "stroke" || !this.drag.moved : this.fingers.size === 0;
    this.draw(!(lineOnly && /down|move/.test(event.type)));
  }

  begin(at, reach, event) {
    const drag = { from: at, moved: false, kind: "tap" };
    const one = this.chosen.length === 1 ? stoneOf(this.state, this.chosen[0]) : null;
    if (event.button === 1 || event.altKey) drag.kind = "pan";
    else if (this.tool === "select" && one) {
      const corner = one.ring.findIndex((p) => distance(this.toScreen(p), at) < reach);
      const middle = corner < 0 ? middles(one.ring).findIndex((p) => distance(this.toScreen(p), at) < 0.8 * reach) : -1;
      if (corner >= 0) Object.assign(drag, { kind: "corner", corner, base: this.state });
      else if (middle >= 0) {
        const base = withNewCorner(this.state, one.id, middle, middles(one.ring)[middle]);
        Object.assign(drag, { kind: "corner", corner: middle + 1, base, fresh: true });
      }
    }
    this.drag = drag;
  }

  dragTo(at, reach) {
    const { drag } = this;
    if (!drag.moved && distance(at, drag.from) < DRAG_PX) return;
    if (!drag.moved) {
      drag.moved = true;
      if (drag.kind === "tap" && (this.drawing || this.tool === "cut") && !this.line.length) {
        drag.kind = "stroke";
        this.line = [this.toPhoto(drag.from)];
      } else if (drag.kind === "tap") drag.kind = "pan";
    }
    if (drag.kind === "stroke") this.line.push(this.toPhoto(at));
    else if (drag.kind === "corner") {
      const [id] = this.chosen;
      const others = this.state.stones.filter((stone) => stone.id !== id).map((stone) => stone.ring);
      const point = this.toPhoto(at);
      const to = (snapped(point, others, (SNAP * reach) / this.k) ?? point).map(rounded);
      drag.next = withCorner(drag.base, id, drag.corner, to);
    } else if (drag.kind === "pan") {
      const last = drag.last ?? drag.from;
      this.left += at[0] - last[0];
      this.top += at[1] - last[1];
      drag.last = at;
    }
  }

  end(at, reach, event) {
    const { drag } = this;
    if (drag.kind === "stroke") this.finish(this.line, true);
    else if (drag.kind === "corner" && drag.next) {
      this.history.add(drag.next);
      this.after("");
    } else if (drag.kind === "corner" && !drag.fresh) {
      this.corner = drag.corner;
      this.tell("Delete takes this corner away.");
    } else if (!drag.moved) this.tap(this.toPhoto(at), reach / this.k, event.shiftKey || event.ctrlKey || event.metaKey);
  }

  pinch(id, at) {
    const [other] = [...this.fingers].filter(([key]) => key !== id).map(([, place]) => place);
    const before = this.fingers.get(id);
    const middle = (a, b) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    const [m0, m1] = [middle(before, other), middle(at, other)];
    this.left += m1[0] - m0[0];
    this.top += m1[1] - m0[1];
    this.zoom(distance(at, other) / Math.max(1, distance(before, other)), m1);
  }

  /** A tap at a place of the photograph: by finger, mouse, pen, or Enter. */
  tap(point, reach, more) {
    const rings = this.state.stones.filter(({ id }) => this.tool !== "redraw" || !this.chosen.includes(id)).map((stone) => stone.ring);
    if (this.tool === "select") {
      const id = stoneAt(this.state, point)?.id ?? null;
      const kept = more || this.several.checked ? this.chosen.filter((one) => one !== id) : [];
      const again = kept.length < this.chosen.length && this.chosen.includes(id) && (more || this.several.checked);
      this.choose(id === null || again ? kept : [...kept, id]);
      if (id !== null) this.tell(this.sayStone(stoneOf(this.state, id)));
      return;
    }
    if (this.tool === "propose") {
      this.propose(point);
      return;
    }
    const { line } = this;
    const closed = line.length > 2 && this.drawing && distance(point, line[0]) < reach;
    const ended = line.length > 1 && distance(point, line[line.length - 1]) < reach;
    if (closed || (ended && (this.tool === "cut" || line.length > 2))) {
      this.finish(line, false);
      return;
    }
    line.push(this.drawing ? (snapped(point, rings, SNAP * reach) ?? point) : point);
    if (line.length === 2 && (this.tool === "scale" || this.tool === "ground")) this.finish(line, false);
    this.draw();
  }

  hover(at) {
    const stone = stoneAt(this.state, this.toPhoto(at));
    this.under = stone?.id ?? null;
    if (!this.waiting && stone) this.tell(this.sayStone(stone), true);
  }

  // --- keys --------------------------------------------------------------------------------------

  key(event) {
    const typing = event.target.closest?.("input, select, textarea");
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.ctrlKey || event.metaKey) {
      const does = { z: () => (event.shiftKey ? this.redo() : this.undo()), y: () => this.redo(), s: () => this.save() }[name];
      if (!does || (typing && name !== "s")) return;
      event.preventDefault();
      does();
      return;
    }
    if (typing || event.altKey) return;
    const onCanvas = event.target === this.canvas;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    if (onCanvas && name in arrows) this.moveCursor(arrows[name], event.shiftKey);
    else if (onCanvas && (name === "Enter" || name === " ")) {
      const at = this.cursor ?? [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2];
      this.cursor = at;
      this.tap(this.toPhoto(at), 3 / this.k, event.shiftKey);
    } else {
      const tool = Object.entries(TOOLS).find(([one, { key }]) => key === name && this.buttons[one]);
      const does = {
        m: () => this.merge(), Delete: () => this.remove(), Backspace: () => (this.line.length ? this.line.pop() : this.remove()), a: () => this.accept(this.chosen.length ? this.chosen : this.state.stones.map((stone) => stone.id)),
        u: () => this.toggleUse(), n: () => this.nextDoubt(1), b: () => this.nextDoubt(-1), f: () => this.lookedAt && this.settle(this.lookedAt), "]": () => this.step(1), "[": () => this.step(-1),
        "+": () => this.zoom(1.4), "=": () => this.zoom(1.4), "-": () => this.zoom(1 / 1.4), 0: () => { this.fit(); this.draw(); },
        Escape: () => this.letGo(),
      }[name];
      if (tool) this.take(tool[0]);
      else if (does) does();
      else return;
    }
    event.preventDefault();
    this.draw();
  }

  moveCursor([dx, dy], fine) {
    const [wide, high] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const step = fine ? 1 : 0.02 * Math.max(wide, high);
    const [u, v] = this.cursor ?? [wide / 2, high / 2];
    this.cursor = [Math.max(0, Math.min(wide, u + dx * step)), Math.max(0, Math.min(high, v + dy * step))];
    // At the edge the photograph goes on under the cross.
    if (this.cursor[0] === 0 || this.cursor[0] === wide) this.left -= dx * step;
    if (this.cursor[1] === 0 || this.cursor[1] === high) this.top -= dy * step;
    this.hover(this.cursor);
  }

  letGo() {
    if (!this.line.length) return this.choose([]);
    this.line = [];
    this.tell("Let go.");
  }

  toggleUse() {
    if (!this.chosen.length) return;
    const use = !stoneOf(this.state, this.chosen[0]).use;
    const state = this.chosen.reduce((now, id) => withUse(now, id, use), this.state);
    this.go(state, use ? "It may be built with." : "It is not built with.");
  }

  take(tool) {
    this.tool = tool;
    this.line = [];
    this.refresh();
    this.tell(TOOLS[tool].help);
  }

  turnTheme() {
    const root = document.documentElement;
    const dark = root.dataset.theme ? root.dataset.theme === "dark" : window.matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = dark ? "light" : "dark";
    this.draw();
  }

  // --- saying ------------------------------------------------------------------------------------

  tell(said, quiet = false) {
    this.said.textContent = said;
    this.waiting = !quiet;
    if (!quiet) {
      window.clearTimeout(this.timer);
      this.timer = window.setTimeout(() => { this.waiting = false; }, 2500);
    }
  }

  /** A length in px of the photograph, in cm when there is a scale. */
  length(px) {
    const scale = pxPerMetre(this.state);
    return scale ? `${((100 * px) / scale).toFixed(1)}\u00a0cm` : `${px.toFixed(0)}\u00a0px`;
  }

  areaOf(px) {
    const scale = pxPerMetre(this.state);
    if (!scale) return `${px.toFixed(0)}\u00a0px²`;
    const square = px / scale ** 2;
    return square < 1 ? `${(1e4 * square).toFixed(0)}\u00a0cm²` : `${square.toFixed(2)}\u00a0m²`;
  }

  sayStone(stone) {
    const [long, short] = sidesOf(stone.ring);
    const more = [stone.proposed ? "proposed" : "", stone.use ? "" : "not built with"].filter(Boolean).join(", ");
    return `Stone ${stone.id}: ${this.length(long)} x ${this.length(short)}, ${this.areaOf(area(stone.ring))}${more ? ` (${more})` : ""}`;
  }

  refresh() {
    const { state } = this;
    const counted = state.stones.filter((stone) => stone.use && !stone.proposed);
    const open = state.stones.filter((stone) => stone.proposed).length;
    const total = counted.reduce((sum, stone) => sum + area(stone.ring), 0);
    const parts = [`${counted.length} ${counted.length === 1 ? "stone" : "stones"}`, this.areaOf(total)];
    if (open) parts.push(`${open} proposed`);
    parts.push(pxPerMetre(state) ? `${pxPerMetre(state).toFixed(1)} px a metre` : "no scale yet");
    this.count.textContent = parts.join(" · ");
    this.acceptButton.hidden = !open;
    this.undoButton.disabled = this.history.at === 0;
    this.redoButton.disabled = this.history.at + 1 >= this.history.states.length;
    for (const [name, one] of Object.entries(this.buttons)) one.setAttribute("aria-pressed", String(name === this.tool));
    this.fillCard();
    this.fillDoubts();
    this.fillList();
    this.draw();
  }

  fillList() {
    if (!this.all.open) return;
    refill(this.list, [...this.state.stones].sort((a, b) => a.id - b.id).map((stone) =>
      make("li", {}, make("button", {
        type: "button", "aria-pressed": String(this.chosen.includes(stone.id)),
        click: () => { this.choose([stone.id]); this.look(boxOf(stone.ring)); },
      }, this.sayStone(stone)))));
  }

  fillCard() {
    const stones = this.chosen.map((id) => stoneOf(this.state, id));
    if (!stones.length) {
      this.card.replaceChildren(make("p", { class: "soft" }, TOOLS[this.tool].help));
      return;
    }
    const parts = stones.slice(0, 6).map((stone) => make("p", {}, this.sayStone(stone)));
    if (stones.length === 1) {
      const [stone] = stones;
      const number = make("input", {
        type: "number", min: 1, step: 1, value: stone.id,
        change: () => {
          const wanted = Number(number.value);
          if (this.go(withNumber(this.state, stone.id, wanted), `It is stone ${wanted} now.`)) this.choose([wanted]);
        },
      });
      const use = make("input", { type: "checkbox", change: () => this.toggleUse() });
      use.checked = stone.use;
      parts.push(make("label", {}, "number ", number), make("label", {}, use, " build with it"));
      if (stone.proposed) parts.push(make("button", { type: "button", class: "main", click: () => this.accept([stone.id]) }, "Accept"));
    }
    this.card.replaceChildren(...parts);
  }

  fillDoubts() {
    const open = this.doubts;
    this.doubtBox.hidden = !this.data.doubts.length;
    const now = this.lookedAt;
    const title = now ? `Doubt ${open.indexOf(now) + 1} of ${open.length}` : open.length ? `To look at: ${open.length}` : "No doubt is left";
    const button = (name, does, disabled = !open.length) => make("button", { type: "button", click: does, disabled }, name);
    refill(this.doubtBox, [
      make("h2", {}, title), ...(now ? [make("p", {}, now.text)] : []),
      make("div", {}, button("Previous", () => this.nextDoubt(-1)), button("Next", () => this.nextDoubt(1)),
        button("Fine", () => this.settle(now), !now)),
    ]);
  }

  // --- drawing -----------------------------------------------------------------------------------

  resize() {
    const ratio = window.devicePixelRatio || 1;
    const [wide, high] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (!wide || !high) return;
    for (const one of [this.canvas, this.still]) {
      one.width = Math.round(wide * ratio);
      one.height = Math.round(high * ratio);
    }
    if (!this.touched) this.fit();
    this.stale = true;
    this.paint();
  }

  /** Keep smaller copies: a large photograph takes too long to be scaled in every frame. */
  async reduce() {
    this.copies = [this.image];
    this.draw();
    while (this.copies[0].width > 1000) {
      const resizeWidth = Math.ceil(this.copies[0].width / 2);
      this.copies.unshift(await createImageBitmap(this.copies[0], { resizeWidth, resizeQuality: "medium" }));
    }
  }

  fit() {
    const { width, height } = this.data.photo;
    this.look([0, 0, width, height], 0.98);
    this.touched = false;
  }

  look([x0, y0, x1, y1], share = 0.4) {
    const [wide, high] = [this.canvas.clientWidth || 800, this.canvas.clientHeight || 600];
    this.k = share * Math.min(wide / Math.max(1, x1 - x0), high / Math.max(1, y1 - y0));
    this.left = wide / 2 - (this.k * (x0 + x1)) / 2;
    this.top = high / 2 - (this.k * (y0 + y1)) / 2;
    this.touched = true;
    this.draw();
  }

  zoom(by, at = [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2]) {
    const k = Math.max(0.02, Math.min(60, this.k * by));
    const factor = k / this.k;
    this.left = at[0] - (at[0] - this.left) * factor;
    this.top = at[1] - (at[1] - this.top) * factor;
    this.k = k;
    this.touched = true;
    this.draw();
  }

  /** Paint in the next frame; photograph and stones only where they are not as before. */
  draw(all = true) {
    this.stale ||= all;
    this.frame ??= window.requestAnimationFrame(() => {
      this.frame = null;
      this.paint();
    });
  }

  paint() {
    const context = this.canvas.getContext("2d");
    const ratio = window.devicePixelRatio || 1;
    const style = window.getComputedStyle(this.canvas);
    const colour = (name) => style.getPropertyValue(name).trim();
    const cleared = (one) => {
      one.setTransform(1, 0, 0, 1, 0, 0);
      one.clearRect(0, 0, this.canvas.width, this.canvas.height);
    };
    if (this.stale) {
      const under = this.still.getContext("2d");
      cleared(under);
      under.setTransform(ratio, 0, 0, ratio, 0, 0);
      this.paintStones(under, colour, ratio);
      this.stale = false;
    }
    cleared(context);
    context.drawImage(this.still, 0, 0);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    if (this.line.length) {
      this.stroke(context, this.path(this.line), colour("--chosen"), []);
      for (const point of this.drag?.kind === "stroke" ? [] : this.line) this.ring(context, this.toScreen(point), 4, colour("--chosen"));
    }
    if (this.cursor) {
      const [u, v] = this.cursor;
      const cross = new Path2D(`M${u - 14} ${v}H${u + 14}M${u} ${v - 14}V${v + 14}`);
      this.stroke(context, cross, colour("--chosen"), []);
    }
  }

  paintStones(context, colour, ratio) {
    const { width, height } = this.data.photo;
    if (this.copies) {
      context.imageSmoothingEnabled = this.k < 4;
      const copy = this.copies.find((one) => one.width >= width * this.k * ratio) ?? this.image;
      context.drawImage(copy, this.left, this.top, width * this.k, height * this.k);
    }
    const state = this.drag?.next ?? this.state;
    const [open, now] = [this.doubts, this.lookedAt];
    const doubtful = new Set(open.flatMap((doubt) => doubt.stones));
    // Outlines of one look are one path.
    const looks = new Map();
    for (const stone of state.stones) {
      const [chosen, dash] = [this.chosen.includes(stone.id), stone.proposed ? [7, 5] : []];
      const line = chosen ? "--chosen" : doubtful.has(stone.id) ? "--doubt" : "--stone";
      const fill = chosen ? "--fill" : stone.use ? "" : "--unused";
      const name = [line, fill, dash].join();
      if (!looks.has(name)) looks.set(name, { line, fill, dash, path: new Path2D() });
      this.path(stone.ring, true, looks.get(name).path);
    }
    for (const { line, fill, dash, path } of looks.values()) {
      context.fillStyle = colour(fill);
      if (fill) context.fill(path);
      this.stroke(context, path, colour(line), dash);
    }
    for (const stone of state.stones) this.label(context, stone);
    if (this.chosen.length === 1 && this.tool === "select") this.handles(context, stoneOf(state, this.chosen[0]), colour);
    // Where it is, when that is not a stone with an outline of that colour.
    for (const doubt of open) {
      if (doubt.stones.length !== 1 || doubt === now) this.ring(context, this.toScreen(doubt.at), 9, colour("--doubt"));
    }
    if (state.scale?.ends) this.stroke(context, this.path(state.scale.ends), colour("--scale"), []);
    if (state.ground) this.stroke(context, this.path(state.ground), colour("--ground"), [12, 6]);
  }

  path(points, closed = false, path = new Path2D()) {
    points.forEach((point, i) => {
      const [u, v] = this.toScreen(point);
      if (i) path.lineTo(u, v);
      else path.moveTo(u, v);
    });
    if (closed) path.closePath();
    return path;
  }

  stroke(context, path, colour, dash) {
    // A dark rim under the colour: seen on light and on dark stones.
    context.setLineDash(dash);
    context.lineWidth = 4;
    context.strokeStyle = "rgba(0, 0, 0, .55)";
    context.stroke(path);
    context.lineWidth = 2;
    context.strokeStyle = colour;
    context.stroke(path);
    context.setLineDash([]);
  }

  ring(context, [u, v], radius, colour) {
    const path = new Path2D();
    path.arc(u, v, radius, 0, 2 * Math.PI);
    this.stroke(context, path, colour, []);
  }

  label(context, stone) {
    const [x0, y0, x1, y1] = boxOf(stone.ring);
    if (Math.min(x1 - x0, y1 - y0) * this.k < 16) return;
    const [u, v] = this.toScreen(centroid(stone.ring));
    context.font = "600 13px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.lineWidth = 3.5;
    context.strokeStyle = "rgba(0, 0, 0, .7)";
    const text = stone.use ? String(stone.id) : `${stone.id} ×`;
    context.strokeText(text, u, v);
    context.fillStyle = "#ffffff";
    context.fillText(text, u, v);
  }

  handles(context, stone, colour) {
    if (!stone) return;
    context.fillStyle = colour("--chosen");
    stone.ring.forEach((point, i) => {
      const [u, v] = this.toScreen(point);
      const near = this.k * distance(point, stone.ring.at(i - 1)) < 9;
      const half = i === this.corner ? 6 : near ? 2 : 4;
      context.fillRect(u - half, v - half, 2 * half, 2 * half);
    });
    for (const [i, point] of middles(stone.ring).entries()) {
      if (this.k * distance(point, stone.ring[i]) < 9) continue; // there is no room for it
      const [u, v] = this.toScreen(point);
      context.beginPath();
      context.arc(u, v, 2.5, 0, 2 * Math.PI);
      context.fill();
    }
  }
}

function middles(ring) {
  return ring.map((p, i) => p.map((value, axis) => (value + ring[(i + 1) % ring.length][axis]) / 2));
}

function rounded(value) {
  return Math.round(100 * value) / 100;
}
