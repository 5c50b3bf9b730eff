// Shows a dry-stone wall: data of the schema "drystone-view/1" as a drawing that one can go through.
// No dependencies, no network.  Everything that comes from the data is set as text or as
// an attribute, never as markup.

import { boxOf, draw, make } from "./dom.js";

const WIDTH = 1000;
const STEP_MS = 700;
const SWING_MS = 2600;
const LARGEST_MOVE = 0.12;
const LONGEST_FORCE = 0.22;
const SWIPE_PX = 50;
const WIDEST_THRUST = 14;
const KINDS = { closed: "dot", opening: "ring", sliding: "triangle", "opening and sliding": "square" };
const MARKS = {
  dot: "M-2 0a2 2 0 1 0 4 0a2 2 0 1 0 -4 0",
  ring: "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0",
  triangle: "M0 -5.5L5 3.5H-5Z",
  square: "M-4 -4H4V4H-4Z",
};
const PATTERNS = {
  rising: "M-2 2 2 -2M0 12 12 0M10 14 14 10",
  falling: "M-2 10 2 14M0 0 12 12M10 -2 14 2",
  dots: "M6 4.6a1.4 1.4 0 1 0 .01 0",
  level: "M0 6H12",
  upright: "M6 0V12",
  crossed: "M0 12 12 0M0 0 12 12",
  grid: "M0 6H12M6 0V12",
};
let count = 0;

/**
 * Show a wall inside of an element.
 *
 * @param {Element|ShadowRoot} element where to put it; what is in it stays.
 * @param {object} data of the schema "drystone-view/1".
 * @param {object} [options] css: style sheet to add; chart, metrics, about: false leaves a part
 *   out; build: false offers no Build view; step: first step to show (the whole wall); pageKeys:
 *   left and right arrows also work when nothing has the focus; onStep(step), onTheme(theme):
 *   called on changes.
 * @returns {{root: Element, show: function(number), step: number, select: function(number),
 *   build: function(boolean), destroy: function()}}
 */
export function mount(element, data, options = {}) {
  if (data.schema !== "drystone-view/1") {
    throw new Error(`this viewer shows drystone-view/1, not ${data.schema}`);
  }
  return new Viewer(element, data, options);
}

function text(value, digits = 3) {
  return typeof value === "number" && Number.isFinite(value) ? value.toFixed(digits) : "–";
}

function sum(values) {
  return values.reduce((total, value) => total + value, 0);
}

function middleOf(points) {
  return [0, 1].map((axis) => sum(points.map((p) => p[axis])) / points.length);
}

function pathOf(loops, x, y) {
  return loops
    .map((loop) => "M" + loop.map((p) => `${x(p[0]).toFixed(1)} ${y(p[1]).toFixed(1)}`).join("L") + "Z")
    .join("");
}

function lineOf([x1, y1], [x2, y2], attributes = {}) {
  const ends = Object.entries({ x1, y1, x2, y2 }).map(([name, value]) => [name, value.toFixed(1)]);
  return draw("line", { ...attributes, ...Object.fromEntries(ends) });
}

