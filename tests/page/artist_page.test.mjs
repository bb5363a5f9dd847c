// An artist's ways through the page: from a frame alone to a saved look, without a line of JSON.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import {
  copyFileSync,
  existsSync,
  mkdirSync,
  readdirSync,
  readFileSync,
  rmSync,
  statSync,
  symlinkSync,
  writeFileSync,
} from "node:fs";
import { join } from "node:path";

import { drawn } from "./served.mjs";
import { program } from "./suite.mjs";
import {
  allDrawn,
  axe,
  canProbeVideo,
  capture,
  clickAt,
  edit,
  environment,
  opened,
  pixelsOf,
  root,
  scene,
  shot,
  state,
  steps,
  until,
  walk,
  walkBlender,
  SUZANNE,
} from "./walks.mjs";

for (const [colorScheme, width, height] of [
  ["dark", 1440, 900],
  ["light", 1440, 900],
  ["dark", 390, 844],
  ["light", 390, 844],
])
  walk(
    `starts from a capture with looks as pictures of its frame, ${colorScheme}, ${width} px`,
    async (page) => {
      assert.deepEqual(await steps(page), []);
      if (width < 1000) await page.locator(".gallery").scrollIntoViewIfNeeded();
      await allDrawn(page, ".starts", 4);
      const names = await page.locator(".starts .name").allInnerTexts();
      assert.ok(names.length >= 5 && names.length <= 10 && names.includes("Portrait"), names.join());
      await axe(page, "gallery");
      await shot(page, `gallery_${colorScheme}_${width}`);
    },
    { viewport: { width, height }, colorScheme },
  );

walk("draws each starting look as `run` draws it, smaller", async (page, folder) => {
  await allDrawn(page, ".starts", 2);
  const { width, height, bytes } = await page.evaluate(() => {
    const item = [...document.querySelectorAll(".starts li")].find((node) => node.innerText.startsWith("Noir"));
    item.scrollIntoView();
    const canvas = item.querySelector("canvas");
    return new Promise((done) => {
      const look = () =>
        "drawn" in canvas.dataset
          ? done({
              width: canvas.width,
              height: canvas.height,
              bytes: [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data],
            })
          : setTimeout(look, 50);
      look();
    });
  });
  const run = spawnSync(
    program,
    ["run", join(root, "looks/noir.json"), capture, "--frames", "3", "--scale", "1/2", "-o", "noir.png"],
    { cwd: folder, env: environment, encoding: "utf8" },
  );
  assert.equal(run.status, 0, run.stderr);
  assert.deepEqual([width, height], [240, 135]);
  assert.deepEqual(bytes, await pixelsOf(join(folder, "noir.png")));
});

walk("takes a starting look, and saves it under a name that it asks for, by keys alone", async (page, folder) => {
  await allDrawn(page, ".starts", 1);
  await page.locator(".start", { hasText: "Noir" }).focus();
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.aftershade.store.state.steps.length === 4);
  assert.equal(await page.locator(".gallery").isVisible(), false);
  await page.keyboard.press("Control+s");
  const dialog = page.locator(".save-dialog");
  await dialog.waitFor();
  await axe(page, "save");
  await shot(page, "save");
  await page.keyboard.type("../noir");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /not a name/.test(document.querySelector(".save-dialog .refusal").textContent));
  page.faults.length = 0; // browsers report the refusal
  await page.keyboard.press("Control+a");
  await page.keyboard.type("my noir");
  await page.keyboard.press("Enter");
  await dialog.waitFor({ state: "hidden" });
  assert.equal(readFileSync(join(folder, "my noir.json"), "utf8"), readFileSync(join(root, "looks/noir.json"), "utf8"));
  assert.equal(await page.locator(".file").innerText(), "my noir.json");
  await page.keyboard.press("Control+z"); // back to no steps, which is another look than the saved one
  await page.waitForFunction(() => window.aftershade.store.state.steps.length === 0);
  await page.locator(".gallery").waitFor();
});

