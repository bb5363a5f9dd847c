// What the colours of a view mean, in the viewer's corner.
import { element } from "./elements.js";
import { short } from "./values.js";

const swatch = (color) => {
  const node = element("span", { class: "swatch" });
  node.style.background = color;
  return node;
};

/** The colours of a ramp from near to far, or of a wheel from right over down. */
function drawingOf({ drawing, colors }) {
  if (drawing === "ramp") {
    const node = element("span", { class: "ramp" });
    node.style.background = `linear-gradient(to right, ${colors.join()})`;
    return [element("span", {}, "near"), node, element("span", {}, "far")];
  }
  if (drawing !== "wheel") return [];
  const node = element("span", { class: "motion-wheel", role: "img", "aria-label": "Colours of directions" });
  // CSS begins at the top, and the program's colours on the right.
  node.style.background = `conic-gradient(from 90deg, ${[...colors, colors[0]].join()})`;
  return [node];
}

/** "in front of 5.9 m", "behind 6.8 m" */
function sharpParts([near, far] = []) {
  return [
    element("span", { class: "swatch front" }),
    near === undefined ? "in front" : `in front of ${short(near, 3)} m`,
    element("span", { class: "swatch behind" }),
    far === undefined ? "behind" : `behind ${short(far, 3)} m`,
    near === undefined ? "; nothing is sharp" : "",
  ];
}

export class Legend {
  constructor() {
    this.node = element("span", { class: "legend", role: "status", hidden: true });
  }

  /** `times`: of the picture of that view. */
  show(view, { legend, sharp_m, fault } = {}) {
    const isSharp = view.startsWith("sharp:") && !fault;
    this.node.hidden = !isSharp && !legend;
    if (isSharp) return this.node.replaceChildren(...sharpParts(sharp_m));
    if (!legend) return this.node.replaceChildren();
    this.node.replaceChildren(
      ...drawingOf(legend),
      element("span", {}, legend.words.join("; ")),
      ...legend.faults.flatMap(({ name, color }) => [swatch(color), element("span", {}, name)]),
    );
  }
}
