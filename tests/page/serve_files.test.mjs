// The waveform of the page, and the files that it hands out.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";

import { changed, compareWithPng, folder, frame, inPage, LOOK, runPicture, textOf } from "./look_page.mjs";
import { drawn } from "./served.mjs";

inPage("plots the brightness of the final picture by column, as luma and as parade", async (page, { look }) => {
  const words = () => page.locator(".panel canvas").nth(1).getAttribute("aria-label");
  await page.waitForFunction(() => /luma from/.test(document.querySelectorAll(".panel canvas")[1].ariaLabel));
  // The levels of each column, of the very PNG that `run` writes.
  const png = readFileSync(runPicture(look)).toString("base64");
  const measured = await page.evaluate(async (text) => {
    const bitmap = await createImageBitmap(
        new Blob([Uint8Array.from(atob(text), (character) => character.charCodeAt(0))], { type: "image/png" }),
      ),
      { width, height } = bitmap,
      context = new OffscreenCanvas(width, height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, width, height),
      [canvas] = [...document.querySelectorAll(".panel canvas")].slice(1),
      plot = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    let wrong = 0;
    const range = [128, -1];
    for (let x = 0; x < width; ++x) {
      const levels = new Set();
      for (let y = 0; y < height; ++y) {
        const at = 4 * (y * width + x);
        levels.add(Math.floor((0.2126 * data[at] + 0.7152 * data[at + 1] + 0.0722 * data[at + 2]) / 2));
      }
      for (const level of levels) [range[0], range[1]] = [Math.min(range[0], level), Math.max(range[1], level)];
      // Lines of the grid are fainter than the faintest level.
      for (let level = 0; level < 128; ++level)
        if (plot[4 * ((127 - level) * canvas.width + x) + 3] > 60 !== levels.has(level)) ++wrong;
    }
    return { wrong, width: canvas.width, range };
  }, png);
  assert.deepEqual([measured.width, measured.wrong], [240, 0]);
  const [low, high] = [measured.range[0], measured.range[1] + 1].map((level) => Math.round((100 * level) / 128));
  assert.equal(await words(), `Waveform: luma from ${low} to ${high} %`);
  await page.getByLabel("Waveform of").selectOption("parade");
  assert.match(await words(), /^Waveform: red from \d+ to \d+ %, green from \d+ to \d+ %, blue from \d+ to \d+ %$/);
  // Another view does not change it: it is of the final picture.
  const parade = await words();
  await page.getByLabel("View", { exact: true }).selectOption("role:depth");
  await drawn(page);
  await page.waitForTimeout(1000);
  assert.equal(await words(), parade);
});

async function downloaded(page, name) {
  await page.keyboard.press("x");
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("dialog", { name: "Export" }).getByRole("button", { name }).click(),
  ]);
  await page.keyboard.press("Escape");
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}

inPage("exports a still with the pixels that `run` writes, a contact sheet, and the look", async (page, { look }) => {
  const base = basename(look, ".json");
  await page.keyboard.press("."); // frame 2
  await page.keyboard.press("]"); // the viewer's exposure is the viewer's alone
  await drawn(page);
  const still = await downloaded(page, "Still");
  assert.equal(still.name, `${base}_0002.png`);
  await page.keyboard.press("[");
  await page.locator(".stage canvas").focus();
  await page.keyboard.press("1");
  await drawn(page);
  await frame(page);
  const file = join(folder, "still.png");
  writeFileSync(file, still.bytes);
  const { width, height, difference } = await compareWithPng(page, file);
  assert.deepEqual([width, height, difference], [240, 135, 0]);
  assert.equal((await compareWithPng(page, runPicture(look, 2))).difference, 0);

  const sheet = await downloaded(page, "Contact sheet");
  assert.equal(sheet.name, `${base}_sheet.png`);
  const colors = await page.evaluate(
    async ([sheetText, stillText]) => {
      const read = async (text) => {
        const bitmap = await createImageBitmap(
            new Blob([Uint8Array.from(atob(text), (character) => character.charCodeAt(0))], { type: "image/png" }),
          ),
          context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
        context.drawImage(bitmap, 0, 0);
        return context;
      };
      const [sheet, still] = [await read(sheetText), await read(stillText)],
        second = sheet.getImageData(8 + 248, 8, 240, 135).data, // frame 2 is the second of two columns
        expected = still.getImageData(0, 0, 240, 135).data;
      return {
        size: [sheet.canvas.width, sheet.canvas.height],
        difference: second.reduce((most, value, i) => Math.max(most, Math.abs(value - expected[i])), 0),
      };
    },
    [sheet.bytes.toString("base64"), still.bytes.toString("base64")],
  );
  assert.deepEqual(colors, { size: [2 * 248 + 8, 163 + 8], difference: 0 });

  const before = await textOf(page);
  await page.evaluate(() => window.aftershade.store.edit([{ op: "set", step: 1, param: "exposure", value: 0.7 }]));
  await changed(page, before);
  const text = await downloaded(page, "Look");
  assert.equal(text.name, `${base}.json`);
  assert.equal(text.bytes.toString(), LOOK.replace("0.3,", "0.7,"));
});