walk(
  "makes the file of a new look when it is saved, and never replaces one",
  async (page, folder) => {
    assert.equal(await page.locator(".mark").innerText(), "new");
    assert.equal(existsSync(join(folder, "new.json")), false);
    await page.evaluate(() => window.aftershade.store.edit([{ op: "add", at: 0, effect: "vignette" }]));
    writeFileSync(join(folder, "new.json"), "{}");
    assert.equal(await page.evaluate(() => window.aftershade.store.save()), false, "another program made it");
    assert.equal(readFileSync(join(folder, "new.json"), "utf8"), "{}");
    rmSync(join(folder, "new.json"));
    assert.equal(await page.evaluate(() => window.aftershade.store.save()), true);
    assert.equal(
      readFileSync(join(folder, "new.json"), "utf8"),
      '{\n  "aftershade": 1,\n  "steps": [\n    { "effect": "vignette" }\n  ]\n}\n',
    );
  },
  { words: () => ["new.json", capture], mayFail: true },
);

/** Drops a file as a desktop does, as far as scripts can. */
const drop = (page, name, bytes) =>
  page.evaluate(
    ([file, size]) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([new Uint8Array(size)], file));
      document.body.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
    },
    [name, bytes],
  );

walk(
  "takes what is dropped from below the capture's folder, and says why it takes nothing else",
  async (page, folder) => {
    await page.evaluate(() => window.aftershade.store.edit([{ op: "add", at: 0, effect: "vignette" }]));
    const { size } = statSync(join(scene, "gbuffer_0004.exr"));
    await drop(page, "gbuffer_0004.exr", size);
    await page.waitForFunction(() => window.aftershade.store.state.capture.path.endsWith("shots/gbuffer_0004.exr"));
    await drawn(page);
    assert.deepEqual((await state(page)).capture.frames, [4]);
    assert.equal((await state(page)).steps.length, 1, "the look stays");
    await page.evaluate(() => window.aftershade.store.takeCapture({ name: "more" }));
    assert.ok((await state(page)).capture.path.endsWith("shots/more"));
    await drop(page, "gbuffer_0004.exr", size - 1);
    await page.waitForFunction(() => /or below, where this server may read/.test(document.body.innerText));
    await drop(page, "secret.exr", size);
    await page.waitForFunction(() => /'secret.exr' is not in/.test(document.body.innerText));
    assert.ok((await state(page)).capture.path.endsWith("shots/more"));
    assert.ok(existsSync(join(folder, "secret.exr")), "it is there, beside the capture's folder");
  },
  {
    mayFail: true,
    words: (folder) => {
      mkdirSync(join(folder, "shots/more"), { recursive: true });
      for (const [from, to] of [
        [3, "shots/gbuffer_0003.exr"],
        [4, "shots/gbuffer_0004.exr"],
        [3, "shots/more/in_0003.exr"],
        [4, "secret.exr"],
      ])
        copyFileSync(join(scene, `gbuffer_000${from}.exr`), join(folder, to));
      symlinkSync(join(folder, "secret.exr"), join(folder, "shots/more/secret.exr"));
      return ["shots/gbuffer_0003.exr"];
    },
  },
);

// ---- names ----

