// The viewer: what is shown, how bright, how large, and which frame.
import { get } from "./api.js";
import { PictureCanvas } from "./canvas.js";
import { button, element, icon, iconButton, notify } from "./elements.js";
import { keyedFrames } from "./keyed.js";
import { Legend } from "./legend.js";
import { field } from "./number.js";
import { Pictures } from "./pictures.js";
import { nameOf } from "./steps.js";
import { hasCircles, quantity, short } from "./values.js";
import { listenToPointer } from "./viewer_input.js";

export class Viewer extends EventTarget {
  view = "final";
  other = "";
  exposure = 0;
  isPlaying = false;
  /** By "step.parameter": numbers that the last picture took from the frame. */
  measured = new Map();

  constructor(store, node) {
    super();
    this.store = store;
    this.pictures = new Pictures();
    this.build(node);
    this.picture = new PictureCanvas(this.canvas);
    this.picture.addEventListener("zoom", () => this.showZoom());
    this.listen();
    listenToPointer(this);
  }

  build(node) {
    this.viewSelect = element("select", { "aria-label": "View", title: "View (V: next, Shift+V: previous)" });
    this.viewSelect.addEventListener("change", () => this.setView(this.viewSelect.value));
    this.otherSelect = element("select", {
      "aria-label": "Compare with",
      title: "Compare with (W: the picture before all steps, on and off)",
    });
    this.otherSelect.addEventListener("change", () => this.setOther(this.otherSelect.value));
    this.exposureSlider = element("input", {
      type: "range",
      min: -8,
      max: 8,
      step: 0.25,
      value: 0,
      "aria-label": "Viewer exposure",
      title: "Exposure of the viewer, which is not saved ([ and ])",
    });
    this.exposureSlider.addEventListener("input", () => this.setExposure(Number(this.exposureSlider.value)));
    this.exposureField = field({
      label: "Viewer exposure, EV",
      parse: (text) => {
        const found = quantity(text);
        return found && Math.abs(found.number) <= 32 ? { value: found.number } : { error: `${text}: -32 to 32 EV` };
      },
      commit: (value) => this.setExposure(value),
    });
    this.zoomWords = element("output", { class: "zoom", "aria-label": "Zoom" }, "");
    this.badge = element("span", { class: "badge", hidden: true });
    this.legend = new Legend();
    this.busy = element("span", { class: "busy", hidden: true }, "drawing");
    const tool = (label, ...nodes) =>
      element("div", { class: "tool" }, element("span", { class: "label" }, label), nodes);
    const tools = element(
      "div",
      { class: "tools" },
      tool("view", this.viewSelect),
      tool(
        "compare",
        this.otherSelect,
        button("Keep", () => this.keep(), { title: "Keep this picture to compare with (K)" }),
      ),
      tool(
        "exposure",
        this.exposureSlider,
        this.exposureField.node,
        element("span", { class: "unit" }, "EV"),
        iconButton("reset", "Reset viewer exposure", () => this.setExposure(0)),
      ),
      element("span", { class: "space" }),
      element(
        "div",
        { class: "tool" },
        button("Fit", () => this.picture.fit(), { title: "Fit the picture (0)" }),
        button("1:1", () => this.picture.zoomTo(1), { title: "Zoom to 100 % (1)" }),
        this.zoomWords,
      ),
    );
    this.canvas = element("canvas", {
      tabindex: 0,
      role: "application",
      "aria-roledescription": "picture",
      "aria-label": "Picture. Arrows move the probe, Ctrl and arrows pan, plus and minus zoom",
    });
    this.wipe = element(
      "div",
      {
        class: "wipe",
        role: "slider",
        tabindex: 0,
        "aria-label": "Wipe",
        "aria-valuemin": 0,
        "aria-valuemax": 100,
        "aria-valuenow": 50,
        hidden: true,
      },
      element("span", { class: "knob" }),
    );
    this.leftName = element("span", { class: "side left", hidden: true });
    this.rightName = element("span", { class: "side right", hidden: true });
    this.stage = element(
      "div",
      { class: "stage" },
      this.canvas,
      this.wipe,
      this.leftName,
      this.rightName,
      element("div", { class: "flags" }, this.legend.node, this.badge, this.busy),
    );

    this.frameSlider = element("input", { type: "range", min: 0, step: 1, "aria-label": "Frame" });
    this.frameSlider.addEventListener("input", () => this.setFrame(this.frames[this.frameSlider.value]));
    this.marks = element("div", { class: "marks", "aria-hidden": "true" });
    this.frameField = field({
      label: "Frame number",
      inputmode: "numeric",
      parse: (text) => (this.frames.includes(Number(text)) ? { value: Number(text) } : { error: `no frame ${text}` }),
      commit: (value) => this.setFrame(value),
    });
    this.playButton = iconButton("play", "Play", () => this.play(), { shortcut: "Space" });
    this.frameCount = element("span", { class: "unit" });
    const frames = element(
      "div",
      { class: "frames", role: "group", "aria-label": "Frames" },
      iconButton("previous", "Previous frame", () => this.stepFrame(-1), { shortcut: "," }),
      this.playButton,
      iconButton("next", "Next frame", () => this.stepFrame(1), { shortcut: "." }),
      element("div", { class: "scrub" }, this.marks, this.frameSlider),
      this.frameField.node,
      this.frameCount,
    );
    node.append(tools, this.stage, frames);
  }

