// 200 random edits of a look on the page.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

import {
  compareWithPng,
  described,
  frame,
  inPage,
  LOOK,
  runPicture,
  state,
  textOf,
  withoutComments,
} from "./look_page.mjs";
import { random, randomEdit } from "./random_edits.mjs";
import { drawn } from "./served.mjs";

inPage(
  "keeps text, state and picture together over 200 random edits, and undoes them all to the byte",
  async (page, { look }) => {
    const next = random(28),
      ids = ["bokeh", "color_grade", "vignette", "view_transform", "sharpen", "bloom", "film_grain", "sanitize"],
      effects = new Map(ids.map((id) => [id, described(id)]));
    const equalsRun = async () => {
      assert.equal(await page.evaluate(() => window.aftershade.store.save()), true);
      await page.keyboard.press("1");
      await drawn(page);
      await frame(page);
      assert.equal((await compareWithPng(page, runPicture(look))).difference, 0);
    };
    let taken = 0,
      compared = 0;
    for (let i = 0; i < 200; ++i) {
      const { steps } = await state(page),
        edit = randomEdit(next, steps, effects);
      if (edit.op === "add" && steps.some(({ effect }) => effect === edit.effect))
        Object.assign(edit, { op: "enable", step: 0, value: true });
      taken += (await page.evaluate((edit) => window.aftershade.store.edit([edit]), edit)) ? 1 : 0;
      const now = await state(page),
        written = withoutComments(now.text);
      assert.deepEqual(
        now.steps.map(({ effect }) => effect),
        written.steps.map(({ effect }) => effect),
        JSON.stringify(edit),
      );
      for (const [at, one] of written.steps.entries())
        for (const [id, value] of Object.entries(one.params ?? {}))
          assert.deepEqual(now.steps[at].params[id].value, value, `${at}.${id}`);
      assert.deepEqual(
        await page.locator(".step .name").allInnerTexts(),
        written.steps.map(({ name, effect }) => name ?? effect),
      );
      if (i % 25 === 24 && !(await page.evaluate(() => window.aftershade.store.hasFaults))) {
        await equalsRun();
        compared += 1;
      }
    }
    assert.equal(taken, 200);
    assert.ok(compared >= 3, `${compared} pictures compared`); // a random value may break a relation of two
    assert.equal(await page.evaluate(() => window.aftershade.store.save()), true);
    assert.equal(readFileSync(look, "utf8"), await textOf(page));
    await page.evaluate(async () => {
      const { store } = window.aftershade;
      while (store.state.can_undo) if (!(await store.undo())) break;
    });
    assert.equal(await textOf(page), LOOK);
  },
  { own: true },
);