walkBlender("shows and writes the names of Blender's objects and materials", async (page) => {
  await edit(page, { op: "add", at: 0, effect: "vignette" }, { op: "add", at: 1, effect: "sss_gaussian" });
  await edit(page, { op: "enable", step: 1, value: false });
  await clickAt(page, ...SUZANNE);
  const cell = (row) => page.locator(".panel tbody tr", { hasText: row }).first();
  await page.waitForFunction(() => /Suzanne/.test(document.querySelector(".panel tbody")?.textContent));
  assert.match(await cell("material").innerText(), /\S/);
  assert.equal(await page.locator(".panel tbody th", { hasText: "object_id" }).count(), 0, "the name stands for it");
  await shot(page, "names");
  // A mask by a click, then a second object from the list.
  const card = await opened(page, "vignette");
  await card.getByLabel("Mask by").selectOption("object");
  await card.getByRole("button", { name: "Pick the mask's object" }).click();
  await clickAt(page, ...SUZANNE);
  await page.waitForFunction(() => window.aftershade.store.state.steps[0].mask?.object === "Suzanne");
  await card.getByRole("button", { name: "Choose objects of the mask" }).click();
  await page.locator("#found-objects [role=option]").nth(3).waitFor();
  const items = await page.locator("#found-objects [role=option]").allInnerTexts();
  assert.ok(items.some((text) => /material/.test(text)) && items.some((text) => /object/.test(text)), items.join());
  assert.ok(items.every((text) => /%/.test(text)));
  await axe(page, "objects");
  await shot(page, "objects");
  await page.keyboard.type("ball object");
  const first = (await page.locator("#found-objects .name").first().innerText()).trim();
  await page.keyboard.press("Enter");
  await page.waitForFunction((name) => window.aftershade.store.state.steps[0].mask.object[1] === name, first);
  // A number of the same object, in another look, is shown by its name.
  const id = await page.evaluate(async () => {
    const response = await fetch("/api/objects?frame=3", { headers: { "X-Aftershade-Token": location.hash.slice(7) } });
    return (await response.json()).find(({ name }) => name === "Suzanne").id;
  });
  await edit(page, { op: "mask", step: 0, value: { object: id } });
  await page.waitForFunction(() => document.querySelector('[aria-label="Mask\'s objects"]').value === "Suzanne");
  // A line of a table.
  const scattering = await opened(page, "sss_gaussian");
  await scattering
    .getByRole("button", { name: /^Pick an object for/ })
    .first()
    .click();
  await clickAt(page, ...SUZANNE);
  await page.waitForFunction(() =>
    JSON.stringify(window.aftershade.store.state.steps[1].params).includes('"name":"Suzanne"'),
  );
});

// ---- focus ----

const numbered = (folder) => {
  for (const frame of [3, 4])
    copyFileSync(join(scene, `gbuffer_000${frame}.exr`), join(folder, `gbuffer_000${frame}.exr`));
  const document = JSON.parse(readFileSync(capture, "utf8").replace(/^\s*\/\/.*$/gm, ""));
  writeFileSync(
    join(folder, "capture.json"),
    JSON.stringify({ ...document, objects: { Suzanne: 1, Ball: 2, Cube: 3 } }),
  );
  return ["capture.json"];
};

