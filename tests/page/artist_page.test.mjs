// An artist's way through the page: from a frame alone to a saved look, without a line of JSON.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import {
  copyFileSync,
  existsSync,
  mkdirSync,
  mkdtempSync,
  readFileSync,
  rmSync,
  statSync,
  symlinkSync,
  writeFileSync,
} from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";

import { axeSource, openBrowser } from "./browser.mjs";
import { drawn, openServed, startServer } from "./served.mjs";
import { program } from "./suite.mjs";

const root = resolve(import.meta.dirname, "../.."),
  scene = join(root, "scenes/suzanne"),
  capture = join(scene, "capture.json"), // of Blender: 480 x 270 px, frames 3 and 4
  environment = { ...process.env, AFTERSHADE_BACKEND: "software" },
  shots = process.env.AFTERSHADE_PAGE_SHOTS; // a folder for screenshots to be looked at

let browser;
before(async () => (browser = await openBrowser()));
after(() => browser?.close());

/** A page over a capture in a folder of its own; the page must not complain, unless `mayFail`. */
function walk(name, work, { words = [capture], mayFail = false, ...options } = {}) {
  test(name, { timeout: 400_000 }, async () => {
    const folder = mkdtempSync(join(tmpdir(), "aftershade-artist-"));
    let server, page;
    try {
      server = await startServer(typeof words === "function" ? words(folder) : words, { env: environment, cwd: folder });
      page = await openServed(browser, server.address, options);
      await drawn(page);
      await work(page, folder);
      if (!mayFail) assert.deepEqual(page.faults, []);
    } finally {
      await page?.context().close();
      await server?.end();
      rmSync(folder, { recursive: true, force: true });
    }
  });
}
const state = (page) => page.evaluate(() => window.aftershade.store.state);
const steps = async (page) => (await state(page)).steps.map(({ effect }) => effect);
const shot = (page, name) => shots && page.screenshot({ path: join(shots, `${name}.png`) });
const allDrawn = (page, list, least) =>
  page.waitForFunction(
    ([selector, count]) => document.querySelectorAll(`${selector} canvas[data-drawn]`).length >= count,
    [list, least],
  );
async function axe(page, place) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(readFileSync(axeSource, "utf8"));
  const { violations } = await page.evaluate(() => window.axe.run({ resultTypes: ["violations"] }));
  assert.deepEqual(
    violations.map(({ id, nodes }) => `${place}: ${id}: ${nodes.length} x ${nodes[0].html.slice(0, 160)}`),
    [],
  );
}

