// A number: a slider over its slider range, and a field that takes any value within its limits.
import { element } from "./elements.js";
import { literal, numberOf, quantity, scaleOf, short, typedNumber } from "./values.js";

const PLACES = 1000; // of a slider
const SCRUB_PX = 300; // of a drag on the number, for the slider's whole range
const REST_MS = 200; // after which a slider counts as let go, where each value costs a compilation

/**
 * A text field that commits on Enter and on leaving, and takes its words back on Escape.
 * `parse(text)` gives {value} or {error}; `commit(value)` resolves to false if the program refuses.
 */
export function field({ label, parse, commit, describedBy, className = "field", inputmode = null, onArrow = null }) {
  const input = element("input", {
    type: "text",
    class: className,
    "aria-label": label,
    "aria-describedby": describedBy,
    autocomplete: "off",
    spellcheck: "false",
    inputmode,
  });
  let shown = "";
  const refuse = (words) => {
    input.setAttribute("aria-invalid", "true");
    input.dispatchEvent(new CustomEvent("refused", { bubbles: true, detail: words }));
  };
  const accept = () => {
    if (input.getAttribute("aria-invalid")) {
      input.removeAttribute("aria-invalid");
      input.dispatchEvent(new CustomEvent("refused", { bubbles: true, detail: null }));
    }
  };
  const finish = async () => {
    if (input.value === shown) return accept();
    const { value, error } = parse(input.value);
    if (error) return refuse(error);
    accept();
    shown = input.value;
    await commit(value);
  };
  input.addEventListener("change", finish);
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter") finish();
    else if (event.key === "Escape" && input.value !== shown) {
      input.value = shown;
      accept();
      event.stopPropagation();
    } else if (onArrow && (event.key === "ArrowUp" || event.key === "ArrowDown") && !event.altKey && !event.ctrlKey) {
      event.preventDefault();
      onArrow(event.key === "ArrowUp" ? 1 : -1, event.shiftKey ? 10 : 1);
    }
  });
  input.addEventListener("focus", () => input.select());
  const show = (text) => {
    const isEdited = document.activeElement === input && input.value !== shown;
    shown = text;
    if (!isEdited) {
      input.value = text;
      accept();
    }
    input.title = text;
  };
  return { node: input, show };
}

/** Dragging sideways on a number changes it; a press without a drag goes into the text. */
function scrubbed(input, { begin, move, end }) {
  input.classList.add("scrub-number");
  input.addEventListener("pointerdown", (event) => {
    // Where the text is edited, a drag selects; a finger scrolls.
    if (document.activeElement === input || event.pointerType === "touch" || event.button !== 0) return;
    event.preventDefault();
    input.setPointerCapture(event.pointerId);
    let begun = null;
    const drag = ({ clientX }) => {
      const px = clientX - event.clientX;
      if (begun === null && Math.abs(px) < 3) return;
      begun ??= begin();
      if (Number.isFinite(begun)) move(begun, px);
    };
    input.addEventListener("pointermove", drag);
    input.addEventListener(
      "lostpointercapture",
      () => {
        input.removeEventListener("pointermove", drag);
        if (begun === null) input.focus();
        else end();
      },
      { once: true },
    );
  });
}

/** {nodes: [slider, field, unit], update(entry)} of a float, int or angle. */
export function numberControl({ label, parameter, describedBy, commit }) {
  const scale = scaleOf(parameter);
  let entry = { effective: parameter.default };
  let gesture = 0;
  let waiting = null; // what a slider that rests will send
  const send = (number, isDrag) => {
    clearTimeout(waiting?.timer);
    const now = () => {
      waiting = null;
      commit(literal(number, parameter, entry.value), isDrag ? `drag ${gesture}` : null);
    };
    if (isDrag && parameter.bind === "define") waiting = { now, timer: setTimeout(now, REST_MS) };
    else now();
  };

  const slider = element("input", {
    type: "range",
    min: 0,
    max: PLACES,
    step: 1,
    "aria-label": label,
    "aria-describedby": describedBy,
  });
  const words = (number) => `${short(number)}${parameter.unit ? ` ${parameter.unit}` : ""}`;
  const paint = (number) => {
    slider.value = Math.round(scale.place(number) * PLACES);
    slider.style.setProperty("--fill", `${scale.place(number) * 100}%`);
    slider.setAttribute("aria-valuetext", words(number));
    slider.classList.toggle("beyond", number < scale.low || number > scale.high);
  };
  let isDragged = false;
  slider.addEventListener("pointerdown", () => {
    isDragged = true;
    gesture = `${label} ${performance.now()}`;
  });
  for (const name of ["pointerup", "pointercancel", "blur"]) slider.addEventListener(name, () => (isDragged = false));
  slider.addEventListener("input", () => {
    const number = scale.value(slider.value / PLACES);
    paint(number);
    typed.show(short(number, 6));
    if (number !== entry.effective) send(number, isDragged);
  });
  slider.addEventListener("change", () => {
    clearTimeout(waiting?.timer);
    waiting?.now();
  });
  // Keys: a hundredth of the range, which for whole numbers is at least 1.
  slider.addEventListener("keydown", (event) => {
    const by = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    if (!by || event.ctrlKey || event.altKey) return;
    event.preventDefault();
    nudge(by);
  });

  const nudge = (by) => {
    const now = numberOf(entry.effective ?? parameter.default, parameter.unit);
    let next = scale.value(Math.min(Math.max(scale.place(now) + by / 100, 0), 1));
    if (parameter.type === "int" && next === now) next = now + Math.sign(by);
    next = Math.min(Math.max(next, parameter.min ?? -Infinity), parameter.max ?? Infinity);
    if (next === now) return;
    entry = { ...entry, effective: next };
    paint(next);
    typed.show(short(next, 6));
    gesture = `keys ${label}`;
    send(next, true);
  };

  const typed = field({
    label: parameter.unit ? `${label}, ${parameter.unit}` : label,
    describedBy,
    inputmode: "decimal",
    parse: (text) => typedNumber(text, parameter, entry.value),
    commit: (value) => commit(value, null),
    onArrow: (sign, times) => nudge(sign * times),
  });
  const unit = element("span", { class: "unit" }, parameter.unit ?? "");
  scrubbed(typed.node, {
    begin() {
      isDragged = true;
      gesture = `${label} ${performance.now()}`;
      return numberOf(entry.effective ?? parameter.default, parameter.unit);
    },
    move(begun, px) {
      const isInside = begun >= scale.low && begun <= scale.high,
        wanted = isInside
          ? scale.value(Math.min(Math.max(scale.place(begun) + px / SCRUB_PX, 0), 1))
          : begun + (px * (scale.high - scale.low)) / SCRUB_PX,
        number = Math.min(Math.max(wanted, parameter.min ?? -Infinity), parameter.max ?? Infinity),
        next = parameter.type === "int" ? Math.round(number) : Number(number.toPrecision(6));
      paint(next);
      typed.show(short(next, 6));
      if (next !== entry.effective) send(next, true);
    },
    end() {
      isDragged = false;
      clearTimeout(waiting?.timer);
      waiting?.now();
    },
  });

  return {
    nodes: [slider, typed.node, unit],
    update(next) {
      entry = next;
      const number = numberOf(next.effective, parameter.unit);
      if (!isDragged && !waiting) {
        paint(number);
        typed.show(short(number, 6));
      }
      const written = typeof next.value === "string" && quantity(next.value)?.unit ? `, written ${next.value}` : "";
      typed.node.title = words(number) + written;
    },
  };
}
