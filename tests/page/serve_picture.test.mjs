// The picture of the page, its views and the dock.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdtempSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import {
  capture,
  changed,
  compareWithPng,
  environment,
  folder,
  frame,
  inPage,
  LOOK,
  middle,
  open,
  opened,
  root,
  row,
  runPicture,
  serveOver,
  state,
  step,
  textOf,
} from "./look_page.mjs";
import { drawn } from "./served.mjs";
import { program } from "./suite.mjs";

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
    await page.evaluate(() => window.aftershade.store.edit([{ op: "set", step: 0, param: "exposure", value: 0.5 }]));
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

inPage("says in a legend what false colours mean, and of pictures nothing", async (page) => {
  const legend = page.locator(".legend");
  for (const [view, words] of [
    ["role:depth", /near far [\d.]+ to [\d.]+ m; nothing hit: /],
    ["role:velocity", /px a frame; rim of the wheel: [\d.]+ px/],
    ["role:object_id", /ids?: .*a colour each, 0 is black/],
    ["tap:color_grade.color", /linear, shown at/],
  ]) {
    await page.getByLabel("View", { exact: true }).selectOption(view);
    await drawn(page);
    await page.waitForFunction(
      (text) => new RegExp(text).test(document.querySelector(".legend").innerText.replaceAll(/\s+/g, " ")),
      words.source,
    );
  }
  await page.getByLabel("View", { exact: true }).selectOption("final");
  await drawn(page);
  assert.equal(await legend.isVisible(), false);
});

inPage("compares with the picture before a step, which is that of the steps before it", async (page) => {
  await page.getByLabel("Compare with").selectOption("before:view_transform");
  await drawn(page);
  await frame(page);
  const right = await middle(page, 60);
  assert.equal(await page.locator(".side.right").innerText(), "before view_transform");
  await page.getByLabel("Compare with").selectOption("");
  await page.getByLabel("Enable view_transform").uncheck();
  await drawn(page);
  await frame(page);
  assert.deepEqual(await middle(page, 60), right);
  const views = await page.getByLabel("View", { exact: true }).locator("option").allInnerTexts();
  assert.ok(views.includes("before vignette") && !views.includes("before view_transform"), views.join());
});

inPage("shows the capture and marks the step where the frame lacks what the step takes", async (page) => {
  const set = (value) =>
    page.evaluate(
      (wanted) => window.aftershade.store.edit([{ op: "set", step: 1, param: "exposure", value: wanted }]),
      value,
    );
  await set({ from: "luminance", object: 4000 });
  const mark = step(page, "color_grade").locator(".step-fault");
  await mark.getByText(/object 4000 has no pixel with light/).waitFor();
  await drawn(page);
  await frame(page);
  assert.match(
    await page.locator(".badge").innerText(),
    /^capture without steps: this frame lacks what color_grade needs$/,
  );
  const shown = await middle(page);
  assert.equal(await step(page, "vignette").locator(".step-fault").isVisible(), false);
  await set(0.3);
  await mark.waitFor({ state: "hidden" });
  await page.getByLabel("View", { exact: true }).selectOption("before");
  await drawn(page);
  await frame(page);
  assert.deepEqual(shown, await middle(page));
  page.faults = page.faults.filter((fault) => !/status of 400/.test(fault)); // browsers report the refusal
});