walk(
  "focuses on an object by a click, racks to another one, and draws both as `run` does",
  async (page, folder) => {
    await edit(page, { op: "add", at: 0, effect: "dof" }, { op: "add", at: 1, effect: "view_transform" });
    await edit(page, { op: "set", step: 0, param: "f_number", value: 0.25 });
    const card = await opened(page, "dof"),
      row = card.locator('[data-param="focus_distance"]');
    await row.getByRole("button", { name: /^Pick/ }).click();
    await clickAt(page, ...SUZANNE);
    await until(page, "focus_distance", { from: "depth", object: "Suzanne" });
    assert.equal(await row.locator(".follows").innerText(), "Suzanne");
    await page.waitForFunction(() => /^6\.\d+ m$/.test(document.querySelector(".bound .now-value").textContent));
    await axe(page, "follows");
    await shot(page, "follows");
    // The limits of sharpness.
    await page.getByLabel("View", { exact: true }).selectOption("sharp:dof");
    await page.waitForFunction(() =>
      /in front of 6\.\d+ m.*behind \d/.test(document.querySelector(".legend").textContent),
    );
    await page.evaluate(() => window.aftershade.settled());
    await axe(page, "sharp");
    await shot(page, "sharp");
    await page.getByLabel("View", { exact: true }).selectOption("final");
    // A key here, another one at frame 4.
    await row.getByRole("button", { name: /^Key/ }).click();
    const rack = (keys) => ({ keys, interpolation: "smooth" });
    await until(page, "focus_distance", rack({ 3: { from: "depth", object: "Suzanne" } }));
    await page.keyboard.press(".");
    await row.getByRole("button", { name: /^Choose the object/ }).click();
    await page.keyboard.type("ball");
    await page.locator("#found-objects .name", { hasText: "Ball" }).waitFor();
    await page.keyboard.press("Enter");
    const keys = { 3: { from: "depth", object: "Suzanne" }, 4: { from: "depth", object: "Ball" } };
    await until(page, "focus_distance", rack(keys));
    assert.deepEqual(await row.locator(".rack .follows").allInnerTexts(), ["Suzanne", "Ball"]);
    await page.evaluate(() => window.aftershade.settled());
    await axe(page, "rack");
    await shot(page, "rack");
    await page.keyboard.press("Control+s");
    await page.keyboard.type("rack");
    await page.keyboard.press("Enter");
    await page.locator(".save-dialog").waitFor({ state: "hidden" });
    assert.match(readFileSync(join(folder, "rack.json"), "utf8"), /"3": \{ "from": "depth", "object": "Suzanne" \}/);
    const drawnByRun = spawnSync(program, ["run", "rack.json", "capture.json", "-o", "out_####.png"], {
      cwd: folder,
      env: environment,
      encoding: "utf8",
    });
    assert.equal(drawnByRun.status, 0, drawnByRun.stderr);
    const shown = await page.evaluate(async () => {
      const { store, viewer } = window.aftershade,
        response = await fetch(
          `/api/picture?revision=${store.state.revision}&frame=${viewer.frame}&scale=1&view=final&exposure=0&format=png`,
          {
            headers: { "X-Aftershade-Token": location.hash.slice(7) },
          },
        );
      return [...new Uint8Array(await response.arrayBuffer())];
    });
    writeFileSync(join(folder, "shown.png"), Buffer.from(shown));
    assert.deepEqual(await pixelsOf(join(folder, "shown.png")), await pixelsOf(join(folder, "out_0004.png")));
    // Back to a number, by the keyboard: the last key goes, and Hold writes what it was.
    await row.getByRole("button", { name: "Suzanne: go to frame 3" }).press("Enter");
    await page.waitForFunction(() => window.aftershade.viewer.frame === 3);
    await row.getByRole("button", { name: /^Remove the key.* frame 4$/ }).press("Enter");
    await until(page, "focus_distance", rack({ 3: keys[3] }));
    await row.getByRole("button", { name: /^Remove the key.* frame 3$/ }).press("Enter");
    await until(page, "focus_distance", { from: "depth", object: "Suzanne" });
    await page.waitForFunction(() => !document.querySelector(".bound button").disabled);
    await row.getByRole("button", { name: /^Hold/ }).press("Enter");
    await page.waitForFunction(
      () => typeof window.aftershade.store.state.steps[0].params.focus_distance.value === "number",
    );
  },
  { words: numbered },
);

walk(
  "sets an exposure by an object, whose light becomes 18 % grey",
  async (page) => {
    await edit(page, { op: "add", at: 0, effect: "view_transform" });
    const row = (await opened(page, "view_transform")).locator('[data-param="exposure"]');
    await row.getByRole("button", { name: /^Pick/ }).click();
    await clickAt(page, ...SUZANNE);
    await until(page, "exposure", { from: "luminance", object: "Suzanne" });
    await page.waitForFunction(() => /^-?\d.* ev$/.test(document.querySelector(".bound .now-value").textContent));
  },
  { words: numbered },
);

// ---- effects ----

