// The authoring page of `aftershade serve`, as its users have it: the program serves a look in a folder of its own.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { after, before, test } from "node:test";

import { axeSource, openBrowser } from "./browser.mjs";
import { random, randomEdit } from "./random_edits.mjs";
import { drawn, openServed, startServer } from "./served.mjs";
import { program } from "./suite.mjs";
import { TINT, tintShader } from "./tint.mjs";

const root = resolve(import.meta.dirname, "../.."),
  capture = join(root, "scenes/starter/capture.json"), // 240 x 135 px
  folder = mkdtempSync(join(tmpdir(), "aftershade-serve-")),
  environment = { ...process.env, AFTERSHADE_BACKEND: "software" };
const LOOK = `// Comments and spaces are the author's.
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
const described = (id) => JSON.parse(spawnSync(program, ["describe", id, "--json"], { encoding: "utf8" }).stdout);
const withoutComments = (text) => JSON.parse(text.replace(/("(?:[^"\\]|\\.)*")|\/\/.*$/gm, (_, kept) => kept ?? ""));

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

const serve = (text, ...words) => serveOver(capture, text, ...words);
async function serveOver(capture, text = LOOK, ...words) {
  const look = join(folder, `look_${++count}.json`);
  writeFileSync(look, text);
  const { address, end } = await startServer([look, capture, ...words], { env: environment });
  return { look, address, end };
}

const open = (address, options) => openServed(browser, address, options);
const state = (page) => page.evaluate(() => window.aftershade.store.state);
const textOf = async (page) => (await state(page)).text;
const lookOf = async (page) => withoutComments(await textOf(page));
/** The state's text when it is another than `old`. */
async function changed(page, old) {
  await page.waitForFunction((before) => window.aftershade.store.state.text !== before, old);
  return lookOf(page);
}
const step = (page, name) => page.locator(`.step[data-step="${name}"]`);
async function opened(page, name) {
  const card = step(page, name),
    opener = card.locator(".opener");
  if ((await opener.getAttribute("aria-expanded")) === "false") await opener.click();
  return card;
}
const row = (card, id) => card.locator(`[data-param="${id}"]`);

/** The server that most tests share, with LOOK as it was. */
async function fresh() {
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
function inPage(name, work, { own = false, words = [], ...options } = {}) {
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
const noRow = { timeout: 240_000 };

// ---- the look ----

inPage("requests nothing but from the program that serves it", async (page, { address }) => {
  const { origin } = new URL(address);
  assert.ok(page.requests.length > 10);
  assert.deepEqual(
    page.requests.filter((url) => new URL(url).origin !== origin),
    [],
  );
});

inPage("shows each step with the look's values, their units and their sources", async (page) => {
  assert.deepEqual(await page.locator(".step .name").allInnerTexts(), [
    "bokeh",
    "color_grade",
    "vignette",
    "view_transform",
  ]);
  assert.equal(await page.getByLabel("Enable bokeh").isChecked(), false);
  assert.equal(await page.getByLabel("Enable vignette").isChecked(), true);
  const bokeh = await opened(page, "bokeh"),
    focus = row(bokeh, "focus_distance");
  assert.equal(await focus.getByRole("textbox").inputValue(), "6.4");
  assert.equal(await focus.getByRole("slider").getAttribute("aria-valuetext"), "6.4 m");
  assert.match(await focus.locator(".hint").textContent(), /set in the look/);
  assert.match(await row(bokeh, "squeeze").locator(".hint").textContent(), /default/);
  const grade = await opened(page, "color_grade");
  const slope = await row(grade, "slope")
    .getByRole("textbox")
    .evaluateAll((fields) => fields.slice(-3).map(({ value }) => value));
  assert.deepEqual(slope, ["1", "0.9", "0.8"]);
});

inPage("makes a control for every parameter of every effect from its declaration", async (page) => {
  const list = JSON.parse(spawnSync(program, ["list", "--json"], { encoding: "utf8" }).stdout);
  const ids = list.map(({ id }) => id);
  const text = JSON.stringify({ aftershade: 1, steps: ids.map((effect) => ({ effect, enabled: false })) });
  await page.evaluate((value) => window.aftershade.store.edit([{ op: "text", value }]), text);
  for (const id of ids) {
    const { params } = described(id),
      card = step(page, id);
    await card.locator(".opener").evaluate((node) => node.click());
    const rows = await card.locator("[data-param]").evaluateAll((nodes) =>
      nodes.map((node) => ({
        id: node.dataset.param,
        slider: node.querySelector("input[type=range]") !== null,
        box: node.querySelector("input[type=checkbox]") !== null,
        choices: [...node.querySelectorAll("option")].map(({ value }) => value),
        swatch: node.querySelector("input[type=color]") !== null,
        fields: node.querySelectorAll("input[type=text]").length,
        unit: node.querySelector(".unit")?.textContent,
        hint: node.querySelector(".hint").textContent,
      })),
    );
    // Without a section first, then by section, and the advanced ones last.
    const named = Object.entries(params),
      sections = [...new Set(["", ...named.map(([, { section = "" }]) => section)])],
      inOrder = sections.flatMap((one) => named.filter(([, p]) => !p.advanced && (p.section ?? "") === one));
    assert.deepEqual(
      rows.map((one) => one.id),
      [...inOrder, ...named.filter(([, p]) => p.advanced)].map(([name]) => name),
      id,
    );
    for (const one of rows) {
      const { type, unit, values, doc, columns } = params[one.id],
        place = `${id}.${one.id}`;
      assert.ok(one.hint.startsWith(doc), place);
      const isNumber = ["float", "int", "angle"].includes(type);
      assert.equal(one.slider, isNumber, place);
      if (isNumber) assert.equal(one.unit, unit ?? "", place);
      if (type === "table") {
        // The line of the others, and the field that adds a line.
        const types = Object.values(columns).map((column) => column.type);
        assert.equal(one.box, types.includes("bool"), place);
        assert.equal(one.fields, 1 + types.filter((kind) => kind !== "bool" && kind !== "enum").length, place);
        continue;
      }
      if (type === "scattering_profile") {
        const shipped = JSON.parse(
          spawnSync(program, ["list", "--scattering-profiles", "--json"], { encoding: "utf8" }).stdout,
        ).map(({ name }) => name);
        assert.deepEqual(
          one.choices,
          [...shipped, "burley", "gaussians", "dipole", "artist", "file", ...shipped],
          place,
        );
        continue;
      }
      assert.equal(one.box, type === "bool", place);
      assert.equal(one.swatch, type === "color", place);
      assert.deepEqual(one.choices, values ?? [], place);
      assert.equal(one.fields, { bool: 0, enum: 0, color: 3, vec2: 2, vec3: 3, vec4: 4 }[type] ?? 1, place);
    }
    await card.locator(".opener").evaluate((node) => node.click());
  }
});

inPage("moves a slider by keys within its range, and changes that value alone", async (page) => {
  const before = await textOf(page),
    slider = row(await opened(page, "vignette"), "natural").getByRole("slider");
  await slider.focus();
  await slider.press("ArrowLeft");
  const look = await changed(page, before);
  const { default: fallback } = described("vignette").params.natural;
  assert.notEqual(look.steps[2].params.natural, fallback);
  assert.equal(typeof look.steps[2].params.natural, "number");
  const kept = (await textOf(page)).split("\n").filter((line) => !line.includes("vignette"));
  assert.deepEqual(
    kept,
    before.split("\n").filter((line) => !line.includes("vignette")),
  );
});

inPage("takes a typed value beyond the slider, and refuses one beyond the limits with both limits", async (page) => {
  const { ui, min, max } = described("color_grade").params.exposure;
  assert.ok(max > ui[1]);
  const exposure = row(await opened(page, "color_grade"), "exposure"),
    field = exposure.getByRole("textbox");
  const before = await textOf(page);
  await field.fill(String(ui[1] + 0.5));
  await field.press("Enter");
  assert.equal((await changed(page, before)).steps[1].params.exposure, ui[1] + 0.5);
  const now = await textOf(page);
  await field.fill(String(max + 1));
  await field.press("Enter");
  assert.match(await exposure.getByRole("alert").innerText(), new RegExp(`${min} to ${max}`));
  assert.equal(await field.getAttribute("aria-invalid"), "true");
  assert.equal(await textOf(page), now);
  await field.press("Escape");
  assert.equal(await field.inputValue(), String(ui[1] + 0.5));
  assert.equal(await exposure.locator(".refusal").textContent(), "");
});

inPage("takes units: as typed, and as the look writes them", async (page) => {
  const focus = row(await opened(page, "bokeh"), "focus_distance"),
    field = focus.getByRole("textbox");
  let before = await textOf(page);
  await field.fill("5");
  await field.press("Enter");
  assert.equal((await changed(page, before)).steps[0].params.focus_distance, "5 m");
  before = await textOf(page);
  await field.fill("240 cm");
  await field.press("Enter");
  assert.equal((await changed(page, before)).steps[0].params.focus_distance, "240 cm");
  assert.equal(await focus.getByRole("slider").getAttribute("aria-valuetext"), "2.4 m");
});

inPage("sets choices, switches, colours and lists", async (page) => {
  const bokeh = await opened(page, "bokeh");
  let before = await textOf(page);
  await row(bokeh, "shape").getByRole("combobox").selectOption("octagon");
  assert.equal((await changed(page, before)).steps[0].params.shape, "octagon");
  before = await textOf(page);
  await bokeh.getByText("Advanced").click();
  await row(bokeh, "highlight_repair").getByRole("checkbox").uncheck();
  assert.equal((await changed(page, before)).steps[0].params.highlight_repair, false);
  before = await textOf(page);
  const green = row(await opened(page, "color_grade"), "slope").getByLabel("slope, green");
  await green.fill("0.5");
  await green.press("Enter");
  assert.deepEqual((await changed(page, before)).steps[1].params.slope, [1, 0.5, 0.8]);
  before = await textOf(page);
  await page.evaluate(() =>
    window.aftershade.store.edit([
      { op: "add", at: 0, effect: "sss_burley" },
      { op: "enable", step: 0, value: false },
    ]),
  );
  await changed(page, before);
  before = await textOf(page);
  const objects = row(await opened(page, "sss_burley"), "object_ids").getByRole("textbox");
  await objects.fill("2, 4-7");
  await objects.press("Enter");
  assert.deepEqual((await changed(page, before)).steps[0].params.object_ids, [2, "4-7"]);
});

inPage("resets a value by taking its key out of the look", async (page) => {
  const before = await textOf(page),
    exposure = row(await opened(page, "color_grade"), "exposure");
  await exposure.getByRole("button", { name: "Reset exposure" }).click();
  const look = await changed(page, before);
  assert.deepEqual(look.steps[1].params, { slope: [1, 0.9, 0.8] });
  assert.equal(
    await exposure.getByRole("textbox").inputValue(),
    String(described("color_grade").params.exposure.default),
  );
  assert.equal(await exposure.getByRole("button", { name: "Reset exposure" }).isVisible(), false);
});

inPage("shows that a preset gives a value", async (page) => {
  const { presets } = described("color_grade"),
    [name, values] = Object.entries(presets).find(([, values]) =>
      Object.keys(values).some((id) => !["exposure", "slope"].includes(id)),
    );
  const id = Object.keys(values).find((id) => !["exposure", "slope"].includes(id));
  const before = await textOf(page),
    card = await opened(page, "color_grade");
  await card.getByLabel("Preset").selectOption(name);
  assert.equal((await changed(page, before)).steps[1].preset, name);
  assert.match(await row(card, id).locator(".hint").textContent(), /from the preset/);
});

inPage("undoes a whole drag of a slider in one step, and redoes it", async (page) => {
  const slider = row(await opened(page, "vignette"), "natural").getByRole("slider"),
    { revision } = await state(page);
  await slider.scrollIntoViewIfNeeded();
  const box = await slider.boundingBox();
  const at = async (share) => page.mouse.move(box.x + box.width * share, box.y + box.height / 2);
  await at(0.5);
  await page.mouse.down();
  for (const share of [0.45, 0.4, 0.35, 0.3, 0.25, 0.2]) {
    await at(share);
    await page.waitForTimeout(60);
  }
  await page.mouse.up();
  await drawn(page);
  const dragged = await textOf(page);
  assert.notEqual(dragged, LOOK);
  assert.ok((await state(page)).revision > revision + 1, "the picture followed the drag");
  await page.keyboard.press("Control+z");
  await page.waitForFunction((text) => window.aftershade.store.state.text === text, LOOK);
  await page.keyboard.press("Control+Shift+z");
  await page.waitForFunction((text) => window.aftershade.store.state.text === text, dragged);
});

inPage("compiles a value that is compiled in once a drag rests, not at each place of the slider", async (page) => {
  const dof = { aftershade: 1, steps: [{ effect: "dof", params: { curvature: 0.9 } }] };
  await page.evaluate((value) => window.aftershade.store.edit([{ op: "text", value }]), JSON.stringify(dof));
  await drawn(page);
  const slider = row(await opened(page, "dof"), "curvature").getByRole("slider"),
    { revision } = await state(page);
  await slider.scrollIntoViewIfNeeded();
  const box = await slider.boundingBox();
  const at = async (share) => page.mouse.move(box.x + box.width * share, box.y + box.height / 2);
  await at(0.9);
  await page.mouse.down();
  for (const share of [0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2]) await at(share);
  const typed = row(step(page, "dof"), "curvature").getByRole("textbox");
  assert.ok(Math.abs((await typed.inputValue()) - 0.2) < 0.05, "the number follows the drag");
  assert.equal((await lookOf(page)).steps[0].params.curvature, 0.9, "the look waits");
  await changed(page, JSON.stringify(dof)); // the slider is still held
  await at(0.1);
  await page.mouse.up();
  await drawn(page);
  const { curvature } = (await lookOf(page)).steps[0].params;
  assert.ok(Math.abs(curvature - 0.1) < 0.05, `${curvature}`);
  assert.equal((await state(page)).revision, revision + 2, "once when the slider rests, once when it is released");
});

inPage("adds a step that is found by a word of its summary", async (page) => {
  const before = await textOf(page);
  await page.keyboard.press("a");
  await page.keyboard.type("grain");
  const found = await page.locator("#found [role=option]").evaluateAll((nodes) => nodes.map((node) => node.dataset.effect));
  assert.equal(found[0], "film_grain");
  await page.getByLabel("Search effects by name and summary").fill("fireflies zzz");
  assert.equal(await page.getByText("No effect matches.").isVisible(), true);
  await page.getByLabel("Search effects by name and summary").fill("scatters pyramid");
  await page.keyboard.press("Enter");
  const look = await changed(page, before);
  assert.deepEqual(
    look.steps.map(({ effect }) => effect),
    ["bokeh", "color_grade", "vignette", "bloom", "view_transform"],
  );
  await page.waitForFunction(() => document.activeElement.closest(".step")?.dataset.step === "bloom");
});

inPage("moves steps by keys and by the pointer", async (page) => {
  const names = () => page.locator(".step .name").allInnerTexts();
  await page.keyboard.press("s");
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Alt+ArrowDown");
  await page.waitForFunction(() => document.querySelectorAll(".step .name")[1].textContent === "vignette");
  assert.deepEqual(await names(), ["bokeh", "vignette", "color_grade", "view_transform"]);
  await page.waitForFunction(() => document.activeElement.closest(".step")?.dataset.step === "color_grade");
  await step(page, "bokeh").locator(".opener").click(); // closes it, so that all heads are in sight
  const grip = await step(page, "color_grade").locator(".grip").boundingBox(),
    first = await step(page, "bokeh").boundingBox();
  await page.mouse.move(grip.x + 8, grip.y + 8);
  await page.mouse.down();
  await page.mouse.move(grip.x + 8, first.y + 20, { steps: 4 });
  await page.mouse.move(grip.x + 8, first.y + 3, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(() => document.querySelector(".step .name").textContent === "color_grade");
  assert.deepEqual(
    (await lookOf(page)).steps.map(({ effect }) => effect),
    ["color_grade", "bokeh", "vignette", "view_transform"],
  );
});

inPage("names, blends, disables and removes a step", async (page) => {
  let before = await textOf(page);
  const card = await opened(page, "vignette"),
    name = card.getByLabel("Name");
  await name.fill("edges");
  await name.press("Enter");
  assert.equal((await changed(page, before)).steps[2].name, "edges");
  before = await textOf(page);
  const mix = step(page, "edges").getByRole("textbox", { name: "mix" });
  await mix.fill("0.25");
  await mix.press("Enter");
  assert.equal((await changed(page, before)).steps[2].mix, 0.25);
  before = await textOf(page);
  await step(page, "edges").locator(".opener").focus();
  await page.keyboard.press("e");
  assert.equal((await changed(page, before)).steps[2].enabled, false);
  before = await textOf(page);
  await page.keyboard.press("Delete");
  assert.equal((await changed(page, before)).steps.length, 3);
});

// ---- saving ----

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
  assert.equal(await page.locator(".numbers .faulty").first().innerText(), "7");
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

// ---- the picture ----

const middle = (page, dx = 0, dy = 0) =>
  page.locator(".stage canvas").evaluate(
    (canvas, [dx, dy]) => [
      ...canvas
        .getContext("2d")
        .getImageData(canvas.width / 2 + dx, canvas.height / 2 + dy, 1, 1)
        .data.slice(0, 3),
    ],
    [dx, dy],
  );
const frame = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
/** A PNG file against the middle of the canvas, where its picture lies at 1:1; the page's policy takes no data: address. */
const compareWithPng = (page, file) =>
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
function runPicture(look, frame = 1) {
  const out = join(folder, `run_${++count}.png`);
  const result = spawnSync(program, ["run", look, capture, "-o", out, "--frames", String(frame)], {
    encoding: "utf8",
    env: environment,
  });
  assert.equal(result.status, 0, result.stderr);
  return out;
}

inPage("shows the very pixels that `run` writes", async (page, { look }) => {
  await page.keyboard.press("1");
  await frame(page);
  const { width, height, difference, brightest } = await compareWithPng(page, runPicture(look));
  assert.deepEqual([width, height], [240, 135]);
  assert.ok(brightest > 100);
  assert.equal(difference, 0);
});

inPage(
  "shows a coarse picture first, then the full one, and of a burst of edits the newest",
  async (page) => {
    const scales = page.requests
      .filter((url) => url.includes("/api/picture"))
      .map((url) => new URL(url).searchParams.get("scale"));
    assert.deepEqual(scales.slice(0, 2), ["4", "1"]);
    await page.evaluate(() => {
      window.seen = [];
      window.aftershade.viewer.pictures.addEventListener("picture", ({ detail }) =>
        window.seen.push([detail.isCoarse, detail.bitmap.width, detail.wish.revision]),
      );
    });
    await page.evaluate(async () => {
      const { store } = window.aftershade;
      await store.edit([{ op: "add", at: 1, effect: "bokeh_gather" }]);
      for (let i = 0; i < 30; ++i) await store.edit([{ op: "set", step: 1, param: "f_number", value: 0.2 + i / 100 }]);
    });
    await drawn(page);
    const seen = await page.evaluate(() => window.seen),
      { revision } = await state(page);
    assert.deepEqual(seen.at(-1), [false, 240, revision]);
    const coarse = seen.filter(([isCoarse]) => isCoarse);
    for (const [, width] of coarse) assert.equal(width, 60);
    assert.ok(seen.length - coarse.length < 31, "older full pictures were given up");
    for (let i = 1; i < seen.length; ++i) assert.ok(seen[i][2] >= seen[i - 1][2], "no older picture after a newer one");
  },
  { own: true },
);

inPage("keeps pixels when it zooms, fits again, and pans", async (page) => {
  await page.locator(".stage canvas").focus();
  await page.keyboard.press("1");
  for (let i = 0; i < 6; ++i) await page.keyboard.press("+");
  assert.equal(await page.locator(".zoom").innerText(), "800 %");
  await frame(page);
  const row = await page.locator(".stage canvas").evaluate((canvas) => {
    const { corner } = window.aftershade.viewer.picture,
      data = canvas.getContext("2d").getImageData(0, Math.round(canvas.height / 2), canvas.width, 1).data;
    return {
      left: corner[0],
      colors: Array.from({ length: canvas.width }, (_, x) => data.slice(4 * x, 4 * x + 3).join()),
    };
  });
  for (let x = 0; x < row.colors.length - 8; ++x)
    if ((x - row.left) % 8 !== 7 && x + 1 < row.colors.length)
      assert.equal(row.colors[x], row.colors[x + 1], `column ${x}`);
  assert.ok(new Set(row.colors).size > 8);
  const before = await page.evaluate(() => window.aftershade.viewer.picture.corner[0]);
  await page.keyboard.press("Control+ArrowRight");
  assert.ok((await page.evaluate(() => window.aftershade.viewer.picture.corner[0])) < before);
  await page.keyboard.press("0");
  const { zoom, canvas } = await page.evaluate(() => {
    const { zoom, canvas } = window.aftershade.viewer.picture;
    return { zoom, canvas: [canvas.width, canvas.height] };
  });
  assert.equal(zoom, Math.min(canvas[0] / 240, canvas[1] / 135));
});

inPage("makes the picture brighter by the viewer's exposure, and leaves the look alone", async (page) => {
  const before = await middle(page);
  await page.keyboard.press("]");
  await page.keyboard.press("]");
  await drawn(page);
  await frame(page);
  const after = await middle(page);
  assert.ok(after[1] > before[1], `${before} -> ${after}`);
  assert.equal(await page.getByLabel("Viewer exposure, EV").inputValue(), "1");
  assert.equal(await textOf(page), LOOK);
});

inPage("wipes between the result and what was before", async (page) => {
  const [left, right] = [await middle(page, -60), await middle(page, 60)];
  await page.keyboard.press("w");
  await drawn(page);
  await frame(page);
  assert.deepEqual(await middle(page, -60), left);
  const other = await middle(page, 60);
  assert.notDeepEqual(other, right);
  const wipe = page.getByRole("slider", { name: "Wipe" });
  await wipe.focus();
  await wipe.press("End");
  await frame(page);
  assert.deepEqual(await middle(page, 60), right);
  await page.keyboard.down("b");
  await frame(page);
  assert.deepEqual(await middle(page, 60), other);
  await page.keyboard.up("b");
  await frame(page);
  assert.deepEqual(await middle(page, 60), right);
});

inPage("compares with a kept picture of another setting", async (page) => {
  await page.keyboard.press("k");
  const kept = await middle(page, 60);
  await page.evaluate(() => window.aftershade.store.edit([{ op: "set", step: 1, param: "exposure", value: 2 }]));
  await drawn(page);
  await frame(page);
  assert.deepEqual(await middle(page, 60), kept);
  assert.ok((await middle(page, -60))[1] > 0);
  await page.keyboard.press("w");
  await frame(page);
  assert.notDeepEqual(await middle(page, 60), kept);
});

inPage("shows every role and every output of a step", async (page) => {
  const views = await page
    .getByLabel("View", { exact: true })
    .locator("option")
    .evaluateAll((nodes) => nodes.map(({ value }) => value));
  for (const role of ["color", "depth", "velocity", "object_id"]) assert.ok(views.includes(`role:${role}`), role);
  const seen = new Set();
  for (const view of ["final", "before", "role:depth", "role:velocity", "role:object_id", "tap:color_grade.color"]) {
    await page.getByLabel("View", { exact: true }).selectOption(view);
    await drawn(page);
    await frame(page);
    assert.equal(await page.locator(".badge.error").count(), 0, view);
    seen.add(String([await middle(page, -100, 40), await middle(page, 0), await middle(page, 120, 90)]));
  }
  assert.ok(seen.size >= 5, `${seen.size} different pictures`);
});

inPage("shows every role's value and unit under the pointer, and by the arrow keys", async (page) => {
  const stored = spawnSync(program, ["inspect", capture, "--pixel", "120,67"], { encoding: "utf8" }).stdout;
  const canvas = page.locator(".stage canvas"),
    box = await canvas.boundingBox();
  await page.mouse.move(box.x + box.width / 2 + 1, box.y + box.height / 2 - 2);
  await page.waitForFunction(() => document.querySelector(".panel tbody tr"));
  const rows = () =>
    page
      .locator(".panel tbody tr")
      .evaluateAll((nodes) =>
        Object.fromEntries(
          nodes.map((node) => [node.cells[0].textContent, [...node.cells].slice(1).map((cell) => cell.textContent)]),
        ),
      );
  const found = await rows();
  for (const role of ["final", "color", "depth", "velocity", "object_id"]) assert.ok(found[role], role);
  assert.equal(found.depth.at(-1), "m");
  assert.equal(found.velocity.at(-1), "px");
  assert.equal(await page.locator(".panel .aside").first().innerText(), "120, 67");
  const depth = Number(found.depth[0]);
  assert.ok(
    [...stored.matchAll(/[-\d.e+]+/g)].some(([text]) => Math.abs(Number(text) - depth) < 2e-3 * Math.abs(depth)),
    `${depth} in ${stored}`,
  );
  await canvas.focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowDown");
  await page.waitForFunction(() => document.querySelector(".panel .aside").textContent === "121, 77");
});

inPage("sets the focus distance by a click in the picture", async (page) => {
  const before = await textOf(page);
  const focus = row(await opened(page, "bokeh"), "focus_distance");
  await focus.getByRole("button", { name: /^Pick/ }).click();
  const box = await page.locator(".stage canvas").boundingBox();
  await page.mouse.click(box.x + box.width / 2 + 1, box.y + box.height / 2 - 2);
  const look = await changed(page, before);
  const cell = (role) =>
    page.evaluate(
      (name) =>
        [...document.querySelectorAll(".panel tbody tr")].find((node) => node.cells[0].textContent === name)?.cells[1]
          .textContent,
      role,
    );
  assert.deepEqual(look.steps[0].params.focus_distance, { from: "depth", object: Number(await cell("object_id")) });
  // With Shift, the focus is at the point.
  const followed = await textOf(page);
  await focus.getByRole("button", { name: /^Pick/ }).click();
  await page.keyboard.down("Shift");
  await page.mouse.click(box.x + box.width / 2 + 1, box.y + box.height / 2 - 2);
  await page.keyboard.up("Shift");
  const point = await changed(page, followed);
  assert.equal(point.steps[0].params.focus_distance, Number(await cell("depth")));
});

inPage("plots the histogram of the final picture", async (page) => {
  await page.waitForFunction(() =>
    /most pixels/.test(document.querySelector(".plot canvas").getAttribute("aria-label")),
  );
  const painted = await page
    .locator(".plot canvas")
    .first()
    .evaluate((canvas) => {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      return data.filter((value, i) => i % 4 === 3 && value > 100).length;
    });
  assert.ok(painted > 200, `${painted} px`);
});

test("shows the truth beside the frame, and how far the steps' colour is from it", async () => {
  const beside = mkdtempSync(join(folder, "truth-")),
    file = join(beside, "gbuffer_0001.exr"),
    text = JSON.stringify({ aftershade: 1, steps: [{ effect: "color_grade", params: { exposure: 0.3 } }] });
  copyFileSync(join(root, "scenes/starter/gbuffer_0001.exr"), file);
  writeFileSync(join(beside, "look.json"), text);
  const made = spawnSync(
    program,
    ["run", join(beside, "look.json"), file, "--pixel-type", "float", "-o", join(beside, "truth_lens_0001.exr")],
    { env: environment, encoding: "utf8" },
  );
  assert.equal(made.status, 0, made.stderr);
  const server = await serveOver(file, text);
  try {
    const page = await open(server.address);
    await drawn(page);
    const figures = page.getByRole("group", { name: "Distance from the truth" });
    await figures.getByText("lens: equal, FLIP 0").waitFor();
    await page.evaluate(() =>
      window.aftershade.store.edit([{ op: "set", step: 0, param: "exposure", value: 0.5 }]),
    );
    await figures.getByText(/^lens: \d+(\.\d+)? dB, FLIP 0\.\d+$/).waitFor();
    const bytes = async () => {
      await drawn(page);
      await frame(page);
      return page.locator(".stage canvas").evaluate((canvas) => canvas.toDataURL());
    };
    const final = await bytes();
    await page.getByLabel("View", { exact: true }).selectOption("truth:lens");
    const truth = await bytes();
    assert.ok(truth !== final, "the truth is another picture");
    await page.getByLabel("View", { exact: true }).selectOption({ label: "difference to lens" });
    const dark = await bytes();
    assert.ok(dark !== truth && dark !== final, "so is what they differ by");
    await page.keyboard.press("]");
    await page.keyboard.press("]");
    assert.ok((await bytes()) !== dark, "which the exposure brightens");
    assert.deepEqual(page.faults, []);
    await page.context().close();
  } finally {
    await server.end();
  }
});

inPage("steps through the frames and plays them", async (page) => {
  const number = page.getByLabel("Frame number");
  assert.equal(await number.inputValue(), "1");
  const sum = () =>
    page.locator(".stage canvas").evaluate((canvas) =>
      canvas
        .getContext("2d")
        .getImageData(0, 0, canvas.width, canvas.height)
        .data.reduce((all, one) => all + one, 0),
    );
  const first = await sum();
  await page.keyboard.press(".");
  await drawn(page);
  assert.equal(await number.inputValue(), "2");
  await frame(page);
  assert.notEqual(await sum(), first);
  await number.fill("9");
  await number.press("Enter");
  assert.equal(await number.getAttribute("aria-invalid"), "true");
  await number.press("Escape");
  await page.evaluate(() => {
    const { viewer } = window.aftershade;
    window.frames_seen = new Set();
    viewer.addEventListener("frame", () => window.frames_seen.add(viewer.frame));
  });
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => window.frames_seen.size === 2);
  await page.getByRole("button", { name: "Pause" }).click();
  await drawn(page);
});

inPage(
  "shows the time of each pass, memory, cached steps and the search for NaN",
  async (page) => {
    const passes = await page.locator(".bars .pass").allInnerTexts();
    for (const pass of ["color_grade", "vignette", "view_transform"])
      assert.ok(
        passes.some((name) => name.startsWith(`${pass}.`)),
        `${pass} in ${passes}`,
      );
    const times = await page
      .locator(".bars .ms")
      .evaluateAll((nodes) => nodes.map((node) => parseFloat(node.textContent)));
    assert.deepEqual(
      times,
      [...times].sort((a, b) => b - a),
    );
    const chips = await page.locator(".chips").innerText();
    assert.match(chips, /no NaN/);
    assert.match(chips, /\d steps? drawn/);
    assert.match(chips, /\d steps? cached/);
    assert.match(chips, /[1-9][\d.]* MiB|0\.[\d]+ MiB/);
    await page.evaluate(() => window.aftershade.store.edit([{ op: "set", step: 3, param: "exposure", value: 1 }]));
    await drawn(page);
    assert.match(await page.locator(".chips").innerText(), /[1-9]\d* steps? cached/);
  },
  { own: true },
);

// ---- waveform and files ----

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

// ---- keys over frames ----

const knots = (card, id) => row(card, id).locator(".knot");
/** Runs `act` and returns the look that it makes. */
async function lookAfter(page, act) {
  const before = await textOf(page);
  await act();
  return changed(page, before);
}

inPage("keys a value at the scrubber's frames, marks them, and draws what `run` draws", async (page, { look }) => {
  const exposure = row(await opened(page, "color_grade"), "exposure"),
    key = exposure.getByRole("button", { name: "Key exposure" });
  assert.equal(await key.getAttribute("title"), "Key this value at frame 1");
  let now = await lookAfter(page, () => key.click());
  assert.deepEqual(now.steps[1].params.exposure, { keys: { 1: 0.3 } });
  assert.equal(await key.getAttribute("aria-pressed"), "true");
  await page.keyboard.press(".");
  assert.equal(await key.getAttribute("aria-pressed"), "false");
  const field = exposure.getByRole("textbox");
  assert.equal(await field.inputValue(), "0.3");
  now = await lookAfter(page, async () => {
    await field.fill("1.5");
    await field.press("Enter");
  });
  assert.deepEqual(now.steps[1].params.exposure, { keys: { 1: 0.3, 2: 1.5 } });
  assert.equal(await page.locator(".marks span").count(), 2);
  assert.equal(await page.getByLabel("Frame", { exact: true }).getAttribute("aria-valuetext"), "frame 2, keyed");
  await drawn(page);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => window.aftershade.store.isSaved);
  await page.keyboard.press("Escape");
  await page.locator(".stage canvas").focus();
  await page.keyboard.press("1");
  await frame(page);
  const { difference, brightest } = await compareWithPng(page, runPicture(look, 2));
  assert.ok(brightest > 100);
  assert.equal(difference, 0);
  // The last key leaves its value.
  now = await lookAfter(page, () => key.click());
  assert.deepEqual(now.steps[1].params.exposure, { keys: { 1: 0.3 } });
  await page.keyboard.press(",");
  now = await lookAfter(page, () => key.click());
  assert.equal(now.steps[1].params.exposure, 0.3);
  assert.equal(await page.locator(".marks span").count(), 0);
});

for (const [interpolation, expected] of [
  ["linear", 1 / 3],
  ["smooth", 7 / 27],
  ["step", 0],
])
  inPage(`shows the value between two keys that the program takes, ${interpolation}`, async (page) => {
    const exposure = row(await opened(page, "color_grade"), "exposure");
    await lookAfter(page, () =>
      page.evaluate((value) => window.aftershade.store.edit([{ op: "set", step: 1, param: "exposure", value }]), {
        keys: { 0: 0, 3: 1 },
        interpolation: interpolation === "step" ? "smooth" : "step",
      }),
    );
    const look = await lookAfter(page, () =>
      exposure.getByLabel("Interpolation of exposure").selectOption(interpolation),
    );
    assert.equal(look.steps[1].params.exposure.interpolation, interpolation);
    const shown = Number(await exposure.getByRole("textbox").inputValue());
    assert.ok(Math.abs(shown - expected) < 1e-5, String(shown));
    const file = join(folder, `keyed_${interpolation}.json`);
    writeFileSync(file, await textOf(page));
    const { stdout } = spawnSync(
      program,
      ["run", file, capture, "-o", join(folder, "explained.png"), "--frames", "1", "--explain"],
      { encoding: "utf8", env: environment },
    );
    const [, taken] = /^.*\bexposure\b\D*([-.\de]+)/m.exec(stdout.slice(stdout.indexOf("color_grade")));
    assert.ok(Math.abs(shown - Number(taken)) < 1e-5, `${shown} on the page, ${taken} in run`);
  });

inPage("moves and removes keys by the keyboard, with the focus kept", async (page) => {
  const card = await opened(page, "bokeh");
  await lookAfter(page, () =>
    page.evaluate(() =>
      window.aftershade.store.edit([
        {
          op: "set",
          step: 0,
          param: "focus_distance",
          value: { keys: { 1: "2 m", 5: "6 m" }, interpolation: "smooth" },
        },
      ]),
    ),
  );
  const points = knots(card, "focus_distance");
  assert.equal(await points.count(), 2);
  assert.equal(await points.nth(1).getAttribute("aria-valuetext"), "6 m at frame 5");
  await points.nth(1).focus();
  let look = await lookAfter(page, () => page.keyboard.press("ArrowRight"));
  assert.deepEqual(look.steps[0].params.focus_distance, { keys: { 1: "2 m", 6: "6 m" }, interpolation: "smooth" });
  look = await lookAfter(page, () => page.keyboard.press("ArrowUp"));
  const [, raised] = /^([\d.]+) m$/.exec(look.steps[0].params.focus_distance.keys[6]);
  assert.ok(raised > 6, raised);
  // Keys do not pass each other.
  for (let i = 0; i < 2; ++i) await page.keyboard.press("Shift+ArrowLeft");
  await page.waitForFunction(
    () => "2" in (window.aftershade.store.state.steps[0].params.focus_distance.value.keys ?? {}),
  );
  assert.deepEqual(Object.keys((await lookOf(page)).steps[0].params.focus_distance.keys), ["1", "2"]);
  look = await lookAfter(page, () => page.keyboard.press("Delete"));
  assert.deepEqual(look.steps[0].params.focus_distance.keys, { 1: "2 m" });
  await page.waitForFunction(() => document.activeElement.matches(".knot"));
  look = await lookAfter(page, () => page.keyboard.press("Delete"));
  assert.equal(look.steps[0].params.focus_distance, "2 m");
});

inPage("drags a key by the pointer in one step of undo, also a channel of a colour", async (page) => {
  const card = await opened(page, "color_grade");
  await lookAfter(page, () =>
    page.evaluate(() =>
      window.aftershade.store.edit([
        { op: "set", step: 1, param: "slope", value: { keys: { 1: [1, 0.9, 0.8], 2: [0.5, 0.6, 0.7] } } },
      ]),
    ),
  );
  const before = await textOf(page),
    points = knots(card, "slope");
  assert.equal(await points.count(), 6);
  await points.first().scrollIntoViewIfNeeded();
  const box = await points.nth(4).boundingBox(); // green at frame 2
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  for (const dy of [-4, -8, -12, -16]) {
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2 + dy);
    await page.waitForTimeout(60);
  }
  await page.mouse.up();
  const look = await changed(page, before);
  await drawn(page);
  const { keys } = (await lookOf(page)).steps[1].params.slope;
  assert.deepEqual(keys[1], [1, 0.9, 0.8]);
  assert.deepEqual([keys[2][0], keys[2][2]], [0.5, 0.7]);
  assert.ok(keys[2][1] > 0.6, JSON.stringify(look));
  await page.keyboard.press("Control+z");
  await page.waitForFunction((text) => window.aftershade.store.state.text === text, before);
});

// ---- variables and masks ----

inPage("edits variables in their place in the text, and unbinds a parameter from one", async (page) => {
  const bound = LOOK.replace(
    '"steps"',
    '"vars": { "far": "6 m", // of the ball\n    "warm": 0.3, "half": 0.5 },\n  "steps"',
  )
    .replace('"6.4 m"', '{ "var": "far" }')
    .replace('"exposure":  0.3', '"exposure": { "var": "warm" }')
    .replace('"effect": "vignette"', '"effect": "vignette", "mix": { "var": "half" }');
  await lookAfter(page, () => page.evaluate((value) => window.aftershade.store.edit([{ op: "text", value }]), bound));
  const card = await opened(page, "bokeh"),
    focus = row(card, "focus_distance"),
    far = page.getByLabel("Variable far", { exact: true });
  assert.equal(await far.inputValue(), "6 m");
  assert.equal(await focus.getByLabel("Variable of focus distance").inputValue(), "far");
  await far.fill("650 cm");
  await lookAfter(page, () => far.press("Enter"));
  assert.equal(await far.evaluate((node) => node === document.activeElement), true);
  assert.equal(await textOf(page), bound.replace('"6 m"', '"650 cm"'));
  assert.equal(await focus.locator(".now-value").innerText(), "650 cm");
  await lookAfter(page, () => page.getByLabel("Enable bokeh").check());
  assert.equal(await focus.locator(".now-value").innerText(), "6.5 m");
  await far.fill("{ no");
  await far.press("Enter");
  assert.equal(await far.getAttribute("aria-invalid"), "true");
  await far.press("Escape");
  let look = await lookAfter(page, () => focus.getByLabel("Variable of focus distance").selectOption("warm"));
  assert.deepEqual(look.steps[0].params.focus_distance, { var: "warm" });
  look = await lookAfter(page, () => focus.getByRole("button", { name: "Unbind focus distance" }).click());
  assert.equal(look.steps[0].params.focus_distance, 0.3);
  assert.equal(await focus.getByRole("slider").count(), 1);
  const vignette = await opened(page, "vignette");
  look = await lookAfter(page, () => vignette.getByRole("button", { name: "Unbind mix" }).click());
  assert.equal(look.steps[2].mix, 0.5);
});

inPage("makes a variable of a parameter's value, gives it to another one and removes it, by the keyboard alone", async (page) => {
  const before = await textOf(page),
    section = page.getByRole("region", { name: "Variables" }),
    add = section.getByRole("button", { name: "Add a variable" });
  await add.focus();
  await page.keyboard.press("Enter");
  const parameter = section.getByLabel("Parameter that uses the variable");
  assert.equal(await parameter.evaluate((node) => node === document.activeElement), true);
  await parameter.selectOption("color_grade.exposure");
  const name = section.getByLabel("Name of the variable");
  assert.equal(await name.inputValue(), "exposure");
  assert.equal(await section.getByLabel("Value of the variable").inputValue(), "0.3");
  await name.fill("No name");
  await name.press("Enter");
  assert.match(await section.getByRole("alert").last().innerText(), /small letters/);
  await name.fill("warm");
  let look = await lookAfter(page, () => name.press("Enter"));
  assert.deepEqual(look.vars, { warm: 0.3 });
  assert.deepEqual(look.steps[1].params.exposure, { var: "warm" });
  assert.equal(await textOf(page), before.replace('"exposure":  0.3', '"exposure":  {"var": "warm"}').replace('"steps"', '"vars": { "warm": 0.3 },\n  "steps"').replace('{"var": "warm"}', '{ "var": "warm" }'));
  assert.equal(await add.evaluate((node) => node === document.activeElement), true);
  look = await lookAfter(page, () => section.getByLabel("Parameter that takes warm").selectOption("vignette.strength"));
  assert.deepEqual(look.steps[2].params.strength, { var: "warm" });
  look = await lookAfter(page, () => section.getByRole("button", { name: /^Remove the variable warm/ }).press("Enter"));
  assert.equal(look.vars, undefined);
  assert.equal(look.steps[1].params.exposure, 0.3);
  assert.equal(look.steps[2].params.strength, 0.3);
  await page.keyboard.press("Enter");
  await section.getByLabel("Name of the variable").fill("far");
  await section.getByLabel("Value of the variable").fill("6 m");
  look = await lookAfter(page, () => section.getByLabel("Value of the variable").press("Enter"));
  assert.deepEqual(look.vars, { far: "6 m" });
});

inPage("refuses a file outside of the folders, and says how it may be named", async (page) => {
  const before = await textOf(page),
    card = await opened(page, "color_grade");
  await card.getByLabel("Mask by").selectOption("file");
  const field = card.getByLabel("Mask's file");
  await field.fill("/etc/passwd");
  await field.press("Enter");
  await page.waitForFunction(() => document.getElementById("notice").textContent.includes("--allow-path"));
  assert.equal(await textOf(page), before);
  page.faults.length = 0; // Chromium lists the refused request
});

inPage(
  "masks a step by a role, by objects, also picked, or by a file, and draws what `run` draws",
  async (page, { look }) => {
    const card = await opened(page, "color_grade"),
      by = card.getByLabel("Mask by");
    const mask = async (act) => (await lookAfter(page, act)).steps[1].mask;
    const roles = (await state(page)).capture.roles.filter(({ channels }) => channels === 1).map(({ name }) => name);
    const first = await mask(() => by.selectOption("role"));
    assert.deepEqual(first, { role: roles[0] });
    await by.selectOption("object");
    const field = card.getByLabel("Mask's objects");
    await field.fill("2, 4-7");
    assert.deepEqual(await mask(() => field.press("Enter")), { object: [2, "4-7"] });
    assert.deepEqual(await mask(() => card.getByLabel("Invert the mask").check()), {
      object: [2, "4-7"],
      invert: true,
    });
    await card.getByRole("button", { name: "Pick the mask's object in the picture" }).click();
    const picked = await mask(async () => {
      await page.keyboard.press("ArrowRight");
      await page.keyboard.press("Enter");
    });
    assert.equal(typeof picked.object, "number");
    assert.equal(picked.invert, true);
    await drawn(page);
    await page.keyboard.press("Control+s");
    await page.waitForFunction(() => window.aftershade.store.isSaved);
    await page.locator(".stage canvas").focus();
    await page.keyboard.press("1");
    await page.evaluate(() => {
      window.aftershade.viewer.picture.probe = null;
      window.aftershade.viewer.picture.draw();
    });
    await frame(page);
    assert.equal((await compareWithPng(page, runPicture(look))).difference, 0);
    assert.deepEqual(await mask(() => card.getByLabel("Invert the mask").uncheck()), { object: picked.object });
    assert.equal(await mask(() => by.selectOption("")), undefined);
    await by.selectOption("file");
    const file = card.getByLabel("Mask's file");
    await file.fill("hole.png");
    assert.deepEqual(await mask(() => file.press("Enter")), { file: "hole.png" });
    await page.waitForFunction(() => window.aftershade.store.hasFaults);
    assert.match(await page.locator(".faults").innerText(), /hole\.png/);
  },
);

// ---- tables and profiles ----

inPage("edits a table by object line by line", async (page) => {
  await lookAfter(page, () =>
    page.evaluate(() =>
      window.aftershade.store.edit([
        { op: "add", at: 0, effect: "motion_blur" },
        { op: "enable", step: 0, value: false }, // the capture has no names of objects
      ]),
    ),
  );
  const table = row(await opened(page, "motion_blur"), "objects"),
    field = (name) => table.getByLabel(`objects, ${name}`, { exact: true });
  const set = async (name, text) => {
    await field(name).fill(text);
    return (await lookAfter(page, () => field(name).press("Enter"))).steps[0].params?.objects;
  };
  assert.equal(await field("others, scale").inputValue(), "1");
  assert.deepEqual(await set("object to add", "2"), { rows: [{ object: 2 }] });
  assert.equal(await field("object to add").inputValue(), "");
  assert.deepEqual(await set("line 1, scale", "0.5"), { rows: [{ object: 2, scale: 0.5 }] });
  assert.deepEqual(await set("object to add", "30-70, 90"), {
    rows: [{ object: 2, scale: 0.5 }, { objects: "30-70,90" }],
  });
  assert.deepEqual(await set("objects of line 1", "Wheel"), {
    rows: [{ name: "Wheel", scale: 0.5 }, { objects: "30-70,90" }],
  });
  assert.deepEqual((await set("others, scale", "2")).default, { scale: 2 });
  assert.equal(await field("line 2, scale").inputValue(), "2");
  await field("line 2, scale").fill("9");
  await field("line 2, scale").press("Enter");
  assert.match(await table.getByRole("alert").innerText(), /0 to 4/);
  await field("line 2, scale").press("Escape");
  const removed = await lookAfter(page, () => table.getByRole("button", { name: "Remove line 1 of objects" }).click());
  assert.deepEqual(removed.steps[0].params.objects, { default: { scale: 2 }, rows: [{ objects: "30-70,90" }] });
  const picked = await lookAfter(page, async () => {
    await table.getByRole("button", { name: "Pick an object for objects" }).click();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Enter");
  });
  assert.equal(typeof picked.steps[0].params.objects.rows[1].object, "number");
  assert.deepEqual(
    (await state(page)).faults.filter(({ severity }) => severity === "error"),
    [],
  );
});

inPage("chooses a scattering profile, sets its numbers, and gives objects their own", async (page) => {
  await lookAfter(page, () =>
    page.evaluate(() =>
      window.aftershade.store.edit([
        { op: "add", at: 0, effect: "sss_gaussian" },
        { op: "enable", step: 0, value: false },
      ]),
    ),
  );
  const profile = row(await opened(page, "sss_gaussian"), "scattering_profile"),
    choice = profile.getByLabel("Profile of scattering profile"),
    field = (name) => profile.getByLabel(`scattering profile, ${name}`, { exact: true });
  const value = async (act) => {
    const look = await lookAfter(page, act);
    assert.equal(await page.evaluate(() => window.aftershade.store.hasFaults), false, JSON.stringify(look.steps[0]));
    return look.steps[0].params.scattering_profile;
  };
  const set = (name, text) =>
    value(async () => {
      await field(name).fill(text);
      await field(name).press("Enter");
    });
  assert.equal(await choice.inputValue(), "skin");
  assert.equal(await value(() => choice.selectOption("marble")), "marble");
  for (const type of ["burley", "gaussians", "dipole", "artist"])
    assert.equal((await value(() => choice.selectOption(type))).type, type);
  assert.deepEqual(await set("strength, green", "0.5"), { type: "artist", width_mm: 1, strength: [0.48, 0.5, 0.28] });
  await field("strength, green").fill("2");
  await field("strength, green").press("Enter");
  assert.match(await profile.getByRole("alert").innerText(), /0.001 to 1/);
  await field("strength, green").press("Escape");
  assert.deepEqual(await set("width mm", "2.5"), { type: "artist", width_mm: 2.5, strength: [0.48, 0.5, 0.28] });
  assert.equal(await value(() => choice.selectOption("cream")), "cream");
  assert.deepEqual(await set("object to add", "3-7"), {
    default: "cream",
    rows: [{ objects: "3-7", profile: "skin" }],
  });
  assert.deepEqual(await set("line 1, profile", "marble"), {
    default: "cream",
    rows: [{ objects: "3-7", profile: "marble" }],
  });
  assert.deepEqual((await value(() => choice.selectOption("potato"))).default, "potato");
  const removed = await value(() => profile.getByRole("button", { name: /Remove line 1/ }).click());
  assert.equal(removed, "potato");
  // A file has no effect before its path is typed.
  const before = await textOf(page);
  await choice.selectOption("file");
  assert.equal(await textOf(page), before);
  await field("file").fill("none.json");
  await lookAfter(page, () => field("file").press("Enter"));
  await page.waitForFunction(() => window.aftershade.store.hasFaults);
  assert.match(await page.locator(".faults").innerText(), /none\.json/);
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

// ---- everybody ----

inPage("can be used by the keyboard alone, with the focus in sight", async (page, { look }) => {
  const seen = new Set();
  const hidden = [];
  for (let i = 0; i < 90; ++i) {
    await page.keyboard.press("Tab");
    const found = await page.evaluate(() => {
      const node = document.activeElement,
        style = getComputedStyle(node);
      return {
        label: node.getAttribute("aria-label") ?? node.textContent.slice(0, 30),
        isShown: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2,
        isBody: node === document.body,
      };
    });
    if (found.isBody) continue;
    if (!found.isShown) hidden.push(found.label);
    seen.add(found.label);
  }
  assert.deepEqual(hidden, []);
  const wanted = [
    "View",
    "Compare with",
    "Viewer exposure",
    "Frame",
    "Enable bokeh",
    "focus distance",
    "mix",
    "Preset",
    "Move down",
    "Remove",
  ];
  for (const label of wanted) assert.ok(seen.has(label), `${label} in ${[...seen]}`);
  // A step is added, moved, opened, changed and saved; a letter in a field is text.
  while (await page.evaluate(() => document.activeElement.matches("input[type=text], select"))) await page.keyboard.press("Tab");
  await page.keyboard.press("s");
  await page.keyboard.press("a");
  await page.keyboard.type("sharpen");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.activeElement.closest(".step")?.dataset.step === "sharpen");
  await page.keyboard.press("Alt+ArrowUp");
  await page.waitForFunction(() => document.querySelectorAll(".step .name")[2].textContent === "sharpen");
  const before = await textOf(page);
  for (let i = 0; i < 20; ++i) {
    await page.keyboard.press("Tab");
    if (await page.evaluate(() => document.activeElement.matches("[data-step=sharpen] [data-param] input[type=range]")))
      break;
  }
  await page.keyboard.press("ArrowRight");
  await changed(page, before);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => window.aftershade.store.isSaved);
  const saved = withoutComments(readFileSync(look, "utf8"));
  assert.equal(saved.steps[2].effect, "sharpen");
  assert.equal(Object.keys(saved.steps[2].params).length, 1);
});

inPage("lists its shortcuts by ?, and docs/page.md lists the same", async (page) => {
  await page.keyboard.press("?");
  const rows = await page
    .locator(".help dl > div")
    .evaluateAll((nodes) =>
      nodes.map((node) => [
        [...node.querySelectorAll("kbd")].map((key) => key.textContent),
        node.querySelector("dd").textContent,
      ]),
    );
  assert.ok(rows.length > 25);
  const docs = readFileSync(join(root, "docs/page.md"), "utf8");
  for (const [keys, words] of rows)
    assert.ok(docs.includes(`| ${keys.map((key) => `\`${key}\``).join(" ")} | ${words} |`), `${keys}: ${words}`);
  await page.keyboard.press("Escape");
  assert.equal(await page.locator("dialog[open]").count(), 0);
});

for (const colorScheme of ["dark", "light"])
  for (const [width, height] of [
    [1440, 900],
    [390, 844],
  ])
    inPage(
      `gives axe-core nothing to find, ${colorScheme}, ${width} px`,
      async (page) => {
        await page.evaluate(readFileSync(axeSource, "utf8"));
        const check = async (place) => {
          const { violations } = await page.evaluate(() => window.axe.run({ resultTypes: ["violations"] }));
          assert.deepEqual(
            violations.map(({ id, nodes }) => `${place}: ${id}: ${nodes.length} x ${nodes[0].html.slice(0, 160)}`),
            [],
          );
        };
        await check("steps");
        await page.evaluate(() => document.querySelectorAll(".opener")[1].click());
        await page.evaluate(
          (value) => window.aftershade.store.edit([{ op: "text", value }]),
          LOOK.replace('"steps"', '"vars": { "push": 0.5 }, "steps"'),
        );
        await page.evaluate(() =>
          window.aftershade.store.edit([
            { op: "set", step: 0, param: "focus_distance", value: { keys: { 1: "2 m", 2: "6 m" } } },
            { op: "mask", step: 0, value: { object: 2, invert: true } },
            { op: "set", step: 1, param: "exposure", value: { var: "push" } },
          ]),
        );
        await page.locator(".knot").first().waitFor();
        await check("curve");
        await page.getByRole("button", { name: "Add a variable" }).click();
        await check("new variable");
        await page.keyboard.press("Escape");
        for (const [i, effect] of ["motion_blur", "sss_gaussian"].entries()) {
          await page.evaluate(
            ([at, id]) =>
              window.aftershade.store.edit([
                { op: "add", at, effect: id },
                { op: "enable", step: at, value: false },
              ]),
            [i, effect],
          );
          const card = await opened(page, effect);
          await card.locator(".objects-table").waitFor();
        }
        await page.evaluate(() =>
          window.aftershade.store.edit([
            { op: "set", step: 0, param: "objects", value: { rows: [{ object: 2, scale: 0 }] } },
            { op: "set", step: 1, param: "scattering_profile", value: { type: "artist" } },
          ]),
        );
        await check("table");
        await page.keyboard.press("w");
        await page.keyboard.press("a");
        await check("add");
        await page.keyboard.press("Escape");
        await page.keyboard.press("?");
        await check("shortcuts");
        await page.keyboard.press("Escape");
        await page.keyboard.press("x");
        await check("export");
        await page.keyboard.press("Escape");
        await page.keyboard.press("t");
        await page.evaluate(
          (value) => window.aftershade.store.edit([{ op: "text", value }]),
          LOOK.replace('"vignette"', '"vignete"'),
        );
        await check("faults");
        await page.evaluate((value) => window.aftershade.store.edit([{ op: "text", value }]), LOOK);
        await page.keyboard.press("Escape");
        await page.getByRole("tab", { name: "Shaders" }).click();
        await page.waitForFunction(() => document.querySelector("#panel-shaders textarea").value.length > 0);
        await check("shaders");
      },
      { viewport: { width, height }, colorScheme },
    );

for (const [width, height] of [
  [390, 844],
  [768, 1024],
  [1024, 768],
  [1440, 900],
  [3840, 2160],
])
  inPage(
    `fits ${width} px without sideways scrolling, and its controls do not cover each other`,
    async (page) => {
      const { scroll, overlaps } = await page.evaluate(() => {
        const boxes = [
          ...document.querySelectorAll(
            "#bar button, .tools button, .tools select, .tools input, .frames > *, .head > *, .row input, .row select",
          ),
        ]
          .filter((node) => node.checkVisibility())
          .map((node) => [node, node.getBoundingClientRect()]);
        const overlaps = [];
        for (const [a, one] of boxes)
          for (const [b, two] of boxes)
            if (
              a !== b &&
              a.parentElement === b.parentElement &&
              one.left < two.right - 1 &&
              two.left < one.right - 1 &&
              one.top < two.bottom - 1 &&
              two.top < one.bottom - 1
            )
              overlaps.push(`${a.outerHTML.slice(0, 80)} ${b.outerHTML.slice(0, 80)}`);
        return { scroll: document.documentElement.scrollWidth - innerWidth, overlaps };
      });
      assert.ok(scroll <= 0, `${scroll} px too wide`);
      assert.deepEqual(overlaps, []);
    },
    { viewport: { width, height } },
  );

inPage(
  "is dark or light as the system is, and by its switch",
  async (page) => {
    const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const dark = await paper();
    await page.keyboard.press("Shift+D"); // dark
    assert.equal(await paper(), dark);
    await page.keyboard.press("Shift+D"); // light
    const light = await paper();
    assert.notEqual(light, dark);
    await page.emulateMedia({ colorScheme: "light" });
    await page.keyboard.press("Shift+D"); // system
    assert.equal(await paper(), light);
  },
  { colorScheme: "dark" },
);

test("explains an address without its token", noRow, async () => {
  const server = await serve();
  try {
    const page = await open(server.address.replace(/#.*/, ""));
    await page.waitForFunction(() => document.getElementById("notice").textContent.includes("no token"));
    await page.context().close();
  } finally {
    await server.end();
  }
});

// ---- shaders ----

/** A page on a look with an effect of the user's own; `files` is its folder. */
function withTint(name, work, options = {}) {
  const effects = mkdtempSync(join(folder, "effects-")),
    files = join(effects, "tint");
  mkdirSync(files);
  const reset = () => {
    writeFileSync(join(files, "effect.json"), JSON.stringify(TINT));
    writeFileSync(join(files, "tint.frag"), tintShader("light * param.amount"));
  };
  reset();
  const text = LOOK.replace('{ "effect": "vignette" }', '{ "effect": "tint" }, { "effect": "vignette" }');
  inPage(
    name,
    async (page, server) => {
      await page.evaluate((value) => window.aftershade.store.edit([{ op: "text", value }]), text);
      await page.evaluate(() => window.aftershade.settled());
      await work(page, { ...server, files, text, shader: join(files, "tint.frag") });
    },
    { words: ["--effect-path", effects, ...(options.words ?? [])], ...without(options, "words") },
  );
}
const without = (all, key) => Object.fromEntries(Object.entries(all).filter(([name]) => name !== key));
const centre = (page) =>
  page.locator(".stage canvas").evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(canvas.width / 2, canvas.height / 2, 1, 1);
    return [...data].slice(0, 3);
  });
/** The picture's centre once it holds, or after 10 s: a saved shader is drawn a moment after it is written. */
async function centreOnce(page, holds) {
  const end = Date.now() + 10000;
  for (;;) {
    await page.evaluate(() => window.aftershade.settled());
    const rgb = await centre(page);
    if (holds(rgb) || Date.now() > end) return rgb;
    await page.waitForTimeout(20);
  }
}
async function openShader(page) {
  await page.getByRole("tab", { name: "Shaders" }).click();
  await page.getByLabel("Effect", { exact: true }).selectOption("tint");
  const area = page.getByLabel("The shader as GLSL");
  await page.waitForFunction(() => document.querySelector("#panel-shaders textarea").value.includes("out_color"));
  return area;
}

withTint(
  "names a pass that does not end, and keeps the look, its undo and the last good picture",
  async (page, { shader, look }) => {
    const before = await textOf(page),
      lines = Array.from({ length: 12_000 }, (_, i) => `light = light * 1.01 + sin(light * ${i}.0);`);
    writeFileSync(shader, tintShader("light * param.amount").replace("    out_color", `${lines.join("\n")}\nout_color`));
    const isFaulty = (words) => window.aftershade.store.state.faults.some(({ message }) => message.includes(words));
    await page.waitForFunction(isFaulty, "did not finish within 4 s");
    assert.equal(await textOf(page), before);
    assert.equal((await state(page)).can_undo, true);
    assert.equal(readFileSync(look, "utf8"), LOOK, "nothing is written before it is saved");
    writeFileSync(shader, tintShader("light * vec4(0.0, 2.0, 0.0, 1.0)"));
    await page.waitForFunction(() => !window.aftershade.store.state.faults.length);
    const isGreen = ([red, green]) => green > red,
      after = await centreOnce(page, isGreen);
    assert.ok(isGreen(after), `${after}`);
    await page.keyboard.press("Control+z");
    await page.waitForFunction((text) => window.aftershade.store.state.text !== text, before);
    page.faults = page.faults.filter((words) => !words.includes("409")); // Chromium lists the refused picture
  },
  { words: ["--pass-timeout", "4"] },
);

withTint("names a pass that crashes the driver, and keeps the last good picture until it is mended", async (page, { shader }) => {
  const shown = () => page.locator(".stage canvas").evaluate((canvas) => canvas.toDataURL());
  await drawn(page);
  const before = await textOf(page),
    good = await shown(),
    deep = tintShader("F(F(F(F(F(F(F(F(F(light)))))))))").replace("void main", "#define F(x) x*x+x*x\nvoid main");
  writeFileSync(shader, deep);
  await page.waitForFunction(() =>
    window.aftershade.store.state.faults.some(({ message }) => /crashed .*compiling pass 'tint' of step 'tint'/.test(message)),
  );
  await page.evaluate(() => window.aftershade.settled());
  assert.equal(await page.locator(".badge").innerText(), "last good picture: the look has faults");
  assert.equal(await shown(), good);
  assert.equal(await textOf(page), before);
  assert.equal((await state(page)).can_undo, true);
  await page.reload();
  await drawn(page);
  await frame(page);
  assert.equal(await shown(), good, "for a page that is opened now, too");
  writeFileSync(shader, tintShader("light * vec4(0.0, 2.0, 0.0, 1.0)"));
  await page.waitForFunction(() => !window.aftershade.store.state.faults.length);
  const isGreen = ([red, green]) => green > red,
    after = await centreOnce(page, isGreen);
  assert.ok(isGreen(after), `${after}`);
  await page.keyboard.press("Control+z");
  await page.waitForFunction((text) => window.aftershade.store.state.text !== text, before);
  page.faults = page.faults.filter((words) => !words.includes("409")); // Chromium lists the refused picture
});

withTint("writes a shader by Ctrl+S and shows the picture that `run` then draws", async (page, { shader, files, look }) => {
  const area = await openShader(page),
    before = await centre(page);
  await area.fill(tintShader("light * vec4(0.0, 2.0, 0.0, 1.0)"));
  assert.match(readFileSync(shader, "utf8"), /param\.amount/, "nothing is written before it is saved");
  await area.press("Control+s");
  await page.waitForFunction(() => document.getElementById("notice").textContent.includes("Saved tint.frag"));
  assert.equal(readFileSync(shader, "utf8"), await area.inputValue());
  const isGreener = (rgb) => rgb[0] < before[0] && rgb[1] > rgb[0],
    after = await centreOnce(page, isGreener);
  assert.ok(isGreener(after), `${before} ${after}`);
  await page.getByRole("tab", { name: "Steps" }).click();
  await page.locator("body").press("Control+s");
  await page.waitForFunction(() => window.aftershade.store.isSaved);
  const png = join(folder, "tinted.png");
  spawnSync(program, ["run", look, capture, "--frames", "1", "--effect-path", join(files, ".."), "-o", png], {
    env: environment,
  });
  const [shown, run] = await page.evaluate(
    async (bytes) => {
      const pixels = async (blob) => {
        const bitmap = await createImageBitmap(blob),
          canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
        canvas.getContext("2d").drawImage(bitmap, 0, 0);
        return [...canvas.getContext("2d").getImageData(0, 0, bitmap.width, bitmap.height).data].join();
      };
      const { pictureBlob } = await import("./api.js"),
        own = await pictureBlob({ frame: 1, scale: 1, view: "final", exposure: 0 });
      return [await pixels(own), await pixels(new Blob([new Uint8Array(bytes)]))];
    },
    [...readFileSync(png)],
  );
  assert.ok(shown === run, "the pixels differ");
});

withTint(
  "makes a new effect by the keyboard alone, adds it to the look and edits its shader",
  async (page, { files }) => {
    await page.keyboard.press("t");
    await page.keyboard.press("t");
    const tabTo = async (label) => {
      for (let i = 0; i < 60; ++i) {
        if ((await page.evaluate(() => document.activeElement.getAttribute("aria-label"))) === label) return;
        await page.keyboard.press("Tab");
      }
      assert.fail(`Tab does not lead to ${label}`);
    };
    await page.waitForFunction(() => !document.querySelector(".new-effect").hidden);
    await tabTo("Name of a new effect");
    await page.keyboard.type("corner_shade");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.activeElement.getAttribute("aria-label") === "The shader as GLSL");
    assert.deepEqual(
      (await lookOf(page)).steps.map(({ effect }) => effect),
      ["bokeh", "color_grade", "tint", "vignette", "corner_shade", "view_transform"],
    );
    const shader = join(files, "../corner_shade/corner_shade.frag"),
      made = readFileSync(shader, "utf8");
    assert.equal(await page.getByLabel("The shader as GLSL").inputValue(), made);
    await page.keyboard.press("Control+Home");
    await page.keyboard.press("End");
    await page.keyboard.press("Enter");
    await page.keyboard.type("// mine");
    await page.keyboard.press("Control+s");
    await page.waitForFunction(() => /Saved corner_shade/.test(document.getElementById("notice").textContent));
    assert.match(readFileSync(shader, "utf8"), /core\n\/\/ mine\n/);
    await page.evaluate(() => window.aftershade.settled());
    // Back to another effect by the list.
    await tabTo("Effect");
    await page.keyboard.press("Home");
    await page.waitForFunction(() => !document.querySelector("#panel-shaders textarea").value.includes("// mine"));
  },
);

withTint("shows GLSL's faults at their file and line, and keeps the last good picture", async (page) => {
  const area = await openShader(page),
    good = await centre(page);
  await area.fill(tintShader("lihgt"));
  await area.press("Control+s");
  const fault = page.locator(".shader-faults li");
  await fault.first().waitFor();
  assert.match(await fault.first().innerText(), /tint\.frag:6[^]*lihgt/);
  assert.equal(await page.locator("#panel-shaders .faulty").first().innerText(), "6");
  assert.deepEqual(await centre(page), good);
  await fault.first().getByRole("button").click();
  assert.equal(await area.evaluate((node) => node.value.slice(0, node.selectionStart).split("\n").length), 6);
  page.faults.length = 0; // Chromium lists the refused pictures
  await area.fill(tintShader("light * param.amount"));
  await area.press("Control+s");
  await page.waitForFunction(() => document.querySelector(".shader-faults").hidden);
  assert.equal(await page.locator("#panel-shaders .faulty").count(), 0);
  await page.evaluate(() => window.aftershade.settled()); // a coarse picture may come first
  assert.deepEqual(await centre(page), good);
});

withTint("follows an effect that another program edits, with the typed text kept", async (page, { shader, files }) => {
  const area = await openShader(page),
    before = await centre(page);
  await area.fill(`${tintShader("light")}// typed`);
  writeFileSync(shader, tintShader("light * vec4(2.0, 0.0, 0.0, 1.0)"));
  await page.waitForFunction(() => window.aftershade.store.state.effects_revision > 1);
  const isRedder = (rgb) => rgb[1] < before[1] && rgb[0] > rgb[1],
    after = await centreOnce(page, isRedder);
  assert.ok(isRedder(after), `${before} ${after}`);
  assert.match(await area.inputValue(), /typed/);
  await area.press("Control+s");
  await page.waitForFunction(() => document.getElementById("notice").textContent.includes("another program"));
  assert.match(readFileSync(shader, "utf8"), /vec4\(2\.0/);
  page.faults.length = 0; // Chromium lists the refused request
  await page.getByRole("button", { name: "Revert" }).click();
  assert.match(await area.inputValue(), /vec4\(2\.0/);
  const { params, ...rest } = TINT;
  writeFileSync(
    join(files, "effect.json"),
    JSON.stringify({ ...rest, params: { ...params, other: { ...params.amount, doc: "A new one." } } }),
  );
  await page.waitForFunction(() => "other" in window.aftershade.store.effects.get("tint").params);
  await page.getByRole("tab", { name: "Steps" }).click();
  assert.equal(await row(await opened(page, "tint"), "other").count(), 1);
});