function markAt(name, x, y) {
  const mark = draw("path", { class: `ds-mark ds-mark-${name}`, d: MARKS[name] });
  return draw("g", { transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` }, mark);
}

// What a legend shows of a mark or a line.
function sampleOf(shape) {
  return draw("svg", { class: "ds-sample", viewBox: "0 0 22 14", "aria-hidden": "true" }, shape);
}

// Rows of names and values; those that nobody needs for building are marked.
function definitions(rows) {
  return make("dl", {}, rows.map(([name, value, more]) => make("div", { class: more ? "ds-more" : null }, make("dt", {}, name), make("dd", {}, value))));
}

function freeName() {
  let name;
  do {
    count += 1;
    name = `ds-view-${count}`;
  } while (document.getElementById(name));
  return name;
}

// Steps that are done, kept by the browser under the hash of the plan; where it keeps nothing, as in
// some frames, they last as long as the page.
function readTicks(data) {
  try {
    return new Set(JSON.parse(window.localStorage.getItem(`drystone ${data.plan}`) ?? "[]"));
  } catch {
    return new Set();
  }
}

function keepTicks(data, ticks) {
  try {
    window.localStorage.setItem(`drystone ${data.plan}`, JSON.stringify([...ticks]));
  } catch {
    // Nothing is kept.
  }
}

// The lines that a joint carries: where its force acts, which way, and how large it is.
function resultant(contact, forces) {
  const [nx, ny] = contact.normal;
  const vectors = forces.map(([n, t]) => [n * nx + t * ny, n * ny - t * nx]);
  const total = [sum(vectors.map((v) => v[0])), sum(vectors.map((v) => v[1]))];
  const first = contact.points[0];
  const last = contact.points[contact.points.length - 1];
  const along = [last[0] - first[0], last[1] - first[1]];
  const moment = sum(
    contact.points.map((p, i) => (p[0] - first[0]) * vectors[i][1] - (p[1] - first[1]) * vectors[i][0]),
  );
  const across = along[0] * total[1] - along[1] * total[0];
  const share = across ? Math.min(1, Math.max(0, moment / across)) : 0.5;
  return {
    between: contact.between,
    point: [first[0] + share * along[0], first[1] + share * along[1]],
    total,
    size: Math.hypot(...total),
  };
}

// Where a block is after a share of its motion: it turns about its centre of rotation by its angle,
// so it keeps its size.
function displacement([vx, vy, turning], factor) {
  const [dx, dy, angle] = [vx * factor, vy * factor, turning * factor];
  const small = Math.abs(angle) < 1e-9;
  const sine = small ? 1 : Math.sin(angle) / angle;
  const rest = small ? 0 : (1 - Math.cos(angle)) / angle;
  return { x: sine * dx - rest * dy, y: rest * dx + sine * dy, angle };
}

// Move what is drawn by a transform, or leave it where it was.
function carry(drawn, way) {
  if (way) drawn.setAttribute("transform", way);
  else drawn.removeAttribute("transform");
}

class Viewer {
  constructor(element, data, options) {
    this.data = data;
    this.options = options;
    this.name = freeName();
    this.parts = new Map(data.parts.map((part) => [part.id, part]));
    this.last = data.steps;
    this.noun = data.noun === "block" ? "Block" : "Stone";
    const [x0, , x1, y1] = data.box;
    this.k = WIDTH / Math.max(x1 - x0, 1e-9);
    this.x = (x) => (x - x0) * this.k;
    this.y = (y) => (y1 - y) * this.k;
    this.at = ([x, y]) => [this.x(x), this.y(y)];
    this.height = this.y(data.box[1]);
    this.state = {
      step: Math.min(this.last, options.step ?? this.last),
      selected: null,
      forces: "none",
      forceScale: 1,
      mechanism: "none",
      amplitude: 1,
      contacts: false,
      kinds: false,
      patterns: true,
      ids: false,
      index: "",
    };
    this.timer = null;
    this.frame = null;
    this.labels = new Map();
    this.building = false;
    this.ticks = readTicks(data);
    this.still = window.matchMedia("(prefers-reduced-motion: reduce)");
    this.assemble(element);
    this.show(this.state.step, { quiet: true });
    if (options.step !== undefined) return;
    this.select(null);
    this.said.textContent = `Choose a ${this.noun.toLowerCase()} in the drawing${this.last ? ", or go to a step" : ""}.`;
  }

  get step() {
    return this.state.step;
  }

  destroy() {
    this.pause();
    this.stopSwing();
    this.sizes.disconnect();
    document.removeEventListener("keydown", this.pageKey);
    this.root.remove();
  }

  // --- building ---------------------------------------------------------------------------------

  assemble(element) {
    const { data, options } = this;
    this.card = make("aside", { class: "ds-card", "aria-label": `${this.noun} card` });
    this.said = make("p", { class: "ds-said", "aria-live": "polite", role: "status" });
    this.note = make("p", { class: "ds-note" });
    this.legend = make("ul", { class: "ds-legend", "aria-label": "Legend" });
    const left = make("div", { class: "ds-left" }, this.buildStage(), this.last ? this.buildTransport() : null, this.said);
    const tools = make("div", { class: "ds-tools" }, this.legend, this.buildControls(), this.note);
    const chart = this.last && options.chart !== false ? this.buildChart() : null;
    this.root = make(
      "section",
      {
        class: "ds-view", id: this.name, "aria-label": data.title, "data-theme": "auto",
        keydown: (event) => this.key(event),
        pointerdown: (event) => { this.swipe = event.isPrimary ? event : null; },
        pointerup: (event) => this.swiped(event),
      },
      options.css ? make("style", {}, options.css) : null,
      this.buildTop(),
      make("div", { class: "ds-main" }, left, this.card, tools, chart),
      options.metrics === false ? null : this.buildMetrics(),
      options.about === false ? null : this.buildAbout(),
    );
    this.pageKey = (event) => {
      if (options.pageKeys && event.target === document.body && /^Arrow(Left|Right)$/.test(event.key)) this.key(event);
    };
    document.addEventListener("keydown", this.pageKey);
    element.append(this.root);
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(this.stage);
  }

  buildTop() {
    const { data, options } = this;
    if (options.title === false) return null;
    const falls = data.stands === false ? " ds-alarm" : "";
    return make("div", { class: "ds-top" }, make("h2", { class: "ds-title" }, data.title), make("p", { class: `ds-summary${falls}` }, data.summary));
  }

  buildStage() {
    const { data } = this;
    this.defs = draw("defs", {});
    for (const [name, d] of Object.entries(PATTERNS)) {
      const attributes = { id: `${this.name}-${name}`, width: 12, height: 12, patternUnits: "userSpaceOnUse" };
      this.defs.append(draw("pattern", attributes, draw("path", { d, class: name === "dots" ? "ds-dots" : "ds-lines" })));
    }
    const ground = this.y(0);
    const back = draw("g", { "aria-hidden": "true" });
    if (this.last) {
      const [wide, high] = data.size;
      const frame = { x: this.x(0), y: this.y(high), width: wide * this.k, height: high * this.k };
      back.append(draw("rect", { class: "ds-frame", ...frame }));
    }
    back.append(draw("line", { class: "ds-ground", x1: -14, x2: WIDTH + 14, y1: ground, y2: ground }));
    this.layers = {};
    // Numbers lie over the thrust, which goes through the middle of the stones.
    for (const name of ["parts", "before", "thrust", "numbers", "contacts", "forces"]) {
      const hidden = name === "parts" ? null : "true";
      this.layers[name] = draw("g", { class: `ds-${name}`, "aria-hidden": hidden });
    }
    this.groups = new Map(data.parts.map((part) => [part.id, this.buildPart(part)]));
    this.layers.parts.append(...this.groups.values());
    this.layers.numbers.append(...[...this.labels.values()].map((one) => one.label));
    this.svg = draw("svg", { role: "group", "aria-label": `${data.title}. ${data.summary}` }, this.defs, back, ...Object.values(this.layers));
    const keys = this.last ? "Left and right arrows go through the steps, space plays, up and down go from stone to stone." : "Arrows go from one to the next.";
    this.stage = make("div", { class: "ds-stage", tabindex: 0, role: "group", "aria-label": `Drawing of the wall. ${keys}` }, this.svg);
    return this.stage;
  }

  buildPart(part) {
    const d = pathOf(part.points, this.x, this.y);
    const choose = () => this.select(part.id);
    const pressed = (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      event.stopPropagation();
      choose();
    };
    const group = draw(
      "g",
      {
        class: `ds-part ds-${part.kind}`, "data-id": part.id, "data-step": part.step, role: "button", tabindex: -1, "aria-label": this.nameOf(part),
        click: choose, focus: choose, keydown: pressed,
      },
      draw("path", { class: "ds-shape", d, fill: part.colour, "fill-rule": "evenodd" }),
    );
    if (part.pattern in PATTERNS) {
      const ink = { class: `ds-pattern ${part.text_colour === "#000000" ? "ds-dark" : "ds-bright"}` };
      group.append(draw("path", { ...ink, d, fill: `url(#${this.name}-${part.pattern})`, "fill-rule": "evenodd" }));
    }
    if (part.number !== null) {
      const [x, y] = this.at(part.centroid).map((value) => value.toFixed(1));
      const halo = part.text_colour === "#000000" ? "ds-on-light" : "ds-on-dark";
      const label = draw("text", { x, y, class: `ds-number ${halo}`, fill: part.text_colour, "aria-hidden": "true" });
      const [x0, y0, x1, y1] = boxOf(part.points.flat());
      this.labels.set(part.id, { label, part, high: this.k * (y1 - y0), wide: (this.k * (x1 - x0)) / 0.62 });
    }
    return group;
  }

  buildTransport() {
    const to = (step) => () => {
      this.pause();
      this.show(step());
    };
    const button = (name, label, sign, step) =>
      make("button", { type: "button", class: `ds-${name}`, "aria-label": label, title: label, click: to(step) }, sign);
    this.playButton = make("button", { type: "button", class: "ds-play", click: () => this.toggle() }, "Play");
    this.slider = make("input", {
      type: "range", class: "ds-slider", min: 0, max: this.last, step: 1, value: this.last, "aria-label": "Step of construction",
      input: to(() => Number(this.slider.value)),
    });
    this.counter = make("output", { class: "ds-counter" });
    this.buildButton = make("button", { type: "button", class: "ds-build", click: () => this.build(!this.building) }, "Build");
    return make(
      "div",
      { class: "ds-transport", role: "group", "aria-label": "Steps" },
      this.options.build === false ? null : this.buildButton,
      button("first", "First step", "|◀", () => 0),
      button("previous", "One step back", "◀", () => this.state.step - 1),
      this.playButton,
      button("next", "One step forward", "▶", () => this.state.step + 1),
      button("last", "Last step", "▶|", () => this.last),
      this.slider,
      this.counter,
    );
  }

  buildControls() {
    const { data } = this;
    const cases = { none: "none" };
    const present = new Set(data.contacts.flatMap((contact) => Object.keys(contact.forces)));
    for (const name of ["self", "left", "right"]) if (present.has(name)) cases[name] = name === "self" ? data.dead_load : name;
    const sides = { none: "none" };
    for (const side of ["left", "right"]) if (data.mechanisms[side]?.velocity) sides[side] = side;
    const forceScale = this.range("Scale", "ds-force-scale", 0.2, 3, 0.1, (value) => {
      this.state.forceScale = value;
      this.drawForces();
    });
    const amplitude = this.range("Amplitude", "ds-amplitude", 0, 2, 0.02, (value) => {
      this.stopSwing();
      this.state.amplitude = value;
      this.move(value);
    });
    this.swingButton = make("button", { type: "button", class: "ds-animate", "aria-pressed": "false", click: () => this.swing() }, "Animate");
    this.moving = make("span", { class: "ds-sub", hidden: true }, amplitude, this.swingButton);
    this.pushing = make("span", { class: "ds-sub", hidden: true }, forceScale);
    const many = Object.keys(cases).length > 1;
    const fails = Object.keys(sides).length > 1;
    this.themeButton = make("button", { type: "button", class: "ds-theme", click: () => this.nextTheme() }, "Theme: auto");
    const zoom = this.range("Zoom", "ds-zoom", 1, 4, 0.25, (value) => this.zoom(value));
    return make(
      "div",
      { class: "ds-controls" },
      fails ? this.choice("Mechanism", "mechanism", sides, this.moving) : null,
      many ? this.choice("Forces", "forces", cases, this.pushing) : null,
      make(
        "fieldset",
        { class: "ds-choice" },
        make("legend", {}, "Show"),
        data.contacts.length ? this.check("Contacts", "contacts") : null,
        fails ? this.check("What joints do", "kinds") : null,
        this.data.parts.some((part) => part.cluster !== null) ? this.check("Patterns", "patterns") : null,
        this.last ? this.check("Ids, not steps", "ids") : null,
        zoom,
        this.themeButton,
      ),
    );
  }

  range(label, name, min, max, step, change) {
    const input = make("input", { type: "range", class: name, min, max, step, value: 1, input: () => change(Number(input.value)) });
    return make("label", { class: "ds-range" }, `${label} `, input);
  }

  check(label, name) {
    const change = () => {
      this.state[name] = input.checked;
      this.root.classList.toggle("ds-plain", !this.state.patterns);
      this.perPx = null;
      this.update();
    };
    const input = make("input", { type: "checkbox", class: `ds-${name}-on`, checked: this.state[name], change });
    return make("label", { class: "ds-check" }, input, ` ${label}`);
  }

  choice(label, name, values, extra) {
    const box = make("fieldset", { class: `ds-choice ds-choose-${name}` }, make("legend", {}, label));
    for (const [value, words] of Object.entries(values)) {
      const change = () => {
        this.state[name] = value;
        this.stopSwing();
        if (value !== "none" && this.state.step !== this.last) {
          this.pause();
          this.show(this.last);
        }
        this.update();
      };
      const input = make("input", { type: "radio", name: `${this.name}-${name}`, value, checked: value === "none", change });
      box.append(make("label", { class: "ds-check" }, input, ` ${words}`));
    }
    box.append(extra);
    return box;
  }

  buildMetrics() {
    const cards = this.data.metrics.map((metric) =>
      make(
        "div",
        { class: "ds-metric" },
        make("h3", {}, metric.name, metric.symbol ? make("span", { class: "ds-symbol" }, ` · ${metric.symbol}`) : null),
        make("p", { class: "ds-value" }, metric.value),
        metric.better ? make("p", { class: "ds-better" }, `${metric.better === "higher" ? "▲" : "▼"} ${metric.better} is better`) : null,
        make("p", { class: "ds-sentence" }, metric.sentence),
        metric.masons ? make("p", { class: "ds-masons" }, `Masons: ${metric.masons}.`) : null,
      ),
    );
    return make("section", { class: "ds-metrics", "aria-label": "Results" }, ...cards);
  }

  buildAbout() {
    const { data } = this;
    const pairs = (rows) =>
      make("table", {}, make("tbody", {}, rows.map(([name, value]) => make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, String(value))))));
    const list = (words) => make("ul", {}, words.map((one) => make("li", {}, one)));
    const toggle = () => {
      if (!box.open || box.children.length > 1) return;
      box.append(pairs(data.inputs));
      if (data.notices.length) box.append(make("h3", {}, "Notices"), list(data.notices.map((n) => `${n.code} ${n.message} ${n.cure}`)));
      if (data.timings.length) box.append(make("h3", {}, "Time"), pairs(data.timings.map(([name, s]) => [name, `${text(s, 2)} s`])));
      box.append(make("h3", {}, "Assumptions"), list(data.assumptions));
      box.append(make("h3", {}, "Settings"), pairs(data.settings));
    };
    const box = make("details", { class: "ds-about", toggle }, make("summary", {}, "What it was made from, settings, assumptions"));
    return box;
  }

  // --- steps ------------------------------------------------------------------------------------

  show(step, { quiet = false } = {}) {
    const { state, data } = this;
    state.step = Math.max(0, Math.min(this.last, Math.round(step)));
    const now = this.last ? data.parts.find((part) => part.step === state.step) : null;
    for (const part of data.parts) {
      const group = this.groups.get(part.id);
      for (const one of this.drawnOf(part)) one.classList.toggle("ds-later", part.step !== null && part.step > state.step);
      group.classList.toggle("ds-now", part === now && (this.building || state.step !== this.last));
    }
    if (this.slider) {
      this.slider.value = state.step;
      this.slider.setAttribute("aria-valuetext", this.sayStep(now));
      this.count();
    }
    this.said.textContent = this.last ? this.sayStep(now) : data.summary;
    this.select(now ? now.id : this.last ? null : (state.selected ?? null), { quiet: true });
    this.update();
    this.markChart();
    if (!quiet) this.options.onStep?.(state.step);
  }

  sayStep(part) {
    if (!part) return "Nothing is placed yet.";
    const { alpha_left: left, alpha_right: right } = part;
    const strength = left === null && right === null ? "" : ` Load multipliers then: left ${text(left)}, right ${text(right)}.`;
    return `Step ${part.step} of ${this.last}: ${part.words}${strength}`;
  }

  toggle() {
    if (this.timer !== null) {
      this.pause();
      return;
    }
    this.said.setAttribute("aria-live", "off");
    this.playButton.textContent = "Pause";
    if (this.state.step >= this.last) this.show(0);
    this.timer = window.setInterval(() => {
      this.show(this.state.step + 1);
      if (this.state.step >= this.last) this.pause();
    }, this.options.stepMs ?? STEP_MS);
  }

  pause() {
    if (this.timer === null) return;
    window.clearInterval(this.timer);
    this.timer = null;
    this.said.setAttribute("aria-live", "polite");
    this.playButton.textContent = "Play";
  }

  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey || event.defaultPrevented) return;
    const target = event.composedPath()[0];
    if (target.closest?.("input, select, textarea, [contenteditable]")) return;
    if (event.key === " " && target.closest?.("button, summary, a")) return;
    const { step } = this.state;
    const steps = this.last ? { ArrowLeft: step - 1, ArrowRight: step + 1, Home: 0, End: this.last } : {};
    const along = { ArrowUp: -1, ArrowDown: 1, ...(this.last ? {} : { ArrowLeft: -1, ArrowRight: 1 }) };
    if (event.key in along) this.walk(along[event.key]);
    else if (event.key in steps) {
      this.pause();
      this.show(steps[event.key]);
    } else if (event.key === " " && this.last) this.toggle();
    else return;
    event.preventDefault();
  }

  walk(by) {
    const seen = [...this.groups.keys()].filter((id) => !this.groups.get(id).classList.contains("ds-later"));
    if (!seen.length) return;
    const at = seen.indexOf(this.state.selected);
    const next = at < 0 ? (by > 0 ? 0 : seen.length - 1) : (at + by + seen.length) % seen.length;
    this.groups.get(seen[next]).focus();
  }

  // --- building -----------------------------------------------------------------------------------

  // One step fills the screen, for a phone beside the wall.
  build(on = true) {
    if (!this.last) return;
    this.pause();
    this.building = on;
    this.root.classList.toggle("ds-building", on);
    this.buildButton.textContent = on ? "Close" : "Build";
    const open = this.data.parts.find((part) => !this.ticks.has(part.step));
    if (on) this.zoom(1);
    this.show(on && open ? open.step : this.last);
    if (on) this.root.scrollTo(0, 0);
  }

  swiped(event) {
    const from = this.swipe;
    this.swipe = null;
    if (!this.building || !from || from.pointerId !== event.pointerId) return;
    const [across, down] = [event.clientX - from.clientX, event.clientY - from.clientY];
    if (Math.abs(across) < SWIPE_PX || Math.abs(across) < 2 * Math.abs(down)) return;
    this.show(Math.max(1, this.state.step - Math.sign(across)));
  }

  tick(part, on) {
    if (on) this.ticks.add(part.step);
    else this.ticks.delete(part.step);
    keepTicks(this.data, this.ticks);
    this.count();
    if (on && this.building && part.step === this.state.step) this.show(part.step + 1);
  }

  count() {
    const done = this.building ? `, ${this.ticks.size} done` : "";
    this.counter.textContent = `${this.state.step} / ${this.last}${done}`;
  }

  // --- what is drawn over the stones --------------------------------------------------------------

  get finished() {
    return this.state.step === this.last;
  }

  get mechanism() {
    const { mechanism } = this.state;
    return mechanism !== "none" && this.finished ? this.data.mechanisms[mechanism] : null;
  }

  update() {
    const { state } = this;
    this.root.classList.toggle("ds-fails", this.mechanism !== null);
    this.root.classList.toggle("ds-pushed", state.forces !== "none" && this.finished);
    this.moving.hidden = state.mechanism === "none";
    this.pushing.hidden = state.forces === "none";
    this.swingButton.disabled = this.still.matches;
    this.swingButton.title = this.still.matches ? "Your system asks for less motion" : "";
    this.frameView();
    this.drawBefore();
    this.drawContacts();
    this.drawForces();
    this.move(state.amplitude);
    this.explain();
  }

  frameView() {
    const [, , x1, y1] = this.data.box;
    const reach = Math.max(y1 - this.data.box[1], 0.2 * (x1 - this.data.box[0])) * this.k * LARGEST_MOVE;
    const pad = this.mechanism ? reach : 0;
    if (this.building) return this.frameStep();
    const foot = this.finished && this.state.forces !== "none" ? 0.8 * reach : 0;
    this.look(-16 - pad, -12 - pad, WIDTH + 32 + 2 * pad, this.height + 26 + pad + foot);
  }

  look(...box) {
    this.svg.setAttribute("viewBox", box.map((value) => value.toFixed(1)).join(" "));
    this.resize();
  }

  // Of a long wall only what is around the step: numbers stay readable.
  frameStep() {
    const wide = Math.min(WIDTH + 32, Math.max(3 * this.height, 200));
    const part = this.data.parts.find((one) => one.step === this.state.step);
    const middle = this.x((part ?? this.data.parts[0]).centroid[0]);
    const left = Math.min(Math.max(middle - wide / 2, -16), WIDTH + 16 - wide);
    this.look(left, -12, wide, this.height + 26);
  }

  resize() {
    const box = this.svg.viewBox.baseVal;
    const wide = this.svg.clientWidth || this.svg.getBoundingClientRect().width;
    // A wall higher than its place is drawn smaller than its place is wide.
    const high = this.svg.clientHeight || this.svg.getBoundingClientRect().height;
    const perPx = box && box.width && wide && high ? Math.max(box.width / wide, box.height / high) : 1.4;
    if (perPx === this.perPx) return;
    this.perPx = perPx;
    this.root.style.setProperty("--ds-px", perPx.toFixed(4));
    for (const { label, part, high, wide } of this.labels.values()) {
      label.textContent = String(this.state.ids ? part.id : part.number);
      const room = Math.min(high, wide / label.textContent.length);
      label.setAttribute("font-size", Math.min(0.6 * room, 15 * perPx).toFixed(1));
    }
    if (this.chart) this.drawChart();
  }

  zoom(value) {
    this.svg.style.width = `${100 * value}%`;
    this.svg.style.maxHeight = value > 1 ? "none" : "";
    this.resize();
    const group = this.groups.get(this.state.selected);
    if (value > 1 && group) group.scrollIntoView({ block: "nearest", inline: "center" });
  }

  move(amplitude) {
    const failing = this.mechanism;
    for (const part of this.data.parts) {
      const velocity = failing?.velocity?.[part.id];
      const way = velocity ? this.wayOf(part, velocity, amplitude * failing.scale) : "";
      for (const one of this.drawnOf(part)) {
        one.classList.toggle("ds-still", failing !== null && !velocity);
        carry(one, way);
      }
    }
    // A joint goes with the block that its normal points into.
    for (const joint of this.layers.contacts.children) {
      carry(joint, this.groups.get(Number(joint.dataset.block))?.getAttribute("transform"));
    }
  }

  drawnOf(part) {
    return [this.groups.get(part.id), this.labels.get(part.id)?.label].filter(Boolean);
  }

  // The transform of a part after so much of its velocity.
  wayOf(part, velocity, factor) {
    const { x, y, angle } = displacement(velocity, factor);
    const [cx, cy] = this.at(part.centroid);
    const shift = `translate(${(x * this.k).toFixed(3)} ${(-y * this.k).toFixed(3)})`;
    return `${shift} rotate(${((-angle * 180) / Math.PI).toFixed(4)} ${cx.toFixed(3)} ${cy.toFixed(3)})`;
  }

  swing() {
    if (this.frame !== null) {
      this.stopSwing();
      return;
    }
    if (this.still.matches || !this.mechanism) return;
    this.swingButton.setAttribute("aria-pressed", "true");
    this.swingButton.textContent = "Stop";
    const begin = performance.now();
    const tick = (now) => {
      const share = (1 - Math.cos((2 * Math.PI * (now - begin)) / SWING_MS)) / 2;
      this.move(this.state.amplitude * share);
      this.frame = window.requestAnimationFrame(tick);
    };
    this.frame = window.requestAnimationFrame(tick);
  }

  stopSwing() {
    if (this.frame === null) return;
    window.cancelAnimationFrame(this.frame);
    this.frame = null;
    this.swingButton.setAttribute("aria-pressed", "false");
    this.swingButton.textContent = "Animate";
    this.move(this.state.amplitude);
  }

  drawBefore() {
    const moved = this.mechanism?.velocity ?? {};
    const shapes = this.data.parts.filter((part) => part.id in moved);
    this.layers.before.replaceChildren(...shapes.map((part) => draw("path", { d: pathOf(part.points, this.x, this.y) })));
  }

  get kindSide() {
    const { state, data } = this;
    if (state.mechanism !== "none") return state.mechanism;
    const known = ["left", "right"].filter((side) => data.mechanisms[side]?.velocity);
    const alpha = (side) => data.mechanisms[side].alpha ?? -1;
    return known.sort((a, b) => alpha(a) - alpha(b))[0];
  }

  drawContacts() {
    const { state } = this;
    const shown = [];
    const seen = (id) => id === 0 || !this.groups.get(id)?.classList.contains("ds-later");
    const kinds = state.kinds && this.finished;
    for (const contact of state.contacts || kinds ? this.data.contacts : []) {
      if (!contact.between.every(seen)) continue;
      const joint = draw("g", { "data-block": contact.between[0] });
      shown.push(joint);
      const points = contact.points.map(this.at);
      if (state.contacts) joint.append(lineOf(points[0], points.at(-1), { class: "ds-joint" }));
      points.forEach(([x, y], at) => joint.append(markAt(kinds ? KINDS[contact.kinds[this.kindSide]?.[at] ?? "closed"] : "dot", x, y)));
    }
    this.layers.contacts.replaceChildren(...shown);
  }

  drawForces() {
    const { state, data } = this;
    const lines = [];
    const thrust = [];
    this.largest = 0;
    if (state.forces !== "none" && this.finished) {
      const acting = data.contacts.filter((c) => c.forces[state.forces]).map((c) => resultant(c, c.forces[state.forces]));
      this.largest = Math.max(0, ...acting.map((one) => one.size));
      const tall = Math.max(this.height, 0.2 * WIDTH);
      for (const one of acting) {
        if (one.size < 1e-6 * this.largest) continue;
        const [x, y] = this.at(one.point);
        const half = (0.5 * state.forceScale * LONGEST_FORCE * tall) / this.largest;
        const [dx, dy] = [one.total[0] * half, -one.total[1] * half];
        lines.push(lineOf([x - dx, y - dy], [x + dx, y + dy]));
        const way = one.between.map((id) => this.parts.get(id)?.centroid).filter(Boolean).map(this.at);
        way.splice(1, 0, [x, y]);
        const points = way.map((place) => place.map((value) => value.toFixed(1)).join()).join(" ");
        const wide = (WIDEST_THRUST * one.size) / this.largest;
        thrust.push(draw("polyline", { points, "stroke-width": wide.toFixed(2) }));
      }
    }
    this.layers.forces.replaceChildren(...lines);
    this.layers.thrust.replaceChildren(...thrust);
  }

  explain() {
    const { state, data } = this;
    const rows = [];
    if (this.finished && state.forces !== "none" && this.largest > 0) {
      rows.push(["force", `force at a joint, the largest ${text(100 * this.largest, 1)} % of the wall's weight`], ["thrust", "thrust, as wide as the force"]);
    }
    if (state.contacts) rows.push(["joint", "contact"]);
    if (this.finished && state.kinds) for (const [words, mark] of Object.entries(KINDS)) rows.push([mark, words]);
    this.legend.replaceChildren(...rows.map(([mark, words]) => make("li", {}, this.sample(mark), ` ${words}`)));
    const said = [];
    const overlays = state.forces !== "none" || state.mechanism !== "none" || state.kinds;
    if (overlays && !this.finished) said.push("Forces and mechanisms are those of the finished wall.");
    if (this.mechanism) {
      const { alpha, words } = this.mechanism;
      const push = alpha === null ? "" : `${this.mechanism.load}, load multiplier ${text(alpha)}. `;
      said.push(`${push}${words}`);
    } else if (this.finished && state.kinds) said.push(`Joints in the mechanism to the ${this.kindSide}.`);
    if (this.finished && state.forces !== "none") said.push(data.forces_words);
    this.note.textContent = said.join(" ");
  }

  sample(mark) {
    const inside = {
      force: () => draw("g", { class: "ds-forces" }, draw("line", { x1: 3, y1: 10, x2: 19, y2: 4 })),
      thrust: () => draw("g", { class: "ds-thrust" }, draw("polyline", { points: "2,7 20,7", "stroke-width": 6 })),
      joint: () => draw("g", { class: "ds-contacts" }, draw("line", { class: "ds-joint", x1: 3, y1: 7, x2: 19, y2: 7 })),
    };
    return sampleOf(mark in inside ? inside[mark]() : draw("g", { class: "ds-contacts" }, markAt(mark, 11, 7)));
  }

  // --- the stone card -----------------------------------------------------------------------------

  nameOf(part) {
    const step = part.step === null ? "" : ` (step ${part.step})`;
    return `${part.kind === "wedge" ? "Wedge" : this.noun} ${part.id}${step}`;
  }

  select(id, { quiet = false } = {}) {
    const before = this.groups.get(this.state.selected);
    before?.classList.remove("ds-selected");
    before?.removeAttribute("aria-pressed");
    this.tabStop?.setAttribute("tabindex", "-1");
    const part = this.parts.get(id) ?? null;
    this.state.selected = part ? part.id : null;
    const group = part ? this.groups.get(part.id) : null;
    this.tabStop = group ?? this.groups.values().next().value;
    this.tabStop?.setAttribute("tabindex", "0");
    group?.classList.add("ds-selected");
    group?.setAttribute("aria-pressed", "true");
    this.card.replaceChildren(...(part ? this.cardOf(part) : this.emptyCard()));
    if (!quiet && part) this.said.textContent = part.step === null ? `${this.nameOf(part)}.` : this.sayStep(part);
  }

  // What is said of the whole wall, until a stone is chosen.
  emptyCard() {
    const { data } = this;
    const { stands } = data;
    const said = stands === null ? "Not known" : stands ? "It stands" : "It does not stand";
    const wedges = data.parts.filter((part) => part.kind === "wedge").length;
    const more = [["Size", this.length(...data.size)]];
    if (this.last) more.push(["Stones", `${data.parts.length - wedges} of ${data.parts.length - wedges + data.unused.length}`]);
    if (data.unused.length) more.push(["Left over", data.unused.join(", ")]);
    if (wedges) more.push(["Wedges", String(wedges)]);
    return [
      make("h3", { class: `ds-name${stands === false ? " ds-alarm" : ""}` }, said),
      make("p", { class: "ds-sentence" }, data.summary),
      definitions(more),
    ];
  }

  length(...values) {
    const { unit } = this.data;
    const [factor, name] = unit === "m" ? [100, "cm"] : [1, unit];
    return `${values.map((value) => text(factor * value, unit === "units" ? 3 : 1)).join(" × ")} ${name}`;
  }

  cardOf(part) {
    const wedge = part.kind === "wedge";
    const under = part.step === null ? "" : `step ${part.step} of ${this.last}`;
    const cluster = part.cluster === null ? "" : `cluster ${part.cluster}`;
    const rows = [];
    if (part.turn) rows.push(["Turn", make("strong", {}, part.turn)]);
    const [x, y] = part.centroid.map((value) => this.length(value));
    rows.push([wedge ? "Around" : "Middle", this.last ? `${x} from the left end, ${y} above the ground` : `x ${x}, ${y} above the ground`]);
    if (part.beside) rows.push(["Lies", part.beside]);
    if (wedge && part.words) rows.push(["What to do", part.words]);
    rows.push(["Size", this.length(...part.size), true]);
    if (part.side) rows.push(["Placed from", `the ${part.side}`, true]);
    if (part.under !== null) rows.push(["Under", this.links([part.under]), true]);
    if (part.wedges.length) rows.push(["Wedges under it", this.links(part.wedges)]);
    rows.push(...this.touching(part));
    const { alpha_left: left, alpha_right: right } = part;
    if (left !== null || right !== null) rows.push(["α then", `left ${text(left)}, right ${text(right)}`, true]);
    return [
      make("h3", { class: "ds-name" }, make("span", { class: "ds-big" }, String(part.step ?? part.id)), ` ${wedge ? "Wedge" : this.noun} ${part.id}`),
      make("p", { class: "ds-which" }, under, cluster && make("span", { class: "ds-more" }, `${under && " · "}${cluster}`)),
      this.figure(part),
      part.step === null ? null : this.tickBox(part),
      definitions(rows),
      this.indexTable(part),
    ].filter(Boolean);
  }

  tickBox(part) {
    const input = make("input", { type: "checkbox", checked: this.ticks.has(part.step), change: () => this.tick(part, input.checked) });
    return make("label", { class: "ds-tick-box" }, input, part.kind === "wedge" ? " Wedge is in" : " Stone is set");
  }

  touching(part) {
    if (part.step === null) return [["Touches", part.neighbours.length ? this.links(part.neighbours) : "nothing"]];
    const placed = (id) => id === 0 || (this.parts.get(id)?.step ?? Infinity) < part.step;
    const now = part.neighbours.filter(placed);
    const later = part.neighbours.filter((id) => !placed(id));
    const rows = [["Touches", now.length ? this.links(now) : "nothing yet", true]];
    if (later.length) rows.push(["Later also", this.links(later), true]);
    return rows;
  }

  links(ids) {
    return ids.map((id) => {
      const part = this.parts.get(id);
      if (!part) return make("span", { class: "ds-link" }, id === 0 ? "the ground" : String(id));
      const step = part.step === null ? "" : ` (step ${part.step})`;
      const click = () => {
        if (part.step !== null && part.step > this.state.step) {
          this.pause();
          this.show(part.step);
        }
        this.select(part.id);
        this.groups.get(part.id).focus();
      };
      return make("button", { type: "button", class: "ds-link", click }, `${part.kind === "wedge" ? "wedge " : ""}${id}${step}`);
    });
  }

  indexTable(part) {
    const names = Object.keys(part.indices);
    if (!names.length) return null;
    const row = (name) =>
      make("tr", {}, make("th", { scope: "row", title: this.data.index_meanings[name] }, name), make("td", {}, text(part.indices[name])), make("td", { class: "ds-meaning" }, this.data.index_meanings[name] ?? ""));
    return make("details", { class: "ds-indices" }, make("summary", {}, "Indices of this step"), make("table", {}, make("tbody", {}, names.map(row))));
  }

  // The stone as it lies in the source image and as it stands in the wall, at one scale.
  figure(part) {
    const placed = part.points;
    const outline = part.source ? [part.source] : placed;
    const [a, b] = [boxOf(outline.flat()), boxOf(placed.flat())];
    const size = Math.max(a[2] - a[0], a[3] - a[1], 1e-9);
    const perUnit = part.source ? Math.max(...part.size, 1e-9) / size : 1;
    const reach = Math.max((a[2] - a[0]) * perUnit, (a[3] - a[1]) * perUnit, b[2] - b[0], b[3] - b[1]);
    const k = 112 / reach;
    const middle = 8 + 0.5 * Math.max(34, (a[3] - a[1]) * perUnit * k, (b[3] - b[1]) * k);
    const below = 2 * middle + 8;
    const panel = (loops, box, scale, left, label, angle) => {
      const [mx, my] = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
      const x = (value) => left + 64 + (value - mx) * scale;
      const y = (value) => middle - (value - my) * scale;
      const shape = draw("path", { class: crop ? "ds-over" : "ds-alone", d: pathOf(loops, x, y), fill: crop ? "none" : part.colour, "fill-rule": "evenodd" });
      const caption = draw("text", { x: left + 64, y: below, class: "ds-caption" }, label);
      // An inner svg cuts off what of the photograph is beside its field.
      const field = { x: left, y: 0, width: 128, height: below - 12, viewBox: `${left} 0 128 ${below - 12}` };
      const [cx, cy] = middleOf(loops[0]);
      const photo = crop ? draw("svg", field, this.photo(part, crop, k * perUnit, [x(cx), y(cy)], angle)) : null;
      return [photo, shape, caption].filter(Boolean);
    };
    const crop = part.source && part.crop && String(part.crop.data).startsWith("data:image/") ? part.crop : null;
    const frameOf = (wide) => `0 0 ${wide} ${(below + 6).toFixed(1)}`;
    const words = part.turn ? `${this.nameOf(part)}: ${part.turn}` : this.nameOf(part);
    if (!part.source) {
      const only = panel(placed, b, k, 0, part.kind === "wedge" ? "to find or to cut" : "", 0);
      return draw("svg", { class: "ds-figure ds-one", viewBox: frameOf(128), role: "img", "aria-label": words }, ...only);
    }
    return draw(
      "svg",
      { class: "ds-figure", viewBox: frameOf(316), role: "img", "aria-label": words },
      ...panel(outline, a, k * perUnit, 0, "as it lies", 0),
      ...this.arc(part.angle_deg, middle),
      ...panel(placed, b, k, 188, "as it stands", part.angle_deg),
    );
  }

  // The photograph of a stone as it lies, turned by an angle about the middle of its outline.
  photo(part, crop, unit, [cx, cy], angle) {
    const [x0, y0, x1, y1] = crop.box;
    const [fx, fy] = middleOf(part.source);
    const place = { x: cx + (x0 - fx) * unit, y: cy - (y1 - fy) * unit, width: (x1 - x0) * unit, height: (y1 - y0) * unit };
    return draw("image", { ...place, transform: `rotate(${-angle} ${cx} ${cy})`, href: crop.data, preserveAspectRatio: "none" });
  }

  // A dial: from upright by the angle, with the way round.
  arc(degrees, cy) {
    const angle = ((((degrees + 180) % 360) + 360) % 360) - 180;
    const [cx, r] = [158, 17];
    // Nobody turns a stone by less: the words say "as it lies", too.
    if (Math.abs(angle) < 2.5) return [draw("path", { class: "ds-arc", d: `M${cx - 14} ${cy}H${cx + 14}m-6 -5l6 5l-6 5` })];
    const words = draw("text", { class: "ds-caption", x: cx, y: 2 * cy + 8 }, `${Math.abs(angle).toFixed(0)}° ${angle > 0 ? "↺" : "↻"}`);
    const at = (turn) => [cx + r * Math.sin(turn), cy - r * Math.cos(turn)];
    const radians = (-angle * Math.PI) / 180;
    const [ex, ey] = at(radians);
    const hands = [at(0), [ex, ey]].map((end) => lineOf([cx, cy], end, { class: "ds-dial" }));
    // Too short for a head of an arrow: the hands and the words say it.
    if (Math.abs(angle) < 30) return [...hands, words];
    const back = at(radians - Math.sign(radians) * 0.4);
    const way = Math.atan2(ey - back[1], ex - back[0]);
    const wing = (turn) => `${(ex - 8 * Math.cos(way + turn)).toFixed(1)} ${(ey - 8 * Math.sin(way + turn)).toFixed(1)}`;
    const round = `A${r} ${r} 0 0 ${angle > 0 ? 0 : 1} ${ex.toFixed(1)} ${ey.toFixed(1)}`;
    return [
      ...hands, words,
      draw("path", { class: "ds-arc", d: `M${cx} ${cy - r}${round}` }),
      draw("path", { class: "ds-arc", d: `M${wing(0.45)}L${ex.toFixed(1)} ${ey.toFixed(1)}L${wing(-0.45)}` }),
    ];
  }

  // --- the chart ----------------------------------------------------------------------------------

  buildChart() {
    const names = Object.keys(this.data.index_meanings);
    const change = () => {
      this.state.index = pick.value;
      this.drawChart();
    };
    const pick = make("select", { class: "ds-index", change }, make("option", { value: "" }, "none"), names.map((name) => make("option", { value: name }, name)));
    const click = (event) => {
      this.pause();
      this.show(this.stepAt(event.clientX - this.chart.getBoundingClientRect().left));
    };
    this.chart = draw("svg", { class: "ds-chart", role: "img", click });
    this.keyOfChart = make("ul", { class: "ds-legend" });
    const toggle = () => {
      if (table.open && table.children.length === 1) table.append(this.chartTable(names));
    };
    const table = make("details", { class: "ds-as-table", toggle }, make("summary", {}, "The same as a table"));
    return make(
      "section",
      { class: "ds-over-steps", "aria-label": "Load multipliers and indices over the steps" },
      make("div", { class: "ds-chart-head" }, make("h3", {}, "Load multipliers over the steps"), make("label", {}, "with index ", pick)),
      this.chart,
      this.keyOfChart,
      table,
    );
  }

  series() {
    const { data, state } = this;
    const of = (value) => data.parts.map((part) => [part.step, value(part)]).filter((pair) => typeof pair[1] === "number");
    const made = [
      { name: "α left", kind: "left", points: of((part) => part.alpha_left) },
      { name: "α right", kind: "right", points: of((part) => part.alpha_right) },
    ];
    if (state.index) made.push({ name: state.index, kind: "index", points: of((part) => part.indices[state.index]) });
    return made;
  }

  drawChart() {
    const wide = Math.max(260, this.chart.clientWidth || 640);
    const [high, left, right, top, bottom] = [190, 40, 10, 10, 34];
    const series = this.series();
    const values = series.flatMap((one) => one.points.map((p) => p[1]));
    const most = Math.max(0.1, ...values);
    const least = Math.min(0, ...values);
    const tick = [0.05, 0.1, 0.2, 0.5, 1, 2, 5].find((size) => (most - least) / size <= 6) ?? 10;
    const [low, up] = [Math.floor(least / tick + 1e-9) * tick, Math.ceil(most / tick - 1e-9) * tick];
    this.stepX = (step) => left + ((wide - left - right) * (step - 1)) / Math.max(1, this.last - 1);
    this.stepAt = (x) => 1 + Math.round(((x - left) * Math.max(1, this.last - 1)) / (wide - left - right));
    const y = (value) => top + ((high - top - bottom) * (up - value)) / (up - low);
    const shapes = [];
    for (let value = low; value <= up + tick / 2; value += tick) {
      shapes.push(draw("line", { class: "ds-grid", x1: left, x2: wide - right, y1: y(value), y2: y(value) }));
      shapes.push(draw("text", { class: "ds-tick ds-end", x: left - 6, y: y(value) + 4 }, text(value, tick < 0.1 ? 2 : 1)));
    }
    const every = [1, 2, 5, 10, 20, 50, 100, 200, 500].find((size) => this.last / size <= wide / 45) ?? 1000;
    for (let step = every === 1 ? 1 : every; step <= this.last; step += every) {
      shapes.push(draw("text", { class: "ds-tick ds-middle", x: this.stepX(step), y: high - 18 }, String(step)));
    }
    shapes.push(draw("text", { class: "ds-tick ds-middle", x: (left + wide - right) / 2, y: high - 3 }, "step"));
    this.nowLine = draw("line", { class: "ds-now-line", y1: top, y2: high - bottom });
    shapes.push(this.nowLine);
    for (const one of series) {
      const points = one.points.map(([step, value]) => `${this.stepX(step).toFixed(1)},${y(value).toFixed(1)}`).join(" ");
      shapes.push(draw("polyline", { class: `ds-line ds-line-${one.kind}`, points }));
    }
    this.chart.setAttribute("viewBox", `0 0 ${wide} ${high}`);
    this.chart.style.height = `${high}px`;
    const ends = series.map((one) => `${one.name} ends at ${text(one.points[one.points.length - 1]?.[1])}`);
    this.chart.setAttribute("aria-label", `Line chart over ${this.last} steps: ${ends.join(", ")}. The table below has all numbers.`);
    this.chart.replaceChildren(...shapes);
    this.keyOfChart.replaceChildren(...series.map((one) => make("li", {}, sampleOf(draw("polyline", { class: `ds-line ds-line-${one.kind}`, points: "1,7 21,7" })), ` ${one.name}`)));
    this.markChart();
  }

  markChart() {
    if (!this.nowLine) return;
    const x = this.stepX(Math.max(1, this.state.step));
    this.nowLine.setAttribute("x1", x);
    this.nowLine.setAttribute("x2", x);
    this.nowLine.classList.toggle("ds-later", this.state.step === 0);
  }

  chartTable(names) {
    const head = ["Step", "Part", "α left", "α right", ...names];
    const row = (part) =>
      make(
        "tr",
        {},
        make("th", { scope: "row" }, String(part.step)),
        make("td", {}, `${part.kind} ${part.id}`),
        make("td", {}, text(part.alpha_left)),
        make("td", {}, text(part.alpha_right)),
        names.map((name) => make("td", {}, text(part.indices[name]))),
      );
    return make(
      "div",
      { class: "ds-scroll", tabindex: 0, role: "region", "aria-label": "Numbers over the steps" },
      make("table", {}, make("thead", {}, make("tr", {}, head.map((name) => make("th", { scope: "col" }, name)))), make("tbody", {}, this.data.parts.map(row))),
    );
  }

  // --- theme --------------------------------------------------------------------------------------

  nextTheme() {
    const themes = ["auto", "dark", "light"];
    const theme = themes[(themes.indexOf(this.root.dataset.theme) + 1) % themes.length];
    this.root.dataset.theme = theme;
    this.themeButton.textContent = `Theme: ${theme}`;
    this.options.onTheme?.(theme);
  }
}
