// The border between picture and look, which the pointer and the arrow keys move. Its place is kept in the browser.
import { element } from "./elements.js";

const KEY = "aftershade.panel",
  LEAST = 300, // px of the panel with the look
  PICTURE = 320, // px that stay for the picture
  STEP = 16; // px of an arrow key

export function addDivider(work, panel) {
  const node = element("div", {
    class: "divider",
    role: "separator",
    tabindex: 0,
    "aria-orientation": "vertical",
    "aria-label": "Width of the look",
    "aria-controls": panel.id,
    "aria-valuemin": LEAST,
    title: "Drag to resize; double-click for the usual width",
  });
  const most = () => Math.max(LEAST, innerWidth - PICTURE),
    width = () => Math.round(panel.getBoundingClientRect().width);
  const describe = () => {
    node.setAttribute("aria-valuemax", most());
    node.setAttribute("aria-valuenow", width());
  };
  function set(px) {
    if (px === null) work.style.removeProperty("--panel-width");
    else work.style.setProperty("--panel-width", `${Math.round(Math.min(Math.max(px, LEAST), most()))}px`);
    describe();
  }
  function keep() {
    try {
      const px = work.style.getPropertyValue("--panel-width");
      if (px) localStorage.setItem(KEY, parseInt(px, 10));
      else localStorage.removeItem(KEY);
    } catch {
      // Private windows may refuse; the width then lasts as long as the page.
    }
  }
  node.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    node.focus();
    node.setPointerCapture(event.pointerId);
    const grip = event.clientX - panel.getBoundingClientRect().left,
      move = ({ clientX }) => set(innerWidth - clientX + grip);
    node.addEventListener("pointermove", move);
    node.addEventListener(
      "lostpointercapture",
      () => {
        node.removeEventListener("pointermove", move);
        keep();
      },
      { once: true },
    );
  });
  node.addEventListener("keydown", ({ key }) => {
    const by = { ArrowLeft: STEP, ArrowRight: -STEP }[key];
    if (by) set(width() + by);
    else if (key === "Home") set(most());
    else if (key === "End") set(LEAST);
    else return;
    keep();
  });
  node.addEventListener("dblclick", () => {
    set(null);
    keep();
  });
  addEventListener("resize", () => {
    const px = work.style.getPropertyValue("--panel-width");
    set(px ? parseInt(px, 10) : null);
  });
  work.append(node);
  let kept = null;
  try {
    kept = Number(localStorage.getItem(KEY)) || null;
  } catch {
    // As above.
  }
  set(kept);
}