inPage("shows shipped shaders, and says why they cannot be written", async (page) => {
  await page.keyboard.press("t");
  await page.keyboard.press("t");
  await page.getByLabel("Effect", { exact: true }).selectOption("vignette");
  const area = page.getByLabel("The shader as GLSL");
  await page.waitForFunction(() => document.querySelector("#panel-shaders textarea").value.includes("void main"));
  assert.equal(await area.evaluate((node) => node.readOnly), true);
  assert.match(await page.locator("#shader-help").innerText(), /comes with Aftershade[^]*--effect-path/);
  assert.equal(await page.getByRole("button", { name: "Save shader" }).isDisabled(), true);
});

// ---- 200 random edits ----

inPage(
  "keeps text, state and picture together over 200 random edits, and undoes them all to the byte",
  async (page, { look }) => {
    const next = random(28),
      ids = ["bokeh", "color_grade", "vignette", "view_transform", "sharpen", "bloom", "film_grain", "sanitize"],
      effects = new Map(ids.map((id) => [id, described(id)]));
    const equalsRun = async () => {
      assert.equal(await page.evaluate(() => window.aftershade.store.save()), true);
      await page.keyboard.press("1");
      await drawn(page);
      await frame(page);
      assert.equal((await compareWithPng(page, runPicture(look))).difference, 0);
    };
    let taken = 0,
      compared = 0;
    for (let i = 0; i < 200; ++i) {
      const { steps } = await state(page),
        edit = randomEdit(next, steps, effects);
      if (edit.op === "add" && steps.some(({ effect }) => effect === edit.effect))
        Object.assign(edit, { op: "enable", step: 0, value: true });
      taken += (await page.evaluate((edit) => window.aftershade.store.edit([edit]), edit)) ? 1 : 0;
      const now = await state(page),
        written = withoutComments(now.text);
      assert.deepEqual(
        now.steps.map(({ effect }) => effect),
        written.steps.map(({ effect }) => effect),
        JSON.stringify(edit),
      );
      for (const [at, one] of written.steps.entries())
        for (const [id, value] of Object.entries(one.params ?? {}))
          assert.deepEqual(now.steps[at].params[id].value, value, `${at}.${id}`);
      assert.deepEqual(
        await page.locator(".step .name").allInnerTexts(),
        written.steps.map(({ name, effect }) => name ?? effect),
      );
      if (i % 25 === 24 && !(await page.evaluate(() => window.aftershade.store.hasFaults))) {
        await equalsRun();
        compared += 1;
      }
    }
    assert.equal(taken, 200);
    assert.ok(compared >= 3, `${compared} pictures compared`); // a random value may break a relation of two
    assert.equal(await page.evaluate(() => window.aftershade.store.save()), true);
    assert.equal(readFileSync(look, "utf8"), await textOf(page));
    await page.evaluate(async () => {
      const { store } = window.aftershade;
      while (store.state.can_undo) if (!(await store.undo())) break;
    });
    assert.equal(await textOf(page), LOOK);
  },
  { own: true },
);
