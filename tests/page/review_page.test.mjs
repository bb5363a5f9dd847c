// The page that a golden suite is reviewed with: `aftershade golden serve`, and the report without a server.
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync, watch, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { axeSource, openBrowser, openPage } from "./browser.mjs";
import { copyOf, makeChangedSuite, namesOf, treeOf } from "./changed_suite.mjs";
import { openServed, startServer } from "./served.mjs";
import { golden } from "./suite.mjs";

const folder = mkdtempSync(join(tmpdir(), "aftershade-review-")),
  names = namesOf(30),
  ADA = "Ada <b>Lovelace</b>",
  GRACE = "Grace Hopper";
let browser, template;
const servers = []; // all end with the tests, or Node would wait for those of a test that failed

before(async () => {
  template = join(folder, "template");
  makeChangedSuite(template, names.length);
  const run = golden(template, "run", ".", "--report", "report");
  assert.equal(run.code, 2, run.err);
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  for (const server of servers) server.kill();
  rmSync(folder, { recursive: true, force: true });
});

async function reviewed(suite, reviewer) {
  const env = { ...process.env, AFTERSHADE_BACKEND: "software" };
  servers.push(await startServer([".", "--approver", reviewer], { cwd: suite, env }, ["golden", "serve"]));
  return servers.at(-1);
}
async function openReview(address, options) {
  const page = await openServed(browser, address, options);
  await page.locator(".review").waitFor(); // laid out once the decisions are there
  return page;
}
const decisionsOf = (suite) => JSON.parse(readFileSync(join(suite, "report/decisions.json"))).decisions;
const groupOf = (page, name) => page.getByRole("group", { name: `Decision about ${name}`, exact: true });
const goldensOf = (suite) => treeOf(join(suite, "goldens"));

/** The API of a server, as its page uses it. */
function apiOf(address) {
  const { origin, hash } = new URL(address);
  const token = new URLSearchParams(hash.slice(1)).get("token");
  return async (path, body, headers = { "X-Aftershade-Token": token }) => {
    const response = await fetch(origin + path, {
      headers: { ...headers, "Content-Type": "application/json" },
      ...(body === undefined ? {} : { method: "POST", body: typeof body === "string" ? body : JSON.stringify(body) }),
    });
    const text = await response.text();
    return { status: response.status, json: text.startsWith("{") ? JSON.parse(text) : null };
  };
}