  // ---- what it shows ----

  get frames() {
    return this.store.state.capture.frames;
  }

  update() {
    const { capture, steps } = this.store.state;
    this.picture.setSize(capture.width, capture.height);
    if (!capture.frames.includes(this.frame)) this.frame = capture.frames[0];
    if (capture.path !== this.capture) this.pictures.forgetOther();
    this.capture = capture.path;
    this.frameSlider.max = Math.max(0, capture.frames.length - 1);
    this.frameSlider.disabled = capture.frames.length < 2;
    this.frameCount.textContent = `of ${capture.frames[0]} to ${capture.frames.at(-1)}`;
    this.keyed = keyedFrames(steps);
    this.markKeys();
    const taps = steps.flatMap((step) => {
      const { outputs = {}, textures = {} } = this.store.effects.get(step.effect) ?? {},
        name = nameOf(step);
      return [...new Set([...Object.keys(outputs), ...Object.keys(textures)])].map((image) => `tap:${name}.${image}`);
    });
    const truths = [...new Set(Object.values(capture.truths).flat())],
      roles = capture.roles.map(({ name }) => `role:${name}`);
    const drawn = steps.filter(({ enabled }) => enabled),
      lenses = drawn.filter(({ effect }) => hasCircles(this.store.effects.get(effect)));
    const groups = [
      ["Picture", ["final", "before"]],
      ["Picture before a step", drawn.slice(1).flatMap((step) => (step.effect ? [`before:${nameOf(step)}`] : []))],
      ["Limits of sharpness", lenses.map((step) => `sharp:${nameOf(step)}`)],
      ["Truth", truths.flatMap((name) => [`truth:${name}`, `difference:${name}`])],
      ["Roles of the capture", roles],
      ["Taps", taps],
    ];
    const signature = JSON.stringify(groups);
    if (signature !== this.signature) {
      this.signature = signature;
      this.views = groups.flatMap(([, names]) => names);
      const group = ([label, names]) =>
        element(
          "optgroup",
          { label },
          names.map((name) => element("option", { value: name }, this.words(name))),
        );
      this.viewSelect.replaceChildren(...groups.filter(([, names]) => names.length).map(group));
      this.otherSelect.replaceChildren(
        element("option", { value: "" }, "nothing"),
        element("option", { value: "kept" }, "kept picture"),
        ...groups.filter(([, names]) => names.length).map(group),
      );
      if (!this.views.includes(this.view)) this.view = "final";
      if (this.other !== "kept" && !this.views.includes(this.other)) [this.other, this.picture.second] = ["", null];
    }
    this.refresh();
  }

