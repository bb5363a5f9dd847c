// A golden suite with every verdict there is, made by the program alone: approved by one document, run by another.
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, rmSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";

const root = resolve(import.meta.dirname ?? new URL(".", import.meta.url).pathname, "../..");
export const program = process.env.AFTERSHADE_EXECUTABLE ?? join(root, "build/release/aftershade");
const scene = join(root, "scenes/starter");
export const capture = join(scene, "capture.json"); // 240 x 135 px: colour, depth, velocity, ids
const smaller = join(root, "scenes/soap/capture.json"); // 160 x 90 px

// Light that a test knows: (x / 64, y / 32, 1 / 4), all of it exact as half. One pixel can be changed.
const card = {
  "effect.json": {
    aftershade: 1,
    id: "card",
    version: "1.0.0",
    summary: "A card of known light.",
    inputs: { color: { role: "color", doc: "Gives the size." } },
    outputs: { color: { role: "color", doc: "The card." } },
    params: {
      change: { type: "float", default: 0, min: -1e6, max: 1e6, ui: [0, 1], doc: "Added to the green of one pixel." },
      poison: { type: "bool", default: false, doc: "Whether a pixel is NaN." },
    },
    passes: [{ name: "card", shader: "card.frag", reads: ["color"], writes: ["color"] }],
  },
  "card.frag": `#version 450 core
#include <pass>

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 light = vec4(vec2(at) / vec2(64.0, 32.0), 0.25, texelFetch(color, at, 0).a);
    if (at == ivec2(31, 17)) light.g += param.change;
    if (param.poison && at == ivec2(40, 20)) light.r = intBitsToFloat(0x7fc00000);
    out_color = light;
}
`,
};

export const approver = "Ada <b>Lovelace</b>";
const broken = "float broken() { return parm; }";

const corner = "corner.exr"; // of the capture: 40 x 30 px from (200, 100)

function casesOf(changed) {
  const cardCase = (name, values, more = {}) => ({
    name,
    steps: [{ effect: "card", params: changed ? values : {} }],
    capture,
    frames: "1",
    ...more,
  });
  return [
    { name: "passing", steps: [{ effect: "vignette" }], capture, frames: "1", tags: ["fast"] },
    {
      name: "lens",
      steps: [{ effect: "bokeh", params: { f_number: 1, rotation: changed ? 12 : 0 } }],
      capture,
      frames: "1",
      tolerance: { fail: 0.02 },
      tags: ["slow", "<b>bold</b>"],
    },
    cardCase("one_pixel", { change: 0.5 }, { tolerance: { fail: 0.004 } }),
    cardCase(
      "left_out",
      { change: 0.5 },
      { tolerance: { fail: 0.004, forgive_shift: 2, ignore: [{ rectangle: [30, 16, 4, 5] }] } },
    ),
    cardCase(
      "areas",
      { change: 0.5 },
      {
        tolerance: {
          fail: 0.004,
          ignore: [{ rectangle: [40, 16, 6, 6] }],
          areas: [{ rectangle: [20, 16, 6, 6], fail: 0.1 }],
        },
      },
    ),
    cardCase("poisoned", { poison: true }),
    cardCase("inside_tolerance", { change: 0.03125 }, { tolerance: { fail: 0.1 } }),
    cardCase("warned", { change: 0.25 }, { tolerance: { fail: 1, warn: 0.01 } }),
    { ...cardCase("shrunk", {}), capture: changed ? smaller : capture },
    { name: "visible_depth", steps: [{ effect: "visualize" }], capture, frames: "1" },
    { name: "roles", steps: [], capture: "in.exr", outputs: ["color", "depth", "velocity", "object_id"] },
    { name: "apart", steps: [], capture: corner },
    { name: "other_layers", steps: [], capture: "in.exr" },
    { ...cardCase("always_poisoned", {}), steps: [{ effect: "card", params: { poison: true } }] },
    ...(changed
      ? [
          { name: "brand_new", steps: [{ effect: "sharpen" }], capture, frames: "1" },
          { name: "absent", steps: [], capture, skip: "<img src=x onerror=\"document.title='broken in'\">" },
          { name: "does_not_compile", steps: [{ effect: "card_broken" }], capture, frames: "1" },
        ]
      : []),
  ];
}

function writeEffect(folder, files) {
  mkdirSync(folder, { recursive: true });
  for (const [name, content] of Object.entries(files))
    writeFileSync(join(folder, name), typeof content === "string" ? content : JSON.stringify(content));
}

export function golden(folder, ...words) {
  const result = spawnSync(program, ["golden", ...words], {
    cwd: folder,
    encoding: "utf8",
    env: { ...process.env, AFTERSHADE_BACKEND: "software" },
  });
  return { code: result.status, err: result.stderr, out: result.stdout };
}

function draw(folder, from, to, ...words) {
  const look = join(folder, "nothing.json");
  writeFileSync(look, JSON.stringify({ aftershade: 1, steps: [] }));
  const result = spawnSync(program, ["run", look, from, "-o", to, "--backend", "software", ...words], {
    cwd: folder,
    encoding: "utf8",
  });
  if (result.status !== 0) throw new Error(result.stderr);
}

/** The report's folder; its page is index.html. */
export function makeReport(folder) {
  rmSync(folder, { recursive: true, force: true });
  writeEffect(join(folder, "effects/card"), card);
  writeEffect(join(folder, "effects/card_broken"), {
    "effect.json": { ...card["effect.json"], id: "card_broken" },
    "card.frag": card["card.frag"] + broken,
  });
  const write = (changed) => {
    copyFileSync(join(scene, `gbuffer_000${changed ? 2 : 1}.exr`), join(folder, "in.exr"));
    writeFileSync(
      join(folder, "golden.json"),
      JSON.stringify({ aftershade: 1, effect_paths: ["effects"], cases: casesOf(changed) }, null, 1),
    );
  };
  write(false);
  draw(folder, "in.exr", corner, "--region", "200,100,40,30");
  const approved = golden(folder, "approve", ".", "--approver", approver);
  if (approved.code !== 0) throw new Error(approved.err);
  copyFileSync(join(folder, "goldens/passing.color.0001.exr"), join(folder, "goldens/gone.color.0001.exr"));
  // What no look makes: a golden of other pixels than the picture's, and one of other layers.
  draw(folder, "in.exr", "goldens/apart.color.0001.exr", "--region", "0,0,40,30");
  copyFileSync(join(folder, "goldens/roles.depth.0001.exr"), join(folder, "goldens/other_layers.color.0001.exr"));
  write(true);
  const run = golden(folder, "run", ".", "--report", "report");
  if (run.code !== 3) throw new Error(`exit ${run.code}\n${run.err}`);
  return join(folder, "report");
}

export const rebuildPage = (report, ...words) => golden(report, "report", ".", ...words);
