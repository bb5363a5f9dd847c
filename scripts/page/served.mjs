// `aftershade serve` for the page's measurements: dof and view_transform over CAPTURE, in a folder of its own.
import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { TINT, tintShader } from "../../tests/page/tint.mjs";

/** A child belongs to the thread that started it. */
const childrenOf = (pid) =>
  readdirSync(`/proc/${pid}/task`)
    .flatMap((thread) => readFileSync(`/proc/${pid}/task/${thread}/children`, "utf8").trim().split(" "))
    .filter(Boolean)
    .map(Number);

/**
 * Starts it on AFTERSHADE_EXECUTABLE; gives the page's address with its token, its processes, and what ends it.
 * `ownEffect`: with the step `tint` between, whose shader may be edited.
 */
export async function serve(capture, { ownEffect = false } = {}) {
  const folder = mkdtempSync(join(tmpdir(), "aftershade-served-")),
    look = join(folder, "look.json");
  writeFileSync(
    look,
    JSON.stringify({
      aftershade: 1,
      steps: [
        { effect: "dof", params: { focus_distance: "6.4 m", f_number: 0.5 } },
        ...(ownEffect ? [{ effect: "tint" }] : []),
        { effect: "view_transform", params: { exposure: 0.5 } },
      ],
    }),
  );
  const words = ["serve", look, capture, "--port", "0"];
  if (ownEffect) {
    const effect = join(folder, "effects/tint");
    mkdirSync(effect, { recursive: true });
    writeFileSync(join(effect, "effect.json"), JSON.stringify(TINT));
    writeFileSync(join(effect, "tint.frag"), tintShader("light"));
    words.push("--effect-path", join(folder, "effects"));
  }
  const server = spawn(process.env.AFTERSHADE_EXECUTABLE, words, {
    env: { AFTERSHADE_BACKEND: "software", ...process.env },
    stdio: ["ignore", "pipe", "inherit"],
  });
  const address = await new Promise((ready, failed) => {
    server.on("exit", (code) => failed(new Error(`aftershade serve ended with ${code}`)));
    server.stdout.on("data", (data) => {
      const found = /http:\S+/.exec(data);
      if (found) ready(new URL(found[0]));
    });
  });
  return {
    address,
    pid: server.pid,
    /** The process that draws, which is another one after it was started again. */
    drawerPid: () => childrenOf(server.pid)[0],
    end() {
      server.kill("SIGINT");
      rmSync(folder, { recursive: true });
    },
  };
}
