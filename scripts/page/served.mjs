// `aftershade serve` for the page's measurements: dof and view_transform over CAPTURE, in a folder of its own.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** Starts it on AFTERSHADE_EXECUTABLE; gives the page's address with its token, and what ends it. */
export async function serve(capture) {
  const folder = mkdtempSync(join(tmpdir(), "aftershade-served-")),
    look = join(folder, "look.json");
  writeFileSync(
    look,
    JSON.stringify({
      aftershade: 1,
      steps: [
        { effect: "dof", params: { focus_distance: "6.4 m", f_number: 0.5 } },
        { effect: "view_transform", params: { exposure: 0.5 } },
      ],
    }),
  );
  const server = spawn(process.env.AFTERSHADE_EXECUTABLE, ["serve", look, capture, "--port", "0"], {
    env: { AFTERSHADE_BACKEND: "osmesa", ...process.env },
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
    end() {
      server.kill("SIGINT");
      rmSync(folder, { recursive: true });
    },
  };
}
