// What the picture holds and what it costs: the probed pixel, the histogram, times, memory, NaN.
import { get } from "./api.js";
import { element } from "./elements.js";
import { megabytes, milliseconds, short } from "./values.js";

const panel = (title, extra, ...children) =>
  element("section", { class: "panel", "aria-label": title }, element("h2", {}, title, extra), children);

/** Values of all roles at a pixel. One request at a time, the newest pixel next. */
export class Probe {
  constructor() {
    this.place = element("span", { class: "aside" });
    this.body = element("tbody");
    this.node = panel(
      "Pixel",
      this.place,
      element(
        "div",
        { class: "scroll", tabindex: 0, role: "region", "aria-label": "Values of the pixel" },
        element("table", {}, element("caption", { class: "unseen" }, "Values under the probe"), this.body),
      ),
    );
    this.hint = element("p", { class: "empty" }, "Point at the picture, or move the probe with the arrow keys.");
    this.node.append(this.hint);
  }

  async show(pixel, frame) {
    this.next = pixel && { pixel, frame };
    if (this.isBusy || !this.next) return;
    this.isBusy = true;
    while (this.next) {
      const { pixel, frame } = this.next;
      this.last = this.next;
      this.next = null;
      try {
        this.fill(await get("/api/probe", { frame, x: pixel[0], y: pixel[1] }));
      } catch (error) {
        this.place.textContent = error.message;
      }
    }
    this.isBusy = false;
  }
  again(frame) {
    const wanted = this.next ?? this.last; // a pixel that waits its turn is newer than the last one
    if (wanted) this.show(wanted.pixel, frame);
  }

  fill({ x, y, roles, result, objects = [] }) {
    this.hint.hidden = true;
    this.place.textContent = `${x}, ${y}`;
    const row = (name, values, unit, isResult) =>
      element(
        "tr",
        { class: isResult ? "result" : null },
        element("th", { scope: "row" }, name),
        [0, 1, 2, 3].map((i) => element("td", {}, i < values.length ? short(values[i]) : "")),
        element("td", { class: "unit" }, unit ?? ""),
      );
    // The number of an object says less than its name.
    const named = objects.filter(({ name }) => name !== undefined),
      hasName = named.some(({ kind }) => kind === "object");
    const nameRow = ({ kind, name, id }) =>
      element(
        "tr",
        { title: String(id) },
        element("th", { scope: "row" }, kind),
        element("td", { colspan: 4 }, name),
        element("td", { class: "unit" }),
      );
    this.body.replaceChildren(
      ...(result ? [row("final", result, "", true)] : []),
      ...named.map(nameRow),
      ...roles
        .filter(({ name }) => !(hasName && name === "object_id"))
        .map(({ name, values, unit }) => row(name, values, unit)),
    );
  }
}

const CHANNELS = [
  ["r", "#e5484d"],
  ["g", "#3fae5a"],
  ["b", "#4c83ff"],
];

export class Histogram {
  constructor() {
    this.range = element("span", { class: "aside" });
    this.canvas = element("canvas", { role: "img", "aria-label": "Histogram" });
    this.node = panel("Histogram", this.range, element("div", { class: "plot" }, this.canvas));
    new ResizeObserver(() => this.draw()).observe(this.canvas.parentElement);
  }

  async load(frame) {
    try {
      this.data = await get("/api/histogram", { frame });
    } catch (error) {
      this.range.textContent = error.message;
      return;
    }
    const { min, max } = this.data;
    this.range.textContent = `${short(min, 3)} to ${short(max, 3)}`;
    const peak = (bins) => short(min + ((bins.indexOf(Math.max(...bins)) + 0.5) / bins.length) * (max - min), 2);
    const [r, g, b] = CHANNELS.map(([name]) => peak(this.data[name]));
    this.canvas.setAttribute(
      "aria-label",
      `Histogram from ${short(min, 3)} to ${short(max, 3)}; most pixels: red ${r}, green ${g}, blue ${b}`,
    );
    this.draw();
  }

  draw() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!this.data || !clientWidth) return;
    this.canvas.width = clientWidth * devicePixelRatio;
    this.canvas.height = clientHeight * devicePixelRatio;
    const context = this.canvas.getContext("2d"),
      { width, height } = this.canvas;
    // The fullest bins hold flat backgrounds; the plot's top is below them, so that the rest can be seen.
    const all = CHANNELS.flatMap(([name]) => this.data[name]).sort((a, b) => b - a),
      top = Math.max(1, Math.min(all[0], 4 * all[Math.floor(all.length / 16)]));
    const isDark = getComputedStyle(this.canvas).colorScheme === "dark";
    context.strokeStyle = isDark ? "#ffffff1a" : "#0000001a";
    for (let i = 1; i < 4; ++i) {
      context.beginPath();
      context.moveTo(Math.round((i * width) / 4) + 0.5, 0);
      context.lineTo(Math.round((i * width) / 4) + 0.5, height);
      context.stroke();
    }
    context.globalCompositeOperation = isDark ? "screen" : "multiply";
    for (const [name, color] of CHANNELS) {
      const bins = this.data[name];
      context.beginPath();
      context.moveTo(0, height);
      bins.forEach((count, i) =>
        context.lineTo(((i + 0.5) / bins.length) * width, height * (1 - Math.min(Math.sqrt(count / top), 1))),
      );
      context.lineTo(width, height);
      context.fillStyle = isDark ? `${color}b0` : `${color}80`;
      context.fill();
    }
    context.globalCompositeOperation = "source-over";
  }
}

