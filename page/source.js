// Values that the program takes from the frame: the depth of an object for a focus, its light for an exposure. And keys of
// such values: a focus that racks from one object to another.
import { EaseChoices, EaseHandles, isCurve, shareAt } from "./ease.js";
import { button, element, iconButton } from "./elements.js";
import { Keyed } from "./keyed.js";
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

/** Keys of which some come from the frame: a line for each, and a curve where the scrubber's stretch has one. */
export function rackControl({ label, parameter, commit, time, measured, objects }) {
  let keyed = null;
  const lines = element("ul", { class: "rack", "aria-label": `Keys of ${label}` }),
    number = element("output", { class: "unit", "aria-label": `${label} in this frame` }),
    choices = new EaseChoices({ label, time, change: commit }),
    plot = element("div", { class: "curve-plot" }),
    frame = element("div", { class: "curve-frame", hidden: true }, plot);
  const flip = ([x, y]) => [x, 1 - y];
  const handles = new EaseHandles({
    label,
    plot,
    place: flip,
    shares: flip,
    change: (ease, gesture) => commit(keyed.withEaseOf(choices.index, ease), gesture),
  });
  const [picture, line, arms] = ["svg", "path", "path"].map((name) =>
    document.createElementNS("http://www.w3.org/2000/svg", name),
  );
  line.setAttribute("class", "line");
  arms.setAttribute("class", "arms");
  for (const path of [line, arms]) path.setAttribute("vector-effect", "non-scaling-stroke");
  for (const [name, text] of Object.entries({ viewBox: "0 0 1 1", preserveAspectRatio: "none", "aria-hidden": "true" }))
    picture.setAttribute(name, text);
  picture.append(line, arms);
  plot.append(picture, handles.node);
  const moved = (i, at) => keyed.withKeys(keyed.keys.with(i, { ...keyed.keys[i], frame: at }));
  const lineOf = ({ frame, literal }, i, keys) => {
    const at = field({
      label: `${label}, frame of key ${i + 1}`,
      className: "field",
      inputmode: "numeric",
      parse: (text) => {
        const next = Number(text);
        if (!Number.isInteger(next)) return { error: `${text} is not a frame` };
        return keys.some((key, k) => k !== i && key.frame === next)
          ? { error: `frame ${next} has a key already` }
          : { value: next };
      },
      commit: (next) => commit(moved(i, next)),
    });
    at.show(String(frame));
    const words = sourceWords(literal, parameter, objects.names);
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
      iconButton("remove", `Remove the key of ${label} at frame ${frame}`, () => commit(keyed.without(i))),
    );
  };
  const showFrame = () => {
    const now = measuredWords(measured(), parameter);
    number.textContent = now && `${now} at ${time.frame}`;
    if (!keyed) return;
    choices.show(keyed);
    const ease = keyed.keys.length > 1 ? keyed.easeOf(choices.index) : null;
    frame.hidden = !isCurve(ease);
    handles.show(ease);
    if (frame.hidden) return;
    const points = Array.from({ length: 33 }, (_, i) => flip([i / 32, shareAt(ease, i / 32)]).join());
    line.setAttribute("d", `M${points.join("L")}`);
    arms.setAttribute("d", handles.lines);
  };
  let signature = "";
  return {
    nodes: [
      element("div", { class: "wide" }, lines, frame, element("div", { class: "curve-foot" }, choices.nodes, number)),
    ],
    isTall: true,
    showFrame,
    update(entry) {
      keyed = new Keyed(entry.value);
      const { keys } = keyed,
        next = JSON.stringify([keys, keys.map(({ literal }) => sourceWords(literal, parameter, objects.names))]);
      if (next !== signature) lines.replaceChildren(...keys.map((key, i) => lineOf(key, i, keys)));
      signature = next;
      showFrame();
    },
  };
}