test("two reviewers decide about 30 cases, and the tree is what approve makes of it", async () => {
  const suite = copyOf(template, join(folder, "walk"));
  const [first, second] = [await reviewed(suite, ADA), await reviewed(suite, GRACE)];
  const ada = await openReview(first.address),
    grace = await openReview(second.address);
  assert.equal(await ada.locator(".review b").innerText(), "0 approved, 0 rejected, 30 to decide");
  assert.match(await ada.locator(".review").innerText(), /You decide as Ada <b>Lovelace<\/b>/, "a name is text");

  // A cause at once: the cases of one effect.
  const causes = ada.locator(".causes li");
  assert.equal(await causes.count(), 3);
  await causes
    .filter({ hasText: "sharpen" })
    .getByRole("button", { name: /^Approve 10/ })
    .click();
  await ada.getByText("10 approved, 0 rejected, 20 to decide").waitFor();

  // A rejection needs a note; an undo takes back what the page did last.
  const lens = groupOf(grace, names[2]);
  await lens.getByRole("button", { name: "Reject" }).click();
  await grace.getByText("Write why, then reject").waitFor();
  await lens.getByRole("textbox").fill("too <i>dark</i> in the corners");
  await lens.getByRole("button", { name: "Reject" }).click();
  await lens.getByText("Rejected by Grace Hopper: too <i>dark</i> in the corners").waitFor();
  await groupOf(grace, names[0]).getByRole("button", { name: "Approve" }).click();
  await groupOf(grace, names[0]).getByText("Approved by Grace Hopper").waitFor();
  await grace.getByRole("button", { name: "Undo", exact: true }).first().click();
  await grace.waitForFunction(() => document.querySelectorAll('.decision[data-state="approve"]').length === 10);

  // Each sees the other's decisions.
  await groupOf(ada, names[2]).getByText("Rejected by Grace Hopper").waitFor();

  // Ada's page is behind: she has not seen what Grace just decided.
  await ada.route("**/api/decisions", (route) => route.abort());
  await groupOf(grace, names[3]).getByRole("textbox").fill("not yet");
  await groupOf(grace, names[3]).getByRole("button", { name: "Reject" }).click();
  await groupOf(grace, names[3]).getByText("Rejected by Grace Hopper").waitFor();
  await groupOf(ada, names[3]).getByRole("button", { name: "Approve" }).click();
  await ada.getByText(`${names[3]}: Grace Hopper has rejected it meanwhile: not yet`).waitFor();
  await groupOf(ada, names[3]).getByText("Rejected by Grace Hopper: not yet").waitFor();
  assert.equal(decisionsOf(suite).find((one) => one.case === names[3]).decision, "reject", "not overwritten");
  await ada.unroute("**/api/decisions");

  // By keys: the rest of the vignettes of Ada, all colour grades of Grace.
  await ada.locator(`[id="case-${names[5]}"] summary`).first().focus();
  await ada.keyboard.press("y");
  await groupOf(ada, names[5]).getByText("Approved by Ada").waitFor();
  await ada.locator(`[id="case-${names[8]}"] summary`).first().focus();
  await ada.keyboard.press("g");
  await ada.getByText("19 approved, 2 rejected, 9 to decide").waitFor();
  await grace.getByText("19 approved, 2 rejected, 9 to decide").waitFor();
  await grace
    .locator(".causes li")
    .filter({ hasText: "color_grade" })
    .getByRole("button", { name: /^Approve 9/ })
    .click();
  await grace.getByText("28 approved, 2 rejected, 0 to decide").waitFor();

  const before = goldensOf(suite);
  await grace.getByRole("button", { name: "Write approved images" }).click();
  await grace.getByText("Written: 28 images.").waitFor();
  await groupOf(ada, names[5]).getByText("Written; approved by Ada").waitFor();
  for (const page of [ada, grace]) {
    assert.deepEqual(
      page.faults.filter((fault) => !/409|ERR_FAILED/.test(fault)),
      [],
    );
    await page.context().close();
  }
  await first.end();
  await second.end();

  const expected = copyOf(template, join(folder, "expected"));
  const isGraces = (name) => name.startsWith("color_grade") && name !== names[3];
  const approve = (approver, chosen) =>
    golden(expected, "approve", ".", "--approver", approver, ...chosen.flatMap((name) => ["--filter", name]));
  const kept = names.filter((name) => name !== names[2] && name !== names[3]);
  assert.equal(
    approve(
      ADA,
      kept.filter((name) => !isGraces(name)),
    ).code,
    0,
  );
  assert.equal(approve(GRACE, kept.filter(isGraces)).code, 0);
  assert.deepEqual(goldensOf(suite), goldensOf(expected));
  const changed = Object.keys(before).filter((path) => before[path] !== goldensOf(suite)[path]);
  assert.equal(changed.length, 56, "28 images and their sidecars");
});

test("lets all reviewers write at once, and takes a second click for none", async () => {
  const suite = copyOf(template, join(folder, "at_once"));
  const all = [await reviewed(suite, ADA), await reviewed(suite, GRACE)];
  const page = await openReview(all[0].address);
  await page.route("**/api/decide", async (route) => (await new Promise((done) => setTimeout(done, 500)), route.continue()));
  await groupOf(page, names[0]).getByRole("button", { name: "Approve" }).dblclick({ noWaitAfter: true });
  await groupOf(page, names[0]).getByText("Approved by Ada").waitFor();
  assert.equal(await page.locator(".review-words").innerText(), "");
  await page.locator(`[id="case-${names[0]}"] summary`).first().focus();
  await page.keyboard.press("y");
  await page.getByText("It is decided; take the decision back first").waitFor();
  const answers = await Promise.all(all.map(({ address }) => apiOf(address)("/api/write", {})));
  for (const { status, json } of answers) {
    assert.equal(status, 200);
    assert.deepEqual([json.warnings, json.kept], [[], []]);
    assert.equal(json.decisions[0].written, true);
  }
  assert.deepEqual(page.faults, []);
  await page.context().close();
  for (const server of all) await server.end();
});

