// Waveforms of the final picture: for each column, how many of its pixels have which brightness.
import { picture } from "./api.js";
import { element } from "./elements.js";

const LEVELS = 128, // rows of a plot
  COLUMNS = 240; // of luma; a channel of the parade has a third

/** Brightness of a pixel's bytes by the weights of ITU-R BT.709, as the picture stores them. */
const luma = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/** Counts by column and level of `data` (RGBA bytes): a Uint32Array of columns * LEVELS. */
export function countLevels({ data, width, height }, columns, valueOf) {
  const counts = new Uint32Array(columns * LEVELS);
  for (let y = 0, at = 0; y < height; ++y)
    for (let x = 0; x < width; ++x, at += 4) {
      const column = Math.floor((x * columns) / width),
        level = Math.min(LEVELS - 1, Math.floor((valueOf(data, at) * LEVELS) / 256));
      ++counts[column * LEVELS + level];
    }
  return counts;
}

const PLOTS = {
  luma: [{ name: "luma", valueOf: (data, at) => luma(data[at], data[at + 1], data[at + 2]), ink: [1, 1, 1] }],
  parade: [
    { name: "red", valueOf: (data, at) => data[at], ink: [1, 0.36, 0.36] },
    { name: "green", valueOf: (data, at) => data[at + 1], ink: [0.34, 0.86, 0.46] },
    { name: "blue", valueOf: (data, at) => data[at + 2], ink: [0.42, 0.6, 1] },
  ],
};

export class Waveform {
  kind = "luma";

  constructor() {
    this.choice = element(
      "select",
      { "aria-label": "Waveform of" },
      element("option", { value: "luma" }, "luma"),
      element("option", { value: "parade" }, "RGB parade"),
    );
    this.choice.addEventListener("change", () => {
      this.kind = this.choice.value;
      this.draw();
    });
    this.canvas = element("canvas", { role: "img", "aria-label": "Waveform" });
    this.node = element(
      "section",
      { class: "panel", "aria-label": "Waveform" },
      element("h2", {}, "Waveform", this.choice),
      element("div", { class: "plot" }, this.canvas),
    );
  }

  /** `shown`: the viewer's bitmap if that is the final picture as it is, else null: the program then gives it. */
  async load({ revision, frame, shown }) {
    const wanted = (this.wanted = { revision, frame });
    let bitmap = shown;
    try {
      bitmap ??= (await picture({ revision, frame, scale: 1, view: "final", exposure: 0 })).bitmap;
    } catch {
      return; // the viewer says why; a newer picture follows
    }
    if (this.wanted !== wanted) return;
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    this.pixels = context.getImageData(0, 0, bitmap.width, bitmap.height);
    this.draw();
  }

  draw() {
    if (!this.pixels) return;
    const isDark = getComputedStyle(this.canvas).colorScheme === "dark",
      plots = PLOTS[this.kind],
      columns = Math.min(Math.floor(COLUMNS / plots.length), this.pixels.width),
      gap = plots.length > 1 ? 2 : 0;
    this.canvas.width = plots.length * columns + (plots.length - 1) * gap;
    this.canvas.height = LEVELS;
    const context = this.canvas.getContext("2d"),
      image = context.createImageData(this.canvas.width, LEVELS),
      words = [];
    plots.forEach(({ name, valueOf, ink }, i) => {
      const counts = countLevels(this.pixels, columns, valueOf),
        full = (this.pixels.width * this.pixels.height) / columns / 12; // pixels of a level that is drawn at full ink
      let [lowest, highest] = [LEVELS, -1];
      for (let column = 0; column < columns; ++column)
        for (let level = 0; level < LEVELS; ++level) {
          const count = counts[column * LEVELS + level];
          if (!count) continue;
          [lowest, highest] = [Math.min(lowest, level), Math.max(highest, level)];
          const at = 4 * ((LEVELS - 1 - level) * this.canvas.width + i * (columns + gap) + column),
            alpha = 0.25 + 0.75 * Math.min(1, Math.sqrt(count / full));
          for (let channel = 0; channel < 3; ++channel)
            image.data[at + channel] = 255 * ink[channel] * (isDark ? 1 : plots.length > 1 ? 0.72 : 0.15);
          image.data[at + 3] = 255 * alpha;
        }
      const percent = (level) => Math.round((100 * level) / LEVELS);
      words.push(`${name} from ${percent(lowest)} to ${percent(highest + 1)} %`);
    });
    context.putImageData(image, 0, 0);
    context.globalCompositeOperation = "destination-over";
    context.fillStyle = isDark ? "#ffffff1f" : "#0000001f";
    for (let i = 1; i < 4; ++i) context.fillRect(0, (i * LEVELS) / 4, this.canvas.width, 1);
    this.canvas.setAttribute("aria-label", `Waveform: ${words.join(", ")}`);
  }
}
