// Variables, masks, tables and profiles on the page.
import assert from "node:assert/strict";

import {
  compareWithPng,
  frame,
  inPage,
  LOOK,
  lookAfter,
  opened,
  row,
  runPicture,
  state,
  textOf,
} from "./look_page.mjs";
import { drawn } from "./served.mjs";

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

inPage(
  "makes a variable of a parameter's value, gives it to another one and removes it, by the keyboard alone",
  async (page) => {
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
    assert.equal(
      await textOf(page),
      before
        .replace('"exposure":  0.3', '"exposure":  {"var": "warm"}')
        .replace('"steps"', '"vars": { "warm": 0.3 },\n  "steps"')
        .replace('{"var": "warm"}', '{ "var": "warm" }'),
    );
    assert.equal(await add.evaluate((node) => node === document.activeElement), true);
    look = await lookAfter(page, () =>
      section.getByLabel("Parameter that takes warm").selectOption("vignette.strength"),
    );
    assert.deepEqual(look.steps[2].params.strength, { var: "warm" });
    look = await lookAfter(page, () =>
      section.getByRole("button", { name: /^Remove the variable warm/ }).press("Enter"),
    );
    assert.equal(look.vars, undefined);
    assert.equal(look.steps[1].params.exposure, 0.3);
    assert.equal(look.steps[2].params.strength, 0.3);
    await page.keyboard.press("Enter");
    await section.getByLabel("Name of the variable").fill("far");
    await section.getByLabel("Value of the variable").fill("6 m");
    look = await lookAfter(page, () => section.getByLabel("Value of the variable").press("Enter"));
    assert.deepEqual(look.vars, { far: "6 m" });
  },
);

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
