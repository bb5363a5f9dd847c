// The page of a golden suite's report, as its users have it. The program makes the suite first (suite.mjs).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import {
  copyFileSync,
  cpSync,
  mkdirSync,
  mkdtempSync,
  readFileSync,
  rmSync,
  symlinkSync,
  writeFileSync,
} from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { axeSource, colorsAt, compareWithPng, openBrowser, openPage, seenColorsAt, viewerOf } from "./browser.mjs";
import { approver, golden, makeReport, program, rebuildPage } from "./suite.mjs";

const folder = mkdtempSync(join(tmpdir(), "aftershade-page-"));
let browser, suite, report, file, json;

before(async () => {
  suite = join(folder, "suite");
  report = makeReport(suite);
  file = join(report, "index.html");
  json = JSON.parse(readFileSync(join(report, "report.json")));
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** A test with a page of its own, which must not complain. */
function inPage(name, work, options) {
  test(name, async () => {
    const page = await openPage(browser, file, options);
    await work(page);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  });
}

const caseOf = (name) => json.cases.find((one) => one.name === name);
const srgb = (light) => {
  const clamped = Math.min(Math.max(light, 0), 1);
  return Math.round(255 * (clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * clamped ** (1 / 2.4) - 0.055));
};
/** The card's light at (x, y). */
const light = (x, y) => [x / 64, y / 32, 0.25];

/** All cards are built; what they show is what a reader sees of them at first. */
async function openAllCases(page) {
  await page.evaluate(() => document.querySelectorAll(".case").forEach((node) => (node.open = true)));
  await page.waitForFunction(() =>
    [...document.querySelectorAll(".case")].every((node) => node.querySelector(".details")),
  );
}

async function exposureOf(viewer) {
  return Number((await viewer.getByLabel("Exposure").getAttribute("aria-valuetext")).replace(" EV", ""));
}

/** Shows the pixel in the middle of the only pane, large; gives its place on the canvas. */
async function lookAtWorst(viewer, mode) {
  await viewer.getByRole("button", { name: mode, exact: true }).click();
  await viewer.getByRole("button", { name: "Worst" }).click();
  await viewer.getByLabel("Frame failing pixels").uncheck();
  const box = await viewer.locator("canvas").boundingBox();
  return [Math.floor(box.width / 2) - 3, Math.floor(box.height / 2) + 3];
}

// ---- one file ----

inPage("asks for nothing but itself, and tells no error", async (page) => {
  for (const name of ["lens", "one_pixel", "warned", "brand_new"]) await viewerOf(page, name);
  const others = page.requests.filter((url) => !url.startsWith("data:") && url !== `file://${file}`);
  assert.deepEqual(others, []);
});

test("shows its pictures without the folder that it was made in", async () => {
  const alone = join(folder, "alone.html");
  copyFileSync(file, alone);
  const page = await openPage(browser, alone);
  const viewer = await viewerOf(page, "lens");
  await viewer.getByRole("button", { name: "Reference" }).click();
  const { width, height } = await viewer.locator("canvas").boundingBox();
  const [middle] = await colorsAt(viewer, [[width / 2, height / 2]]);
  assert.ok(Math.max(...middle) > 20, `the middle is ${middle}`);
  assert.deepEqual(
    page.requests.filter((url) => url.startsWith("file:") && !url.endsWith("alone.html")),
    [],
  );
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

inPage("takes names and messages as text", async (page) => {
  assert.match(await page.title(), /suite$/);
  const skipped = page.locator("#case-absent");
  await skipped.locator("summary").press("Enter"); // pictures above may move it as they come
  await skipped.locator(".details").waitFor();
  assert.match(await skipped.innerText(), /<img src=x onerror/);
  assert.equal(await skipped.locator("img").count(), 0);
  assert.match(await page.locator("#case-lens .facts").last().innerText(), /<b>bold<\/b>/);
});

// ---- summary and order ----

inPage("tells the sums of report.json", async (page) => {
  const chips = await page.locator(".chip").allInnerTexts();
  const { failed, warned, skipped, passed } = json.counts;
  assert.deepEqual(chips, [`${failed} failed`, `${warned} with warnings`, `${skipped} skipped`, `${passed} passed`]);
  assert.equal(failed + warned + skipped + passed, await page.locator(".case").count());
  assert.match(await page.locator("#head").innerText(), /gone\.color\.0001\.exr/);
  assert.doesNotMatch(await page.locator("body").innerText(), /null|undefined/);
});

inPage("has failures first, the worst at the top, and opens them", async (page) => {
  const kinds = await page.locator(".case").evaluateAll((nodes) => nodes.map((node) => [node.dataset.kind, node.open]));
  const order = ["failed", "warned", "skipped", "passed"];
  const ranks = kinds.map(([kind]) => order.indexOf(kind));
  assert.deepEqual(ranks, [...ranks].sort());
  for (const [kind, open] of kinds) assert.equal(open, kind === "failed" || kind === "warned", kind);
  const worst = await page.locator(".case .mark").evaluateAll((nodes) => nodes.map((node) => node.textContent));
  assert.equal(worst[0], "different size or channels");
});

inPage("has the largest of equal failures first", async (page) => {
  // one_pixel fails in 1 of 32400 pixels, passing's neighbours in many: report.json decides, not the page.
  const share = ({ images }) =>
    Math.max(...images.flatMap(({ comparison }) => comparison?.layers.map((layer) => layer.failing?.percent ?? 100) ?? [100]));
  const failures = json.cases.filter(({ verdict, images }) => verdict === "failure" && images.length);
  const shares = new Map(failures.map((test) => [`case-${test.name}`, share(test)]));
  const shown = (await page.locator(".case").evaluateAll((nodes) => nodes.map((node) => node.id)))
    .filter((id) => shares.has(id))
    .map((id) => shares.get(id));
  assert.ok(new Set(shown).size >= 3, `failures of several sizes: ${shown}`);
  assert.deepEqual(shown, [...shown].sort((a, b) => b - a));
  assert.ok(shown.at(-1) < 0.01, "one pixel comes last");
});

inPage("names renderer, Mesa, CPU and why a case failed", async (page) => {
  const { renderer, mesa, cpu } = json.environment,
    foot = await page.locator("#environment").innerText();
  for (const words of [renderer, mesa, cpu]) assert.ok(foot.includes(words), words);
  assert.match(await page.locator("#case-does_not_compile").innerText(), /card\.frag:\d+:.*parm/);
  assert.match(await page.locator("#case-brand_new").innerText(), /no golden/);
});

inPage("finds cases by name, tag and verdict", async (page) => {
  const shown = () => page.locator(".case:visible").evaluateAll((nodes) => nodes.map((node) => node.id));
  await page.getByRole("searchbox").fill("fast");
  assert.deepEqual(await shown(), ["case-passing"]);
  await page.getByRole("searchbox").fill("nothing like it");
  assert.ok(await page.getByText("No case matches.").isVisible());
  await page.getByRole("searchbox").fill("");
  await page.getByRole("button", { name: /failed/ }).click();
  assert.equal((await shown()).length, json.counts.cases - json.counts.failed);
});

test("is short where all is well", async () => {
  const mine = join(folder, "green");
  assert.equal(golden(suite, "run", ".", "--filter", "passing", "--filter", "visible_depth", "--report", mine).code, 0);
  const page = await openPage(browser, join(mine, "index.html"));
  assert.equal(await page.locator("details[open]").count(), 0);
  assert.doesNotMatch(await page.locator("body").innerText(), /null|undefined|NaN|Approve/);
  await page.waitForFunction(() =>
    [...document.querySelectorAll(".thumbnail")].every((node) => node.complete && node.naturalWidth),
  );
  const thumbnails = await page.locator(".thumbnail").evaluateAll((nodes) => nodes.map((node) => node.naturalWidth));
  assert.deepEqual(thumbnails, [240, 240]);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("lays out of many cases only those near the window", async () => {
  const mine = join(folder, "many");
  cpSync(report, mine, { recursive: true });
  const failing = caseOf("one_pixel");
  const cases = Array.from({ length: 150 }, (_, i) => ({ ...failing, name: `case_${i}` }));
  writeFileSync(join(mine, "report.json"), JSON.stringify({ ...json, cases }));
  rebuildPage(mine, "--page-limit", "0");
  const page = await openPage(browser, `${join(mine, "index.html")}#case-case_140`);
  const isLaidOut = (name) =>
    page.locator(`#case-${name} .details`).evaluate((node) => node.checkVisibility({ contentVisibilityAuto: true }));
  await page.waitForFunction(() => Math.abs(document.getElementById("case-case_140").getBoundingClientRect().top) < 100);
  assert.equal(await isLaidOut("case_140"), true);
  assert.equal(await isLaidOut("case_10"), false);
  await page.locator("#case-case_10").scrollIntoViewIfNeeded();
  await page.waitForFunction(() => document.querySelector("#case-case_10 .details").innerText.includes("1 of 32400"));
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("opens the case that its address names", async () => {
  const page = await openPage(browser, `${file}#case-passing`);
  assert.ok(await page.locator("#case-passing").evaluate((node) => node.open));
  assert.match(await page.locator("#case-passing").innerText(), /Every bit is as approved/);
  await page.context().close();
});

inPage("has the figures of report.json in its table", async (page) => {
  const rgb = caseOf("one_pixel").images[0].comparison.layers.find((layer) => layer.layer === "RGB");
  const row = page.locator("#case-one_pixel .metrics tr", { hasText: "RGB" }),
    words = await row.innerText();
  assert.match(words, /1 of 32400/);
  assert.match(words, /31, 17 G/);
  const cells = (await row.locator("td").allInnerTexts()).map(Number);
  for (const value of [rgb.max_error.value, rgb.rmse, rgb.mean_absolute, rgb.psnr_db, rgb.ssim, rgb.hdr_flip.mean])
    assert.ok(
      cells.some((cell) => Math.abs(cell - value) <= 1e-3 * Math.abs(value)),
      `${value} in ${words}`,
    );
});

// ---- pictures ----

inPage("shows the colours of the program's own pictures", async (page) => {
  for (const [name, kind, button] of [
    ["lens", "reference", "Reference"],
    ["lens", "test", "Test"],
    ["one_pixel", "reference", "Reference"],
  ]) {
    const viewer = await viewerOf(page, name),
      { pictures } = caseOf(name).images[0];
    await viewer.getByLabel("Frame failing pixels").uncheck();
    await viewer.getByRole("button", { name: button, exact: true }).click();
    await page.keyboard.press("1");
    const { width, height, difference, brightest } = await compareWithPng(viewer, join(report, pictures[kind]));
    assert.deepEqual([width, height], [240, 135]);
    assert.ok(difference <= 1 && brightest > 100, `${name} ${kind}: ${difference}, ${brightest}`);
  }
});

inPage("colours depth, velocity and ids as the program does", async (page) => {
  for (const [i, name] of ["depth", "velocity", "object_id"].entries()) {
    const viewer = await viewerOf(page, "roles", i + 1);
    const { pictures, output } = caseOf("roles").images[i + 1];
    assert.equal(output, name);
    await viewer.getByLabel("Frame failing pixels").uncheck();
    await viewer.getByRole("button", { name: "Reference", exact: true }).click();
    await page.keyboard.press("1");
    const { difference, brightest } = await compareWithPng(viewer, join(report, pictures.reference));
    // The page takes the nearest of 256 colours of the ramp.
    assert.ok(difference <= 3 && brightest > 100, `${name}: ${difference}, ${brightest}`);
  }
});

inPage("shows the program's difference picture and FLIP heat map", async (page) => {
  const viewer = await viewerOf(page, "lens"),
    { pictures } = caseOf("lens").images[0];
  await viewer.getByLabel("Frame failing pixels").uncheck();
  for (const [kind, button] of [
    ["difference", "Difference"],
    ["heat_map", "FLIP"],
  ]) {
    await viewer.getByRole("button", { name: button, exact: true }).click();
    await page.keyboard.press("1");
    const { difference, brightest } = await compareWithPng(viewer, join(report, pictures[kind]));
    assert.ok(difference <= 1 && brightest > 100, `${kind}: ${difference}, ${brightest}`);
  }
});

inPage("exposes light by what the slider says", async (page) => {
  const viewer = await viewerOf(page, "one_pixel"),
    place = await lookAtWorst(viewer, "Reference");
  for (const stops of [-2, 0, 1.5]) {
    await viewer.getByLabel("Exposure").fill(String(stops));
    assert.equal(await exposureOf(viewer), stops);
    assert.deepEqual(
      (await colorsAt(viewer, [place]))[0],
      light(31, 17).map((value) => srgb(value * 2 ** stops)),
      `${stops} EV`,
    );
  }
  const before = await exposureOf(viewer);
  await page.keyboard.press("[");
  assert.equal(await exposureOf(viewer), before - 0.5);
});

inPage("keeps pixels when it zooms", async (page) => {
  const viewer = await viewerOf(page, "one_pixel");
  const [, y] = await lookAtWorst(viewer, "Reference");
  assert.equal(await viewer.locator(".zoom").innerText(), "1600 %");
  const runs = await viewer.locator("canvas").evaluate((canvas, row) => {
    const line = canvas.getContext("2d").getImageData(0, row, canvas.width, 1).data,
      lengths = [];
    for (let i = 1, length = 1; i < canvas.width; ++i)
      if (line[4 * i] === line[4 * i - 4] && line[4 * i + 1] === line[4 * i - 3]) ++length;
      else (lengths.push(length), (length = 1));
    return lengths;
  }, y);
  // The card's red changes from pixel to pixel, by a byte at least where it is not bright; the pane cuts off the first.
  assert.ok(runs.length > 20 && runs.slice(1).every((length) => length % 16 === 0), String(runs));
});

inPage("swaps test for reference where the pointer is, and with the space bar", async (page) => {
  const viewer = await viewerOf(page, "one_pixel");
  await viewer.getByRole("button", { name: "Worst" }).click();
  await viewer.getByLabel("Frame failing pixels").uncheck();
  const box = await viewer.locator("canvas").boundingBox();
  const [reference, test] = [1 / 6, 3 / 6].map((share) => [
    Math.floor(box.width * share) - 3,
    Math.floor(box.height / 2) + 3,
  ]);
  await page.mouse.move(box.x + 5, box.y + 5);
  const [left, right] = await colorsAt(viewer, [reference, test]);
  assert.notDeepEqual(left, right, "the pixel differs");
  await page.mouse.move(box.x + test[0], box.y + test[1]);
  assert.deepEqual((await colorsAt(viewer, [test]))[0], left, "under the pointer the reference");
  await page.mouse.move(box.x + 5, box.y + 5);
  assert.deepEqual((await colorsAt(viewer, [test]))[0], right, "and the test again");
  await viewer.locator("canvas").focus();
  await page.keyboard.press(" ");
  assert.deepEqual(await colorsAt(viewer, [reference, test]), [right, left]);
});

inPage("wipes between reference and test by pointer, slider and keys", async (page) => {
  const viewer = await viewerOf(page, "one_pixel"),
    reference = await lookAtWorst(viewer, "Reference");
  const [expected] = await colorsAt(viewer, [reference]);
  const place = await lookAtWorst(viewer, "Test");
  const [other] = await colorsAt(viewer, [place]);
  assert.notDeepEqual(expected, other);
  await viewer.getByRole("button", { name: "Wipe" }).click();
  const wipe = viewer.getByLabel("Wipe", { exact: true }).and(viewer.getByRole("slider"));
  await wipe.fill("0.9");
  assert.deepEqual((await colorsAt(viewer, [place]))[0], expected, "left of the line the reference");
  await wipe.fill("0.1");
  assert.deepEqual((await colorsAt(viewer, [place]))[0], other, "right of it the test");
  await viewer.locator("canvas").focus();
  for (let i = 0; i < 30; ++i) await page.keyboard.press(".");
  assert.deepEqual((await colorsAt(viewer, [place]))[0], expected, "moved by a key");
  const box = await viewer.locator("canvas").boundingBox();
  await page.mouse.move(box.x + box.width * 0.7, box.y + 30);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.2, box.y + 30);
  await page.mouse.up();
  assert.deepEqual((await colorsAt(viewer, [place]))[0], other, "drawn by the pointer");
});

inPage("tells the values under the pointer", async (page) => {
  const viewer = await viewerOf(page, "one_pixel"),
    place = await lookAtWorst(viewer, "Test");
  const box = await viewer.locator("canvas").boundingBox();
  await page.mouse.move(box.x + place[0] + 32, box.y + place[1] + 16);
  const words = await viewer.locator(".readout").innerText();
  const same = light(33, 18).join("  ");
  assert.equal(words, `x 33  y 18   R G B   reference ${same}   test ${same}`);
  await page.mouse.move(box.x + place[0], box.y + place[1]);
  assert.match(
    await viewer.locator(".readout").innerText(),
    /x 31 {2}y 17 .*reference 0\.484375 {2}0\.53125 {2}0\.25 .*test 0\.484375 {2}1\.03125 {2}0\.25/,
  );
});

inPage("shows what is not finite in a colour that light has not", async (page) => {
  const viewer = await viewerOf(page, "poisoned"),
    place = await lookAtWorst(viewer, "Test");
  assert.deepEqual((await colorsAt(viewer, [place]))[0], [255, 0, 255]);
  assert.match(await page.locator("#case-poisoned .metrics").innerText(), /none → 1, 0/);
});

inPage("shows every role", async (page) => {
  const words = [/linear light/, /bright .* m, dark .* m/, /direction as hue, full at .* px/, /a colour for each id/];
  for (let i = 0; i < 4; ++i) {
    const viewer = await viewerOf(page, "roles", i);
    assert.match(await viewer.locator(".under").innerText(), words[i]);
    assert.equal(await viewer.getByLabel("Exposure").isVisible(), i === 0, "only light has exposure");
  }
});

inPage("shows images of different size at their places", async (page) => {
  const viewer = await viewerOf(page, "shrunk"),
    box = await viewer.locator("canvas").boundingBox();
  await viewer.getByRole("button", { name: "Test", exact: true }).click();
  await page.keyboard.press("1");
  const { width, height } = await viewer.locator("canvas").boundingBox();
  // The reference's 240 x 135 px are in the middle; the test's 160 x 90 px begin at the same corner.
  const at = (x, y) => [Math.round(width / 2) - 120 + x, Math.round(height / 2 - 67.5) + y];
  const [inside, outside, ground] = await colorsAt(viewer, [at(157, 87), at(163, 93), [2, height - 2]]);
  assert.notDeepEqual(inside, ground);
  assert.deepEqual(outside, ground, `beyond the picture of ${box.width} px`);
});

inPage("shows files that have no pixel or no layer in common", async (page) => {
  assert.match(await page.locator("#case-apart .metrics").innerText(), /no pixel in common/);
  for (const [name, words] of [
    ["apart", "Test"],
    ["other_layers", "Test"],
  ]) {
    const viewer = await viewerOf(page, name);
    if (name === "other_layers") await viewer.getByRole("combobox", { name: "Layer" }).selectOption("RGB");
    await viewer.getByRole("button", { name: words, exact: true }).click();
    await page.keyboard.press("0");
    const colors = await viewer
      .locator("canvas")
      .evaluate(
        (canvas) =>
          new Set(new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer))
            .size,
      );
    assert.ok(colors > 50, `${name} has ${colors} colours`);
  }
});

inPage("does not call NaN approved", async (page) => {
  assert.equal(caseOf("always_poisoned").images[0].bits_equal, true);
  const viewer = await viewerOf(page, "always_poisoned"),
    place = await lookAtWorst(viewer, "Test");
  assert.deepEqual((await colorsAt(viewer, [place]))[0], [255, 0, 255]);
  assert.doesNotMatch(await page.locator("#case-always_poisoned").innerText(), /as approved/);
});

inPage("frees pictures far from the window and reads them again", async (page) => {
  const before = await viewerOf(page, "lens"),
    size = () => before.locator("canvas").evaluate((canvas) => canvas.width);
  await before.getByLabel("Exposure").fill("-1");
  const width = await size();
  assert.ok(width > 100);
  await page.evaluate(() =>
    document.querySelectorAll(".viewer").forEach((node) => (node.style.marginBottom = "1500px")),
  );
  const names = await page.locator(".case:has(.viewer)").evaluateAll((nodes) => nodes.map((node) => node.id.slice(5)));
  // Away from the case to one end of the page, then from the other end towards it.
  const at = names.indexOf("lens"),
    others = [...names.slice(at + 1), ...names.slice(0, at)];
  let seen = 0;
  for (const name of others)
    for (let i = 0; i < (await page.locator(`#case-${name} .viewer`).count()); ++i, ++seen) await viewerOf(page, name, i);
  assert.ok(seen > 8, `more pictures than are kept: ${seen}`);
  await page.waitForTimeout(200); // an IntersectionObserver reports after the next frame
  assert.equal(await size(), 1, "freed");
  await viewerOf(page, "lens");
  assert.equal(await size(), width);
  assert.equal(await exposureOf(before), -1);
});

// ---- what a verdict leaves aside, who approved ----

inPage("says what is left out, what is forgiven, and who approved when", async (page) => {
  await page.locator("#case-left_out > summary").click();
  const details = page.locator("#case-left_out .details");
  await details.waitFor();
  const text = await details.innerText();
  const layer = caseOf("left_out").images[0].comparison.layers[0];
  assert.equal(caseOf("left_out").verdict, "same");
  assert.equal(layer.left_out_pixels, 20);
  assert.match(text, /20 left out/);
  assert.match(text, /forgives a shift of up to 2 px; leaves out 30,16,4,5/);
  assert.match(text, /Every bit that is not left out is as approved/);
  const { sidecar } = caseOf("left_out").images[0].approved;
  assert.equal(sidecar.approver, approver);
  assert.match(sidecar.approved, /^\d{4}-\d\d-\d\d$/);
  assert.ok(text.includes(`${approver}, ${sidecar.approved}`), text);
});

inPage("draws the areas of a tolerance where they lie", async (page) => {
  const viewer = await viewerOf(page, "areas");
  assert.equal(caseOf("areas").verdict, "failure");
  await lookAtWorst(viewer, "Reference"); // 16 px of the canvas for each, (31, 17) in the middle
  const box = await viewer.locator("canvas").boundingBox();
  const place = (x, y) => [box.width / 2 + 16 * (x - 31), box.height / 2 + 16 * (y - 17)];
  const places = [place(22, 18), place(42, 18), place(43, 18), place(44, 18), place(36, 18)];
  const shown = await colorsAt(viewer, places);
  await viewer.getByLabel("Show areas").uncheck();
  const plain = await colorsAt(viewer, places);
  assert.ok(shown[0][2] > plain[0][2] && shown[0][0] < plain[0][0] + 64, `tinted blue: ${plain[0]}, ${shown[0]}`);
  const brighter = [1, 2, 3].map((i) => Math.sign(shown[i][0] - plain[i][0]));
  assert.ok(brighter.includes(1) && brighter.includes(-1), `hatched: ${shown.slice(1, 4)}`);
  assert.deepEqual(shown[4], plain[4], "outside of the areas");
  await page.keyboard.press("m");
  assert.deepEqual(await colorsAt(viewer, places), shown);
});

// ---- approving ----

inPage("copies by key what approves the case that has the focus", async (page) => {
  await viewerOf(page, "lens");
  await page.locator("#case-one_pixel > summary").focus();
  await page.keyboard.press("c");
  await page.getByText("Copied the command that approves one_pixel").waitFor();
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), caseOf("one_pixel").approve);
});

test("copies a command that approves the case", async () => {
  const mine = join(folder, "approved");
  cpSync(suite, mine, { recursive: true });
  const page = await openPage(browser, join(mine, "report/index.html"));
  const line = page.locator("#case-one_pixel .command", { hasText: "Approve" });
  await line.getByRole("button").click();
  await page.getByText("Copied", { exact: true }).waitFor();
  const command = await page.evaluate(() => navigator.clipboard.readText());
  assert.equal(command, caseOf("one_pixel").approve);
  await page.context().close();
  const bin = join(folder, "bin");
  mkdirSync(bin);
  symlinkSync(program, join(bin, "aftershade"));
  const options = {
    cwd: mine,
    env: { ...process.env, PATH: `${bin}:${process.env.PATH}`, AFTERSHADE_BACKEND: "software" },
    stdio: "pipe",
  };
  execFileSync("sh", ["-c", command], options);
  execFileSync("sh", ["-c", caseOf("one_pixel").rerun], options); // throws unless it exits 0
});

// ---- keys, themes, widths ----

inPage("works by keyboard alone", async (page) => {
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "To the cases");
  await page.keyboard.press("j");
  const current = () => page.evaluate(() => document.querySelector(".viewer.current").closest(".case").id);
  await page.waitForSelector(".viewer.current[data-ready]");
  const first = await current();
  for (let i = 0; i < 2; ++i) await page.keyboard.press("j");
  assert.notEqual(await current(), first);
  for (let i = 0; i < 2; ++i) await page.keyboard.press("k");
  assert.equal(await current(), first);
  await viewerOf(page, "lens");
  for (const [key, mode] of [
    ["r", "reference"],
    ["t", "test"],
    ["d", "difference"],
    ["w", "wipe"],
    ["h", "heat_map"],
    ["a", "all"],
  ]) {
    await page.keyboard.press(key);
    assert.equal(
      await page.evaluate(() => document.querySelector(".viewer.current [aria-pressed=true]").dataset.mode),
      mode,
    );
  }
  await page.keyboard.press("+");
  assert.equal(await page.locator(".viewer.current .zoom").innerText(), "200 %");
  await page.keyboard.press("?");
  assert.ok(await page.getByRole("dialog").isVisible());
  await page.keyboard.press("Escape");
  assert.ok(!(await page.getByRole("dialog").isVisible()));
  await page.keyboard.press("/");
  await page.keyboard.type("jt");
  assert.equal(await page.getByRole("searchbox").inputValue(), "jt", "a field keeps its letters");
  await page.keyboard.press("Escape");
  await page.keyboard.press("l");
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "light");
});

test("follows the system's dark and light, and the reader's choice", async () => {
  const luminance = (page) =>
    page.evaluate(
      () =>
        getComputedStyle(document.body)
          .backgroundColor.match(/\d+/g)
          .slice(0, 3)
          .reduce((sum, c) => sum + Number(c), 0) / 3,
    );
  for (const [colorScheme, isDark] of [
    ["dark", true],
    ["light", false],
  ]) {
    const page = await openPage(browser, file, { colorScheme });
    assert.equal((await luminance(page)) < 80, isDark, colorScheme);
    await page.keyboard.press("l");
    if (!isDark) await page.keyboard.press("l");
    assert.equal((await luminance(page)) < 80, !isDark, `chosen against ${colorScheme}`);
    await page.context().close();
  }
});

test("has no fault that axe finds, dark or light", async () => {
  for (const colorScheme of ["dark", "light"]) {
    const page = await openPage(browser, file, { colorScheme });
    await viewerOf(page, "lens");
    await openAllCases(page);
    await page.evaluate(readFileSync(axeSource, "utf8"));
    const found = await page.evaluate(async () =>
      (await axe.run()).violations.map(
        ({ id, nodes }) =>
          `${id}: ${nodes
            .slice(0, 3)
            .map((node) => node.html)
            .join(" ")}`,
      ),
    );
    assert.deepEqual(found, []);
    await page.context().close();
  }
});

inPage(
  "fits a narrow window",
  async (page) => {
    await viewerOf(page, "lens");
    await openAllCases(page);
    assert.ok(
      await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth),
      "nothing to scroll sideways",
    );
  },
  { viewport: { width: 390, height: 800 } },
);

inPage(
  "shows every column of the figures in a window of 1400 px",
  async (page) => {
    await openAllCases(page);
    const cut = await page
      .locator(".wide")
      .evaluateAll((nodes) =>
        nodes
          .filter((node) => node.scrollWidth > node.clientWidth)
          .map((node) => `${node.ariaLabel}: ${node.scrollWidth} px in ${node.clientWidth} px`),
      );
    assert.deepEqual(cut, []);
    assert.ok((await page.locator(".wide").count()) > 5);
  },
  { viewport: { width: 1400, height: 900 } },
);

// ---- large and damaged reports ----

test("shows pictures from the files beside it where they do not fit", async () => {
  const mine = join(folder, "100 % #1? it's");
  cpSync(report, mine, { recursive: true });
  assert.equal(rebuildPage(mine, "--page-limit", "0", "-o", "../linked.html").code, 0);
  const page = await openPage(browser, join(folder, "linked.html"));
  const viewer = await viewerOf(page, "lens");
  assert.match(await viewer.locator(".under").innerText(), /from the files next to the page/);
  assert.ok(!(await viewer.getByLabel("Exposure").isVisible()));
  await viewer.getByRole("button", { name: "Reference" }).click();
  const { width, height } = await viewer.locator("canvas").boundingBox();
  assert.ok(Math.max(...(await seenColorsAt(viewer, [[width / 2, height / 2]]))[0]) > 20);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("tells pictures that are gone, and no report", async () => {
  const mine = join(folder, "damaged");
  cpSync(report, mine, { recursive: true });
  rmSync(join(mine, caseOf("lens").images[0].pictures.test_exr));
  const foreign = structuredClone(json);
  foreign.cases.find((one) => one.name === "one_pixel").images[0].pictures.test_exr = "images/../../suite/in.exr";
  writeFileSync(join(mine, "report.json"), JSON.stringify(foreign));
  assert.equal(rebuildPage(mine).code, 0);
  const page = await openPage(browser, join(mine, "index.html"));
  assert.match(await page.locator("#case-one_pixel").innerText(), /suite\/in\.exr: leads out of its folder/);
  assert.match(await page.locator("#case-lens").innerText(), /Pictures are missing: .*lens\.color\.0001\.test\.exr/);
  await page.context().close();
  writeFileSync(join(mine, "report.json"), '{"cases": []}');
  assert.match(rebuildPage(mine).err, /report\.json: is not a report of a golden suite: .*'document'/);
  rmSync(join(mine, "report.json"));
  const failed = rebuildPage(mine);
  assert.equal(failed.code, 4);
  assert.match(failed.err, /report\.json/);
});
