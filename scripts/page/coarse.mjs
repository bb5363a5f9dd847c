// scripts/bench-coarse CAPTURE: the time of the first picture, a quarter of the size, over the full one's, after an edit.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const EDITS = 7,
  LIMIT = 0.2, // of the full picture's time
  folder = mkdtempSync(join(tmpdir(), "aftershade-coarse-")),
  look = join(folder, "look.json");
writeFileSync(
  look,
  JSON.stringify({
    aftershade: 1,
    steps: [
      { effect: "dof", params: { focus_distance: "6.4 m", f_number: 0.5 } },
      { effect: "view_transform", params: { exposure: 0.5 } },
    ],
  }),
);
const server = spawn(process.env.AFTERSHADE_EXECUTABLE, ["serve", look, process.argv[2], "--port", "0"], {
  env: { AFTERSHADE_BACKEND: "osmesa", ...process.env },
  stdio: ["ignore", "pipe", "inherit"],
});
const address = await new Promise((ready) =>
  server.stdout.on("data", (data) => {
    const found = /http:\S+/.exec(data);
    if (found) ready(new URL(found[0]));
  }),
);
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
server.kill("SIGINT");
rmSync(folder, { recursive: true });
process.exitCode = isWithin ? 0 : 1;
