// Files for other people: all frames as images or a video, a still, a sheet of frames, the look.
import { get, pictureBlob, post } from "./api.js";
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

const FORMATS = [
    ["mp4", "MP4 video, H.264"],
    ["mov", "MOV video, ProRes 422 HQ"],
    ["png", "PNG images, 8 bits, for display"],
    ["exr", "EXR images, scene-linear"],
  ],
  POLL_MS = 300;

/** All frames, which the program writes to the look's folder: whole, or not at all. */
class FramesForm {
  #watching = false;
  #isOwn = false; // this page started the export, which may have ended already

  constructor(store) {
    this.store = store;
    this.name = element("input", {
      type: "text",
      class: "field text",
      "aria-label": "Name of the export",
      "aria-describedby": "export-where",
      autocomplete: "off",
      spellcheck: "false",
    });
    this.format = element(
      "select",
      { "aria-label": "Format" },
      FORMATS.map(([value, words]) => element("option", { value }, words)),
    );
    this.start = element("button", { type: "submit", class: "save" }, "Export frames");
    this.cancel = button("Cancel", () => post("/api/export/cancel").catch((error) => this.#fail(error.message)), {
      hidden: true,
    });
    this.where = element("p", { id: "export-where" });
    this.bar = element("progress", { "aria-label": "Exported frames", hidden: true });
    this.words = element("p", { role: "status" });
    this.refusal = element("p", { class: "refusal", role: "alert" });
    this.node = element(
      "form",
      { class: "export-frames" },
      element("div", { class: "line" }, this.name, this.format, this.start, this.cancel),
      this.where,
      this.bar,
      this.words,
      this.refusal,
    );
    this.node.addEventListener("submit", (event) => {
      event.preventDefault();
      this.#start();
    });
  }

  open(name) {
    const { look, capture, read_only } = this.store.state,
      count = capture.frames.length;
    if (!this.#watching) this.name.value = name;
    this.where.textContent = read_only
      ? "The program was started with --read-only: it writes no frames."
      : `${count} ${count === 1 ? "frame" : "frames"} at full size, into ${look.folder}. Images get a folder of this name.` +
        (count && capture.frames.at(-1) - capture.frames[0] >= count ? " Numbers without a frame are left out." : "");
    this.start.disabled = read_only;
    this.#watch();
  }

  #fail(words) {
    this.words.textContent = "";
    this.refusal.textContent = words;
  }

  async #start() {
    this.refusal.textContent = this.words.textContent = "";
    const name = this.name.value.trim();
    if (!name) return this.#fail("Type a name");
    try {
      await post("/api/export/start", { name, format: this.format.value });
      this.#isOwn = true;
      await this.#watch();
    } catch (error) {
      this.#fail(error.message);
    }
  }

  /** Shows how far the export is until it ends, also one that was started before the page was loaded. */
  async #watch() {
    if (this.#watching) return;
    this.#watching = true;
    try {
      for (let wasRunning = false; ; await new Promise((done) => setTimeout(done, POLL_MS))) {
        const wasOwn = this.#isOwn;
        const { runs, name, done, frames, written, fault } = await get("/api/export");
        if (this.#isOwn !== wasOwn) continue; // this answer is older than the start
        const isLeft = !runs && document.activeElement === this.cancel; // a hidden button loses the focus
        this.start.hidden = runs;
        this.cancel.hidden = this.bar.hidden = !runs;
        if (!runs) {
          if (isLeft) this.name.focus();
          const isNews = this.#isOwn || wasRunning;
          this.#isOwn = false;
          if (isNews && fault) this.#fail(`${name}: ${fault}`);
          else if (isNews) this.words.textContent = `Wrote ${written}`;
          break;
        }
        if (!wasRunning) this.cancel.focus();
        wasRunning = true;
        this.bar.max = frames;
        this.bar.value = done;
        this.words.textContent = `${name}: frame ${Math.min(done + 1, frames)} of ${frames}`;
      }
    } catch (error) {
      this.#fail(error.message);
    }
    this.#watching = false;
  }
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
    this.all = new FramesForm(store);
    this.node = element(
      "dialog",
      { class: "export", "aria-label": "Export" },
      element(
        "div",
        { class: "help-head" },
        element("h2", {}, "Export"),
        button("Close", () => this.node.close()),
      ),
      this.all.node,
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
    this.all.open(this.name);
    this.node.showModal();
  }

  /** The page gives one with what is typed and not yet applied. */
  textOfLook = () => this.store.state.text;

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
    download(new Blob([this.textOfLook()], { type: "application/json" }), name);
    return name;
  }
}
