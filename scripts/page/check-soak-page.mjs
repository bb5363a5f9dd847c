// Random use of the authoring page's server for an hour (or MINUTES): edits, also of a shader, undo, frames, views, probes.
// After every round it has the first look again, draws the same pictures and counts: exits with 1 where resident memory grew
// by more than 2 % between the first quarter after the warm-up and the last one, or where the number of GL objects grew.
// Needs Node.
//
//   scripts/check soak-page [MINUTES]
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";

import { random, randomEdit } from "../../tests/page/random_edits.mjs";
import { tintShader } from "../../tests/page/tint.mjs";
import { serve } from "./served.mjs";

const ACTIONS = 40, // of a round
  WARM_UP = 0.25, // of the time
  GROWTH = 0.02, // of resident memory, at most
  LEAST_ROUNDS = 12,
  minutes = Number(process.argv[2] ?? 60),
  capture = join(resolve(import.meta.dirname, "../.."), "scenes/starter/capture.json"),
  { address, pid, drawerPid, end } = await serve(capture, { ownEffect: true }),
  headers = { "X-Aftershade-Token": address.hash.slice("#token=".length) },
  next = random(28),
  pick = (list) => list[Math.floor(next() * list.length)];

async function call(path, body) {
  const options = body ? { method: "POST", headers, body: JSON.stringify(body) } : { headers };
  const response = await fetch(address.origin + path, options);
  await response.clone().arrayBuffer();
  return response;
}
const json = async (path, body) => (await call(path, body)).json();
const picture = (view, frame, scale) => call(`/api/picture?${new URLSearchParams({ view, frame, scale })}`);

const first = await json("/api/state"),
  { frames, width, height, roles } = first.capture,
  ids = ["dof", "bokeh", "color_grade", "vignette", "view_transform", "sharpen", "bloom", "film_grain", "sanitize"],
  effects = new Map(
    ids.map((id) => {
      const { stdout } = spawnSync(process.env.AFTERSHADE_EXECUTABLE, ["describe", id, "--json"], { encoding: "utf8" });
      return [id, JSON.parse(stdout)];
    }),
  ).set("tint", { params: {} });
const counts = { actions: 0, refused: 0 };

let shader = tintShader("light");
async function writeShader(text) {
  const response = await call("/api/shader", { effect: "tint", file: "tint.frag", before: shader, text });
  if (!response.ok) throw new Error(`a shader is refused: ${await response.text()}`);
  shader = text;
  return response;
}
/** One in five does not compile. */
const randomShader = () =>
  tintShader(next() < 0.2 ? "light * ;" : `light * vec4(${[1, 2, 3].map(() => next().toFixed(6)).join(", ")}, 1.0)`);

async function act() {
  const state = await json("/api/state"),
    frame = pick(frames);
  const edit = () => call("/api/edit", { revision: state.revision, edits: [randomEdit(next, state.steps, effects)] });
  const actions = [
    edit,
    edit,
    edit,
    () => writeShader(randomShader()),
    () => call("/api/undo", {}),
    () => call("/api/redo", {}),
    () => picture("final", frame, pick([1, 2, 4])),
    () => picture("before", frame, 1),
    () => picture(`role:${pick(roles).name}`, frame, 1),
    () => call(`/api/probe?frame=${frame}&x=${Math.floor(next() * width)}&y=${Math.floor(next() * height)}`),
    () => call(`/api/histogram?frame=${frame}`),
  ];
  const { ok } = await pick(actions)();
  ++counts.actions;
  if (!ok) ++counts.refused; // nothing to undo, a look that has faults
}

const resident_mib = (process) =>
  Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${process}/status`, "utf8"))[1]) / 1024;

/** The first look and shader again and its pictures: what is held then must not grow. */
async function settled() {
  await writeShader(tintShader("light"));
  const { revision } = await json("/api/state");
  await call("/api/edit", { revision, edits: [{ op: "text", value: first.text }] });
  for (const frame of frames) for (const scale of [4, 2, 1]) await picture("final", frame, scale);
  const response = await picture("final", frames[0], 1);
  if (!response.ok) throw new Error(`the first look gives no picture: ${await response.text()}`);
  const { gl_objects } = JSON.parse(response.headers.get("X-Aftershade-Times"));
  const drawer_mib = resident_mib(drawerPid());
  return { gl_objects, drawer_mib, resident_mib: resident_mib(pid) + drawer_mib };
}

const begun = performance.now(),
  share = () => (performance.now() - begun) / (60_000 * minutes),
  rounds = [];
while (share() < 1 || rounds.length < LEAST_ROUNDS) {
  for (let i = 0; i < ACTIONS; ++i) await act();
  rounds.push({ at: share(), ...(await settled()) });
}
end();

const warm = rounds.filter(({ at }) => at >= WARM_UP),
  later = warm.length >= LEAST_ROUNDS / 2 ? warm : rounds.slice(rounds.length / 2),
  quarter = Math.ceil(later.length / 4),
  median = (list) => list.toSorted((a, b) => a - b)[list.length >> 1],
  memory = (part) => median(part.map(({ resident_mib }) => resident_mib)),
  objects = (part) => Math.max(...part.map(({ gl_objects }) => gl_objects));
const early = later.slice(0, quarter),
  late = later.slice(-quarter),
  growth = memory(late) / memory(early) - 1;
if (process.env.VERBOSE)
  for (const { at, resident_mib, drawer_mib, gl_objects } of rounds)
    console.log(at.toFixed(3), resident_mib.toFixed(1), drawer_mib.toFixed(1), gl_objects);
console.log(
  `${((performance.now() - begun) / 60_000).toFixed(1)} min, ${rounds.length} rounds, ${counts.actions} actions, ${counts.refused} refused: ` +
    `resident ${memory(early).toFixed(1)} to ${memory(late).toFixed(1)} MiB (${(100 * growth).toFixed(1)} %), ` +
    `GL objects ${objects(early)} to ${objects(late)}`,
);
process.exitCode = growth <= GROWTH && objects(late) <= objects(early) ? 0 : 1;