for (const [colorScheme, width, height] of [
  ["dark", 1440, 900],
  ["light", 390, 844],
])
  walk(
    `lists effects in groups, the recommended ones first, with pictures of this frame, ${colorScheme}, ${width} px`,
    async (page) => {
      await page.keyboard.press("a");
      const groups = await page
        .locator("#found [role=group]")
        .evaluateAll((nodes) =>
          nodes.map((node) => [
            node.getAttribute("aria-label"),
            [...node.querySelectorAll("[role=option]")].map((one) => one.dataset.effect),
          ]),
        );
      const listed = Object.fromEntries(groups);
      assert.deepEqual(Object.keys(listed), [
        "Lens",
        "Shutter",
        "Scattering",
        "Light",
        "Film",
        "Colour",
        "Repair",
        "Diagnosis",
      ]);
      assert.equal(listed.Lens[0], "dof");
      assert.ok(listed.Lens.includes("bokeh"));
      assert.equal(listed.Shutter[0], "motion_blur");
      await allDrawn(page, "#found", 3);
      await axe(page, "groups");
      await shot(page, `effects_${colorScheme}_${width}`);
      await page.keyboard.type("depth of field");
      assert.equal(await page.locator("#found [role=option]").first().getAttribute("data-effect"), "dof");
      await page.keyboard.press("Enter");
      await page.waitForFunction(() => window.aftershade.store.state.steps[0]?.effect === "dof");
    },
    { viewport: { width, height }, colorScheme },
  );

// ---- out ----

for (const [colorScheme, width, height] of [
  ["dark", 1440, 900],
  ["light", 390, 844],
])
  walk(
    `exports all frames as a video and as images, by keys alone, ${colorScheme}, ${width} px`,
    async (page, folder) => {
      await edit(page, { op: "add", at: 0, effect: "view_transform" });
      const dialog = page.getByRole("dialog", { name: "Export" });
      await page.keyboard.press("x");
      const name = dialog.getByLabel("Name of the export");
      await name.fill("../film");
      await name.press("Enter");
      await dialog.getByText("is not a name for the export").waitFor();
      await axe(page, "export");
      const hasVideo = canProbeVideo();
      for (const [format, file] of [...(hasVideo ? [["mp4", "film.mp4"]] : []), ["png", "film"]]) {
        await name.fill("film");
        await dialog.getByLabel("Format").selectOption(format);
        await name.press("Enter");
        await dialog.getByText(/: frame [12] of 2/).waitFor();
        if (format === "png") await shot(page, `exporting_${colorScheme}_${width}`);
        await dialog.getByText(`Wrote ${join(folder, file)}`, { exact: true }).waitFor();
      }
      await shot(page, `exported_${colorScheme}_${width}`);
      if (hasVideo) {
        const entries = "stream=codec_name,width,height,nb_frames";
        const probed = spawnSync("ffprobe", ["-v", "error", "-show_entries", entries, "-of", "csv=p=0", "film.mp4"], {
          cwd: folder,
          encoding: "utf8",
        });
        assert.equal(probed.stdout.trim(), "h264,480,270,2");
      }
      assert.deepEqual(readdirSync(join(folder, "film")), ["film_0003.png", "film_0004.png"]);
      assert.deepEqual(
        readdirSync(folder).filter((file) => file.startsWith(".")),
        [],
      );
      await name.press("Enter");
      await dialog.getByText("is there already; choose another name").waitFor();
      await name.fill("other");
      await name.press("Enter");
      await dialog.getByRole("button", { name: "Cancel" }).press("Enter");
      await dialog.getByText("other: cancelled; nothing was written").waitFor();
      assert.ok(!existsSync(join(folder, "other")));
    },
    { viewport: { width, height }, colorScheme, mayFail: true }, // refusals, which the browser logs as errors
  );

// ---- hands ----

const typedIn = (row, text) =>
  row
    .getByRole("textbox")
    .fill(text)
    .then(() => row.getByRole("textbox").press("Enter"));

