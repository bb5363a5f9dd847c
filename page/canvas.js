// The picture on the canvas: zoom that keeps pixels, pan, wipe between two pictures, the probed pixel.

const LEAST_ZOOM = 1 / 16,
  MOST_ZOOM = 64,
  OUTLINE_ZOOM = 6; // from which the probed pixel is framed

export class PictureCanvas extends EventTarget {
  /** {bitmap, isCoarse} of the picture, and of the one to compare with. */
  first = null;
  second = null;
  size = [1, 1];
  zoom = 1; // device pixels for a pixel of the picture
  center = [0.5, 0.5]; // place of the picture in the middle of the canvas
  isFit = true;
  wipe = 0.5;
  isSwapped = false;
  probe = null;

  constructor(canvas) {
    super();
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    this.canvas.width = Math.max(1, Math.round(clientWidth * devicePixelRatio));
    this.canvas.height = Math.max(1, Math.round(clientHeight * devicePixelRatio));
    if (this.isFit) this.fit();
    else this.draw();
  }

  setSize(width, height) {
    if (width === this.size[0] && height === this.size[1]) return;
    this.size = [width, height];
    if (this.isFit) this.fit();
  }

  fit() {
    const [width, height] = this.size;
    this.isFit = true;
    this.center = [width / 2, height / 2];
    this.setZoom(Math.min(this.canvas.width / width, this.canvas.height / height));
  }

  setZoom(zoom) {
    this.zoom = Math.min(Math.max(zoom, LEAST_ZOOM), MOST_ZOOM);
    this.draw();
    this.dispatchEvent(new Event("zoom"));
  }

  /** To the next power of two (or half of one), around a place of the canvas in device pixels. */
  zoomBy(direction, at = [this.canvas.width / 2, this.canvas.height / 2]) {
    const stops = 2 * Math.log2(this.zoom),
      next = 2 ** ((direction > 0 ? Math.floor(stops + 1.001) : Math.ceil(stops - 1.001)) / 2);
    this.zoomTo(Math.min(Math.max(next, LEAST_ZOOM), MOST_ZOOM), at);
  }
  zoomTo(zoom, at = [this.canvas.width / 2, this.canvas.height / 2]) {
    const [x, y] = this.placeOf(at);
    this.isFit = false;
    this.zoom = zoom;
    this.center = [x - (at[0] - this.canvas.width / 2) / zoom, y - (at[1] - this.canvas.height / 2) / zoom];
    this.setZoom(zoom);
  }

  pan(dx, dy) {
    this.isFit = false;
    const clamp = (value, most) => Math.min(Math.max(value, 0), most);
    this.center = [
      clamp(this.center[0] - dx / this.zoom, this.size[0]),
      clamp(this.center[1] - dy / this.zoom, this.size[1]),
    ];
    this.draw();
  }

  /** Corner of the picture on the canvas: a whole device pixel, so that no pixel of the picture is cut. */
  get corner() {
    return [
      Math.round(this.canvas.width / 2 - this.center[0] * this.zoom),
      Math.round(this.canvas.height / 2 - this.center[1] * this.zoom),
    ];
  }
  placeOf([x, y]) {
    const [left, top] = this.corner;
    return [(x - left) / this.zoom, (y - top) / this.zoom];
  }
  /** Pixel of the picture under a pointer event; null beside the picture. */
  pixelAt(event) {
    const box = this.canvas.getBoundingClientRect(),
      place = this.placeOf([
        (event.clientX - box.left) * devicePixelRatio,
        (event.clientY - box.top) * devicePixelRatio,
      ]),
      pixel = place.map(Math.floor);
    return pixel[0] >= 0 && pixel[1] >= 0 && pixel[0] < this.size[0] && pixel[1] < this.size[1] ? pixel : null;
  }
  /** Place of the wipe from the canvas's left edge, device pixels. */
  get wipeX() {
    return this.corner[0] + this.wipe * this.size[0] * this.zoom;
  }

  draw() {
    cancelAnimationFrame(this.waiting);
    this.waiting = requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    const { canvas, context } = this;
    context.clearRect(0, 0, canvas.width, canvas.height);
    const both = this.second && this.first;
    const shown = this.isSwapped && this.second ? this.second : this.first;
    if (shown) this.paint(shown);
    if (both && !this.isSwapped) {
      context.save();
      context.beginPath();
      context.rect(this.wipeX, 0, canvas.width, canvas.height);
      context.clip();
      const [left, top] = this.corner;
      context.clearRect(left, top, this.size[0] * this.zoom, this.size[1] * this.zoom);
      this.paint(this.second);
      context.restore();
      const x = Math.round(this.wipeX);
      context.fillStyle = "#000a";
      context.fillRect(x - 2, 0, 4, canvas.height);
      context.fillStyle = "#fff";
      context.fillRect(x - 1, 0, 2, canvas.height);
    }
    if (this.probe) this.outline();
  }

  paint({ bitmap, isCoarse }) {
    const { context, zoom } = this,
      [left, top] = this.corner;
    context.imageSmoothingEnabled = isCoarse || zoom < 1;
    context.imageSmoothingQuality = "high";
    context.drawImage(bitmap, left, top, Math.round(this.size[0] * zoom), Math.round(this.size[1] * zoom));
  }

  outline() {
    const { context, zoom } = this,
      [left, top] = this.corner,
      [x, y] = this.probe,
      size = Math.max(zoom, OUTLINE_ZOOM),
      at = [left + (x + 0.5) * zoom - size / 2, top + (y + 0.5) * zoom - size / 2];
    context.lineWidth = 1;
    context.strokeStyle = "#000";
    context.strokeRect(Math.round(at[0]) - 1.5, Math.round(at[1]) - 1.5, Math.round(size) + 3, Math.round(size) + 3);
    context.strokeStyle = "#fff";
    context.strokeRect(Math.round(at[0]) - 0.5, Math.round(at[1]) - 0.5, Math.round(size) + 1, Math.round(size) + 1);
  }
}
