// Edits of a look, by a seed.

/** Numbers from 0 to 1 by a seed (mulberry32). */
export function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}
/** An edit of a look with these steps; effects: the described ones by id. */
export function randomEdit(next, steps, effects) {
  const pick = (list) => list[Math.floor(next() * list.length)],
    step = Math.floor(next() * steps.length),
    kind = steps.length < 2 ? "add" : next() < 0.7 ? "set" : pick(["add", "remove", "move", "enable", "mix"]);
  if (kind === "add")
    return {
      op: "add",
      at: Math.floor(next() * steps.length),
      effect: pick(
        ["sharpen", "vignette", "bloom", "film_grain"]
          .filter((id) => steps.every(({ effect }) => effect !== id))
          .concat("sanitize")
          .slice(0, 4),
      ),
    };
  if (kind === "remove") return steps.length > 4 ? { op: "remove", step } : { op: "enable", step, value: false };
  if (kind === "move") return { op: "move", step, to: Math.floor(next() * steps.length) };
  if (kind === "enable") return { op: "enable", step, value: next() < 0.5 };
  if (kind === "mix") return { op: "mix", step, value: Math.round(next() * 100) / 100 };
  const { params } = effects.get(steps[step].effect),
    [param, declared] =
      pick(Object.entries(params).filter(([, { type }]) => ["float", "int", "bool", "enum", "angle"].includes(type))) ??
      [];
  if (!param) return { op: "enable", step, value: true };
  if (next() < 0.15) return { op: "set", step, param, value: null };
  const [low, high] = declared.ui ?? [0, 1],
    number = low + next() * (high - low);
  const value =
    { bool: () => next() < 0.5, enum: () => pick(declared.values), int: () => Math.round(number) }[declared.type]?.() ??
    Number(number.toPrecision(4));
  return { op: "set", step, param, value };
}
