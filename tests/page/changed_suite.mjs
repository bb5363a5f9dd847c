// A small suite whose cases all differ from their goldens, for reviews.
import { cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join, relative } from "node:path";

import { capture, golden } from "./suite.mjs";

const steps = {
  color_grade: (i, changed) => ({ exposure: (i + (changed ? 8 : 0)) / 16 }),
  sharpen: (i, changed) => ({ amount: (i + (changed ? 8 : 0)) / 32 }),
  vignette: (i, changed) => ({ strength: (i + (changed ? 8 : 0)) / 64 }),
};
const effects = Object.keys(steps);

/** Names of the suite's cases: "color_grade_00", "sharpen_01", ... */
export const namesOf = (count) =>
  Array.from({ length: count }, (_, i) => `${effects[i % 3]}_${String(i).padStart(2, "0")}`);

/** A suite below `folder`, its goldens approved, then every case changed. */
export function makeChangedSuite(folder, count) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const cases = (changed) =>
    namesOf(count).map((name, i) => {
      const effect = name.slice(0, -3);
      return { name, steps: [{ effect, params: steps[effect](i, changed) }], capture, frames: "1" };
    });
  const write = (changed) =>
    writeFileSync(join(folder, "golden.json"), JSON.stringify({ aftershade: 1, cases: cases(changed) }, null, 1));
  write(false);
  const approved = golden(folder, "approve", ".", "--approver", "Nobody");
  if (approved.code !== 0) throw new Error(approved.err);
  write(true);
}

/** Paths below a folder with the text of each file. */
export function treeOf(folder) {
  const files = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
  return Object.fromEntries(
    files
      .map((entry) => join(entry.parentPath ?? entry.path, entry.name))
      .sort()
      .map((path) => [relative(folder, path), readFileSync(path).toString("base64")]),
  );
}

export const copyOf = (folder, to) => {
  rmSync(to, { recursive: true, force: true });
  cpSync(folder, to, { recursive: true });
  return to;
};
