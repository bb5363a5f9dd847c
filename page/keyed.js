// Keys over frames as data: {"keys": {"1": 2, "24": "5 m"}, "interpolation": "smooth"}.
import { isNumeric, isVector, numberOf } from "./values.js";

export const INTERPOLATIONS = ["linear", "smooth", "step"];

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
export const isKeyed = (value) => isObject(value) && isObject(value.keys) && Object.keys(value.keys).length > 0;
/** A parameter that is compiled into the shader has no keys. */
export const canBeKeyed = ({ type, bind }) => (isNumeric(type) || isVector(type)) && bind !== "define";

/** [[frame, literal], ...] in the order of the frames. */
export const keysOf = (value) =>
  Object.entries(value.keys)
    .map(([frame, literal]) => [Number(frame), literal])
    .sort(([a], [b]) => a - b);

/** The same form with other keys; what else it holds stays. */
export const withKeys = (value, entries) => ({
  ...value,
  keys: Object.fromEntries([...entries].sort(([a], [b]) => a - b).map(([frame, literal]) => [String(frame), literal])),
});

/** One number for each channel. */
export const numbersOf = (literal, unit) =>
  (Array.isArray(literal) ? literal : [literal]).map((one) => numberOf(one, unit));

/** The channels at a frame, as the program interpolates them. */
export function numbersAt(value, frame, { unit, type }) {
  const keys = keysOf(value),
    next = keys.findIndex(([at]) => at >= frame),
    after = keys.at(next),
    end = numbersOf(after[1], unit);
  if (next <= 0 || after[0] === frame) return end;
  const before = keys[next - 1],
    begin = numbersOf(before[1], unit);
  if (value.interpolation === "step") return begin;
  let t = (frame - before[0]) / (after[0] - before[0]);
  if (value.interpolation === "smooth") t = t * t * (3 - 2 * t);
  const round = type === "int" ? Math.round : (number) => number;
  return begin.map((number, i) => round(number + t * (end[i] - number)));
}

/** Frames with a key, of all values of all steps. */
export function keyedFrames(steps) {
  const found = new Set();
  for (const { params, mix } of steps)
    for (const value of [mix, ...Object.values(params).map((entry) => entry.value)])
      if (isKeyed(value)) for (const [frame] of keysOf(value)) found.add(frame);
  return found;
}
