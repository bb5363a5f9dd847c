// Shaders on the page.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { capture, environment, folder, frame, inPage, LOOK, lookOf, opened, row, state, textOf } from "./look_page.mjs";
import { drawn } from "./served.mjs";
import { program } from "./suite.mjs";
import { TINT, tintShader } from "./tint.mjs";

/** A sound shader in place of the faulty one is drawn, in green. */
async function mends(page, shader) {
  writeFileSync(shader, tintShader("light * vec4(0.0, 2.0, 0.0, 1.0)"));
  await page.waitForFunction(() => !window.aftershade.store.state.faults.length);
  const isGreen = ([red, green]) => green > red,
    after = await centreOnce(page, isGreen);
  assert.ok(isGreen(after), `${after}`);
}

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
    writeFileSync(
      shader,
      tintShader("light * param.amount").replace("    out_color", `${lines.join("\n")}\nout_color`),
    );
    const isFaulty = (words) => window.aftershade.store.state.faults.some(({ message }) => message.includes(words));
    await page.waitForFunction(isFaulty, "did not finish within 4 s");
    assert.equal(await textOf(page), before);
    assert.equal((await state(page)).can_undo, true);
    assert.equal(readFileSync(look, "utf8"), LOOK, "nothing is written before it is saved");
    await mends(page, shader);
    await page.keyboard.press("Control+z");
    await page.waitForFunction((text) => window.aftershade.store.state.text !== text, before);
    page.faults = page.faults.filter((words) => !words.includes("409")); // Chromium lists the refused picture
  },
  { words: ["--pass-timeout", "4"] },
);

withTint(
  "names a pass that crashes the driver, and keeps the last good picture until it is mended",
  async (page, { shader }) => {
    const shown = () => page.locator(".stage canvas").evaluate((canvas) => canvas.toDataURL());
    await drawn(page);
    const before = await textOf(page),
      good = await shown(),
      deep = tintShader("F(F(F(F(F(F(F(F(F(light)))))))))").replace("void main", "#define F(x) x*x+x*x\nvoid main");
    writeFileSync(shader, deep);
    await page.waitForFunction(() =>
      window.aftershade.store.state.faults.some(({ message }) =>
        /crashed .*compiling pass 'tint' of step 'tint'/.test(message),
      ),
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
    await mends(page, shader);
    await page.keyboard.press("Control+z");
    await page.waitForFunction((text) => window.aftershade.store.state.text !== text, before);
    page.faults = page.faults.filter((words) => !words.includes("409")); // Chromium lists the refused picture
  },
);

withTint("undoes a drag at once, also where an effect's file changed after it", async (page, { shader, text }) => {
  const before = await textOf(page);
  for (const value of [0.1, 0.2, 0.5, 0.4])
    await page.evaluate(
      ([step, value]) => window.aftershade.store.edit([{ op: "set", step, param: "exposure", value }], "drag"),
      [JSON.parse(text.replace(/\/\/.*$/gm, "")).steps.findIndex(({ effect }) => effect === "color_grade"), value],
    );
  assert.notEqual(await textOf(page), before);
  await page.evaluate(() => window.aftershade.store.followFiles());
  const revision = (await state(page)).effects_revision;
  writeFileSync(shader, tintShader("light * 0.5 * param.amount"));
  await page.waitForFunction((old) => window.aftershade.store.state.effects_revision > old, revision);
  await page.evaluate(() => window.aftershade.store.undo());
  assert.equal(await textOf(page), before);
});

withTint(
  "writes a shader by Ctrl+S and shows the picture that `run` then draws",
  async (page, { shader, files, look }) => {
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
  },
);

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
  assert.equal(await page.locator("#panel-shaders .faulty .number").first().innerText(), "6");
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

withTint("completes the effect's parameters and images and functions of GLSL in a shader", async (page) => {
  const area = await openShader(page);
  await area.focus();
  await page.keyboard.press("Control+End");
  await page.keyboard.type("par");
  const offered = () => page.locator("#panel-shaders .completion li").allInnerTexts();
  assert.equal((await offered())[0], "param.amount");
  await page.keyboard.press("Enter");
  await page.keyboard.type(" * texelF");
  assert.deepEqual(await offered(), ["texelFetch"]);
  await page.keyboard.press("Tab");
  assert.ok((await area.inputValue()).endsWith("param.amount * texelFetch"));
  await page.getByRole("button", { name: "Revert" }).click();
});
