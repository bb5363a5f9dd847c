// What a reader does with an image: views, exposure, zoom, wipe, values under the pointer, keys.

const STOP = 0.5; // EV that a key changes

class Viewer extends ComparedImage {
  constructor(image, report) {
    super(image, report);
    this.node = this.build();
    this.resizing = new ResizeObserver(() => this.draw());
    this.resizing.observe(this.frame);
  }

  async load() {
    try {
      await this.showLayer(this.layer);
      this.node.classList.remove("waiting");
      this.node.dataset.ready = "";
      if (!this.hasMode(this.mode)) this.mode = this.hasTest() ? "test" : "reference";
      this.refresh();
    } catch (error) {
      this.tools.remove();
      this.frame.replaceChildren(
        element("p", { class: "missing" }, `This picture cannot be shown: ${error.message || error}`),
      );
    }
  }
  /** Frees the pixels of a picture that is far from the window; load() reads them again, and all settings stay. */
  release() {
    this.values.clear();
    this.linked = null;
    this.canvas.width = this.canvas.height = 1;
    this.node.classList.add("waiting");
    delete this.node.dataset.ready;
  }
  get isReady() {
    return "ready" in this.node.dataset;
  }
  draw() {
    super.draw();
    if (!this.isReady) return;
    this.zoomWords.textContent = `${Number((this.view.zoom * 100).toPrecision(3))} %`;
  }

  // ---- what can be done ----

  setMode(mode) {
    if (!this.hasMode(mode)) return tell(`${MODES[mode].label}: there is none`);
    this.mode = mode;
    this.swapped = false;
    this.refresh();
  }
  setStops(stops) {
    if (!this.coloring() || this.coloring().stops === null) return;
    this.stops = Math.min(Math.max(stops, -12), 12);
    this.refresh();
  }
  setScale(stops) {
    this.scaleStops = Math.min(Math.max(stops, this.leastScale), this.mostScale);
    this.refresh();
  }
  setWipe(share) {
    this.wipe = Math.min(Math.max(share, 0), 1);
    this.refresh();
  }
  async setLayer(label) {
    this.wanted = this.layers.find((layer) => layer.label === label);
    await this.showLayer(this.wanted).catch((error) => tell(`This layer cannot be shown: ${error.message}`));
    if (!this.hasMode(this.mode)) this.mode = this.hasTest() ? "test" : "reference";
    this.refresh();
  }
  zoomBy(steps, screenX, screenY) {
    if (!this.isReady) return;
    const panes = this.panes(),
      pane = panes.find((one) => screenX >= one.left && screenX < one.left + one.width) ?? panes[0];
    this.view.zoomBy(steps, pane, screenX ?? pane.left + pane.width / 2, screenY ?? pane.top + pane.height / 2);
    this.draw();
  }
  showWhole() {
    if (!this.isReady) return;
    this.view.fitted = true;
    this.draw();
  }
  showPixels() {
    if (!this.isReady) return;
    this.view.setZoom(1);
    this.draw();
  }
  /** To the largest difference, close enough to see the pixel. */
  showWorst() {
    if (!this.isReady) return;
    const worst = this.comparisonOf(this.layer)?.max_error;
    if (!worst) return tell("No pixel was compared");
    this.view.setZoom(Math.max(this.view.zoom, 16));
    [this.view.x, this.view.y] = [worst.x + 0.5, worst.y + 0.5];
    this.draw();
    this.tellValues(worst.x, worst.y);
  }
  coloring() {
    return this.layer ? this.values.get(this.layer)?.coloring : null;
  }
  tellValues(x, y) {
    if (!this.layer) return;
    const { reference, test } = this.values.get(this.layer);
    const words = (image) => {
      const values = image && valuesAt(image, x, y);
      return values ? values.map(exact).join("  ") : "none";
    };
    const names = (reference ?? test).channels.map((name) => name.split(".").pop()).join(" ");
    this.readout.textContent = `x ${x}  y ${y}   ${names}   reference ${words(reference)}   test ${words(test)}`;
  }

  // ---- elements ----

