// How the page saves a look, and follows its file.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { test } from "node:test";

import { changed, inPage, LOOK, lookOf, noRow, open, opened, row, serve, state, textOf } from "./look_page.mjs";
import { drawn } from "./served.mjs";

inPage("writes the file on Ctrl+S alone, and leaves its other lines alone", async (page, { look }) => {
  const mark = page.locator(".mark");
  assert.equal(await mark.innerText(), "");
  const before = await textOf(page);
  const field = row(await opened(page, "color_grade"), "exposure").getByRole("textbox");
  await field.fill("0.75");
  await field.press("Enter");
  await changed(page, before);
  assert.equal(await mark.innerText(), "unsaved");
  assert.equal(readFileSync(look, "utf8"), LOOK);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => window.aftershade.store.isSaved);
  assert.equal(readFileSync(look, "utf8"), LOOK.replace("0.3,", "0.75,"));
  assert.equal(await mark.innerText(), "");
});

inPage(
  "cannot save what is served with --read-only",
  async (page, { look }) => {
    assert.equal(await page.getByRole("button", { name: "Save" }).isDisabled(), true);
    assert.equal(await page.locator(".mark").innerText(), "read-only");
    await page.keyboard.press("Control+s");
    assert.match(await page.locator("#notice").innerText(), /--read-only/);
    assert.equal(readFileSync(look, "utf8"), LOOK);
  },
  { words: ["--read-only"] },
);

inPage("lists the faults of the text at their lines while the last good picture stays", async (page) => {
  const colors = () =>
    page
      .locator(".stage canvas")
      .evaluate((canvas) => [...canvas.getContext("2d").getImageData(canvas.width / 2, canvas.height / 2, 1, 1).data]);
  const good = await colors();
  await page.keyboard.press("t");
  const area = page.getByLabel("The look as JSON");
  assert.equal(await area.inputValue(), LOOK);
  await area.fill(LOOK.replace('"vignette"', '"vignete"').replace('"agx"', '"<img src=x>"'));
  await page.waitForFunction(() => window.aftershade.store.hasFaults);
  const faults = page.locator(".faults li");
  assert.match(await faults.first().innerText(), /^7:\d+[^]*vignete/);
  assert.match(await page.locator(".badge").innerText(), /last good picture/);
  assert.equal(await page.locator("#panel-text .faulty .number").first().innerText(), "7");
  await page.evaluate(() => window.aftershade.settled()); // a coarse picture may come first
  assert.deepEqual(await colors(), good);
  await faults.first().getByRole("button").click();
  const line = await area.evaluate((node) => node.value.slice(0, node.selectionStart).split("\n").length);
  assert.equal(line, 7);
  await area.fill(LOOK);
  await page.waitForFunction(() => window.aftershade.store.state.faults.length === 0);
  assert.equal(await page.locator(".faults").isVisible(), false);
});

inPage("takes names and messages as text", async (page) => {
  const text = LOOK.replace('"effect": "vignette"', '"effect": "vignette", "name": "<img src=x onerror=alert(1)>"');
  await page.evaluate((value) => window.aftershade.store.edit([{ op: "text", value }]), text);
  await page.waitForFunction(() => document.querySelectorAll(".step .name")[2].textContent.includes("<img"));
  assert.equal(await page.locator("#look img").count(), 0);
});

inPage(
  "keeps the last good picture where another program empties the look's file, and draws it again once it is back",
  async (page, { look }) => {
    const good = await page.evaluate(() => window.aftershade.viewer.picture.first !== null);
    assert.equal(good, true);
    writeFileSync(look, "");
    await page.waitForFunction(() => window.aftershade.store.hasFaults);
    await page.evaluate(() => window.aftershade.settled());
    assert.match(await page.locator(".faults li").first().innerText(), /^1:1/);
    assert.match(await page.locator(".badge").innerText(), /last good picture/);
    writeFileSync(look, LOOK.replace("0.3", "0.6"));
    await page.waitForFunction(() => !window.aftershade.store.hasFaults);
    await page.evaluate(() => window.aftershade.settled());
    assert.equal((await lookOf(page)).steps[1].params.exposure, 0.6);
    await page.waitForFunction(() => !/last good/.test(document.querySelector(".badge").textContent));
    assert.equal((await state(page)).revision, (await state(page)).saved_revision, "nothing is unsaved");
  },
  { own: true },
);

test("opens a look that is empty, and draws it once another program has written it", noRow, async () => {
  const server = await serve("");
  let page;
  try {
    page = await open(server.address);
    await page.waitForFunction(() => window.aftershade.store.state?.faults.length);
    await drawn(page);
    assert.equal(await page.locator(".badge").innerText(), "capture without steps: the look has faults");
    writeFileSync(server.look, LOOK);
    await page.waitForFunction(() => !window.aftershade.store.state.faults.length);
    await drawn(page);
    assert.deepEqual(page.faults, []);
  } finally {
    await page?.context().close();
    await server.end();
  }
});
