// What goes wrong around the page: a program that ends, files that go, a second page, a frame without what it needs.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { drawn, openServed } from "./served.mjs";
import { program } from "./suite.mjs";
import { capture, clickAt, edit, environment, opened, shot, state, until, walk, SUZANNE } from "./walks.mjs";

const LOOK = '{\n  "aftershade": 1,\n  "steps": [\n    { "effect": "vignette" } // mine\n  ]\n}\n';
/** A look of a file, seen on the capture. */
const withFile = (folder) => {
  writeFileSync(join(folder, "look.json"), LOOK);
  return ["look.json", capture];
};
const strength = (page, value) => edit(page, { op: "set", step: 0, param: "strength", value });
const notice = (page, words) =>
  page.waitForFunction((text) => document.getElementById("notice").textContent.includes(text), words);
const mark = (page, words) =>
  page.locator(".mark", { hasText: new RegExp(`^${words}$`) }).waitFor({ state: "attached" });
async function downloaded(page, name) {
  const coming = page.waitForEvent("download");
  await page.getByRole("button", { name, exact: true }).click();
  return readFileSync(await (await coming).path());
}

walk(
  "picks another object by a click in a frame that lacks the one in focus",
  async (page) => {
    await edit(page, { op: "add", at: 0, effect: "dof" });
    await edit(page, { op: "set", step: 0, param: "focus_distance", value: { from: "depth", object: 4000 } });
    const card = await opened(page, "dof");
    await card.getByText(/object 4000 has no pixel with a depth/).waitFor();
    for (const view of ["role:depth", "sharp:dof", "before", "final"]) {
      await page.getByLabel("View", { exact: true }).selectOption(view);
      await drawn(page);
      await page.getByText("capture without steps: this frame lacks what dof needs").waitFor();
      assert.ok(await card.getByText(/object 4000 has no pixel/).isVisible(), view);
    }
    await shot(page, "lacking");
    await card.locator('[data-param="focus_distance"]').getByRole("button", { name: /^Pick/ }).click();
    await clickAt(page, ...SUZANNE);
    await until(page, "focus_distance", { from: "depth", object: 1 });
    await card.getByText(/object 4000/).waitFor({ state: "hidden" });
    await page.keyboard.press("Control+z");
    await until(page, "focus_distance", { from: "depth", object: 4000 });
  },
);

walk(
  "says that the program has ended, and keeps the look",
  async (page, _, server) => {
    await strength(page, 0.9);
    await page.evaluate(() => void window.aftershade.viewer.play()); // it ends with the playing
    server.kill();
    await notice(page, "the program does not answer");
    await page.waitForFunction(() => !window.aftershade.viewer.isPlaying);
    const { text } = await state(page);
    assert.equal(await strength(page, 0.1), false);
    await page.keyboard.press("t");
    await page.locator("#panel-text textarea").fill(text.replace("mine", "typed"));
    await page.waitForTimeout(1500); // after it was to be sent
    assert.match(await page.locator("#panel-text textarea").inputValue(), /typed/);
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press("x");
    await shot(page, "ended");
    assert.equal(String(await downloaded(page, "Look")), text.replace("mine", "typed"));
  },
  { words: withFile, mayFail: true },
);

walk(
  "shows what another page saves, and has a change made again that came too late",
  async (page, folder, { address }) => {
    const other = await openServed(page.context().browser(), address);
    await drawn(other);
    await edit(page, { op: "add", at: 0, effect: "vignette" });
    await page.evaluate(() => window.aftershade.store.save("ours"));
    await other.locator(".file", { hasText: "ours.json" }).waitFor();
    await mark(other, "");
    const taken = await Promise.all([strength(page, 0.9), strength(other, 0.1)]);
    assert.deepEqual(taken.toSorted(), [false, true]);
    await notice(taken[0] ? other : page, "make the change again");
    await page.waitForFunction(() => window.aftershade.store.state.steps[0].params.strength.from === "look");
    await other.context().close();
    assert.equal(existsSync(join(folder, "ours.json")), true);
  },
  { mayFail: true },
);

walk(
  "says that the look's file is gone, and writes it again",
  async (page, folder) => {
    const file = join(folder, "look.json");
    rmSync(file);
    await mark(page, "file is gone");
    await page.keyboard.press("Control+s");
    await mark(page, "");
    assert.equal(readFileSync(file, "utf8"), LOOK);
    // A file that another program changed meanwhile stays, and the message says what to do.
    await strength(page, 0.9);
    writeFileSync(file, LOOK.replace("mine", "theirs"));
    await page.keyboard.press("Control+s");
    await notice(page, "export the look, or undo to the saved one");
    assert.match(readFileSync(file, "utf8"), /theirs/);
    await page.keyboard.press("Control+z");
    await page.waitForFunction(() => window.aftershade.store.state.text.includes("theirs"));
    await mark(page, "");
  },
  { words: withFile, mayFail: true },
);

walk("reports an export that ends before it is looked at", async (page, folder) => {
  await edit(page, { op: "add", at: 0, effect: "view_transform" });
  await page.keyboard.press("x");
  const dialog = page.getByRole("dialog", { name: "Export" });
  await dialog.getByLabel("Format").selectOption("png");
  await page.waitForTimeout(500); // the dialog has asked for the state of an export
  await page.route("**/api/export", async (route) => {
    await new Promise((done) => setTimeout(done, 4000));
    await route.continue();
  });
  await dialog.getByLabel("Name of the export").fill("quick");
  await dialog.getByLabel("Name of the export").press("Enter");
  await dialog.getByText(`Wrote ${join(folder, "quick")}`, { exact: true }).waitFor();
  await page.unroute("**/api/export");
  await dialog.getByLabel("Name of the export").fill("slow");
  await dialog.getByLabel("Name of the export").press("Enter");
  await dialog.getByText(`Wrote ${join(folder, "slow")}`, { exact: true }).waitFor();
  assert.equal(await page.evaluate(() => document.activeElement.ariaLabel), "Name of the export", "for the next one");
});

walk("downloads the still that `run` writes, to the byte", async (page, folder) => {
  await edit(page, { op: "add", at: 0, effect: "vignette" }, { op: "add", at: 1, effect: "view_transform" });
  await page.evaluate(() => window.aftershade.store.save("still"));
  await page.keyboard.press("x");
  const still = await downloaded(page, "Still");
  const words = ["run", "still.json", capture, "--frames", "3", "-o", "own.png", "--no-journal"];
  const run = spawnSync(program, words, { cwd: folder, env: environment, encoding: "utf8" });
  assert.equal(run.status, 0, run.stderr);
  assert.ok(still.equals(readFileSync(join(folder, "own.png"))));
});
