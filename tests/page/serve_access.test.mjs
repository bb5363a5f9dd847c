// The page for everybody: keyboard, axe-core, sizes of windows, colours.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { axeSource } from "./browser.mjs";
import { changed, inPage, LOOK, noRow, open, opened, root, serve, textOf, withoutComments } from "./look_page.mjs";

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
  while (await page.evaluate(() => document.activeElement.matches("input[type=text], select")))
    await page.keyboard.press("Tab");
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
