// What the tests of the authoring page share: a look that the program serves in a folder of its own, and its page.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";

import { openBrowser } from "./browser.mjs";
import { drawn, openServed, startServer } from "./served.mjs";
import { program } from "./suite.mjs";

export const root = resolve(import.meta.dirname, "../.."),
  capture = join(root, "scenes/starter/capture.json"), // 240 x 135 px
  folder = mkdtempSync(join(tmpdir(), "aftershade-serve-")),
  environment = { ...process.env, AFTERSHADE_BACKEND: "software" };
export const LOOK = `// Comments and spaces are the author's.
{
  "aftershade": 1,
  "steps": [
    { "effect": "bokeh", "enabled": false, "params": { "focus_distance": "6.4 m" } },
    { "effect": "color_grade", "params": { "exposure":  0.3, "slope": [1, 0.9, 0.8] } }, // warm
    { "effect": "vignette" },
    { "effect": "view_transform", "params": { "transform": "agx" } }
  ]
}
`;
export const described = (id) =>
  JSON.parse(spawnSync(program, ["describe", id, "--json"], { encoding: "utf8" }).stdout);
export const withoutComments = (text) =>
  JSON.parse(text.replace(/("(?:[^"\\]|\\.)*")|\/\/.*$/gm, (_, kept) => kept ?? ""));

let browser,
  shared,
  count = 0;
before(async () => {
  browser = await openBrowser();
  shared = await serve();
});
after(async () => {
  await shared?.end();
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

export const serve = (text, ...words) => serveOver(capture, text, ...words);
export async function serveOver(capture, text = LOOK, ...words) {
  const look = join(folder, `look_${++count}.json`);
  writeFileSync(look, text);
  const { address, end } = await startServer([look, capture, ...words], { env: environment });
  return { look, address, end };
}

export const open = (address, options) => openServed(browser, address, options);
export const state = (page) => page.evaluate(() => window.aftershade.store.state);
export const textOf = async (page) => (await state(page)).text;
export const lookOf = async (page) => withoutComments(await textOf(page));
/** The state's text when it is another than `old`. */
export async function changed(page, old) {
  await page.waitForFunction((before) => window.aftershade.store.state.text !== before, old);
  return lookOf(page);
}
export const step = (page, name) => page.locator(`.step[data-step="${name}"]`);
export async function opened(page, name) {
  const card = step(page, name),
    opener = card.locator(".opener");
  if ((await opener.getAttribute("aria-expanded")) === "false") await opener.click();
  return card;
}
export const row = (card, id) => card.locator(`[data-param="${id}"]`);

/** The server that most tests share, with LOOK as it was. */
export async function fresh() {
  const { origin, hash } = new URL(shared.address);
  const call = async (path, body) => {
    const headers = { "X-Aftershade-Token": hash.slice("#token=".length) };
    const response = await fetch(
      origin + path,
      body ? { method: "POST", headers, body: JSON.stringify(body) } : { headers },
    );
    assert.equal(response.status, 200, path);
    return response.json();
  };
  const { revision } = await call("/api/state");
  await call("/api/edit", { revision, edits: [{ op: "text", value: LOOK }] });
  await call("/api/save", {});
  return { ...shared, end: () => {} };
}

/** A test with a page of its own, which must not complain; with `words` or `own`, the server is its own, too. */
export function inPage(name, work, { own = false, words = [], ...options } = {}) {
  test(name, { timeout: 400_000 }, async () => {
    const server = own || words.length ? await serve(LOOK, ...words) : await fresh();
    let page;
    try {
      page = await open(server.address, options);
      await drawn(page);
      await work(page, server);
      assert.deepEqual(page.faults, []);
    } finally {
      await page?.context().close();
      await server.end();
    }
  });
}
export const noRow = { timeout: 240_000 };

export const middle = (page, dx = 0, dy = 0) =>
  page.locator(".stage canvas").evaluate(
    (canvas, [dx, dy]) => [
      ...canvas
        .getContext("2d")
        .getImageData(canvas.width / 2 + dx, canvas.height / 2 + dy, 1, 1)
        .data.slice(0, 3),
    ],
    [dx, dy],
  );
export const frame = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
/** A PNG file against the middle of the canvas, where its picture lies at 1:1; the page's policy takes no data: address. */
export const compareWithPng = (page, file) =>
  page.locator(".stage canvas").evaluate(async (canvas, text) => {
    const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0)),
      bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" })),
      { width, height } = bitmap,
      other = new OffscreenCanvas(width, height).getContext("2d");
    other.drawImage(bitmap, 0, 0);
    const expected = other.getImageData(0, 0, width, height).data,
      [left, top] = window.aftershade.viewer.picture.corner,
      found = canvas.getContext("2d").getImageData(left, top, width, height).data;
    const largest = (list) => list.reduce((most, value) => Math.max(most, value), 0);
    return {
      width,
      height,
      difference: largest(found.map((value, i) => Math.abs(value - expected[i]))),
      brightest: largest(found.filter((_, i) => i % 4 < 3)),
    };
  }, readFileSync(file).toString("base64"));
/** The PNG that `run` writes of a frame. */
export function runPicture(look, frame = 1) {
  const out = join(folder, `run_${++count}.png`);
  const result = spawnSync(program, ["run", look, capture, "-o", out, "--frames", String(frame)], {
    encoding: "utf8",
    env: environment,
  });
  assert.equal(result.status, 0, result.stderr);
  return out;
}

/** Runs `act` and returns the look that it makes. */
export async function lookAfter(page, act) {
  const before = await textOf(page);
  await act();
  return changed(page, before);
}