  /** Marks the frames with keys at their places of the scrubber. */
  markKeys() {
    const wanted = this.frames.flatMap((frame, i) =>
      this.keyed.has(frame) ? [i / Math.max(1, this.frames.length - 1)] : [],
    );
    while (this.marks.children.length > wanted.length) this.marks.lastChild.remove();
    while (this.marks.children.length < wanted.length) this.marks.append(element("span"));
    wanted.forEach((share, i) => (this.marks.children[i].style.left = `${100 * share}%`));
  }

  words = (view) =>
    ({ final: "final", before: "before (no steps)" })[view] ??
    view
      .replace(/^difference:/, "difference to ")
      .replace(/^sharp:/, "sharp by ")
      .replace(/^before:/, "before ")
      .replace(/^\w+:/, "");

  refresh() {
    this.viewSelect.value = this.view;
    this.otherSelect.value = this.other;
    this.exposureSlider.value = this.exposure;
    this.exposureField.show(this.exposure.toFixed(2).replace(/\.?0+$/, ""));
    const at = this.frames.indexOf(this.frame);
    this.frameSlider.value = at;
    this.frameSlider.setAttribute(
      "aria-valuetext",
      `frame ${this.frame}${this.keyed.has(this.frame) ? ", keyed" : ""}`,
    );
    this.frameSlider.style.setProperty("--fill", `${(100 * at) / Math.max(1, this.frames.length - 1)}%`);
    this.exposureSlider.style.setProperty("--fill", `${(100 * (this.exposure + 8)) / 16}%`);
    this.frameField.show(String(this.frame));
    this.placeWipe();
    const { revision, has_picture, is_capture_alone } = this.store.state;
    if (!has_picture) return this.setBadge("no picture yet: the look has faults");
    if (this.store.hasFaults)
      this.setBadge(`${is_capture_alone ? "capture without steps" : "last good picture"}: the look has faults`);
    this.pictures.want({
      revision,
      frame: this.frame,
      view: this.view,
      other: this.other,
      exposure: this.exposure,
      continues: this.isPlaying,
    });
  }

  setView(view) {
    this.view = view;
    this.refresh();
  }
  nextView(by) {
    const at = this.views.indexOf(this.view);
    this.setView(this.views.at((at + by) % this.views.length));
    notify(`View: ${this.words(this.view)}`);
  }
  setOther(view) {
    if (view === "kept" && !this.kept) this.keep();
    this.other = view;
    this.picture.second = view === "kept" ? this.kept : null;
    this.pictures.forgetOther();
    this.picture.draw();
    this.refresh();
  }
  /** Keeps the picture, so that another setting can be compared with it. */
  keep() {
    if (!this.picture.first) return;
    this.kept = this.picture.first;
    notify("Kept: compare with “kept picture”");
    if (this.other !== "kept") this.setOther("kept");
    else {
      this.picture.second = this.kept;
      this.picture.draw();
    }
  }
  setExposure(stops) {
    this.exposure = Math.min(Math.max(stops, -32), 32);
    this.refresh();
  }
  setFrame(frame) {
    if (frame === undefined || frame === this.frame) return;
    this.frame = frame;
    this.refresh();
    this.dispatchEvent(new Event("frame"));
  }
  stepFrame(by) {
    const { frames } = this,
      at = frames.indexOf(this.frame);
    this.setFrame(frames[(at + by + frames.length) % frames.length]);
  }
  swap(isSwapped) {
    this.picture.isSwapped = isSwapped;
    this.picture.draw();
    this.placeWipe();
  }

  /** Frame after frame, each drawn in full behind the one before it, so that effects with history see them in order. */
  async play() {
    this.isPlaying = !this.isPlaying;
    this.playButton.replaceChildren(icon(this.isPlaying ? "pause" : "play"));
    this.playButton.setAttribute("aria-label", this.isPlaying ? "Pause" : "Play");
    while (this.isPlaying) {
      const begun = performance.now();
      this.stepFrame(1);
      await this.pictures.settled();
      await new Promise((resolve) =>
        setTimeout(resolve, Math.max(10, 1000 / (this.store.state.capture.fps || 24) - (performance.now() - begun))),
      );
    }
  }

