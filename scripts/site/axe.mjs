// Prints what axe-core finds on each page of a site; exits with 1 if it finds anything.
//   node axe.mjs SITE [PAGE...]
import { createRequire } from "node:module";
import { createServer } from "node:http";
import { readFile, readdir } from "node:fs/promises";
import path from "node:path";

const root = path.resolve(process.argv[2]);
const modules = process.env.AFTERSHADE_PAGE_MODULES ?? "build/page-modules";
const require = createRequire(path.resolve(modules, "package.json"));
const { chromium } = require("playwright-core");
const axe = await readFile(require.resolve("axe-core/axe.min.js"), "utf8");

const TYPES = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".json": "application/json", ".svg": "image/svg+xml" };
const server = createServer(async (request, response) => {
  const file = path.join(root, decodeURIComponent(new URL(request.url, "http://site").pathname));
  try {
    response.setHeader("Content-Type", TYPES[path.extname(file)] ?? "application/octet-stream");
    response.end(await readFile(file));
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const pages = (await readdir(root, { recursive: true })).filter((name) => name.endsWith(".html") && name !== "404.html" && (process.argv.length < 4 || process.argv.includes(name)));
const browser = await chromium.launch({ executablePath: process.env.AFTERSHADE_CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
let faults = 0;
for (const colorScheme of ["light", "dark"]) {
  const page = await browser.newPage({ colorScheme, reducedMotion: "reduce" });
  page.setDefaultTimeout(300_000); // for machines that are busy
  for (const name of pages) {
    await page.goto(`http://127.0.0.1:${server.address().port}/${name}`, { waitUntil: "domcontentloaded" });
    await page.waitForFunction(() => [...document.styleSheets].length > 0);
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => axe.run({ resultTypes: ["violations"] }));
    process.stderr.write(".");
    for (const found of violations) {
      faults += found.nodes.length;
      console.log(`${name} (${colorScheme}): ${found.id}: ${found.help}: ${found.nodes.length} x ${found.nodes[0].html.slice(0, 200)}`);
    }
  }
  await page.close();
}
await browser.close();
server.close();
console.log(`${pages.length} pages, light and dark: ${faults} faults`);
process.exit(faults ? 1 : 0);
