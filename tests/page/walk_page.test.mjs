// The whole way of an artist, from a frame of Blender to a film: once by the pointer, once by the keyboard alone.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { TINT, tintShader } from "./tint.mjs";
import { program } from "./suite.mjs";
import {
  axe,
  canProbeVideo,
  clickAt,
  environment,
  pixelsOf,
  shot,
  state,
  steps,
  SUZANNE,
  walkBlender,
} from "./walks.mjs";

/** A hand at the pointer. */
const pointer = {
  show: (page, tab) => page.getByRole("tab", { name: tab }).click(),
  press: (page, node) => node.click(),
  choose: (page, node, value) => node.selectOption(value),
  check: (page, node) => node.check(),
  type: (page, node, text) => node.fill(text).then(() => node.press("Enter")),
};
/** Hands at the keyboard: Tab until the control has the focus. */
async function tabTo(page, node) {
  await node.waitFor();
  const has = () => node.evaluate((one) => one === document.activeElement);
  for (const key of ["Tab", "Shift+Tab"])
    for (let i = 0; i < 200; ++i) {
      if (await has()) return;
      await page.keyboard.press(key);
    }
  assert.fail(`Tab does not lead to ${node}`);
}
const keyboard = {
  async show(page, tab) {
    await tabTo(page, page.locator("[role=tab][aria-selected=true]"));
    for (let i = 0; i < 3; ++i) {
      if ((await page.locator("[role=tab][aria-selected=true]").innerText()) === tab) return;
      await page.keyboard.press("ArrowRight");
    }
    assert.fail(`no tab ${tab}`);
  },
  press: (page, node) => tabTo(page, node).then(() => page.keyboard.press("Enter")),
  async choose(page, node, value) {
    const words = await node.evaluate(
      (select, wanted) => [...select.options].find((option) => option.value === wanted).textContent,
      value,
    );
    await tabTo(page, node);
    // As soon as it is chosen, the focus may move on.
    for (const letter of words) {
      if ((await node.inputValue()) === value) return;
      await page.keyboard.type(letter);
    }
  },
  check: (page, node) => tabTo(page, node).then(() => page.keyboard.press("Space")),
  async type(page, node, text) {
    await tabTo(page, node);
    await page.keyboard.press("Control+a");
    await page.keyboard.type(text);
    await page.keyboard.press("Enter");
  },
};

const step = (page, name) => page.locator(`.step[data-step="${name}"]`);
const inStep = (page, name, holds) =>
  page.waitForFunction(
    ([effect, text]) =>
      JSON.stringify(window.aftershade.store.state.steps.find((one) => one.effect === effect) ?? "").includes(text),
    [name, holds],
  );
async function open(page, hand, name) {
  const opener = step(page, name).locator(".opener");
  if ((await opener.getAttribute("aria-expanded")) === "false") await hand.press(page, opener);
  return step(page, name);
}
async function fromList(page, hand, node, words) {
  await hand.press(page, node);
  await page.keyboard.type(words);
  await page
    .locator("#found-objects .name", { hasText: words.split(" ")[0] })
    .first()
    .waitFor();
  await page.keyboard.press("Enter");
}
/** With the keys that steps have for it. */
async function add(page, words, effect, up) {
  await page.locator(".stage canvas").focus();
  await page.keyboard.press("a");
  await page.keyboard.type(words);
  await page.keyboard.press("Enter");
  await step(page, effect).waitFor();
  await page.waitForFunction((name) => document.activeElement.closest(".step")?.dataset.step === name, effect);
  for (let i = 0; i < up; ++i) {
    const before = (await steps(page)).indexOf(effect);
    await page.keyboard.press("Alt+ArrowUp");
    await page.waitForFunction(
      ([name, at]) => window.aftershade.store.state.steps.findIndex((one) => one.effect === name) === at - 1,
      [effect, before],
    );
  }
}