test("goes on where it ended, and counts no decision about other images", async () => {
  const suite = copyOf(template, join(folder, "again"));
  const first = await reviewed(suite, ADA);
  const ask = apiOf(first.address);
  const decide = (name, decision, note = "") =>
    ask("/api/decide", { decisions: [{ case: name, decision, note, before: "" }] });
  assert.equal((await decide(names[0], "approve")).status, 200);
  assert.equal((await decide(names[1], "reject", "why")).status, 200);
  await first.end();
  const second = await reviewed(suite, GRACE);
  const page = await openReview(second.address);
  assert.match(await groupOf(page, names[0]).innerText(), /Approved by Ada/);
  assert.match(await groupOf(page, names[1]).innerText(), /Rejected by Ada.*: why/);
  const changes = await page.evaluate(
    () =>
      new Promise((done) => {
        let count = 0;
        const observer = new MutationObserver((all) => (count += all.length));
        observer.observe(document.querySelector(".review"), { subtree: true, childList: true, attributes: true });
        setTimeout(() => done(count), 5000); // two polls
      }),
  );
  assert.equal(changes, 0, "where nothing is new nothing is laid out, which takes a second for 1000 cases");
  await page.context().close();
  await second.end();
  // Another picture of the same case.
  const document = JSON.parse(readFileSync(join(suite, "golden.json")));
  document.cases[0].steps[0].params.exposure = 3;
  writeFileSync(join(suite, "golden.json"), JSON.stringify(document));
  assert.equal(golden(suite, "run", ".", "--report", "report").code, 2);
  const third = await reviewed(suite, GRACE);
  const later = await openReview(third.address);
  assert.match(await groupOf(later, names[0]).innerText(), /Was approved by Ada.* for other images/);
  assert.match(await groupOf(later, names[1]).innerText(), /Rejected by Ada/);
  // A note that is written and not sent is not lost in silence.
  const note = groupOf(later, names[2]).getByRole("textbox");
  await note.click();
  await note.pressSequentially("too da");
  const asked = new Promise((done) => later.once("dialog", (dialog) => dialog.dismiss().then(() => done(dialog.type()))));
  await later.evaluate(() => void setTimeout(() => location.reload()));
  assert.equal(await asked, "beforeunload");
  assert.equal(await note.inputValue(), "too da");
  await later.context().close();
  await third.end();
});

test("says that the suite was run again, and takes no decision about what its page shows", async () => {
  const suite = copyOf(template, join(folder, "rerun"));
  const server = await reviewed(suite, ADA);
  const ask = apiOf(server.address);
  const page = await openReview(server.address);
  await groupOf(page, names[0]).getByRole("button", { name: "Approve" }).click();
  await groupOf(page, names[0]).getByText("Approved by Ada").waitFor();
  assert.equal(golden(suite, "run", ".", "--report", "report", "--filter", names[1]).code, 2);
  await page.getByText("was written again, or removed, since `aftershade golden serve` read it").waitFor();
  const wish = { case: names[1], decision: "approve", note: "", before: "" };
  for (const [path, body] of [["/api/report"], ["/api/decide", { decisions: [wish] }], ["/api/write", {}]])
    assert.equal((await ask(path, body)).status, 409, path);
  assert.deepEqual(
    decisionsOf(suite).map((one) => one.case),
    [names[0]],
  );
  await page.reload();
  await page.getByText("end the command and start it again").waitFor();
  await page.context().close();
  await server.end();
});

test("writes no image that differs from the one that was reviewed", async () => {
  const suite = copyOf(template, join(folder, "moved"));
  const server = await reviewed(suite, ADA);
  const ask = apiOf(server.address);
  const wish = (name) => ({ case: name, decision: "approve", note: "", before: "" });
  assert.equal((await ask("/api/decide", { decisions: [wish(names[0]), wish(names[1])] })).status, 200);
  const document = JSON.parse(readFileSync(join(suite, "golden.json")));
  document.cases[0].steps[0].params.exposure = 3;
  writeFileSync(join(suite, "golden.json"), JSON.stringify(document));
  const before = goldensOf(suite);
  const { status, json } = await ask("/api/write", {});
  assert.equal(status, 200, json.error);
  assert.equal(json.written.length, 1);
  assert.match(json.kept.join(), /color_grade_00.*draws another picture here than the one that was reviewed/);
  const changed = Object.keys(before).filter((path) => before[path] !== goldensOf(suite)[path]);
  assert.deepEqual(changed, [`${names[1]}.color.0001.exr`, `${names[1]}.color.0001.json`]);
  await server.end();
});

