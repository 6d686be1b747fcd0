// SPDX-License-Identifier: Apache-2.0
// A real Chromium, and pages of the console in it. A page that logs an error or a warning, throws,
// or violates its Content-Security-Policy fails its test.
//
//   const browser = await openBrowser();
//   const page = await openPage(test, browser, server.url + "/jobs");
import { existsSync } from "node:fs";
import { readdir } from "node:fs/promises";
import { join } from "node:path";
import { PNG } from "pngjs";
import puppeteer from "puppeteer-core";
import { atEnd, folderFor, until } from "./weftd.js";

const patience = 180_000; // ms: software draws a mesh in up to 60 s on a loaded machine
const size = { width: 1280, height: 720, deviceScaleFactor: 1 };

const chromium = [process.env.CHROMIUM, "/usr/bin/chromium"].find((path) => path && existsSync(path));

// WebGL2 is drawn by software, text without the machine's own settings: the same pixels anywhere.
export function openBrowser() {
  if (!chromium) throw new Error("there is no Chromium; deploy/install-deps.sh test installs it");
  const sandbox = process.getuid() === 0 ? ["--no-sandbox"] : [];
  return puppeteer.launch({
    executablePath: chromium,
    defaultViewport: size,
    timeout: patience,
    protocolTimeout: 300_000,
    args: [
      ...sandbox,
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--disable-dev-shm-usage",
      "--disable-gpu-watchdog", // it ends a software renderer that a loaded machine keeps waiting
      "--font-render-hinting=none",
      "--disable-lcd-text",
      "--force-color-profile=srgb",
      "--hide-scrollbars",
    ],
  });
}

// Opens a page, which is closed after the test. `expected` are regular expressions of messages that
// this test brings about: the browser itself logs every answer with an error's status.
export async function openPage(test, browser, url, { dark = false, expected = [], token } = {}) {
  const context = await browser.createBrowserContext();
  const page = await context.newPage();
  const faults = [];
  page.on("console", (message) => {
    if (["error", "warn"].includes(message.type())) faults.push(`${message.type()}: ${message.text()}`);
  });
  page.on("pageerror", (error) => faults.push(`uncaught: ${error.stack ?? error}`));
  await page.exposeFunction("weftViolation", (text) => faults.push(`CSP: ${text}`));
  await page.evaluateOnNewDocument(() =>
    addEventListener("securitypolicyviolation", (event) =>
      window.weftViolation(`${event.violatedDirective} ${event.blockedURI} ${event.sourceFile}`),
    ),
  );
  if (token)
    await page.evaluateOnNewDocument((value) => sessionStorage.setItem("weft-token", value), token);
  await page.emulateMediaFeatures([
    { name: "prefers-reduced-motion", value: "reduce" },
    { name: "prefers-color-scheme", value: dark ? "dark" : "light" },
  ]);
  page.setDefaultTimeout(patience);
  atEnd(test, async () => {
    await context.close();
    for (const fault of faults) test.diagnostic(fault);
    const unexpected = faults.filter((fault) => !expected.some((pattern) => pattern.test(fault)));
    if (unexpected.length > 0) throw new Error(`the page complained:\n${unexpected.join("\n")}`);
  });
  await page.goto(url, { waitUntil: "load" });
  return page;
}

// Waits until the text of what `selector` finds matches, and returns the match.
export async function textMatches(page, selector, pattern, { timeout = patience } = {}) {
  try {
    const found = await page.waitForFunction(
      (css, source, flags) =>
        [...document.querySelectorAll(css)].map((node) => new RegExp(source, flags).exec(node.innerText)).find(Boolean),
      { timeout, polling: 50 },
      selector, pattern.source, pattern.flags,
    );
    return await found.jsonValue(); // what matched then: the text may be another one by now
  } catch {
    const seen = await page.$$eval(selector, (nodes) => nodes.map((node) => node.innerText).join(" | "));
    throw new Error(`${selector} never matched ${pattern}: ${seen || "there is none"}`);
  }
}

// Presses the button, link or box of this name, as the accessibility tree has it.
export async function press(page, name) {
  const node = await page.waitForSelector(`aria/${name}[role="button"]`);
  await node.click();
}

// Downloads the mesh in a format, from the page; returns the path of the file.
export async function downloaded(test, page, format) {
  const folder = await folderFor(test);
  const session = await page.createCDPSession();
  await session.send("Browser.setDownloadBehavior", {
    behavior: "allow",
    downloadPath: folder,
    browserContextId: page.browserContext().id,
  });
  await page.waitForSelector(`.downloads option[value="${format}"]`);
  await page.select(".downloads select", format);
  await press(page, "Download");
  const [name] = await until("the file is there", async () => {
    const names = await readdir(folder);
    return names.length > 0 && !names.some((each) => each.endsWith(".crdownload")) && names;
  });
  return join(folder, name);
}

async function pixelsOf(page, clip) {
  return PNG.sync.read(Buffer.from(await page.screenshot({ clip }))).data;
}

// The colour around a point of the page, as a number: the mean of a square of `side` pixels.
export async function colourAt(page, x, y, side = 1) {
  const data = await pixelsOf(page, {
    x: Math.round(x - (side - 1) / 2),
    y: Math.round(y - (side - 1) / 2),
    width: side,
    height: side,
  });
  let colour = 0;
  for (let channel = 0; channel < 3; ++channel) {
    let sum = 0;
    for (let i = channel; i < data.length; i += 4) sum += data[i];
    colour = 256 * colour + Math.round(sum / side ** 2);
  }
  return colour;
}

// The middle of a view once it is drawn, as bytes; around that there may be buttons and a legend.
export async function middleOf(page, view) {
  await view.waitForSelector('canvas[data-drawn="whole"]');
  const { x, y, width, height } = await view.boundingBox();
  return pixelsOf(page, { x: x + width / 4, y: y + height / 4, width: width / 2, height: height / 2 });
}

// Waits until the views show the same three times in a row, and something else than `before`; returns
// what each shows.
export async function settled(page, before = Buffer.alloc(0)) {
  const pictures = [];
  for (const view of await page.$$("main .mesh-view")) {
    const seen = [];
    await until("the picture rests", async () => {
      seen.push(await middleOf(page, view));
      const [a, b, c] = seen.slice(-3);
      return c && a.equals(b) && b.equals(c) && !c.equals(before);
    });
    pictures.push(seen.at(-1));
  }
  return pictures;
}

// Waits until a view shows what it did before. Values may be rounded otherwise at the rims of triangles.
export async function isBack(page, view, before) {
  let apart = 0;
  let now;
  const isLike = async () => {
    now = await middleOf(page, view);
    apart = 0;
    for (let i = 0; i < now.length; ++i) apart += Math.abs(now[i] - before[i]) > 8;
    return now.length === before.length && apart < now.length / 200;
  };
  await until("the picture is back", isLike).catch(async ({ message }) => {
    const pressed = await view.$$eval("[aria-pressed]", (all) => all.map((one) => `${one.innerText} ${one.ariaPressed}`));
    throw new Error(`${message}: ${apart} of ${now.length} values differ, ${before.length} before; ${pressed.join(", ")}`);
  });
}

// Whether the page shows `count` whole meshes, each in `least` colours or more.
export async function areDrawn(page, count, least = 16) {
  const views = await page.$$('main .mesh-view[data-phase="done"]');
  if (views.length !== count) return false;
  for (const view of views) {
    const data = await middleOf(page, view);
    const colours = new Set();
    for (let i = 0; i < data.length && colours.size < least; i += 4) colours.add(data.readUInt32LE(i));
    if (colours.size < least) return false;
  }
  return true;
}
