// The page in a real browser: Debian's Chromium, driven by playwright-core.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const modules =
  process.env.AFTERSHADE_PAGE_MODULES ?? resolve(dirname(fileURLToPath(import.meta.url)), "../../build/page-modules");
const require = createRequire(join(modules, "/"));
const { chromium } = require("playwright-core");

export const axeSource = require.resolve("axe-core/axe.min.js");

export async function openBrowser() {
  // No sandbox: containers run as root.
  return chromium.launch({
    executablePath: process.env.AFTERSHADE_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--force-color-profile=srgb"],
  });
}

/** A page at the address in a window of its own. It keeps what goes wrong in `page.faults`, and addresses in `page.requests`. */
export async function openAt(browser, address, options) {
  const context = await browser.newContext(options);
  context.setDefaultTimeout(Number(process.env.AFTERSHADE_PAGE_TIMEOUT ?? 60_000)); // for machines that are busy
  const page = await context.newPage();
  page.faults = [];
  page.requests = [];
  page.on("pageerror", (error) => page.faults.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.faults.push(message.text()));
  page.on("request", (request) => page.requests.push(request.url()));
  await page.goto(address);
  return page;
}

/** Opens the page as a user does, from a file and without a network. */
export const openPage = (browser, file, options = {}) =>
  openAt(browser, `file://${file}`, {
    viewport: { width: 1280, height: 900 },
    permissions: ["clipboard-read", "clipboard-write"],
    offline: true,
    ...options,
  });

/** The viewer of a case's image, read and drawn. */
export async function viewerOf(page, name, index = 0) {
  const viewer = page.locator(`[id="case-${name}"] .viewer`).nth(index);
  await viewer.scrollIntoViewIfNeeded();
  await page.waitForFunction((node) => "ready" in node.dataset, await viewer.elementHandle());
  await viewer.locator("canvas").focus();
  return viewer;
}

/** Colours of places of the canvas, in CSS pixels from its corner. */
export const colorsAt = (viewer, places) =>
  viewer.locator("canvas").evaluate((canvas, wanted) => {
    const context = canvas.getContext("2d"),
      ratio = devicePixelRatio;
    return wanted.map(([x, y]) => [...context.getImageData(x * ratio, y * ratio, 1, 1).data.slice(0, 3)]);
  }, places);

/** Colours of places of what the reader sees; where pictures are from files a canvas may not be read. */
export async function seenColorsAt(viewer, places) {
  const picture = (await viewer.locator("canvas").screenshot()).toString("base64");
  return viewer.evaluate(
    async (_, [text, wanted]) => {
      const image = new Image();
      image.src = `data:image/png;base64,${text}`;
      await image.decode();
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      return wanted.map(([x, y]) => [...context.getImageData(x, y, 1, 1).data.slice(0, 3)]);
    },
    [picture, places],
  );
}

/**
 * A PNG file against the middle of the canvas, where its picture lies when a pixel is shown as a pixel:
 * {width, height, difference: the largest of all bytes, brightest: byte}.
 */
export const compareWithPng = (viewer, file) =>
  viewer.locator("canvas").evaluate(async (canvas, text) => {
    const image = new Image();
    image.src = `data:image/png;base64,${text}`;
    await image.decode();
    const [width, height] = [image.naturalWidth, image.naturalHeight],
      other = document.createElement("canvas");
    [other.width, other.height] = [width, height];
    other.getContext("2d").drawImage(image, 0, 0);
    const expected = other.getContext("2d").getImageData(0, 0, width, height).data;
    const found = canvas
      .getContext("2d")
      .getImageData(
        Math.round((canvas.width - width) / 2),
        Math.round((canvas.height - height) / 2),
        width,
        height,
      ).data;
    let difference = 0,
      brightest = 0;
    for (let i = 0; i < found.length; ++i) {
      difference = Math.max(difference, Math.abs(found[i] - expected[i]));
      if (i % 4 < 3) brightest = Math.max(brightest, found[i]);
    }
    return { width, height, difference, brightest };
  }, readFileSync(file).toString("base64"));
