// The authoring page's first, coarse picture against the full one: scenes/toys at 1920x1080, median of 7 edits of dof and of
// view_transform behind it. Exits with 1 if the coarse one takes longer than 0.2 of the full one's time. Needs Node.
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

import { serve } from "./served.mjs";

const folder = mkdtempSync(join(tmpdir(), "coarse-")),
  scene = resolve(import.meta.dirname, "../../scenes/toys"),
  words = ["render", scene, "-o", folder, "--size", "1920x1080", "--frames", "1", "--quiet"];
spawnSync(process.env.AFTERSHADE_EXECUTABLE, words, { stdio: "inherit" });
process.on("exit", () => rmSync(folder, { recursive: true }));

const EDITS = 7,
  LIMIT = 0.2, // of the full picture's time
  { address, end } = await serve(join(folder, "capture.json"));
const headers = { "X-Aftershade-Token": address.hash.slice("#token=".length) };
async function call(path, body) {
  const response = await fetch(
    address.origin + path,
    body ? { method: "POST", headers, body: JSON.stringify(body) } : { headers },
  );
  if (!response.ok) throw new Error(`${path}: ${response.status} ${await response.text()}`);
  return response;
}
async function picture_ms(scale) {
  const begun = performance.now();
  await (await call(`/api/picture?frame=1&scale=${scale}`)).arrayBuffer();
  return performance.now() - begun;
}
const middle = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];

let isWithin = true;
await picture_ms(4);
await picture_ms(1);
for (const [step, param] of [
  [0, "f_number"],
  [1, "exposure"],
]) {
  const samples = [];
  for (let i = 0; i < EDITS; ++i) {
    const { revision } = await (await call("/api/state")).json();
    await call("/api/edit", { revision, edits: [{ op: "set", step, param, value: 0.6 + i / 20 }] });
    samples.push({ coarse_ms: await picture_ms(4), full_ms: await picture_ms(1) });
  }
  const share = middle(samples.map(({ coarse_ms, full_ms }) => coarse_ms / full_ms));
  const [coarse, full] = ["coarse_ms", "full_ms"].map((key) => middle(samples.map((one) => one[key])).toFixed(0));
  console.log(`${param}: coarse ${coarse} ms, full ${full} ms, ${share.toFixed(3)} of it, limit ${LIMIT}`);
  isWithin &&= share <= LIMIT;
}
end();
process.exitCode = isWithin ? 0 : 1;
