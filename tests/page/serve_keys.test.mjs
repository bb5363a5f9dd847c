// Keys over frames on the page.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";

import {
  capture,
  changed,
  compareWithPng,
  environment,
  folder,
  frame,
  inPage,
  LOOK,
  lookAfter,
  lookOf,
  opened,
  row,
  runPicture,
  textOf,
} from "./look_page.mjs";
import { drawn } from "./served.mjs";
import { program } from "./suite.mjs";

/** The exposure that the page shows in frame 1 is that of `run` with the look on the page. */
async function isTakenByRun(shown, page) {
  const file = join(folder, "explained.json");
  writeFileSync(file, await textOf(page));
  const { stdout } = spawnSync(
    program,
    ["run", file, capture, "-o", join(folder, "explained.png"), "--frames", "1", "--explain"],
    { encoding: "utf8", env: environment },
  );
  const [, taken] = /^.*\bexposure\b\D*([-.\de]+)/m.exec(stdout.slice(stdout.indexOf("color_grade")));
  assert.ok(Math.abs(shown - Number(taken)) < 1e-5, `${shown} on the page, ${taken} in run`);
}

const knots = (card, id) => row(card, id).locator(".knot");

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
      exposure.getByLabel("Interpolation of exposure", { exact: true }).selectOption(interpolation),
    );
    assert.equal(look.steps[1].params.exposure.interpolation, interpolation);
    const shown = Number(await exposure.getByRole("textbox").inputValue());
    assert.ok(Math.abs(shown - expected) < 1e-5, String(shown));
    await isTakenByRun(shown, page);
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

inPage(
  "gives a stretch a curve of its own, whose handles keys and pointer move, and takes what `run` takes",
  async (page) => {
    const controls = row(await opened(page, "color_grade"), "exposure"),
      exposure = async () => (await lookOf(page)).steps[1].params.exposure,
      set = (value) =>
        lookAfter(page, () =>
          page.evaluate(
            (wanted) => window.aftershade.store.edit([{ op: "set", step: 1, param: "exposure", value: wanted }]),
            value,
          ),
        );
    await set({ keys: { 0: 0, 4: 1, 9: 0.5 }, interpolation: "step" });
    const own = controls.getByLabel("Interpolation of exposure from frame 0");
    await lookAfter(page, () => own.selectOption("curve"));
    assert.deepEqual(await exposure(), {
      keys: { 0: { value: 0, interpolation: [0.4, 0, 0.6, 1] }, 4: 1, 9: 0.5 },
      interpolation: "step",
    });
    const handles = controls.locator(".handle");
    assert.equal(await handles.count(), 2);
    await handles.first().focus();
    await lookAfter(page, () => page.keyboard.press("Shift+ArrowUp"));
    await lookAfter(page, () => page.keyboard.press("ArrowLeft"));
    assert.deepEqual((await exposure()).keys[0].interpolation, [0.35, 0.2, 0.6, 1]);
    assert.equal(await handles.first().getAttribute("aria-valuetext"), "20 % of the change after 35 % of the frames");
    // The field has the number of the program's own curve.
    const shown = Number(await controls.getByRole("textbox").inputValue());
    await isTakenByRun(shown, page);
    assert.ok(Math.abs(shown - 0.25) > 0.005, `${shown} is that of a straight line`);
    // A drag is one step of undo, and ends at the border.
    const before = await textOf(page),
      box = await handles.nth(1).boundingBox();
    await page.mouse.move(box.x + 10, box.y + 10);
    await page.mouse.down();
    await page.mouse.move(box.x + 10, box.y + 60, { steps: 5 });
    await page.mouse.move(box.x + 10, box.y + 400, { steps: 5 });
    await page.mouse.up();
    await changed(page, before);
    await page.waitForFunction(
      () => window.aftershade.store.state.steps[1].params.exposure.value.keys[0].interpolation[3] === 0,
    );
    await page.keyboard.press("Control+z");
    await page.waitForFunction((text) => window.aftershade.store.state.text === text, before);
    // A key that moves keeps its curve, and a word takes it out.
    await knots(await opened(page, "color_grade"), "exposure")
      .first()
      .focus();
    await lookAfter(page, () => page.keyboard.press("ArrowRight"));
    assert.deepEqual((await exposure()).keys[1], { value: 0, interpolation: [0.35, 0.2, 0.6, 1] });
    await lookAfter(page, () => controls.getByLabel("Interpolation of exposure from frame 1").selectOption(""));
    assert.deepEqual(await exposure(), { keys: { 1: 0, 4: 1, 9: 0.5 }, interpolation: "step" });
  },
);

inPage("keeps comments between keys while a key changes", async (page) => {
  const text = LOOK.replace(
    '"exposure":  0.3',
    '"exposure": {\n      "keys": {\n        "1": 0.30, // dawn\n        "2": 1 // noon\n      }\n    }',
  );
  await lookAfter(page, () => page.evaluate((value) => window.aftershade.store.edit([{ op: "text", value }]), text));
  const field = row(await opened(page, "color_grade"), "exposure").getByRole("textbox");
  await lookAfter(page, async () => {
    await field.fill("0.6");
    await field.press("Enter");
  });
  assert.equal(await textOf(page), text.replace("0.30", "0.6"));
});
