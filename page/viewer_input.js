// What the pointer and the keys do on the picture: pan, zoom, the probe, the wipe, a pick.

const PAN = 64; // device pixels of a key

export function listenToPointer(viewer) {
  const { canvas, picture, wipe } = viewer;
  let from = null;
  canvas.addEventListener("pointerdown", (event) => {
    from = { x: event.clientX, y: event.clientY, moved: false };
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (from) {
      const [dx, dy] = [event.clientX - from.x, event.clientY - from.y];
      if (from.moved || Math.hypot(dx, dy) > 3) {
        picture.pan(dx * devicePixelRatio, dy * devicePixelRatio);
        viewer.placeWipe();
        from = { x: event.clientX, y: event.clientY, moved: true };
      }
    } else {
      const pixel = picture.pixelAt(event);
      if (pixel) viewer.setProbe(pixel);
    }
  });
  canvas.addEventListener("pointerup", (event) => {
    const pixel = picture.pixelAt(event);
    if (from && !from.moved && pixel) {
      viewer.setProbe(pixel);
      if (viewer.picking) viewer.finishPick(pixel, event.shiftKey);
    }
    from = null;
  });
  canvas.addEventListener("pointercancel", () => (from = null));
  canvas.addEventListener("dblclick", () => picture.fit());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const box = canvas.getBoundingClientRect();
      picture.zoomBy(event.deltaY < 0 ? 1 : -1, [
        (event.clientX - box.left) * devicePixelRatio,
        (event.clientY - box.top) * devicePixelRatio,
      ]);
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => onKey(viewer, event));
  wipe.addEventListener("pointerdown", (event) => wipe.setPointerCapture(event.pointerId));
  wipe.addEventListener("pointermove", (event) => {
    if (!wipe.hasPointerCapture(event.pointerId)) return;
    const x = (event.clientX - canvas.getBoundingClientRect().left) * devicePixelRatio;
    viewer.setWipe((x - picture.corner[0]) / (picture.size[0] * picture.zoom));
  });
  wipe.addEventListener("keydown", (event) => {
    const by = {
      ArrowLeft: -0.02,
      ArrowDown: -0.02,
      ArrowRight: 0.02,
      ArrowUp: 0.02,
      PageDown: -0.1,
      PageUp: 0.1,
      Home: -1,
      End: 1,
    }[event.key];
    if (!by) return;
    event.preventDefault();
    viewer.setWipe(picture.wipe + by);
  });
}

function onKey(viewer, event) {
  const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (event.key === "Enter" && viewer.picking && viewer.picture.probe) viewer.finishPick(viewer.picture.probe, event.shiftKey);
  else if (event.key === "Escape" && viewer.picking) viewer.pick(viewer.picking.node);
  else if (arrow && event.ctrlKey) {
    viewer.picture.pan(-arrow[0] * PAN, -arrow[1] * PAN);
    viewer.placeWipe();
  } else if (arrow && !event.altKey) {
    const by = event.shiftKey ? 10 : 1,
      now = viewer.picture.probe ?? viewer.picture.size.map((side) => Math.floor(side / 2));
    viewer.setProbe(now.map((place, i) => Math.min(Math.max(place + by * arrow[i], 0), viewer.picture.size[i] - 1)));
  } else return;
  event.preventDefault();
  event.stopPropagation();
}
