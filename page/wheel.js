// A colour wheel: the pointer shifts red, green and blue against each other and keeps their mean. The fields beside it do
// the same by keyboard.
import { element } from "./elements.js";

// Directions of red, green and blue, 120 degrees apart, as on a vectorscope's simplest form: red at the top.
const AXES = [90, 210, 330].map((degrees) => [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)]);

const mean = (numbers) => numbers.reduce((sum, one) => sum + one, 0) / numbers.length;

/** The point of three numbers; 1 is a shift of `reach`. */
export function pointOf(numbers, reach) {
  const middle = mean(numbers);
  return [0, 1].map((at) => (2 / 3) * numbers.reduce((sum, one, i) => sum + ((one - middle) / reach) * AXES[i][at], 0));
}

/** Three numbers of the mean of `numbers`, at a point. */
export function numbersAt([x, y], numbers, reach) {
  const middle = mean(numbers);
  return AXES.map(([ax, ay]) => middle + reach * (x * ax + y * ay));
}

/** {node, show(numbers)}. `reach`: the shift at the rim; `change(numbers, gesture)`. */
export function wheel({ label, reach, change }) {
  const dot = element("span", { class: "dot" }),
    node = element("span", { class: "wheel", title: "Drag to shift the colour; double-click for grey" }, dot);
  node.setAttribute("aria-hidden", "true");
  let now = [0, 0, 0],
    begun = now, // where a drag began: its mean stays while limits cut a channel
    gesture = "";
  const place = (event) => {
    const box = node.getBoundingClientRect(),
      x = (2 * (event.clientX - box.left)) / box.width - 1,
      y = 1 - (2 * (event.clientY - box.top)) / box.height,
      length = Math.max(Math.hypot(x, y), 1);
    return [x / length, y / length];
  };
  const drag = (event) => change(numbersAt(place(event), begun, reach), gesture);
  node.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    node.setPointerCapture(event.pointerId);
    begun = now;
    gesture = `wheel ${label} ${performance.now()}`;
    node.addEventListener("pointermove", drag);
    node.addEventListener("lostpointercapture", () => node.removeEventListener("pointermove", drag), { once: true });
  });
  node.addEventListener("dblclick", () => change(numbersAt([0, 0], now, reach), null));
  return {
    node,
    show(numbers) {
      now = numbers;
      const [x, y] = pointOf(numbers, reach),
        length = Math.max(Math.hypot(x, y), 1);
      dot.style.left = `${50 + (50 * x) / length}%`;
      dot.style.top = `${50 - (50 * y) / length}%`;
    },
  };
}
