// One image of a case: reference, test, difference, heat map, wipe, drawn from what the page holds.

const MODES = {
  all: {
    key: "a",
    label: "All",
    title: "Reference, test and difference beside each other; point at the test to see the reference in its place",
  },
  reference: { key: "r", label: "Reference", title: "The approved image" },
  test: { key: "t", label: "Test", title: "The image that this run made" },
  difference: { key: "d", label: "Difference", title: "|reference \u2212 test| times the scale" },
  heat_map: { key: "h", label: "FLIP", title: "Difference that people see: dark 0, bright 1" },
  wipe: { key: "w", label: "Wipe", title: "Reference left of the line, test right of it" },
};

/** Layers of pictures that lie beside the page: no values, so no exposure. */
async function linkedLayer(image, report) {
  const load = async (path) => {
    if (!path) return null;
    const picture = new Image();
    picture.src = await pictureAddress(report, path);
    await picture.decode();
    return picture;
  };
  const kinds = ["reference", "test", "difference", "heat_map"];
  const pictures = await Promise.all(kinds.map((kind) => load(image.pictures[kind])));
  // Narrow pictures are enlarged by a whole factor, wide ones reduced: all are shown in the size of the first.
  const size = pictures.find(Boolean),
    result = { x: 0, y: 0, width: size.naturalWidth, height: size.naturalHeight };
  kinds.forEach(
    (kind, i) =>
      (result[kind] = pictures[i] && { source: pictures[i], x: 0, y: 0, width: result.width, height: result.height }),
  );
  return result;
}

/** What is to be seen of an image, drawn on `canvas` in `frame`, which its Viewer brings. */
class ComparedImage {
  constructor(image, report) {
    this.image = image;
    this.palette = report.palette;
    this.report = report;
    this.layers = image.shown.layers;
    this.values = new Map(); // layer -> {reference, test, coloring}
    this.layer = this.firstLayer();
    this.mode = this.hasReference() ? (innerWidth < 800 ? "test" : "all") : "test";
    this.swapped = this.hovered = false;
    this.wipe = 0.5;
    this.marks = this.areas = true;
    this.scaleStops = Math.log2(image.pictures.difference_scale || 1);
    [this.leastScale, this.mostScale] = [
      Math.min(0, Math.floor(this.scaleStops)),
      Math.max(20, Math.ceil(this.scaleStops)),
    ];
  }

  comparisonOf(layer) {
    return this.image.comparison?.layers.find((one) => one.layer === layer?.label) ?? null;
  }
  /** The layer of the worst verdict; of equal ones the first with colours. */
  firstLayer() {
    const rank = (layer) => {
      const verdicts = ["same", "warning", "failure", "different size or channels"];
      return 2 * verdicts.indexOf(this.comparisonOf(layer)?.verdict ?? "failure") + ["color", "display"].includes(layer.role);
    };
    return this.layers.reduce((best, layer) => (best && rank(best) >= rank(layer) ? best : layer), null);
  }
  /** FLIP is drawn of one layer. */
  flipLayer() {
    return this.layers.find((layer) => {
      const found = this.comparisonOf(layer);
      return found?.hdr_flip || found?.ldr_flip;
    });
  }
  hasReference() {
    return this.layer ? this.layer.reference !== null : !!this.image.pictures.reference;
  }
  hasTest() {
    return this.layer ? this.layer.test !== null : !!this.image.pictures.test;
  }
  hasMode(mode) {
    const { pictures, shown } = this.image;
    if (mode === "test") return this.hasTest();
    if (!this.hasReference()) return false;
    if (mode === "reference") return true;
    if (!this.hasTest()) return false;
    if (mode === "heat_map")
      return this.layer ? shown.heat_map !== null && this.layer === this.flipLayer() : !!pictures.heat_map;
    return mode !== "difference" || this.layer !== null || !!pictures.difference;
  }

  // ---- what is drawn ----

