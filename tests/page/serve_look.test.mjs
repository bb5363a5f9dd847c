// How the page shows and changes the list of steps.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";

import { changed, described, inPage, LOOK, lookOf, opened, row, state, step, textOf } from "./look_page.mjs";
import { drawn } from "./served.mjs";
import { program } from "./suite.mjs";

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
  const found = await page
    .locator("#found [role=option]")
    .evaluateAll((nodes) => nodes.map((node) => node.dataset.effect));
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

inPage("draws a line where a dragged step lands", async (page) => {
  await step(page, "bokeh").locator(".opener").click(); // closes it, so that all heads are in sight
  const grip = await step(page, "bokeh").locator(".grip").boundingBox(),
    color = (name, pseudo) =>
      page.locator(name).evaluate((node, part) => {
        const { content, backgroundColor, height } = getComputedStyle(node, part);
        return content === "none" ? null : [backgroundColor, height];
      }, pseudo),
    accent = await page
      .locator(".step")
      .first()
      .evaluate((node) => {
        const probe = node.appendChild(document.createElement("i"));
        probe.style.color = "var(--accent)";
        const { color: found } = getComputedStyle(probe);
        probe.remove();
        return found;
      });
  await page.mouse.move(grip.x + 8, grip.y + 8);
  await page.mouse.down();
  const { y } = await step(page, "vignette").boundingBox();
  await page.mouse.move(grip.x + 8, y + 2, { steps: 3 });
  assert.deepEqual(await color('.step[data-step="vignette"]', "::before"), [accent, "3px"]);
  assert.equal(await color('.step[data-step="color_grade"]', "::before"), null);
  await page.mouse.move(grip.x + 8, y + 200, { steps: 3 });
  assert.deepEqual(await color("ol.steps", "::after"), [accent, "3px"]);
  await page.mouse.up();
});
