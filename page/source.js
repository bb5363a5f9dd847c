// Values that the program takes from the frame: the depth of an object for a focus, its light for an exposure. And keys of
// such values: a focus that racks from one object to another.
import { button, element, iconButton, options } from "./elements.js";
import { INTERPOLATIONS, keysOf, withKeys } from "./keyed.js";
import { field } from "./number.js";
import { asText, short } from "./values.js";

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
/** {"from": "depth", "object": "Suzanne"} or the same of a point. */
export const isPixelSource = (value) => isObject(value) && (value.from === "depth" || value.from === "luminance");

/** "Suzanne", "point 0.5, 0.25", "6 m" */
function sourceWords(value, { unit = "" }, names) {
  if (!isPixelSource(value)) return typeof value === "number" && unit ? `${short(value)} ${unit}` : asText(value);
  if (value.uv) return `point ${value.uv.map((place) => short(place, 3)).join(", ")}`;
  return [value.object].flat().map(names.words).join(", ");
}

/** What a value of this parameter takes from an object. */
export const sourceOf = ({ unit }, object) => ({ from: unit === "ev" ? "luminance" : "depth", object });

/** The value that the last picture was drawn with, in words. */
const measuredWords = (measured, { unit = "" }) =>
  typeof measured === "number" ? `${short(measured)}${unit && ` ${unit}`}` : "";

/** `measured()` gives the number that the last picture was drawn with. */
export function sourceControl({ label, parameter, commit, measured, objects, describedBy }) {
  const name = element("span", { class: "follows" }),
    number = element("output", { class: "unit now-value", "aria-label": `${label} in this frame` });
  const hold = button("Hold", () => commit(Number(short(measured() ?? parameter.default, 6))), {
    title: "Write the number in place of the object",
    "aria-label": `Hold ${label} at its number`,
    "aria-describedby": describedBy,
  });
  const showFrame = () => {
    number.textContent = measuredWords(measured(), parameter);
    hold.disabled = typeof measured() !== "number";
  };
  return {
    nodes: [element("span", { class: "wide bound" }, name, number, hold)],
    showFrame,
    update({ value }) {
      name.textContent = sourceWords(value, parameter, objects.names);
      name.title = value.from === "luminance" ? "Its light becomes 18 % grey" : "The focus follows its depth";
      showFrame();
    },
  };
}

/** Keys of which some come from the frame: a line for each. */
export function rackControl({ label, parameter, commit, time, measured, objects }) {
  let value = null;
  const lines = element("ul", { class: "rack", "aria-label": `Keys of ${label}` }),
    number = element("output", { class: "unit", "aria-label": `${label} in this frame` }),
    choice = element("select", { "aria-label": `Interpolation of ${label}`, title: "Between two keys" });
  options(
    choice,
    INTERPOLATIONS.map((name) => [name, name === "smooth" ? "eased" : name]),
    "linear",
  );
  choice.addEventListener("change", () => commit({ ...value, interpolation: choice.value }));
  const moved = (keys, i, frame) =>
    withKeys(
      value,
      keys.map(([at, one], k) => [k === i ? frame : at, one]),
    );
  const line = ([frame, one], i, keys) => {
    const at = field({
      label: `${label}, frame of key ${i + 1}`,
      className: "field",
      inputmode: "numeric",
      parse: (text) => {
        const next = Number(text);
        if (!Number.isInteger(next)) return { error: `${text} is not a frame` };
        return keys.some(([other], k) => k !== i && other === next)
          ? { error: `frame ${next} has a key already` }
          : { value: next };
      },
      commit: (next) => commit(moved(keys, i, next)),
    });
    at.show(String(frame));
    const words = sourceWords(one, parameter, objects.names);
    return element(
      "li",
      {},
      element("span", { class: "unit" }, "frame"),
      at.node,
      button(words, () => time.frames.includes(frame) && time.setFrame(frame), {
        class: "follows",
        title: `Go to frame ${frame}`,
        "aria-label": `${words}: go to frame ${frame}`,
      }),
      iconButton("remove", `Remove the key of ${label} at frame ${frame}`, () => {
        const rest = keys.toSpliced(i, 1);
        commit(rest.length ? withKeys(value, rest) : one);
      }),
    );
  };
  const showFrame = () => {
    const now = measuredWords(measured(), parameter);
    number.textContent = now && `${now} at ${time.frame}`;
  };
  let signature = "";
  return {
    nodes: [element("div", { class: "wide" }, lines, element("div", { class: "curve-foot" }, choice, number))],
    isTall: true,
    showFrame,
    update(entry) {
      value = entry.value;
      choice.value = value.interpolation ?? "linear";
      const keys = keysOf(value),
        next = JSON.stringify([keys, keys.map(([, one]) => sourceWords(one, parameter, objects.names))]);
      if (next !== signature) lines.replaceChildren(...keys.map((key, i) => line(key, i, keys)));
      signature = next;
      showFrame();
    },
  };
}