const walkAll = (hand, options) => async (page, folder) => {
  const note = async (name) => {
    await page.evaluate(() => window.aftershade.settled());
    await axe(page, name);
    await shot(page, `walk_${name}_${options.colorScheme}_${options.viewport.width}`);
  };
  await hand.press(page, page.locator(".start", { hasText: "Portrait" }));
  await page.waitForFunction(() => window.aftershade.store.state.steps.length === 3);
  // Focus on Suzanne, then a rack to the ball over 24 frames, along a curve.
  const focus = (await open(page, hand, "dof")).locator('[data-param="focus_distance"]'),
    list = focus.getByRole("button", { name: /^Choose the object/ });
  if (hand === pointer) {
    await focus.getByRole("button", { name: /^Pick/ }).click();
    await clickAt(page, ...SUZANNE);
  } else await fromList(page, hand, list, "Suzanne object");
  await inStep(page, "dof", '{"from":"depth","object":"Suzanne"}');
  await hand.press(page, focus.getByRole("button", { name: /^Key/ }));
  await inStep(page, "dof", '"keys":{"1":');
  await hand.type(page, page.getByLabel("Frame number"), "24");
  await page.waitForFunction(() => window.aftershade.viewer.frame === 24);
  await fromList(page, hand, list, "Ball object");
  await inStep(page, "dof", '"24":{"from":"depth","object":"Ball"}');
  await hand.choose(page, focus.getByLabel("Interpolation of focus distance from frame 1"), "curve");
  await inStep(page, "dof", '"interpolation":[0.4,0,0.6,1]');
  await focus.locator(".handle").first().press("ArrowUp");
  await inStep(page, "dof", "[0.4,0.05,0.6,1]");
  await note("rack");
  // Scattering on the material "skin" alone, before the lens.
  await add(page, "sss_gaussian", "sss_gaussian", 2);
  const skin = (await open(page, hand, "sss_gaussian")).getByRole("button", { name: "Choose objects of object ids" });
  await fromList(page, hand, skin, "skin material");
  await inStep(page, "sss_gaussian", '"value":["skin"]');
  // As wide as a hand, so that light is seen to go some pixels far.
  await hand.type(page, step(page, "sss_gaussian").locator('[data-param="world_unit"]').getByRole("textbox"), "20");
  await inStep(page, "sss_gaussian", '"value":20');
  await note("skin");
  // A vignette beside Suzanne.
  const card = await open(page, hand, "vignette");
  await hand.choose(page, card.getByLabel("Mask by"), "object");
  await fromList(page, hand, card.getByRole("button", { name: "Choose objects of the mask" }), "Suzanne object");
  await inStep(page, "vignette", '"object":"Suzanne"');
  await hand.check(page, card.getByLabel("Invert the mask"));
  await inStep(page, "vignette", '"invert":true');
  await note("mask");
  // The user's own effect, whose shader has a fault.
  await add(page, "tint", "tint", 0);
  await hand.show(page, "Shaders");
  await hand.choose(page, page.getByLabel("Effect", { exact: true }), "tint");
  await page.locator(".shader-faults li").first().waitFor();
  await note("fault");
  await hand.press(page, page.locator(".shader-faults li button").first());
  await page.keyboard.type("light * param.amount;");
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector(".shader-faults").hidden);
  page.faults.length = 0; // the browser lists the pictures that the fault refused
  await note("mended");
  assert.equal(readFileSync(join(folder, "effects/tint/tint.frag"), "utf8"), tintShader("light * param.amount"));
  await hand.show(page, "Steps");
  // Saved and exported.
  await page.keyboard.press("Control+s");
  await page.keyboard.type("film");
  await page.keyboard.press("Enter");
  await page.locator(".save-dialog").waitFor({ state: "hidden" });
  await page.keyboard.press("x");
  const dialog = page.getByRole("dialog", { name: "Export" });
  for (const format of canProbeVideo() ? ["png", "mp4"] : ["png"]) {
    await hand.choose(page, dialog.getByLabel("Format"), format);
    await hand.type(page, dialog.getByLabel("Name of the export"), "film");
    const file = join(folder, format === "png" ? "film" : "film.mp4");
    await dialog.getByText(`Wrote ${file}`, { exact: true }).waitFor({ timeout: 240_000 });
  }
  await note("export");
  await check(folder, await state(page));
};

