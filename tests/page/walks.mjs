// What the walks of an artist through the page share: a page over a capture in a folder of its own.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, symlinkSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";

import { axeSource, openBrowser } from "./browser.mjs";
import { drawn, openServed, startServer } from "./served.mjs";

export const root = resolve(import.meta.dirname, "../.."),
  scene = join(root, "scenes/suzanne"),
  capture = join(scene, "capture.json"), // of Blender: 480 x 270 px, frames 3 and 4
  environment = { ...process.env, AFTERSHADE_BACKEND: "software" },
  shots = process.env.AFTERSHADE_PAGE_SHOTS; // a folder for screenshots to be looked at

let browser;
before(async () => (browser = await openBrowser()));
after(() => browser?.close());

/** A page over a capture in a folder of its own; the page must not complain, unless `mayFail`. */
export function walk(name, work, { words = [capture], mayFail = false, ...options } = {}) {
  test(name, { timeout: 400_000 }, async () => {
    const folder = mkdtempSync(join(tmpdir(), "aftershade-artist-"));
    let server, page;
    try {
      server = await startServer(typeof words === "function" ? words(folder) : words, {
        env: environment,
        cwd: folder,
      });
      page = await openServed(browser, server.address, options);
      await drawn(page);
      await work(page, folder, server);
      if (!mayFail) assert.deepEqual(page.faults, []);
    } finally {
      await page?.context().close();
      await server?.end();
      rmSync(folder, { recursive: true, force: true });
    }
  });
}
export const canProbeVideo = () =>
  ["ffmpeg", "ffprobe"].every((program) => spawnSync(program, ["-version"]).status === 0);
export const state = (page) => page.evaluate(() => window.aftershade.store.state);
export const steps = async (page) => (await state(page)).steps.map(({ effect }) => effect);
export const shot = (page, name) => shots && page.screenshot({ path: join(shots, `${name}.png`) });
export const allDrawn = (page, list, least) =>
  page.waitForFunction(
    ([selector, count]) => document.querySelectorAll(`${selector} canvas[data-drawn]`).length >= count,
    [list, least],
  );
export async function axe(page, place) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(readFileSync(axeSource, "utf8"));
  const { violations } = await page.evaluate(() => window.axe.run({ resultTypes: ["violations"] }));
  assert.deepEqual(
    violations.map(({ id, nodes }) => `${place}: ${id}: ${nodes.length} x ${nodes[0].html.slice(0, 160)}`),
    [],
  );
}

/** RGBA of a PNG file. */
export async function pixelsOf(file) {
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

const blender = join(process.env.AFTERSHADE_CAPTURES ?? "/nowhere", "blender-versions/5.2.3"),
  isThere = existsSync(blender);
/** Frames of Blender 5.2, with Cryptomattes of objects and of materials: its frames 3 and 4, also in turn. */
export const walkBlender = (name, work, { frames = [3, 4], words = () => [], ...options } = {}) =>
  isThere
    ? walk(name, work, {
        words: (folder) => {
          for (const frame of frames)
            symlinkSync(
              join(blender, `multi_000${frame % 2 ? 3 : 4}.exr`),
              join(folder, `multi_${String(frame).padStart(4, "0")}.exr`),
            );
          return ["multi_####.exr", ...words(folder)];
        },
        ...options,
      })
    : test(name, { skip: `no ${blender}; set AFTERSHADE_CAPTURES` }, () => {});
/** Clicks a place of the picture, in its pixels. */
export async function clickAt(page, x, y) {
  const place = await page.evaluate(
    ([px, py]) => {
      const { picture, canvas } = window.aftershade.viewer,
        box = canvas.getBoundingClientRect(),
        [left, top] = picture.corner;
      return [
        box.left + (left + (px + 0.5) * picture.zoom) / devicePixelRatio,
        box.top + (top + (py + 0.5) * picture.zoom) / devicePixelRatio,
      ];
    },
    [x, y],
  );
  await page.mouse.click(...place);
}
export const edit = (page, ...edits) => page.evaluate((list) => window.aftershade.store.edit(list), edits);
export async function opened(page, name) {
  const card = page.locator(`.step[data-step="${name}"]`);
  if ((await card.locator(".opener").getAttribute("aria-expanded")) === "false") await card.locator(".opener").click();
  return card;
}
/** Waits until the parameter of the first step is this. */
export const until = (page, param, value) =>
  page.waitForFunction(
    ([name, wanted]) => {
      const sorted = (one) =>
        JSON.stringify(one, (_, v) => (v?.constructor === Object ? Object.fromEntries(Object.entries(v).sort()) : v));
      return sorted(window.aftershade.store.state.steps[0].params[name]?.value) === sorted(wanted);
    },
    [param, value],
  );
export const SUZANNE = [240, 120];