  /** Reads first, then shows: what is shown meanwhile stays whole, and the last wish counts. */
  async showLayer(layer) {
    this.wanted = layer;
    if (!layer) {
      this.linked = await linkedLayer(this.image, this.report);
      this.view ??= new View(this.linked);
      return;
    }
    const values = this.values.get(layer) ?? (await this.readLayer(layer));
    if (this.wanted !== layer) return;
    this.values.set(layer, values);
    if (this.layer !== layer || this.stops === undefined) this.stops = values.coloring.stops;
    this.layer = layer;
    if (!this.view || JSON.stringify(this.view.box) !== JSON.stringify(values.box)) this.view = new View(values.box);
  }
  async readLayer(layer) {
    const reference = layer.reference && (await readPixels(layer.reference));
    const test = layer.equal ? reference : layer.test && (await readPixels(layer.test));
    const all = [reference, test].filter(Boolean),
      coloring = coloringOf(layer, all, this.palette);
    const x = Math.min(...all.map((one) => one.x)),
      y = Math.min(...all.map((one) => one.y));
    const right = Math.max(...all.map((one) => one.x + one.width)),
      bottom = Math.max(...all.map((one) => one.y + one.height));
    const flip =
      layer === this.flipLayer() && this.image.shown.heat_map !== null ? await this.readHeatMap(layer) : null;
    return {
      reference,
      test,
      coloring,
      heat_map: flip,
      box: { x, y, width: right - x, height: bottom - y },
      pictures: {},
    };
  }
  async readHeatMap(layer) {
    const source = new Image();
    source.src = pngAddress(this.image.shown.heat_map);
    await source.decode();
    const [x, y] = this.comparisonOf(layer).window.min;
    return { source, x, y, width: source.naturalWidth, height: source.naturalHeight };
  }
  /** Drawn once for each exposure or scale. */
  picture(kind) {
    if (!this.layer) return this.linked[kind];
    const values = this.values.get(this.layer);
    if (kind === "heat_map") return values.heat_map;
    const setting = kind === "difference" ? this.scaleStops : (this.stops ?? 0),
      kept = values.pictures[kind];
    if (kept?.setting === setting) return kept.picture;
    let picture = null;
    if (kind === "difference") {
      if (values.reference && values.test)
        picture = differencePictureOf(this.layer, values.reference, values.test, setting);
    } else if (values[kind]) picture = pictureOf(this.layer, values[kind], values.coloring, setting, this.palette);
    values.pictures[kind] = { setting, picture };
    return picture;
  }
  /** Of the areas of the layer; null where it has none. */
  areaPicture() {
    const areas = this.layer && this.image.areas?.[this.layer.label];
    if (!areas) return null;
    const values = this.values.get(this.layer);
    return (values.areas ??= areaPictureOf(areas));
  }
  panes() {
    const { width, height } = this.canvas,
      kinds = this.mode === "all" ? ["reference", "test", "difference"] : [this.mode];
    const gap = Math.round(4 * devicePixelRatio),
      each = Math.floor((width - gap * (kinds.length - 1)) / kinds.length);
    return kinds.map((kind, i) => ({ kind, left: i * (each + gap), top: 0, width: each, height }));
  }
  shownKind(kind) {
    const other = { reference: "test", test: "reference" };
    const swap = (this.swapped && kind in other) !== (this.hovered && this.mode === "all" && kind === "test");
    return swap && this.hasMode(other[kind]) ? other[kind] : kind;
  }
  draw() {
    if (!this.isReady) return;
    const ratio = devicePixelRatio,
      { clientWidth, clientHeight } = this.frame;
    if (clientWidth === 0) return;
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    const context = this.canvas.getContext("2d"),
      panes = this.panes();
    if (this.view.fitted) this.view.fit(panes[0]);
    for (const pane of panes) {
      const kind = this.shownKind(pane.kind);
      within(context, pane, () => {
        if (kind === "wipe") this.drawWipe(context, pane, ratio);
        else drawPicture(context, this.view, pane, this.picture(kind));
        if (this.areas) drawPicture(context, this.view, pane, this.areaPicture());
        if (this.marks) this.drawMarks(context, pane);
        if (kind !== "wipe") drawLabel(context, pane, MODES[kind].label, ratio);
      });
    }
  }
  drawWipe(context, pane, ratio) {
    const line = Math.round(pane.left + pane.width * this.wipe);
    within(context, { ...pane, width: line - pane.left }, () => {
      drawPicture(context, this.view, pane, this.picture("reference"));
      drawLabel(context, pane, MODES.reference.label, ratio);
    });
    within(context, { ...pane, left: line, width: pane.left + pane.width - line }, () => {
      drawPicture(context, this.view, pane, this.picture("test"));
      drawLabel(context, { ...pane, left: line }, MODES.test.label, ratio);
    });
    context.fillStyle = "#fff";
    context.fillRect(line - ratio, pane.top, 2 * ratio, pane.height);
  }
  drawMarks(context, pane) {
    const found = this.comparisonOf(this.layer),
      box = found?.failing?.box;
    if (!box) return;
    const [x, y] = box.min,
      [right, bottom] = box.max;
    drawFrame(context, this.view, pane, { x, y, width: right - x + 1, height: bottom - y + 1 }, "#ffd23f");
    if (this.view.zoom >= 6) drawFrame(context, this.view, pane, { ...found.max_error, width: 1, height: 1 }, "#fff");
  }
}
