// Makes the pictures of docs/page.md by the page itself. Arguments: names of some of them. Needs what AFTERSHADE_TEST_ORACLES=1
// scripts/test installs; `objects` needs AFTERSHADE_CAPTURES.
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

import { openBrowser } from "../../tests/page/browser.mjs";
import { drawn, openServed, startServer } from "../../tests/page/served.mjs";
import { TINT, tintShader } from "../../tests/page/tint.mjs";

const root = resolve(import.meta.dirname, "../.."),
  folder = mkdtempSync(join(tmpdir(), "aftershade-pictures-")),
  suzanne = join(root, "scenes/suzanne/capture.json"),
  program = process.env.AFTERSHADE_EXECUTABLE,
  portrait = readFileSync(join(root, "scenes/looks/portrait.json"), "utf8"),
  blender = join(process.env.AFTERSHADE_CAPTURES ?? "", "blender-versions/5.2.3/multi_0003.exr");

const settled = (page) => page.evaluate(() => window.aftershade.settled());
const edit = (page, ...edits) => page.evaluate((list) => window.aftershade.store.edit(list), edits);
const probe = (page, pixel) => page.evaluate((at) => window.aftershade.viewer.setProbe(at), pixel);
const view = (page, name) => page.getByLabel("View", { exact: true }).selectOption(name);
const look = (name, text) => {
  writeFileSync(join(folder, name), text);
  return name;
};

/** A frame with the truth of its lens beside it. */
function withTruth() {
  execFileSync(program, [
    "render",
    join(root, "scenes/toys"),
    "-o",
    join(folder, "toys"),
    "--truth",
    "lens",
    "--frames",
    "1",
  ]);
  return join(folder, "toys/capture.json");
}
function ownEffects() {
  mkdirSync(join(folder, "effects/tint"), { recursive: true });
  writeFileSync(join(folder, "effects/tint/effect.json"), JSON.stringify(TINT));
  writeFileSync(join(folder, "effects/tint/tint.frag"), tintShader("light * param.amount"));
  return ["--effect-path", "effects"];
}

/** {words: of `serve`, act(page), and what the page's window is like} by name. */
const pictures = {
  dark: {
    words: () => [look("portrait.json", portrait), suzanne],
    act: (page) => probe(page, [200, 120]),
  },
  start: {
    words: () => [suzanne],
    act: (page) => page.waitForFunction(() => document.querySelectorAll(".starts canvas[data-drawn]").length >= 4),
  },
  objects: {
    words: () => [blender],
    async act(page) {
      await edit(page, { op: "add", at: 0, effect: "vignette" });
      await edit(page, { op: "mask", step: 0, value: { object: "Suzanne" } });
      await page.locator(".opener").click();
      await page.getByRole("button", { name: "Choose objects of the mask" }).click();
      await page.locator("#found-objects [role=option]").nth(3).waitFor();
    },
  },
  sharp: {
    words: () => [look("portrait.json", portrait), suzanne],
    act: (page) => view(page, "sharp:dof"),
  },
  curve: {
    words: () => [look("portrait.json", portrait), suzanne],
    async act(page) {
      await edit(page, {
        op: "set",
        step: 0,
        param: "focus_distance",
        value: { keys: { 3: { value: "4.6 m", interpolation: [0.6, 0, 0.2, 1] }, 4: "6.4 m" } },
      });
      await page.locator(".handle").first().focus();
    },
  },
  faults: {
    words: () => [look("portrait.json", portrait), suzanne],
    async act(page) {
      await page.keyboard.press("t");
      await page
        .getByLabel("The look as JSON")
        .fill(portrait.replace('"f_number"', '"f_numer"').replace("agx", "agix"));
      await page.locator(".faults li").nth(1).waitFor();
    },
  },
  shaders: {
    words: () => [
      look("portrait.json", portrait.replace('{ "effect": "view', '{ "effect": "tint" },\n    { "effect": "view')),
      suzanne,
      ...ownEffects(),
    ],
    async act(page) {
      await page.getByRole("tab", { name: "Shaders" }).click();
      await page.getByLabel("Effect", { exact: true }).selectOption("tint");
      const area = page.getByLabel("The shader as GLSL");
      await area.focus();
      await area.evaluate((node) => {
        const at = node.value.indexOf("param.amount") + "param.amount".length;
        node.setSelectionRange(at - 6, at);
      });
      await page.keyboard.type("a");
    },
  },
  light: {
    colorScheme: "light",
    words: () => [look("portrait.json", portrait), suzanne],
    async act(page) {
      await page.getByLabel("Compare with").selectOption("before");
      await page.getByLabel("Waveform of").selectOption("parade");
      await probe(page, [150, 120]);
    },
  },
  truth: {
    colorScheme: "light",
    words: () => [
      look("toys.json", '{ "aftershade": 1, "steps": [ { "effect": "dof" }, { "effect": "view_transform" } ] }'),
      withTruth(),
    ],
    async act(page) {
      await page.getByLabel("Compare with").selectOption("truth:lens");
      await page.getByRole("group", { name: "Distance from the truth" }).getByText(/dB/).waitFor();
    },
  },
  phone: {
    viewport: { width: 390, height: 844 },
    words: () => [look("portrait.json", portrait), suzanne],
    act: () => {},
  },
};

const wanted = process.argv.length > 2 ? process.argv.slice(2) : Object.keys(pictures),
  browser = await openBrowser();
try {
  for (const name of wanted) {
    const { words, act, colorScheme = "dark", viewport = { width: 1440, height: 900 } } = pictures[name];
    const server = await startServer(words(), { cwd: folder, env: { ...process.env, AFTERSHADE_BACKEND: "software" } });
    const page = await openServed(browser, server.address, { colorScheme, viewport });
    await drawn(page);
    await act(page);
    await settled(page);
    await page.waitForTimeout(3000); // histogram and waveform come after the picture, and notices go
    await page.screenshot({ path: join(root, `docs/images/page/${name}.jpg`), type: "jpeg", quality: 82 });
    console.log(`docs/images/page/${name}.jpg`);
    await page.context().close();
    await server.end();
  }
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
