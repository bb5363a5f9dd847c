// A small curve editor: keys over frames as points that the pointer and the arrow keys move.
import { EaseChoices, EaseHandles } from "./ease.js";
import { element } from "./elements.js";
import { Keyed, numbersOf } from "./keyed.js";
import { field } from "./number.js";
import { isVector, literal, scaleOf, short, typedNumber } from "./values.js";

const SPACE = "http://www.w3.org/2000/svg",
  SAMPLES = 24; // of a stretch between two keys that is not straight

function drawing(name, attributes) {
  const node = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  return node;
}
const clamp = (number, low, high) => Math.min(Math.max(number, low), high);

/** `time`: {frame, frames, setFrame(frame)} of the scrubber. */
export function curveControl({ label, parameter, describedBy, commit, time }) {
  const hasChannels = isVector(parameter.type),
    names = hasChannels
      ? parameter.type === "color"
        ? ["red", "green", "blue"]
        : ["x", "y", "z", "w"].slice(0, parameter.default.length)
      : [""],
    lowest = parameter.min ?? -Infinity,
    highest = parameter.max ?? Infinity,
    scale = scaleOf(parameter);
  let keyed = null,
    isDragged = false,
    gesture = 0,
    low = 0,
    high = 1,
    first = 0,
    last = 1;
  const withUnit = (number) => `${short(number)}${parameter.unit ? ` ${parameter.unit}` : ""}`;
  const nice = (number) => {
    const inside = clamp(number, lowest, highest);
    return parameter.type === "int" ? Math.round(inside) : Number(inside.toPrecision(4));
  };
  const place = (frame, number) => [(frame - first) / (last - first), 1 - (number - low) / (high - low)];

  // ---- what is seen ----

  const lines = names.map((name) => drawing("path", { class: `line ${name}`, "vector-effect": "non-scaling-stroke" })),
    now = drawing("path", { class: "now", "vector-effect": "non-scaling-stroke" }),
    arms = drawing("path", { class: "arms", "vector-effect": "non-scaling-stroke" }),
    picture = drawing("svg", { viewBox: "0 0 1 1", preserveAspectRatio: "none", "aria-hidden": "true" });
  picture.append(now, ...lines, arms);
  const ends = ["most", "least", "begin", "finish"].map((name) =>
      element("span", { class: `end ${name}`, "aria-hidden": "true" }),
    ),
    knots = element("div", { class: "knots" });
  const plot = element(
    "div",
    { class: "curve-plot", role: "group", "aria-label": `Curve of ${label}` },
    picture,
    knots,
  );
  const choices = new EaseChoices({ label, time, change: commit });
  // A stretch's corners in the plot: its two keys, by the first channel.
  const corners = () =>
    [0, 1].map((i) => {
      const { frame, literal } = keyed.keys[choices.index + i];
      return place(frame, numbersOf(literal, parameter.unit)[0]);
    });
  const handles = new EaseHandles({
    label,
    plot,
    place: (shares) => {
      const [a, b] = corners();
      return shares.map((one, axis) => a[axis] + one * (b[axis] - a[axis]));
    },
    // A stretch between equal values is flat: the height of its handles stays.
    shares: (at) => {
      const [a, b] = corners();
      return at.map((one, axis) => (a[axis] === b[axis] ? NaN : (one - a[axis]) / (b[axis] - a[axis])));
    },
    change: (ease, gesture) => take(keyed.withEaseOf(choices.index, ease), gesture),
  });
  plot.append(handles.node);
  const fields = names.map((name, channel) =>
    field({
      label: name ? `${label}, ${name}` : parameter.unit ? `${label}, ${parameter.unit}` : label,
      describedBy,
      inputmode: "decimal",
      parse: (text) => typedNumber(text, parameter, oldLiteral(time.frame, channel)),
      commit: (typed) => commit(withChannel(time.frame, channel, typed)),
      onArrow: (sign, times) => {
        gesture = `keys ${label}`;
        set(time.frame, channel, nudged(keyed.numbersAt(time.frame, parameter)[channel], sign * times), gesture);
      },
    }),
  );
  const moment = element("span", { class: "unit" });
  const node = element(
    "div",
    { class: "wide curve-editor" },
    element("div", { class: "curve-frame" }, plot, ends),
    element(
      "div",
      { class: "curve-foot" },
      choices.nodes,
      moment,
      fields.map((one) => one.node),
      element("span", { class: "unit" }, parameter.unit ?? ""),
    ),
  );

  // ---- changes ----

  /** The literal of a channel at a frame; of a frame without a key, that of the nearest key before or after. */
  function oldLiteral(frame, channel) {
    const { literal: found } = keyed.keys.find((key) => key.frame >= frame) ?? keyed.keys.at(-1);
    return Array.isArray(found) ? found[channel] : found;
  }
  /** The value with a key whose channel is `typed`; the other channels of a new key are those of the curve. */
  function withChannel(frame, channel, typed) {
    const held = keyed.at(frame)?.literal ?? keyed.numbersAt(frame, parameter).map(nice);
    return keyed.withLiteral(frame, hasChannels ? [...held].with(channel, typed) : typed);
  }
  function take(next, name) {
    keyed = new Keyed(next);
    draw();
    commit(next, name);
  }
  function set(frame, channel, number, name) {
    const next = literal(nice(number), parameter, oldLiteral(frame, channel));
    take(withChannel(frame, channel, next), name);
  }
  function nudged(number, by) {
    if (number < scale.low || number > scale.high) return number + (by * (scale.high - scale.low)) / 100;
    const next = scale.value(scale.place(number) + by / 100);
    return parameter.type === "int" && next === number ? number + Math.sign(by) : next;
  }
  /** Keys do not pass each other: a key's point is the same point after each move. */
  function move(index, frame, channel, number, name) {
    const { keys } = keyed,
      { frame: old, literal: whole, ease } = keys[index],
      to = clamp(
        Math.round(frame),
        (keys[index - 1]?.frame ?? -Infinity) + 1,
        (keys[index + 1]?.frame ?? Infinity) - 1,
      ),
      typed = literal(nice(number), parameter, hasChannels ? whole[channel] : whole),
      next = { frame: to, literal: hasChannels ? whole.with(channel, typed) : typed, ease };
    if (to !== old || numbersOf(whole, parameter.unit)[channel] !== nice(number))
      take(keyed.withKeys(keys.with(index, next)), name);
  }
  function remove(index) {
    const isLast = index === keyed.keys.length - 1;
    commit(keyed.without(index)).then?.((isTaken) => {
      if (isTaken && isLast) knots.lastChild?.focus();
    });
  }

  // ---- points ----

  const whereIs = (index, channel) => {
    const { frame, literal: one } = keyed.keys[index];
    return [frame, numbersOf(one, parameter.unit)[channel]];
  };
  let held = null;
  knots.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    // Of points that cover each other, the nearest one.
    const distance = (point) => {
      const box = point.getBoundingClientRect();
      return Math.hypot(box.left + box.width / 2 - event.clientX, box.top + box.height / 2 - event.clientY);
    };
    const all = [...knots.children],
      point = all.reduce((best, one) => (distance(one) < distance(best) ? one : best)),
      at = all.indexOf(point);
    const [index, channel] = [Math.floor(at / names.length), at % names.length];
    point.focus();
    point.setPointerCapture(event.pointerId);
    held = { index, channel, x: event.clientX, y: event.clientY, at: whereIs(index, channel), hasMoved: false };
    gesture = `curve ${label} ${performance.now()}`;
    isDragged = true;
  });
  knots.addEventListener("pointermove", ({ clientX, clientY }) => {
    if (!held) return;
    const box = plot.getBoundingClientRect(),
      [dx, dy] = [clientX - held.x, clientY - held.y],
      [frame, number] = held.at;
    if (!held.hasMoved && Math.hypot(dx, dy) < 3) return;
    held.hasMoved = true;
    move(
      held.index,
      clamp(frame + (dx / box.width) * (last - first), Math.min(first, frame), Math.max(last, frame)),
      held.channel,
      clamp(number - (dy / box.height) * (high - low), low, high),
      gesture,
    );
  });
  for (const name of ["pointerup", "pointercancel"])
    knots.addEventListener(name, () => {
      if (!held) return;
      const [frame] = whereIs(held.index, held.channel);
      if (!held.hasMoved && time.frames.includes(frame)) time.setFrame(frame);
      held = null;
      isDragged = false;
      draw();
    });

  function knot(index, channel) {
    const point = element("span", { class: `knot ${names[channel]}`, role: "slider", tabindex: 0 });
    point.addEventListener("dblclick", (event) => {
      event.stopPropagation();
      remove(index);
    });
    point.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      const times = event.shiftKey ? 10 : 1,
        up = { ArrowUp: times, ArrowDown: -times, PageUp: 10, PageDown: -10 }[event.key],
        right = { ArrowRight: times, ArrowLeft: -times }[event.key],
        [frame, number] = whereIs(index, channel);
      if (up) move(index, frame, channel, nudged(number, up), `keys ${label}`);
      else if (right) move(index, frame + right, channel, number, `keys ${label}`);
      else if (event.key === "Enter" && time.frames.includes(frame)) time.setFrame(frame);
      else if (event.key === "Delete" || event.key === "Backspace") remove(index);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
    return point;
  }
  plot.addEventListener("dblclick", (event) => {
    const box = plot.getBoundingClientRect(),
      frame = Math.round(first + ((event.clientX - box.left) / box.width) * (last - first));
    if (keyed.at(frame)) return;
    set(frame, 0, keyed.numbersAt(frame, parameter)[0], null);
  });

  // ---- drawing ----

  function fitAxes(keys) {
    const numbers = keys.flatMap((key) => numbersOf(key.literal, parameter.unit)).filter(Number.isFinite),
      [least, most] = [Math.min(...numbers), Math.max(...numbers)],
      pad = most > least ? (most - least) / 3 : (scale.high - scale.low) / 8 || 1;
    [low, high] = [clamp(least - pad, lowest, least), clamp(most + pad, most, highest)];
    if (!(high > low)) [low, high] = [low - 1, high + 1];
    const frames = [...time.frames, ...keys.map(({ frame }) => frame)];
    [first, last] = [Math.min(...frames), Math.max(...frames)];
    if (first === last) [first, last] = [first - 1, last + 1];
  }
  function draw() {
    const { keys } = keyed;
    if (!isDragged) fitAxes(keys);
    names.forEach((_, channel) => {
      const points = [[first, keyed.numbersAt(first, parameter)[channel]]];
      keys.forEach(({ frame, literal: one }, i) => {
        const before = keys[i - 1]?.frame,
          ease = keyed.easeOf(i - 1);
        if (i && ease === "step") points.push([frame, points.at(-1)[1]]);
        else if (i && ease !== "linear")
          for (let s = 1; s < SAMPLES; ++s) {
            const at = before + ((frame - before) * s) / SAMPLES;
            points.push([at, keyed.numbersAt(at, { unit: parameter.unit })[channel]]);
          }
        points.push([frame, numbersOf(one, parameter.unit)[channel]]);
      });
      points.push([last, points.at(-1)[1]]);
      lines[channel].setAttribute("d", `M${points.map(([f, n]) => place(f, n).join()).join("L")}`);
    });
    ends.forEach((end, i) => (end.textContent = [withUnit(high), withUnit(low), `frame ${first}`, String(last)][i]));
    const count = keys.length * names.length;
    while (knots.children.length > count) knots.lastChild.remove();
    while (knots.children.length < count) {
      const i = knots.children.length;
      knots.append(knot(Math.floor(i / names.length), i % names.length));
    }
    [...knots.children].forEach((point, i) => {
      const { frame, literal: one } = keys[Math.floor(i / names.length)],
        channel = i % names.length,
        number = numbersOf(one, parameter.unit)[channel],
        [x, y] = place(frame, number),
        words = `${withUnit(number)} at frame ${frame}`;
      point.style.left = `${100 * x}%`;
      point.style.top = `${100 * clamp(y, 0, 1)}%`;
      point.title = words;
      for (const [name, text] of Object.entries({
        "aria-label": `Key of ${label}${names[channel] && `, ${names[channel]}`}, frame ${frame}`,
        "aria-valuenow": number,
        "aria-valuetext": words,
        "aria-valuemin": Math.min(low, number),
        "aria-valuemax": Math.max(high, number),
      }))
        point.setAttribute(name, text);
    });
    showFrame();
  }
  function showFrame() {
    const { frame } = time,
      [x] = place(frame, low);
    now.setAttribute("d", `M${x},0L${x},1`);
    moment.textContent = `at ${frame}`;
    choices.show(keyed);
    handles.show(keyed.keys.length > 1 ? keyed.easeOf(choices.index) : null);
    arms.setAttribute("d", handles.lines);
    keyed.numbersAt(frame, parameter).forEach((number, i) => fields[i]?.show(short(number, 6)));
  }

  return {
    nodes: [node],
    isTall: true,
    showFrame,
    update(entry) {
      if (isDragged) return;
      keyed = new Keyed(entry.value);
      draw();
    },
  };
}
