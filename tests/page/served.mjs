// `aftershade serve` as a process, and its page in the browser.
import { spawn } from "node:child_process";

import { openAt } from "./browser.mjs";
import { program } from "./suite.mjs";

/** {address, end(), kill()} of `aftershade serve`, or of another command that serves, with these words. */
export async function startServer(words, options, command = ["serve"]) {
  const child = spawn(program, [...command, ...words, "--port", "0"], options);
  let errors = "";
  child.stderr.on("data", (data) => (errors += data));
  const address = await new Promise((ready, fail) => {
    let out = "";
    child.stdout.on("data", (data) => {
      out += data;
      const found = /http:\S+/.exec(out);
      if (found) ready(found[0]);
    });
    child.on("exit", (code) => fail(new Error(`serve ended with ${code}: ${errors}`)));
  });
  const end = () =>
    new Promise((done) => {
      if (child.exitCode !== null || child.signalCode !== null) return done();
      child.on("exit", done);
      child.kill("SIGINT");
    });
  return { address, end, kill: () => child.kill("SIGKILL") };
}

export const openServed = (browser, address, options = {}) =>
  openAt(browser, address, { viewport: { width: 1440, height: 900 }, reducedMotion: "reduce", ...options });

/** Once the picture of the present state is there, at full size. */
export const drawn = async (page) => {
  await page.waitForFunction(() => window.aftershade.store.state && "scale" in window.aftershade.viewer.canvas.dataset);
  await page.evaluate(() => window.aftershade.settled());
};
