// Values of parameters as text and back.
import { sum } from "./sum.js";

/** At most `digits` significant digits, without trailing zeros. */
export function short(number, digits = 4) {
  if (number === null || number === undefined) return "–";
  if (typeof number !== "number") return String(number);
  if (!Number.isFinite(number)) return Number.isNaN(number) ? "NaN" : number < 0 ? "-inf" : "inf";
  if (number === 0) return "0";
  const text = Number(number.toPrecision(digits));
  return Math.abs(text) >= 1e7 || Math.abs(text) < 1e-4 ? text.toExponential() : String(text);
}

export const isNumeric = (type) => type === "float" || type === "int" || type === "angle";
export const isVector = (type) => /^(color|vec[234])$/.test(type);

const QUANTITY = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([a-z%]*)\s*$/;

/** "85 mm" -> {number: 85, unit: "mm"}, "3" -> {number: 3, unit: ""}, else null. */
export function quantity(text) {
  const found = QUANTITY.exec(text);
  return found && { number: Number(found[1]), unit: found[2] };
}

/**
 * The number for the look, in the way its author writes it: with a unit if `old` has one, else without.
 */
export function literal(number, parameter, old) {
  if (typeof old === "string" && quantity(old)?.unit && parameter.unit) return `${number} ${parameter.unit}`;
  return number;
}

/** {value} of what a person typed for a number, or {error}. A unit other than the declared one is left to the program. */
export function typedNumber(text, parameter, old) {
  const point = text.replaceAll(",", "."),
    found = quantity(point) ?? sum(point);
  if (!found)
    return {
      error: `${text || "nothing"} is not a number${parameter.unit ? `; examples: 2.5, 2.5 ${parameter.unit}, 2+0.5` : ""}`,
    };
  if (found.unit && found.unit !== parameter.unit) return { value: `${found.number} ${found.unit}` };
  const range = outOfRange(found.number, parameter);
  if (range) return { error: range };
  if (parameter.type === "int" && !Number.isInteger(found.number)) return { error: `${text} is not a whole number` };
  return { value: found.unit ? `${found.number} ${parameter.unit}` : literal(found.number, parameter, old) };
}

export function outOfRange(number, { min, max, unit = "" }) {
  if ((min === undefined || number >= min) && (max === undefined || number <= max)) return null;
  return `${short(number)} is outside ${short(min ?? -Infinity, 7)} to ${short(max ?? Infinity, 7)}${unit && ` ${unit}`}`;
}

/** Keys, variables and sources: {"keys": ...}, {"var": ...}, {"from": ...}. */
export const isExpression = (value) =>
  value !== null &&
  typeof value === "object" &&
  !Array.isArray(value) &&
  ("keys" in value || "var" in value || "from" in value);

/** How many of the first unit of its kind one of a unit is. */
const UNITS = [
  { m: 1, um: 1e-6, mm: 1e-3, cm: 0.01, km: 1000, in: 0.0254, ft: 0.3048 },
  { deg: 1, rad: 180 / Math.PI, turn: 360 },
  { s: 1, ms: 1e-3 },
];
/** The number of a value in the parameter's unit, also of one with a unit of its own; NaN of any other. */
export function numberOf(value, unit = "") {
  if (typeof value === "number") return value;
  const found = typeof value === "string" ? quantity(value) : null;
  if (!found) return NaN;
  const kind = UNITS.find((units) => found.unit in units && unit in units);
  return kind ? Number(((found.number * kind[found.unit]) / kind[unit]).toPrecision(12)) : found.number;
}

export const asText = (value) => (typeof value === "string" ? value : (JSON.stringify(value) ?? ""));

/** Text of a field that takes any value: JSON if it is JSON, else the text itself. */
export function fromText(text) {
  const trimmed = text.trim();
  if (!/^[[{"\d-]|^(true|false)$/.test(trimmed)) return trimmed;
  try {
    return JSON.parse(trimmed);
  } catch (error) {
    if (/^[[{]/.test(trimmed)) throw error;
    return trimmed;
  }
}

/** [2, "4-7", "Wheel"] <-> "2, 4-7, Wheel" */
export const objectsText = (list, words = String) => (Array.isArray(list) ? list.map(words).join(", ") : asText(list));
export const objectsFrom = (text) =>
  text
    .split(",")
    .map((one) => one.trim())
    .filter(Boolean)
    .map((one) => (/^\d+$/.test(one) ? Number(one) : one));

/** A slider's place from 0 to 1, and back. Sliders that span a factor of 20 or more are logarithmic. */
export function scaleOf(parameter) {
  const [low, high] = parameter.ui ?? [parameter.min ?? 0, parameter.max ?? 1],
    isLog = low > 0 && high / low >= 20;
  const place = (value) =>
    isLog ? Math.log(Math.max(value, low) / low) / Math.log(high / low) : (value - low) / (high - low);
  const exact = (at) => (isLog ? low * (high / low) ** at : low + (high - low) * at);
  const span = high - low;
  const value = (at) => {
    const raw = exact(at);
    if (parameter.type === "int") return Math.round(raw);
    if (isLog) return Number(raw.toPrecision(3));
    const step = 10 ** Math.floor(Math.log10(span) - 2.3);
    return Number((Math.round(raw / step) * step).toPrecision(10));
  };
  return { low, high, isLog, value, place: (number) => Math.min(Math.max(place(number), 0), 1) };
}

const encode = (light) => (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);
const decode = (byte) => (byte <= 0.04045 ? byte / 12.92 : ((byte + 0.055) / 1.055) ** 2.4);
const hex = (light) =>
  Math.round(255 * encode(Math.min(Math.max(light, 0), 1)))
    .toString(16)
    .padStart(2, "0");
/** Linear light to the colour of a screen, for a swatch. */
export const swatchOf = ([r, g, b]) => `#${hex(r)}${hex(g)}${hex(b)}`;
export const lightOf = (swatch) =>
  [1, 3, 5].map((at) => Number(decode(parseInt(swatch.slice(at, at + 2), 16) / 255).toPrecision(4)));

const WORDS = {
  look: "set in the look",
  preset: "from the preset",
  default: "the effect's default",
  key: "from keys over frames",
  variable: "from a variable",
};
/** Where a value came from: {tag: its sign beside the control, words: a phrase}. */
export function sourceOf(from = "default") {
  if (from.startsWith("capture"))
    return { tag: "capture", words: `from the capture: ${from.replace(/^capture:?\s*/, "")}` };
  const tag = { preset: "preset", key: "keys", variable: "variable" }[from] ?? "";
  return { tag, words: WORDS[from] ?? from };
}

export const milliseconds = (ms) => `${ms < 10 ? ms.toFixed(2) : ms < 100 ? ms.toFixed(1) : Math.round(ms)} ms`;
export const megabytes = (bytes) => `${(bytes / 2 ** 20).toFixed(1)} MiB`;

/** Whether an effect has the texture of the lens with signed radii of circles of confusion. */
export const hasCircles = ({ textures = {}, outputs = {} } = {}) => "coc" in textures || "coc" in outputs;