  build() {
    const button = (label, title, act, more = {}) =>
      element("button", { type: "button", title, onclick: act, ...more }, label);
    this.modeButtons = Object.entries(MODES).map(([mode, { label, title, key }]) =>
      button(label, `${title} (${key})`, () => this.setMode(mode), { "data-mode": mode }),
    );
    this.canvas = element("canvas", { tabindex: 0, role: "img", "aria-label": this.image.name });
    this.frame = element("div", { class: "frame" }, this.canvas);
    this.zoomWords = element("output", { class: "zoom" });
    this.words = element("span", { class: "quiet" });
    this.exposure = this.slider("Exposure", -12, 12, 0.1, (value) => this.setStops(value));
    this.scale = this.slider("Scale", this.leastScale, this.mostScale, 1, (value) => this.setScale(value));
    this.wiper = this.slider("Wipe", 0, 1, 0.001, (value) => this.setWipe(value));
    this.markBox = element("input", {
      type: "checkbox",
      checked: true,
      onchange: () => {
        this.marks = this.markBox.checked;
        this.draw();
      },
    });
    this.areaBox = element("input", {
      type: "checkbox",
      checked: true,
      onchange: () => {
        this.areas = this.areaBox.checked;
        this.draw();
      },
    });
    this.readout = element("div", { class: "readout", role: "status" });
    this.layerMenu = element(
      "select",
      { "aria-label": "Layer", onchange: () => this.setLayer(this.layerMenu.value) },
      this.layers.map((layer) =>
        element(
          "option",
          { value: layer.label, selected: layer === this.layer },
          `${layer.label} (${layer.role})${layer.equal ? ", same bits" : ""}`,
        ),
      ),
    );
    this.tools = element(
      "div",
      { class: "tools" },
      element("div", { class: "group", role: "group", "aria-label": "View" }, this.modeButtons),
      this.layers.length > 1 ? this.layerMenu : null,
      this.exposure.node,
      this.scale.node,
      this.wiper.node,
      element(
        "div",
        { class: "group", role: "group", "aria-label": "Zoom" },
        button("\u2212", "Smaller (-)", () => this.zoomBy(-1)),
        this.zoomWords,
        button("+", "Larger (+)", () => this.zoomBy(1)),
        button("Fit", "Fit the whole picture (0)", () => this.showWhole()),
        button("1:1", "Zoom to 100 % (1)", () => this.showPixels()),
        this.layer && this.image.comparison
          ? button("Worst", "Go to the largest difference (x)", () => this.showWorst())
          : null,
      ),
      this.layer && this.image.comparison
        ? element("label", { title: "A frame around all pixels that fail (b)" }, this.markBox, "Frame failing pixels")
        : null,
      this.layer && Object.keys(this.image.areas ?? {}).length
        ? element(
            "label",
            { title: "Hatched: left out. Blue: held to limits of its own. (m)" },
            this.areaBox,
            "Show areas",
          )
        : null,
    );
    this.listen();
    return element(
      "div",
      { class: "viewer waiting" },
      this.tools,
      this.frame,
      element("div", { class: "under" }, this.readout, this.words),
    );
  }
  slider(label, min, max, step, act) {
    const input = element("input", {
      type: "range",
      min,
      max,
      step,
      "aria-label": label,
      oninput: () => act(Number(input.value)),
    });
    const output = element("output");
    return { input, output, node: element("label", { class: "slider" }, label, input, output) };
  }
  refresh() {
    if (!this.isReady) return;
    for (const node of this.modeButtons) {
      node.setAttribute("aria-pressed", String(node.dataset.mode === this.mode));
      node.disabled = !this.hasMode(node.dataset.mode);
    }
    const show = (slider, visible, value, words) => {
      slider.node.hidden = !visible;
      slider.input.value = value;
      slider.input.setAttribute("aria-valuetext", (slider.output.textContent = words));
    };
    const coloring = this.coloring(),
      exposes = coloring && coloring.stops !== null && !["difference", "heat_map"].includes(this.mode);
    show(
      this.exposure,
      exposes,
      this.stops ?? 0,
      `${(this.stops ?? 0) >= 0 ? "+" : ""}${(this.stops ?? 0).toFixed(1)} EV`,
    );
    show(
      this.scale,
      this.layer && (this.mode === "all" || this.mode === "difference"),
      this.scaleStops,
      `${short(2 ** this.scaleStops)} \u00d7`,
    );
    show(this.wiper, this.mode === "wipe", this.wipe, `${Math.round(this.wipe * 100)} %`);
    const words = { difference: "|reference \u2212 test| times the scale", heat_map: "dark 0, bright 1" };
    this.words.textContent =
      words[this.mode] ?? (coloring ? coloring.words : "shown from the files next to the page, without exposure and values");
    const shown = this.swapped && this.mode !== "all" ? this.shownKind(this.mode) : this.mode;
    this.canvas.setAttribute("aria-label", `${this.image.name}: ${MODES[shown].title}`);
    this.shape();
    this.draw();
  }
  /** As high as the fitted picture is, and no higher than the window. */
  shape() {
    const panes = this.mode === "all" ? 3 : 1;
    if (this.shapedFor === panes) return; // the user may have drawn the corner since
    this.shapedFor = panes;
    const pane = { left: 0, top: 0, width: (this.frame.clientWidth * devicePixelRatio) / panes, height: Infinity },
      whole = new View(this.view.box);
    whole.fit(pane);
    this.frame.style.height = `${Math.ceil((whole.zoom * whole.box.height) / devicePixelRatio) + 2 * LABEL_HEIGHT}px`;
  }
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [(event.clientX - box.left) * devicePixelRatio, (event.clientY - box.top) * devicePixelRatio];
  }
  listen() {
    const { canvas } = this;
    let grip = null; // "pan" or "wipe"
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !this.isReady) return;
      this.clicked = true;
      const [x] = this.place(event),
        line = this.canvas.width * this.wipe;
      grip = this.mode === "wipe" && Math.abs(x - line) < 12 * devicePixelRatio ? "wipe" : "pan";
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!this.isReady) return;
      const [x, y] = this.place(event),
        pane = this.panes().find((one) => x >= one.left && x < one.left + one.width);
      if (grip === "wipe") this.setWipe(x / canvas.width);
      else if (grip === "pan")
        (this.view.moveBy(event.movementX * devicePixelRatio, event.movementY * devicePixelRatio), this.draw());
      if (!pane) return;
      this.tellValues(...this.view.toFile(pane, x, y));
      this.hover(pane.kind === "test");
    });
    canvas.addEventListener("pointerup", () => (grip = null));
    canvas.addEventListener("pointercancel", () => (grip = null));
    canvas.addEventListener("pointerleave", () => this.hover(false));
    canvas.addEventListener(
      "dblclick",
      () => this.isReady && (this.view.fitted ? this.showPixels() : this.showWhole()),
    );
    // Without Ctrl the wheel scrolls the page, unless the picture was clicked. Trackpads send many small turns.
    let turned = 0;
    const turnOfStep = 50; // CSS pixels; a notch of a wheel has about 100
    canvas.addEventListener(
      "wheel",
      (event) => {
        if (!this.isReady || event.deltaY === 0 || (!event.ctrlKey && !event.metaKey && !this.clicked)) return;
        event.preventDefault();
        turned = Math.sign(turned) === Math.sign(event.deltaY) ? turned + event.deltaY : event.deltaY;
        if (Math.abs(turned) < turnOfStep && event.deltaMode === WheelEvent.DOM_DELTA_PIXEL) return;
        this.zoomBy(turned < 0 ? 1 : -1, ...this.place(event));
        turned = 0;
      },
      { passive: false },
    );
    canvas.addEventListener("blur", () => (this.clicked = false));
  }
  swap() {
    if (!["all", "reference", "test"].includes(this.mode))
      return tell("Space swaps reference and test only where they are shown alone or side by side");
    this.swapped = !this.swapped;
    this.refresh();
  }
  hover(on) {
    if (this.hovered === on) return;
    this.hovered = on;
    this.draw();
  }
  /** Whether the key meant something. */
  key(event) {
    const mode = Object.keys(MODES).find((name) => MODES[name].key === event.key);
    const pan = { ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40] }[event.key];
    const acts = {
      " ": () => this.swap(),
      "[": () => this.setStops((this.stops ?? 0) - STOP),
      "]": () => this.setStops((this.stops ?? 0) + STOP),
      "\\": () => this.setStops(this.coloring()?.stops ?? 0),
      "{": () => this.setScale(this.scaleStops - 1),
      "}": () => this.setScale(this.scaleStops + 1),
      ",": () => this.setWipe(this.wipe - 0.02),
      ".": () => this.setWipe(this.wipe + 0.02),
      "+": () => this.zoomBy(1),
      "=": () => this.zoomBy(1),
      "-": () => this.zoomBy(-1),
      0: () => this.showWhole(),
      1: () => this.showPixels(),
      x: () => this.showWorst(),
      b: () => {
        this.markBox.checked = this.marks = !this.marks;
        this.draw();
      },
      m: () => {
        this.areaBox.checked = this.areas = !this.areas;
        this.draw();
      },
    };
    if (!this.isReady) return false;
    if (mode) this.setMode(mode);
    else if (pan && document.activeElement === this.canvas)
      (this.view.moveBy(...pan.map((step) => step * devicePixelRatio)), this.draw());
    else if (acts[event.key]) acts[event.key]();
    else return false;
    return true;
  }
}