walk("adds up what is typed, and changes a number by a drag on it", async (page) => {
  await edit(page, { op: "add", at: 0, effect: "dof" });
  const row = (await opened(page, "dof")).locator('[data-param="focus_distance"]');
  for (const [text, wanted] of [
    ["6+0.4", 6.4],
    ["(2,5 + 1) * 2", 7],
    ["6+0.4 m", "6.4 m"],
  ]) {
    await typedIn(row, text);
    await until(page, "focus_distance", wanted);
  }
  await typedIn(row, "6+");
  await row.getByText("6+ is not a number").waitFor();
  await row.getByRole("textbox").press("Escape");
  await typedIn(row, "6");
  await until(page, "focus_distance", "6 m");
  await page.locator(".opener").first().focus();
  const box = await row.getByRole("textbox").boundingBox(),
    [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 30, y, { steps: 6 });
  await page.mouse.up();
  // A tenth of the slider, whose ends are a factor of 500 apart.
  await page.waitForFunction(
    (wanted) =>
      Math.abs(parseFloat(window.aftershade.store.state.steps[0].params.focus_distance.value) / wanted - 1) < 0.05,
    6 * 500 ** 0.1,
  );
  await page.keyboard.press("Control+z");
  await until(page, "focus_distance", "6 m"); // the drag was one change
  await row.getByRole("textbox").click();
  assert.ok(await row.getByRole("textbox").evaluate((node) => node === document.activeElement));
});

walk("moves the border of the look by pointer and keys, and keeps its place", async (page) => {
  const border = page.getByRole("separator", { name: "Width of the look" }),
    width = () => page.locator("#look").evaluate((node) => Math.round(node.getBoundingClientRect().width)),
    before = await width(),
    box = await border.boundingBox();
  await page.mouse.move(box.x + 4, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x - 96, box.y + 200, { steps: 4 });
  await page.mouse.up();
  assert.equal(await width(), before + 100);
  await border.press("ArrowLeft");
  assert.equal(await width(), before + 116);
  assert.equal(await border.getAttribute("aria-valuenow"), String(before + 116));
  await axe(page, "border");
  await page.reload();
  await drawn(page);
  assert.equal(await width(), before + 116);
  await border.dblclick();
  assert.equal(await width(), before);
});

walk("explains the value with the focus, not the one under the pointer", async (page) => {
  await edit(page, { op: "add", at: 0, effect: "dof" });
  const card = await opened(page, "dof"),
    help = page.locator(".explain");
  await card.locator('[data-param="f_number"]').hover();
  assert.match(await help.innerText(), /^Focal length divided by/);
  await card.locator('[data-param="focus_distance"]').getByRole("textbox").focus();
  await card.locator('[data-param="f_number"]').hover();
  assert.match(await help.innerText(), /^Distance along the view axis.*Now the effect's default/s);
  await card.locator('[data-param="focus_distance"]').getByRole("textbox").fill("5");
  await page.keyboard.press("Enter");
  await until(page, "focus_distance", 5);
  assert.match(await help.innerText(), /^Distance along the view axis.*Now set in the look/s);
});

walk("asks before a look with faults is saved", async (page, folder) => {
  await edit(page, { op: "add", at: 0, effect: "vignette" });
  await edit(page, { op: "set", step: 0, param: "amount", value: 1e9 });
  const asks = page.getByRole("dialog", { name: "The look has a fault" });
  await page.keyboard.press("Control+s");
  await asks.waitFor();
  await axe(page, "faulty save");
  await page.keyboard.press("Enter"); // Cancel has the focus
  await asks.waitFor({ state: "detached" });
  await page.keyboard.press("Control+s");
  await asks.getByRole("button", { name: "Save with faults" }).press("Enter");
  await page.getByRole("dialog", { name: "Save the look" }).getByLabel("Name of the look").fill("faulty");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.aftershade.store.state.look.has_file);
  assert.ok(existsSync(join(folder, "faulty.json")));
});