const chip = (words, kind = "", title = null) => element("span", { class: `chip ${kind}`, title }, words);

/** How far the steps' colour is from the truths beside the frame. */
class Truths {
  constructor() {
    this.node = element("div", { class: "truths", role: "group", "aria-label": "Distance from the truth", hidden: true });
  }

  /** Figures of an older call are dropped. */
  async load(frame, truths) {
    this.node.hidden = !truths.length;
    const call = (this.call = {}),
      chips = [];
    for (const truth of truths) {
      try {
        const { psnr_db, flip } = await get("/api/metrics", { frame, truth });
        const psnr = psnr_db === "inf" ? "equal" : `${short(psnr_db, 4)} dB`;
        chips.push(chip(`${truth}: ${psnr}, FLIP ${short(flip, 3)}`, "", `PSNR and mean FLIP of the steps' colour against the truth '${truth}'`));
      } catch (error) {
        chips.push(chip(`${truth}: not compared`, "bad", error.message));
      }
      if (call !== this.call) return;
    }
    this.node.replaceChildren(...chips);
  }
}

export class Costs {
  known = new Map();

  constructor() {
    this.total = element("span", { class: "aside" });
    this.chips = element("div", { class: "chips" });
    this.truths = new Truths();
    this.bars = element("ol", { class: "bars", "aria-label": "Time by pass" });
    this.hint = element("p", { class: "slow", hidden: true });
    this.none = element(
      "p",
      { class: "empty", hidden: true },
      "All steps were cached. The next change shows times.",
    );
    this.node = panel(
      "Cost",
      this.total,
      this.chips,
      this.truths.node,
      this.hint,
      this.none,
      element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Times" }, this.bars),
    );
  }

  /** `steps`: names of the steps that the look has. */
  show(times, isCoarse, steps) {
    if (!times) return;
    const { passes, total_ms, steps_drawn, steps_cached, memory_bytes, gl_objects, non_finite, warnings } = times;
    this.total.textContent = `${milliseconds(total_ms)}${isCoarse ? " at 1/4" : ""}`;
    const counted = (count, what = "step") => `${count} ${what}${count === 1 ? "" : "s"}`;
    this.chips.replaceChildren(
      chip(
        non_finite ? `${non_finite} NaN or infinite` : "no NaN",
        non_finite ? "bad" : "good",
        "Values of the final picture that are NaN or infinite",
      ),
      ...(warnings.length ? [chip(counted(warnings.length, "warning"), "bad", warnings.join("\n"))] : []),
      chip(`${counted(steps_drawn)} drawn`),
      chip(`${counted(steps_cached)} cached`, "", "Steps before the change, whose pictures were kept"),
      chip(megabytes(memory_bytes), "", `Memory of textures and buffers; the program has ${gl_objects} GL objects`),
    );
    if (isCoarse) return;
    // Passes of cached steps keep the time of their last drawing.
    for (const { step, name, ms } of passes) this.known.set(`${step}.${name}`, { step, name, ms });
    for (const [key, { step }] of this.known) if (step && !steps.has(step)) this.known.delete(key);
    const drawn = new Set(passes.map(({ step, name }) => `${step}.${name}`));
    const sorted = [...this.known.values()].sort((a, b) => b.ms - a.ms),
      most = sorted[0]?.ms || 1;
    const sum = sorted.reduce((all, { ms }) => all + ms, 0),
      share = sum > 0 ? most / sum : 0;
    this.hint.hidden = !(sorted.length > 2 && share > 0.5);
    if (!this.hint.hidden)
      this.hint.textContent = `${[sorted[0].step, sorted[0].name].filter(Boolean).join(".")} takes ${Math.round(share * 100)} % of the time.`;
    this.none.hidden = sorted.length > 0;
    this.bars.replaceChildren(
      ...sorted.map(({ step, name, ms }) => {
        const bar = element("span", { class: "bar" });
        bar.style.setProperty("--share", `${(100 * ms) / most}%`);
        return element(
          "li",
          drawn.has(`${step}.${name}`)
            ? {}
            : { class: "cached", title: "Cached; the time is that of its last drawing" },
          element("span", { class: "pass" }, element("span", { class: "of" }, step ? `${step}.` : ""), name),
          bar,
          element("span", { class: "ms" }, milliseconds(ms)),
        );
      }),
    );
  }
}