/** RGBA of a PNG file. */
async function pixelsOf(file) {
  const blank = await browser.newPage();
  const bytes = await blank.evaluate(async (text) => {
    const image = new Image();
    image.src = `data:image/png;base64,${text}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
    canvas.getContext("2d").drawImage(image, 0, 0);
    return [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data];
  }, readFileSync(file).toString("base64"));
  await blank.close();
  return bytes;
}

for (const [colorScheme, width, height] of [
  ["dark", 1440, 900],
  ["light", 1440, 900],
  ["dark", 390, 844],
  ["light", 390, 844],
])
  walk(
    `starts from a capture with looks as pictures of its frame, ${colorScheme}, ${width} px`,
    async (page) => {
      assert.deepEqual(await steps(page), []);
      if (width < 1000) await page.locator(".gallery").scrollIntoViewIfNeeded();
      await allDrawn(page, ".starts", 4);
      const names = await page.locator(".starts .name").allInnerTexts();
      assert.ok(names.length >= 5 && names.length <= 10 && names.includes("Portrait"), names.join());
      await axe(page, "gallery");
      await shot(page, `gallery_${colorScheme}_${width}`);
    },
    { viewport: { width, height }, colorScheme },
  );

walk("draws each starting look as `run` draws it, smaller", async (page, folder) => {
  await allDrawn(page, ".starts", 2);
  const { width, height, bytes } = await page.evaluate(() => {
    const item = [...document.querySelectorAll(".starts li")].find((node) => node.innerText.startsWith("Noir"));
    item.scrollIntoView();
    const canvas = item.querySelector("canvas");
    return new Promise((done) => {
      const look = () =>
        "drawn" in canvas.dataset
          ? done({
              width: canvas.width,
              height: canvas.height,
              bytes: [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data],
            })
          : setTimeout(look, 50);
      look();
    });
  });
  const run = spawnSync(
    program,
    ["run", join(root, "looks/noir.json"), capture, "--frames", "3", "--scale", "1/2", "-o", "noir.png"],
    { cwd: folder, env: environment, encoding: "utf8" },
  );
  assert.equal(run.status, 0, run.stderr);
  assert.deepEqual([width, height], [240, 135]);
  assert.deepEqual(bytes, await pixelsOf(join(folder, "noir.png")));
});

walk("takes a starting look, and saves it under a name that it asks for, by keys alone", async (page, folder) => {
  await allDrawn(page, ".starts", 1);
  await page.locator(".start", { hasText: "Noir" }).focus();
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.aftershade.store.state.steps.length === 4);
  assert.equal(await page.locator(".gallery").isVisible(), false);
  await page.keyboard.press("Control+s");
  const dialog = page.locator(".save-dialog");
  await dialog.waitFor();
  await axe(page, "save");
  await shot(page, "save");
  await page.keyboard.type("../noir");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /not a name/.test(document.querySelector(".save-dialog .refusal").textContent));
  page.faults.length = 0; // browsers report the refusal
  await page.keyboard.press("Control+a");
  await page.keyboard.type("my noir");
  await page.keyboard.press("Enter");
  await dialog.waitFor({ state: "hidden" });
  assert.equal(readFileSync(join(folder, "my noir.json"), "utf8"), readFileSync(join(root, "looks/noir.json"), "utf8"));
  assert.equal(await page.locator(".file").innerText(), "my noir.json");
  await page.keyboard.press("Control+z"); // back to no steps, which is another look than the saved one
  await page.waitForFunction(() => window.aftershade.store.state.steps.length === 0);
  await page.locator(".gallery").waitFor();
});

walk(
  "makes the file of a new look when it is saved, and never replaces one",
  async (page, folder) => {
    assert.equal(await page.locator(".mark").innerText(), "new");
    assert.equal(existsSync(join(folder, "new.json")), false);
    await page.evaluate(() => window.aftershade.store.edit([{ op: "add", at: 0, effect: "vignette" }]));
    writeFileSync(join(folder, "new.json"), "{}");
    assert.equal(await page.evaluate(() => window.aftershade.store.save()), false, "another program made it");
    assert.equal(readFileSync(join(folder, "new.json"), "utf8"), "{}");
    rmSync(join(folder, "new.json"));
    assert.equal(await page.evaluate(() => window.aftershade.store.save()), true);
    assert.equal(
      readFileSync(join(folder, "new.json"), "utf8"),
      '{\n  "aftershade": 1,\n  "steps": [\n    { "effect": "vignette" }\n  ]\n}\n',
    );
  },
  { words: () => ["new.json", capture], mayFail: true },
);

/** Drops a file as a desktop does, as far as scripts can. */
const drop = (page, name, bytes) =>
  page.evaluate(
    ([file, size]) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([new Uint8Array(size)], file));
      document.body.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
    },
    [name, bytes],
  );

walk(
  "takes what is dropped from below the capture's folder, and says why it takes nothing else",
  async (page, folder) => {
    await page.evaluate(() => window.aftershade.store.edit([{ op: "add", at: 0, effect: "vignette" }]));
    const { size } = statSync(join(scene, "gbuffer_0004.exr"));
    await drop(page, "gbuffer_0004.exr", size);
    await page.waitForFunction(() => window.aftershade.store.state.capture.path.endsWith("shots/gbuffer_0004.exr"));
    await drawn(page);
    assert.deepEqual((await state(page)).capture.frames, [4]);
    assert.equal((await state(page)).steps.length, 1, "the look stays");
    await page.evaluate(() => window.aftershade.store.takeCapture({ name: "more" }));
    assert.ok((await state(page)).capture.path.endsWith("shots/more"));
    await drop(page, "gbuffer_0004.exr", size - 1);
    await page.waitForFunction(() => /or below, where this server may read/.test(document.body.innerText));
    await drop(page, "secret.exr", size);
    await page.waitForFunction(() => /'secret.exr' is not in/.test(document.body.innerText));
    assert.ok((await state(page)).capture.path.endsWith("shots/more"));
    assert.ok(existsSync(join(folder, "secret.exr")), "it is there, beside the capture's folder");
  },
  {
    mayFail: true,
    words: (folder) => {
      mkdirSync(join(folder, "shots/more"), { recursive: true });
      for (const [from, to] of [
        [3, "shots/gbuffer_0003.exr"],
        [4, "shots/gbuffer_0004.exr"],
        [3, "shots/more/in_0003.exr"],
        [4, "secret.exr"],
      ])
        copyFileSync(join(scene, `gbuffer_000${from}.exr`), join(folder, to));
      symlinkSync(join(folder, "secret.exr"), join(folder, "shots/more/secret.exr"));
      return ["shots/gbuffer_0003.exr"];
    },
  },
);
