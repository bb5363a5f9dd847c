// Files for other people: a still, a sheet of frames, the look.
import { pictureBlob } from "./api.js";
import { button, element, notify } from "./elements.js";

export const MOST_FRAMES = 24; // of a contact sheet
const WIDEST = 4096, // px of a sheet
  LINE = 20, // px of a frame's number
  GAP = 8;

/** Hands a file to the browser's downloads. */
function download(blob, name) {
  const address = URL.createObjectURL(blob),
    link = element("a", { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** At most `count` of the frames, evenly spread, with the first and the last one. */
export function spread(frames, count) {
  if (frames.length <= count) return [...frames];
  return Array.from({ length: count }, (_, i) => frames[Math.round((i * (frames.length - 1)) / (count - 1))]);
}

export class ExportDialog {
  constructor(store, viewer) {
    this.store = store;
    this.viewer = viewer;
    this.words = element("p", { class: "progress", role: "status" });
    const choice = (name, doc, work) => {
      const run = button(name, () => this.run(work));
      return element("div", { class: "choice" }, run, element("p", {}, doc));
    };
    this.sheetDoc = element("span");
    this.node = element(
      "dialog",
      { class: "export", "aria-label": "Export" },
      element(
        "div",
        { class: "help-head" },
        element("h2", {}, "Export"),
        button("Close", () => this.node.close()),
      ),
      element(
        "div",
        { class: "choices" },
        choice("Still", "This frame of the final picture at full size, as PNG.", () => this.still()),
        choice("Contact sheet", [this.sheetDoc], () => this.sheet()),
        choice("Look", "The look as edited, saved or not, as JSON.", () => this.look()),
      ),
      this.words,
    );
    document.body.append(this.node);
  }

  open() {
    const { length } = this.frames;
    this.words.textContent = "";
    this.sheetDoc.textContent = `${length} ${length === 1 ? "frame" : "frames"} of ${this.store.state.capture.frames.length} with their numbers, as PNG.`;
    this.node.showModal();
  }

  get frames() {
    return spread(this.store.state.capture.frames, MOST_FRAMES);
  }
  get name() {
    return this.store.state.look.name.replace(/\.json$/, "");
  }

  async run(work) {
    if (this.isBusy) return;
    this.isBusy = true;
    try {
      const name = await work();
      this.words.textContent = `Downloaded ${name}`;
    } catch (error) {
      this.words.textContent = "";
      notify(error.message, true);
    }
    this.isBusy = false;
  }

  #picture(frame, scale) {
    const { revision } = this.store.state;
    return pictureBlob({ revision, frame, scale, view: "final", exposure: 0, format: "png" });
  }

  async still() {
    const { frame } = this.viewer,
      name = `${this.name}_${String(frame).padStart(4, "0")}.png`;
    this.words.textContent = `Drawing frame ${frame}`;
    download(await this.#picture(frame, 1), name);
    return name;
  }

  /** Rows of frames, each at the largest of the scales 1, 1/2 and 1/4 at which the sheet is not too wide. */
  async sheet() {
    const { frames } = this,
      columns = Math.ceil(Math.sqrt(frames.length)),
      rows = Math.ceil(frames.length / columns),
      { width } = this.store.state.capture,
      scale = [1, 2, 4].find((one) => (columns * width) / one <= WIDEST) ?? 4;
    let context = null,
      cell = null;
    for (const [i, frame] of frames.entries()) {
      this.words.textContent = `Drawing frame ${frame}, ${i + 1} of ${frames.length}`;
      const bitmap = await createImageBitmap(await this.#picture(frame, scale));
      if (!context) {
        cell = [bitmap.width + GAP, bitmap.height + LINE + GAP];
        context = new OffscreenCanvas(columns * cell[0] + GAP, rows * cell[1] + GAP).getContext("2d");
        context.fillStyle = "#1e1e21";
        context.fillRect(0, 0, context.canvas.width, context.canvas.height);
      }
      const [x, y] = [GAP + (i % columns) * cell[0], GAP + Math.floor(i / columns) * cell[1]];
      context.drawImage(bitmap, x, y);
      context.fillStyle = "#c8c8d0";
      context.font = "13px sans-serif";
      context.fillText(String(frame), x + 2, y + bitmap.height + 15);
    }
    const name = `${this.name}_sheet.png`;
    download(await context.canvas.convertToBlob({ type: "image/png" }), name);
    return name;
  }

  async look() {
    const name = `${this.name}.json`;
    download(new Blob([this.store.state.text], { type: "application/json" }), name);
    return name;
  }
}