/** The files are those of `run` with the saved look, which is as one writes it by hand. */
async function check(folder, { text }) {
  assert.equal(readFileSync(join(folder, "film.json"), "utf8"), text);
  assert.ok(text.startsWith("// A fast lens, focused on what is in the middle"), "comments are kept");
  assert.ok(Math.max(...text.split("\n").map((line) => line.length)) < 120, text);
  assert.deepEqual(JSON.parse(text.replace(/^\/\/.*$/gm, "")).steps, [
    { effect: "sss_gaussian", params: { object_ids: ["skin"], world_unit: 20 } },
    {
      effect: "dof",
      params: {
        focus_distance: {
          keys: {
            1: { value: { from: "depth", object: "Suzanne" }, interpolation: [0.4, 0.05, 0.6, 1] },
            24: { from: "depth", object: "Ball" },
          },
          interpolation: "smooth",
        },
        f_number: 0.35,
      },
    },
    { effect: "vignette", mask: { object: "Suzanne", invert: true } },
    { effect: "tint" },
    { effect: "view_transform", params: { transform: "agx" } },
  ]);
  const frames = Array.from({ length: 24 }, (_, i) => `film_${String(i + 1).padStart(4, "0")}.png`);
  assert.deepEqual(readdirSync(join(folder, "film")).sort(), frames);
  const run = spawnSync(
    program,
    ["run", "film.json", "multi_####.exr", "--effect-path", "effects", "--frames", "1,12,24", "-o", "own_####.png"],
    { cwd: folder, env: environment, encoding: "utf8" },
  );
  assert.equal(run.status, 0, run.stderr);
  for (const frame of ["0001", "0012", "0024"]) {
    const [exported, own] = await Promise.all(
      [`film/film_${frame}.png`, `own_${frame}.png`].map((file) => pixelsOf(join(folder, file))),
    );
    assert.ok(exported.length > 0 && exported.join() === own.join(), `frame ${frame} is not that of \`run\``);
  }
  if (!canProbeVideo()) return;
  const entries = "stream=codec_name,width,height,nb_frames";
  const probed = spawnSync("ffprobe", ["-v", "error", "-show_entries", entries, "-of", "csv=p=0", "film.mp4"], {
    cwd: folder,
    encoding: "utf8",
  });
  assert.equal(probed.stdout.trim(), "h264,480,270,24");
}

for (const [name, hand, options] of [
  ["by the pointer", pointer, { colorScheme: "dark", viewport: { width: 1440, height: 900 } }],
  ["by the keyboard alone", keyboard, { colorScheme: "light", viewport: { width: 1440, height: 900 } }],
  ["by the pointer", pointer, { colorScheme: "light", viewport: { width: 390, height: 844 } }],
])
  walkBlender(
    `goes from a frame of Blender to a film ${name}, ${options.colorScheme}, ${options.viewport.width} px`,
    walkAll(hand, options),
    {
      ...options,
      frames: Array.from({ length: 24 }, (_, i) => i + 1),
      words: (folder) => {
        mkdirSync(join(folder, "effects/tint"), { recursive: true });
        writeFileSync(join(folder, "effects/tint/effect.json"), JSON.stringify(TINT));
        writeFileSync(
          join(folder, "effects/tint/tint.frag"),
          tintShader("light * param.amount").replace("light * param.amount", "lihgt * param.amount"),
        );
        return ["--effect-path", "effects"];
      },
    },
  );