  /** What a picture's times say of the frame: values from it, and what its colours mean. */
  setMeasured(times) {
    this.measured = new Map((times?.measured ?? []).map(({ step, param, value }) => [`${step}.${param}`, value]));
    this.legend.show(this.view, times ?? {});
  }
  setBadge(words, isError = true) {
    this.badge.textContent = words;
    this.badge.hidden = !words;
    this.badge.classList.toggle("error", isError);
  }
  showZoom() {
    this.zoomWords.textContent = `${short(this.picture.zoom * 100, 3)} %`;
    this.placeWipe();
  }
  placeWipe() {
    const isShown = this.other !== "" && !this.picture.isSwapped,
      isOther = this.other !== "" && this.picture.isSwapped;
    this.wipe.hidden = !isShown;
    this.leftName.hidden = !isShown;
    this.rightName.hidden = !isShown && !isOther;
    this.wipe.style.left = `${this.picture.wipeX / devicePixelRatio}px`;
    this.wipe.setAttribute("aria-valuenow", Math.round(this.picture.wipe * 100));
    this.leftName.textContent = this.words(this.view);
    this.rightName.textContent = this.other === "kept" ? "kept picture" : this.words(this.other);
  }
  setWipe(place) {
    this.picture.wipe = Math.min(Math.max(place, 0), 1);
    this.picture.draw();
    this.placeWipe();
  }

  // ---- events ----

  listen() {
    const { pictures } = this;
    pictures.addEventListener("busy", () => (this.busy.hidden = false));
    pictures.addEventListener("idle", () => (this.busy.hidden = true));
    pictures.addEventListener("fail", ({ detail }) => {
      const [first, ...rest] = detail.message.split("\n"); // a shader's tab lists all of its faults
      this.setBadge(rest.length ? `${first} (and ${rest.length} more)` : first);
      if (detail.status === 0 && this.isPlaying) this.play(); // the program is gone: it pauses
      this.dispatchEvent(new CustomEvent("fail", { detail }));
    });
    pictures.addEventListener("picture", ({ detail }) => {
      if (detail.name === "second" && this.other !== detail.wish.other) return;
      this.picture[detail.name] = { bitmap: detail.bitmap, isCoarse: detail.isCoarse };
      this.picture.draw();
      if (detail.name === "first") {
        const fault = detail.times?.fault;
        // The step has the message.
        if (fault)
          this.setBadge(
            `capture without steps: ${fault.step ? `this frame lacks what ${fault.step} needs` : fault.message}`,
          );
        else if (!this.store.hasFaults) this.setBadge(detail.isCoarse ? "1/4" : "", false);
        this.canvas.dataset.revision = detail.wish.revision;
        this.canvas.dataset.scale = detail.isCoarse ? 4 : 1;
        this.dispatchEvent(new CustomEvent("picture", { detail }));
      }
    });
  }

  /** The next click in the picture gives `take(pixel's values)`; a second call ends it. */
  pick(node, take) {
    const isSame = this.picking?.node === node;
    this.picking?.node.setAttribute("aria-pressed", "false");
    this.picking = isSame ? null : { node, take };
    node.setAttribute("aria-pressed", String(!isSame));
    this.stage.classList.toggle("picking", !isSame);
    if (!isSame) {
      notify("Click in the picture, or move the probe with the arrows and press Enter");
      this.canvas.focus();
    }
  }
  /** With Shift, what is picked is the point and not the object at it. */
  async finishPick(pixel, isPoint) {
    const { node, take } = this.picking;
    this.pick(node, take);
    try {
      take({ ...(await get("/api/probe", { frame: this.frame, x: pixel[0], y: pixel[1] })), isPoint });
      node.focus();
    } catch (error) {
      notify(error.message, true);
    }
  }

  setProbe(pixel) {
    this.picture.probe = pixel;
    this.picture.draw();
    this.dispatchEvent(new CustomEvent("probe", { detail: pixel }));
  }
}