walk("shifts a colour by its wheel and keeps the mean", async (page) => {
  await edit(page, { op: "add", at: 0, effect: "color_grade" });
  await edit(page, { op: "set", step: 0, param: "slope", value: [1, 1.2, 0.8] });
  const row = (await opened(page, "color_grade")).locator('[data-param="slope"]'),
    slope = () => page.evaluate(() => window.aftershade.store.state.steps[0].params.slope.value),
    box = await row.locator(".wheel").boundingBox(),
    [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y - box.height / 4, { steps: 5 }); // half of the radius towards red
  await page.mouse.up();
  await page.waitForFunction(() => window.aftershade.store.state.steps[0].params.slope.value[0] > 1.2);
  const [red, green, blue] = await slope();
  assert.ok(Math.abs((red + green + blue) / 3 - 1) < 0.01, [red, green, blue].join());
  assert.ok(Math.abs(green - blue) < 0.05 && Math.abs(red - 1 + 2 * (green - 1)) < 0.05, [red, green, blue].join());
  await axe(page, "wheel");
  await shot(page, "wheel");
  await page.keyboard.press("Control+z");
  await until(page, "slope", [1, 1.2, 0.8]); // the drag was one change
  await row.locator(".wheel").dblclick();
  await until(page, "slope", [1, 1, 1]);
});

for (const [colorScheme, width, height] of [
  ["dark", 1440, 900],
  ["light", 390, 844],
])
  walk(
    `shows parameters under headings and folds the advanced ones away, ${colorScheme}, ${width} px`,
    async (page) => {
      await edit(page, { op: "add", at: 0, effect: "dof" });
      const card = await opened(page, "dof"),
        names = (place) => card.locator(place).evaluateAll((rows) => rows.map(({ dataset }) => dataset.param));
      const { params } = JSON.parse(spawnSync(program, ["describe", "dof", "--json"], { encoding: "utf8" }).stdout);
      const wanted = (fits) => Object.keys(params).filter((name) => fits(params[name]));
      await page.getByRole("group", { name: "Aperture" }).waitFor();
      assert.deepEqual(
        await names('[role=group][aria-labelledby]:has(> .section-name:text-is("Aperture")) > .row'),
        wanted(({ section, advanced }) => section === "Aperture" && !advanced),
      );
      const fold = card.locator("details.advanced");
      assert.deepEqual(
        await names("details.advanced > .row"),
        wanted(({ advanced }) => advanced),
      );
      assert.ok(!(await fold.evaluate((node) => node.open)));
      assert.ok(await card.locator('[data-param="focus_distance"]').isVisible());
      await axe(page, "sections");
      await card.scrollIntoViewIfNeeded();
      await shot(page, `sections_${colorScheme}_${width}`);
      await fold.locator("summary").press("Enter");
      assert.ok(await card.locator('[data-param="quality"]').isVisible());
      // A step whose look sets one of them opens the fold by itself.
      await edit(page, { op: "add", at: 1, effect: "dof" });
      await edit(page, { op: "set", step: 1, param: "quality", value: "exact" });
      await page.reload();
      await drawn(page);
      await page.locator(".opener").nth(1).click();
      await page.locator('.step >> nth=1 >> [data-param="quality"]').waitFor();
    },
    { viewport: { width, height }, colorScheme },
  );

// ---- the list ----

walk("folds open steps while one of them is dragged", async (page) => {
  for (const [at, effect] of ["dof", "vignette", "view_transform"].entries())
    await edit(page, { op: "add", at, effect });
  for (const name of ["dof", "vignette"]) await opened(page, name);
  const grip = await page.locator('.step[data-step="dof"] .grip').boundingBox(),
    shown = () =>
      page.locator(".step .body").evaluateAll((nodes) => nodes.filter((node) => node.checkVisibility()).length);
  assert.equal(await shown(), 2);
  await page.mouse.move(grip.x + 8, grip.y + 8);
  await page.mouse.down();
  assert.equal(await shown(), 0);
  // The heads are near each other now: the last one is two heads below.
  const last = await page.locator('.step[data-step="view_transform"]').boundingBox();
  assert.ok(last.y < grip.y + 120, last.y);
  await page.mouse.move(grip.x + 8, last.y + last.height + 4, { steps: 4 });
  await shot(page, "folded");
  await page.mouse.up();
  await page.waitForFunction(() => window.aftershade.store.state.steps.at(-1).effect === "dof");
  assert.equal(await shown(), 2);
});
