// The look's text on the page: colours, wrapped lines and completion from the schema.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

import { axeSource } from "./browser.mjs";
import { described, inPage, LOOK } from "./look_page.mjs";

async function openText(page) {
  await page.keyboard.press("t");
  const area = page.getByLabel("The look as JSON"),
    answered = page.waitForResponse((response) => response.url().includes("/api/schema"));
  await area.focus();
  await answered;
  return area;
}
const caretBehind = (area, words) =>
  area.evaluate((node, before) => {
    const at = node.value.indexOf(before) + before.length;
    node.setSelectionRange(at, at);
  }, words);
const offered = (page) => page.locator("#panel-text .completion li").allInnerTexts();
const offersAtLeast = (page, count) => page.locator("#panel-text .completion li").nth(count - 1).waitFor();

inPage("completes keys and words of the look from the schema, by the keyboard alone", async (page) => {
  const area = await openText(page);
  await caretBehind(area, '{ "effect": "vignette"');
  await page.keyboard.type(', "par');
  await offersAtLeast(page, 1);
  assert.deepEqual(await offered(page), ["params"]);
  await page.keyboard.press("Enter");
  await page.keyboard.type("{ ");
  await page.keyboard.press("Control+Space");
  assert.deepEqual((await offered(page)).sort(), Object.keys(described("vignette").params).sort());
  await page.keyboard.type('"stre');
  assert.deepEqual(await offered(page), ["strength"]);
  assert.match(await page.locator("#panel-text .completion-words").innerText(), /vignette/);
  assert.equal(
    await area.getAttribute("aria-activedescendant"),
    await page.locator("#panel-text .completion li").first().getAttribute("id"),
  );
  await page.keyboard.press("Tab");
  await page.keyboard.type("0.4 }");
  const wanted = LOOK.replace('"vignette" }', '"vignette", "params": { "strength": 0.4 } }');
  await page.waitForFunction((text) => window.aftershade.store.state.text === text, wanted);
  await area.fill(LOOK);
  await caretBehind(area, '"transform": "');
  await page.keyboard.press("Control+Space");
  const { values } = described("view_transform").params.transform;
  for (const value of values) assert.ok((await offered(page)).includes(value) || value === "agx", value);
  await page.keyboard.press("Escape");
  assert.deepEqual(await offered(page), []);
  // What was taken is undone as the browser undoes typing.
  await page.keyboard.press("Control+Space");
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  assert.notEqual(await area.inputValue(), LOOK);
  await page.keyboard.press("Control+z");
  await page.waitForFunction((text) => document.querySelector("#panel-text textarea").value === text, LOOK);
});

inPage("opens the list that was wanted before its words had come", async (page) => {
  const wanted = new Promise((resolve) => page.route("**/api/schema*", resolve));
  await page.keyboard.press("t");
  const area = page.getByLabel("The look as JSON");
  await area.focus();
  await area.fill('{ "aftershade": 1, "steps": [ { "effect": "');
  await page.keyboard.press("Control+Space");
  assert.deepEqual(await offered(page), []);
  await (await wanted).continue();
  await offersAtLeast(page, 10);
  await area.fill(LOOK);
  await page.unroute("**/api/schema*");
});

inPage("offers the effects, and for each step its own parameters and presets alone", async (page) => {
  const area = await openText(page);
  await area.fill('{ "aftershade": 1, "steps": [ { "effect": "');
  await page.keyboard.press("Control+Space");
  const effects = await page.evaluate(() => [...window.aftershade.store.effects.keys()]);
  await offersAtLeast(page, Math.min(effects.length, 38));
  await area.fill('{ "aftershade": 1, "steps": [ { "effect": "dof" }, { "effect": "bokeh", "preset": "');
  await page.keyboard.press("Control+Space");
  assert.deepEqual((await offered(page)).sort(), Object.keys(described("bokeh").presets).sort());
  for (const [text, wanted] of [
    ['"mask": { "', ["file", "invert", "object", "role", "var"]],
    ['"params": { "focus_distance": { "keys": { "1": { "value": 2, "interpolation": "', ["linear", "smooth", "step"]],
    ['"params": { "shape": "hex', ["hexagon"]],
    ['// "mask": "', []],
  ]) {
    await area.fill(`{ "aftershade": 1, "steps": [ { "effect": "bokeh", ${text}`);
    await page.keyboard.press("Control+Space");
    assert.deepEqual((await offered(page)).sort(), wanted, text);
    await page.keyboard.press("Escape");
  }
  await area.fill(LOOK);
});

inPage(
  "wraps long lines under their numbers, and colours each part",
  async (page) => {
    const area = await openText(page),
      long = LOOK.replace('"steps"', `"summary": "${"many words ".repeat(20)}",\n  "steps"`);
    await area.fill(long);
    await page.waitForFunction((text) => window.aftershade.store.state.text === text, long);
    const sizes = await page.evaluate(() => {
      const [text, back] = ["textarea", ".back"].map((name) => document.querySelector(`#panel-text ${name}`)),
        lines = [...back.children].map((node) => node.getBoundingClientRect().height);
      return { wide: text.scrollWidth - text.clientWidth, apart: text.scrollHeight - back.scrollHeight, lines };
    });
    assert.equal(sizes.wide, 0);
    assert.equal(sizes.apart, 0, "the lines under the text are as high");
    assert.ok(sizes.lines[3] >= 3 * 18 && sizes.lines[1] === 18, sizes.lines.join());
    const colored = (kind) =>
      page.evaluate(
        (name) =>
          [...CSS.highlights.get(`code-${name}`)].map((range) =>
            range.startContainer.data.slice(range.startOffset, range.endOffset),
          ),
        kind,
      );
    assert.deepEqual(await colored("comment"), ["// Comments and spaces are the author's.", "// warm"]);
    assert.deepEqual(await colored("number"), ["1", "0.3", "1", "0.9", "0.8"]);
    assert.deepEqual(await colored("word"), ["false"]);
    assert.ok((await colored("name")).includes('"slope"') && (await colored("string")).includes('"agx"'));
    await caretBehind(area, '"effect": "vignette"');
    await page.keyboard.type(', "');
    await page.locator("#panel-text .completion li").first().waitFor();
    await page.evaluate(readFileSync(axeSource, "utf8"));
    const { violations } = await page.evaluate(() => window.axe.run({ resultTypes: ["violations"] }));
    assert.deepEqual(
      violations.map(({ id, nodes }) => `${id}: ${nodes[0].html.slice(0, 160)}`),
      [],
    );
    await area.fill(LOOK);
  },
  { viewport: { width: 390, height: 844 } },
);
