// How a value goes from one key to the next: a word, or the handles of a cubic Bezier curve as in CSS.
import { element, options } from "./elements.js";

const WORDS = { linear: "linear", smooth: "eased", step: "step" },
  FIRST_CURVE = [0.4, 0, 0.6, 1],
  STEP = 0.05; // of a handle by an arrow key

export const isCurve = Array.isArray;

const bezier = (first, second, s) => 3 * (1 - s) ** 2 * s * first + 3 * (1 - s) * s ** 2 * second + s ** 3;

/** Share of the change at a share of the frames, as the program has it. */
export function shareAt(ease, t) {
  if (ease === "step") return t < 1 ? 0 : 1;
  if (ease === "smooth") return t * t * (3 - 2 * t);
  if (!isCurve(ease)) return t;
  const [x1, y1, x2, y2] = ease;
  let [low, high] = [0, 1];
  for (let i = 0; i < 40; ++i) {
    const middle = (low + high) / 2;
    if (bezier(x1, x2, middle) < t) low = middle;
    else high = middle;
  }
  return bezier(y1, y2, high);
}

/**
 * Lists for all keys and for those from the key at or before the scrubber's frame on. `change(keyed, gesture)` sets the
 * value; `time` is {frame}.
 */
export class EaseChoices {
  constructor({ label, time, change }) {
    Object.assign(this, { time, change });
    this.all = element("select", { "aria-label": `Interpolation of ${label}`, title: "From each key to the next" });
    this.all.addEventListener("change", () => change(this.keyed.withEase(this.#taken(this.all.value))));
    this.own = element("select", {});
    this.own.addEventListener("change", () => {
      const ease = this.own.value === "" ? undefined : this.#taken(this.own.value);
      change(this.keyed.withEaseOf(this.index, ease));
    });
    this.label = label;
    this.nodes = [this.all, this.own];
  }

  #taken(word) {
    if (word !== "curve") return word;
    const now = this.keyed.easeOf(this.index);
    return isCurve(now) ? now : FIRST_CURVE;
  }

  /** `keyed`: a Keyed. */
  show(keyed) {
    this.keyed = keyed;
    this.index = keyed.segmentAt(this.time.frame);
    const own = keyed.keys[this.index]?.ease,
      word = (ease) => (isCurve(ease) ? "curve" : ease),
      entries = [...Object.entries(WORDS), ["curve", "curve"]];
    options(this.all, entries, word(keyed.ease));
    this.own.hidden = keyed.keys.length < 2;
    if (this.own.hidden) return;
    const from = keyed.keys[this.index].frame;
    this.own.setAttribute("aria-label", `Interpolation of ${this.label} from frame ${from}`);
    this.own.title = `From the key at frame ${from} to the next`;
    options(
      this.own,
      [["", `from ${from}: as all`], ...entries.map(([name, text]) => [name, `from ${from}: ${text}`])],
      word(own) ?? "",
    );
  }
}

/**
 * The two handles of a curve over a plot. `place([x, y])` gives the shares of the plot's width and height, from its top
 * left, of shares of the frames and the change; `shares([left, top])` the reverse. `change(handles, gesture)` sets them.
 */
export class EaseHandles {
  #dragged = null;

  constructor({ label, plot, place, shares, change }) {
    Object.assign(this, { label, plot, place, shares, change });
    this.points = ["out of the key", "into the next key"].map((words, i) => this.#handle(words, i));
    this.node = element("div", { class: "handles", hidden: true }, this.points);
  }

  #handle(words, i) {
    const point = element("span", { class: "handle", role: "slider", tabindex: 0, title: `Handle ${words}` });
    point.dataset.words = words;
    point.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      event.stopPropagation();
      point.focus();
      point.setPointerCapture(event.pointerId);
      this.#dragged = `handle ${this.label} ${performance.now()}`;
    });
    point.addEventListener("pointermove", ({ clientX, clientY }) => {
      if (!this.#dragged) return;
      const box = this.plot.getBoundingClientRect();
      this.#set(i, this.shares([(clientX - box.left) / box.width, (clientY - box.top) / box.height]), this.#dragged);
    });
    for (const name of ["pointerup", "pointercancel"]) point.addEventListener(name, () => (this.#dragged = null));
    point.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      const by = STEP * (event.shiftKey ? 4 : 1),
        [dx, dy] = { ArrowLeft: [-by, 0], ArrowRight: [by, 0], ArrowUp: [0, by], ArrowDown: [0, -by] }[event.key] ?? [];
      if (dx === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      this.#set(i, [this.handles[2 * i] + dx, this.handles[2 * i + 1] + dy], `handle keys ${this.label}`);
    });
    return point;
  }

  #set(i, shares, gesture) {
    const inside = shares.map((one) => Number(Math.min(Math.max(one, 0), 1).toFixed(3)));
    if (inside.some((one) => !Number.isFinite(one))) return;
    const next = this.handles.with(2 * i, inside[0]).with(2 * i + 1, inside[1]);
    if (next.join() !== this.handles.join()) this.change(next, gesture);
  }

  /** `ease`: of the segment; one without handles has none to show. */
  show(ease) {
    this.node.hidden = !isCurve(ease);
    if (this.node.hidden) return;
    this.handles = ease;
    this.points.forEach((point, i) => {
      const shares = ease.slice(2 * i, 2 * i + 2),
        [left, top] = this.place(shares),
        [x, y] = shares.map((one) => Math.round(100 * one));
      point.style.left = `${100 * left}%`;
      point.style.top = `${100 * top}%`;
      for (const [name, text] of Object.entries({
        "aria-label": `Handle of ${this.label} ${point.dataset.words}`,
        "aria-valuemin": 0,
        "aria-valuemax": 100,
        "aria-valuenow": y,
        "aria-valuetext": `${y} % of the change after ${x} % of the frames`,
      }))
        point.setAttribute(name, text);
    });
  }

  /** Lines from the keys to the handles, as points of a path in the plot's shares. */
  get lines() {
    if (this.node.hidden) return "";
    const at = (shares) => this.place(shares).join(),
      [x1, y1, x2, y2] = this.handles;
    return `M${at([0, 0])}L${at([x1, y1])}M${at([1, 1])}L${at([x2, y2])}`;
  }
}