/** Half of the kills fall on times of the drawing, half on the first to tenth rename of a golden. */
function killWhen(i, server, suite) {
  return new Promise((done) => {
    const kill = () => {
      renames.close();
      clearTimeout(limit);
      server.kill();
      done();
    };
    let seen = 0;
    const renames = watch(join(suite, "goldens"), (_, name) => {
      if (i % 2 && !name.startsWith(".") && ++seen > i / 4) kill();
    });
    const limit = setTimeout(kill, i % 2 ? 20_000 : i * 50); // a decision takes milliseconds, 8 images a second or two
  });
}

test(
  "killed at 40 moments leaves each file old or new, and the next write completes it",
  { timeout: 600_000 },
  async () => {
    const expected = copyOf(template, join(folder, "complete"));
    const chosen = namesOf(8).flatMap((name) => ["--filter", name]);
    assert.equal(golden(expected, "approve", ".", "--approver", ADA, ...chosen).code, 0);
    const [old, fresh] = [goldensOf(template), goldensOf(expected)];
    const suite = join(folder, "killed"),
      few = names.slice(0, 8),
      wishes = few.map((name) => ({ case: name, decision: "approve", note: "", before: "" }));
    let partial = 0;
    for (let i = 0; i < 40; ++i) {
      copyOf(template, suite);
      const server = await reviewed(suite, ADA);
      const ask = apiOf(server.address);
      const work = ask("/api/decide", { decisions: wishes })
        .then(() => ask("/api/write", {}))
        .catch(() => null);
      await killWhen(i, server, suite);
      await work;
      const now = goldensOf(suite);
      const states = Object.keys(now).filter((path) => !path.startsWith("."));
      assert.deepEqual(states, Object.keys(old), "no file is gone or new");
      for (const path of states) assert.ok([old[path], fresh[path]].includes(now[path]), `${path} is half`);
      const renewed = states.filter((path) => now[path] === fresh[path]).length;
      partial += renewed > states.length - 16 && renewed < states.length;
      if (existsSync(join(suite, "report/decisions.json"))) assert.equal(decisionsOf(suite).length, few.length);
      if (i % 8 !== 7) continue;
      const again = await reviewed(suite, ADA);
      const resume = apiOf(again.address);
      const { json } = await resume("/api/decisions");
      if (json.decisions.length === 0) await resume("/api/decide", { decisions: wishes });
      await resume("/api/write", {});
      assert.deepEqual(goldensOf(suite), fresh);
      await again.end();
    }
    console.log(`${partial} of 40 kills fell between two renames`);
  },
);

test("refuses those without its token, and bodies that no page sends", async () => {
  const suite = copyOf(template, join(folder, "hostile"));
  const server = await reviewed(suite, ADA);
  const ask = apiOf(server.address);
  const before = treeOf(suite);
  for (const path of ["/api/report", "/api/decisions", "/api/picture?name=images/x.png"])
    assert.equal((await ask(path, undefined, {})).status, 401);
  assert.equal((await ask("/api/write", {}, { "X-Aftershade-Token": "0".repeat(32) })).status, 401);
  for (const name of ["../golden.json", "/etc/passwd", "report.json", "images/../../golden.json", ""])
    assert.notEqual((await ask(`/api/picture?${new URLSearchParams({ name })}`)).status, 200, name);
  for (const body of [
    "{",
    "[]",
    "[".repeat(100_000),
    {},
    { decisions: [] },
    { decisions: [3] },
    { decisions: [{ case: "../../x", decision: "approve", before: "" }] },
    { decisions: [{ case: "*", decision: "approve", before: "" }] },
    { decisions: [{ case: names[0], decision: "aprove", before: "" }] },
    { decisions: [{ case: names[0], decision: "reject", note: "x".repeat(2001), before: "" }] },
  ])
    assert.equal((await ask("/api/decide", body)).status, 400, JSON.stringify(body).slice(0, 80));
  assert.equal((await ask("/api/write", {})).status, 400, "nothing is approved");
  assert.deepEqual(treeOf(suite), before);
  await server.end();
});

