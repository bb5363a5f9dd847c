// Pictures of one size of pixel, in panes beside each other that move together.

const ZOOMS = [1 / 8, 1 / 4, 1 / 2, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64];

/** The part of the plane of pixels that panes show: its centre, and screen pixels per picture pixel. */
class View {
  constructor(box) {
    this.box = box;
    this.fitted = true;
    this.zoom = 1;
    this.x = box.x + box.width / 2;
    this.y = box.y + box.height / 2;
  }
  fit(pane) {
    const zoom = Math.min(pane.width / this.box.width, pane.height / this.box.height);
    this.fitted = true;
    this.zoom = zoom >= 1 ? Math.floor(zoom) : zoom; // whole factors keep every pixel the same size
    this.x = this.box.x + this.box.width / 2;
    this.y = this.box.y + this.box.height / 2;
  }
  /** Where (x, y) of the file lies; rounded, so that pixels of the picture begin at pixels of the screen. */
  toScreen(pane, x, y) {
    const left = Math.round(pane.left + pane.width / 2 - (this.x - this.box.x) * this.zoom);
    const top = Math.round(pane.top + pane.height / 2 - (this.y - this.box.y) * this.zoom);
    return [left + (x - this.box.x) * this.zoom, top + (y - this.box.y) * this.zoom];
  }
  toFile(pane, screenX, screenY) {
    const [left, top] = this.toScreen(pane, this.box.x, this.box.y);
    return [
      Math.floor((screenX - left) / this.zoom) + this.box.x,
      Math.floor((screenY - top) / this.zoom) + this.box.y,
    ];
  }
  zoomBy(steps, pane, screenX, screenY) {
    const [x, y] = [
      (screenX - pane.left - pane.width / 2) / this.zoom,
      (screenY - pane.top - pane.height / 2) / this.zoom,
    ];
    const above =
      steps > 0 ? ZOOMS.find((zoom) => zoom > this.zoom * 1.001) : ZOOMS.findLast((zoom) => zoom < this.zoom * 0.999);
    this.setZoom(above ?? this.zoom);
    // What lies under the pointer stays there.
    this.x += x - (screenX - pane.left - pane.width / 2) / this.zoom;
    this.y += y - (screenY - pane.top - pane.height / 2) / this.zoom;
    this.keepInside();
  }
  setZoom(zoom) {
    this.fitted = false;
    this.zoom = zoom;
  }
  moveBy(screenX, screenY) {
    this.fitted = false;
    this.x -= screenX / this.zoom;
    this.y -= screenY / this.zoom;
    this.keepInside();
  }
  keepInside() {
    this.x = Math.min(Math.max(this.x, this.box.x), this.box.x + this.box.width);
    this.y = Math.min(Math.max(this.y, this.box.y), this.box.y + this.box.height);
  }
}

function drawPicture(context, view, pane, picture) {
  if (!picture) return;
  const [left, top] = view.toScreen(pane, picture.x, picture.y);
  context.imageSmoothingEnabled = view.zoom < 1;
  context.imageSmoothingQuality = "high";
  context.drawImage(picture.source, left, top, picture.width * view.zoom, picture.height * view.zoom);
}

/** A frame around pixels (x, y) to (x + width, y + height), seen on dark and on bright. */
function drawFrame(context, view, pane, box, color) {
  const [left, top] = view.toScreen(pane, box.x, box.y);
  const [width, height] = [box.width * view.zoom, box.height * view.zoom];
  for (const [line, grow, style] of [
    [4, 2, "rgba(0, 0, 0, 0.6)"],
    [2, 2, color],
  ]) {
    context.lineWidth = line;
    context.strokeStyle = style;
    context.strokeRect(left - grow, top - grow, width + 2 * grow, height + 2 * grow);
  }
}

function within(context, { left, top, width, height }, draw) {
  context.save();
  context.beginPath();
  context.rect(left, top, width, height);
  context.clip();
  draw();
  context.restore();
}

const LABEL_HEIGHT = 20; // CSS pixels

function drawLabel(context, pane, words, ratio) {
  context.font = `${12 * ratio}px system-ui, sans-serif`;
  const padding = 5 * ratio,
    height = LABEL_HEIGHT * ratio,
    width = context.measureText(words).width + 2 * padding;
  context.fillStyle = "rgba(0, 0, 0, 0.65)";
  context.fillRect(pane.left, pane.top, width, height);
  context.fillStyle = "#fff";
  context.textBaseline = "middle";
  context.fillText(words, pane.left + padding, pane.top + height / 2);
}
