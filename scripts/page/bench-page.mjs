// From a change on the authoring page to its picture in Chromium: exposure of view_transform behind dof, 480x270, median of
// 50 edits through the page's own store. Exits with 1 if it takes longer than 1.3 times the passes drawn plus 30 ms, or if dof is
// drawn again. Needs what AFTERSHADE_TEST_ORACLES=1 scripts/test installs, and a quiet machine.
import { join, resolve } from "node:path";

import { openBrowser } from "../../tests/page/browser.mjs";
import { serve } from "./served.mjs";

const EDITS = 50,
  PAUSE_MS = 60,
  root = resolve(import.meta.dirname, "../.."),
  { address, end } = await serve(join(root, "scenes/suzanne/capture.json"));

const browser = await openBrowser(),
  page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
await page.goto(address.href);
await page.waitForFunction(() => window.aftershade?.viewer.canvas.dataset.scale === "1");
await page.waitForTimeout(1000);
const median = await page.evaluate(
  async ([edits, pause]) => {
    const { store, viewer } = window.aftershade,
      samples = [];
    let begun, done;
    viewer.pictures.addEventListener("picture", ({ detail }) => {
      if (detail.isCoarse || detail.wish.revision !== store.state.revision || !done) return;
      const passes_ms = detail.times.passes.reduce((sum, { ms }) => sum + ms, 0);
      samples.push({ picture_ms: performance.now() - begun, passes_ms, steps_drawn: detail.times.steps_drawn });
      done();
    });
    for (let i = 0; i < edits; ++i) {
      const shown = new Promise((resolve) => (done = resolve));
      begun = performance.now();
      store.edit([{ op: "set", step: 1, param: "exposure", value: i / 40 }]);
      await shown;
      done = null;
      await new Promise((resolve) => setTimeout(resolve, pause));
    }
    const middle = (key) => samples.map((sample) => sample[key]).sort((a, b) => a - b)[samples.length >> 1];
    return { picture_ms: middle("picture_ms"), passes_ms: middle("passes_ms"), steps_drawn: middle("steps_drawn") };
  },
  [EDITS, PAUSE_MS],
);
await browser.close();
end();

const limit_ms = 1.3 * median.passes_ms + 30;
console.log(
  `change to picture ${median.picture_ms.toFixed(1)} ms, limit ${limit_ms.toFixed(1)} ms ` +
    `(passes ${median.passes_ms.toFixed(1)} ms, steps drawn ${median.steps_drawn})`,
);
process.exit(median.picture_ms <= limit_ms && median.steps_drawn === 1 ? 0 : 1);