test("writes nothing for a report that names other files, suites or names", async () => {
  const suite = copyOf(template, join(folder, "report_from_elsewhere"));
  const file = join(suite, "report/report.json"),
    report = JSON.parse(readFileSync(file));
  const outside = join(folder, "elsewhere");
  writeFileSync(file, JSON.stringify({ ...report, document: join(outside, "golden.json") }));
  const refused = golden(suite, "serve", "report");
  assert.equal(refused.code, 64);
  assert.match(refused.err, /its suite .* is not in this folder; name yours: aftershade golden serve SUITE --report/);

  report.cases[0].name = "../../outside";
  report.cases[1].images[0].pictures.test_exr = "../../../etc/passwd";
  report.cases[2].images[0].name = "<img src=x onerror=\"document.title='broken in'\">";
  report.cases[3].images[0].pictures.test_exr = report.cases[4].images[0].pictures.test_exr;
  writeFileSync(file, JSON.stringify(report));
  const server = await reviewed(suite, ADA);
  const page = await openReview(server.address);
  await page.locator(".decision").first().waitFor();
  assert.equal(await page.locator("img[src=x]").count(), 0);
  const ask = apiOf(server.address);
  const before = goldensOf(suite);
  const wishes = report.cases
    .slice(1, 4)
    .map(({ name }) => ({ case: name, decision: "approve", note: "", before: "" }));
  assert.equal((await ask("/api/decide", { decisions: wishes })).status, 200);
  const { status, json } = await ask("/api/write", {});
  assert.ok(status !== 200 || json.written.length === 0, JSON.stringify(json));
  assert.deepEqual(goldensOf(suite), before);
  assert.equal((await ask("/api/decide", { decisions: [{ ...wishes[0], case: "../../outside" }] })).status, 200);
  assert.notEqual((await ask("/api/write", {})).status, 200, "a case that the suite lacks");
  assert.deepEqual(goldensOf(suite), before);
  await page.context().close();
  await server.end();
});

test("hands decisions back without a server, which apply-approvals takes", async () => {
  const suite = copyOf(template, join(folder, "static"));
  const page = await openPage(browser, join(suite, "report/index.html"), { acceptDownloads: true });
  await groupOf(page, names[0]).getByRole("button", { name: "Approve" }).click();
  await groupOf(page, names[1]).getByRole("textbox").fill("blurred");
  await groupOf(page, names[1]).getByRole("button", { name: "Reject" }).click();
  const button = page.getByRole("button", { name: "Download decisions" });
  await button.click();
  await page.getByText("Write your name and address first").waitFor();
  await page.getByLabel("Your name and address").fill("Ada <ada@example.org>");
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  await download.saveAs(join(suite, "decisions.json"));
  assert.deepEqual(page.faults, []);
  await page.context().close();
  writeFileSync(
    join(suite, "approvers.json"),
    JSON.stringify({ aftershade: 1, approvers: [{ who: ["ada@example.org"] }] }),
  );
  const applied = golden(suite, "apply-approvals", ".", "decisions.json");
  assert.equal(applied.code, 2, "one is rejected");
  assert.match(applied.err, new RegExp(`REJECTED ${names[1]} by Ada <ada@example.org>: blurred`));
  assert.equal(applied.out.trim(), `./goldens/${names[0]}.color.0001.exr`);
});

for (const [theme, width] of [
  ["light", 1440],
  ["dark", 1440],
  ["light", 390],
  ["dark", 390],
])
  test(`has no fault of axe, ${theme} and ${width} px wide`, async () => {
    const suite = copyOf(template, join(folder, `axe-${theme}-${width}`));
    const server = await reviewed(suite, ADA);
    const page = await openReview(server.address, { viewport: { width, height: 900 }, colorScheme: theme });
    await groupOf(page, names[0]).getByRole("button", { name: "Approve" }).click();
    await groupOf(page, names[1]).getByRole("textbox").fill("why");
    await groupOf(page, names[1]).getByRole("button", { name: "Reject" }).click();
    await page.getByText("1 approved, 1 rejected, 28 to decide").waitFor();
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(wide <= 0, `${wide} px too wide`);
    if (process.env.AFTERSHADE_SCREENSHOTS)
      (await page.evaluate(() => scrollTo(0, 0)),
        await page.screenshot({ path: join(process.env.AFTERSHADE_SCREENSHOTS, `review-${theme}-${width}.png`) }));
    // Of the page without its 30 pictures, which the report's own tests look at.
    await page.evaluate(() => document.querySelectorAll(".case").forEach((node, i) => i > 1 && node.remove()));
    await page.evaluate(readFileSync(axeSource, "utf8"));
    const { violations } = await page.evaluate(() => axe.run());
    assert.deepEqual(
      violations.map(({ id, nodes }) => [id, nodes[0].html]),
      [],
    );
    assert.deepEqual(page.faults, []);
    await page.context().close();
    await server.end();
  });
