// Keys over frames as data: {"keys": {"1": 2, "24": {"value": "5 m", "interpolation": "step"}}, "interpolation": "smooth"}.
import { shareAt } from "./ease.js";
import { isNumeric, isVector, numberOf } from "./values.js";

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
export const isKeyed = (value) => isObject(value) && isObject(value.keys) && Object.keys(value.keys).length > 0;
/** A parameter that is compiled into the shader has no keys. */
export const canBeKeyed = ({ type, bind }) => (isNumeric(type) || isVector(type)) && bind !== "define";

/** One number for each channel. */
export const numbersOf = (literal, unit) =>
  (Array.isArray(literal) ? literal : [literal]).map((one) => numberOf(one, unit));

/** A value by keys. It does not change: each change gives what the look then holds. */
export class Keyed {
  constructor(value) {
    this.value = value;
    /** [{frame, literal, ease}] in the order of the frames; without an ease of its own, a key has that of all. */
    this.keys = Object.entries(value.keys)
      .map(([frame, key]) =>
        isObject(key) && "value" in key
          ? { frame: Number(frame), literal: key.value, ease: key.interpolation }
          : { frame: Number(frame), literal: key },
      )
      .sort((a, b) => a.frame - b.frame);
  }
  get ease() {
    return this.value.interpolation ?? "linear";
  }
  /** From the key of that index to the next. */
  easeOf(index) {
    return this.keys[index]?.ease ?? this.ease;
  }
  at(frame) {
    return this.keys.find((key) => key.frame === frame);
  }
  /** Index of the key that the stretch around a frame begins with; the first or the last stretch beside all. */
  segmentAt(frame) {
    const before = this.keys.findLastIndex((key) => key.frame <= frame);
    return Math.min(Math.max(before, 0), Math.max(this.keys.length - 2, 0));
  }

  /** What the look holds with these keys. */
  withKeys(keys) {
    const written = ({ literal, ease }) => (ease === undefined ? literal : { value: literal, interpolation: ease });
    return {
      ...this.value,
      keys: Object.fromEntries(
        [...keys].sort((a, b) => a.frame - b.frame).map((key) => [String(key.frame), written(key)]),
      ),
    };
  }
  /** A new key goes on as the stretch does that it divides. */
  withLiteral(frame, literal) {
    const ease = (this.at(frame) ?? this.keys.findLast((key) => key.frame < frame))?.ease;
    return this.withKeys([...this.keys.filter((key) => key.frame !== frame), { frame, literal, ease }]);
  }
  /** Without the keys of the index; the last one leaves its value. */
  without(index) {
    return this.keys.length === 1 ? this.keys[0].literal : this.withKeys(this.keys.toSpliced(index, 1));
  }
  withEase(ease) {
    const { interpolation, ...rest } = this.value;
    return ease === "linear" && !interpolation ? rest : { ...this.value, interpolation: ease };
  }
  withEaseOf(index, ease) {
    return this.withKeys(this.keys.with(index, { ...this.keys[index], ease }));
  }

  /** The channels at a frame, as the program interpolates them. */
  numbersAt(frame, { unit, type }) {
    const next = this.keys.findIndex((key) => key.frame >= frame),
      after = this.keys.at(next),
      end = numbersOf(after.literal, unit);
    if (next <= 0 || after.frame === frame) return end;
    const before = this.keys[next - 1],
      begin = numbersOf(before.literal, unit),
      ease = this.easeOf(next - 1);
    if (ease === "step") return begin;
    const share = shareAt(ease, (frame - before.frame) / (after.frame - before.frame)),
      round = type === "int" ? Math.round : (number) => number;
    return begin.map((number, i) => round(number + share * (end[i] - number)));
  }
}

/** Frames with a key, of all values of all steps. */
export function keyedFrames(steps) {
  const found = new Set();
  for (const { params, mix } of steps)
    for (const value of [mix, ...Object.values(params).map((entry) => entry.value)])
      if (isKeyed(value)) for (const frame of Object.keys(value.keys)) found.add(Number(frame));
  return found;
}
