// SPDX-License-Identifier: GPL-3.0-or-later
// How many frames a second the console draws while a mesh is panned: a real weftd, a real Chromium
// that draws by software. Prints the rows of bench/README.md.
//
//   (cd tests/console && npm ci)
//   WEFT_PROGRAMS=build/release node bench/console_pan.js [EDGE...]
import { openBrowser, press } from "../tests/console/browser.js";
import { Weftd } from "../tests/console/weftd.js";

const edges = process.argv.slice(2);
const seconds = 8;
const views = [
  ["whole mesh", 0],
  ["3 pixels per triangle", 3],
  ["60 pixels per triangle", 60],
];

// Drags the picture in circles of 250 pixels at 300 pixels per second. Returns frames per second, and
// the longest time between two, in milliseconds.
const pan = (page, time) =>
  page.evaluate(
    (time) =>
      new Promise((resolve) => {
        const canvas = document.querySelector(".stage canvas");
        canvas.setPointerCapture = () => {};
        const at = (t) => [320 + 250 * Math.sin(1.2 * t), 300 - 250 * Math.cos(1.2 * t)];
        const tell = (type, t) => {
          const { left, top } = canvas.getBoundingClientRect();
          const [x, y] = at(t);
          canvas.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: left + x, clientY: top + y, bubbles: true }));
        };
        tell("pointerdown", 0);
        const stamps = [];
        const step = (now) => {
          stamps.push(now);
          const passed = (now - stamps[0]) / 1000;
          tell("pointermove", passed);
          if (passed < time) return requestAnimationFrame(step);
          tell("pointercancel", passed);
          const gaps = stamps.slice(1).map((stamp, i) => stamp - stamps[i]);
          resolve([(stamps.length - 1) / passed, Math.max(...gaps)]);
        };
        requestAnimationFrame(step);
      }),
    time,
  );

const rest = (page) => page.waitForSelector('.stage canvas[data-drawn="whole"]', { timeout: 120_000 });

const server = await Weftd.start();
const browser = await openBrowser();
const page = await browser.newPage();
console.log("| triangles | view | frames/s | longest ms |\n|---|---|---|---|");
for (const edge of edges.length > 0 ? edges : ["0.00155", "0.00048"]) {
  await page.goto(server.url, { waitUntil: "load" });
  await press(page, "A million");
  await page.focus("#size");
  await page.$eval("#size", (field) => field.select());
  await page.keyboard.type(edge);
  await page.keyboard.press("Enter");
  await page.waitForSelector('.mesh-view[data-phase="done"]', { timeout: 600_000 });
  const triangles = await page.$eval(".mesh-view", (view) => Number(view.dataset.triangles));
  for (const [name, pixels] of views) {
    await press(page, "Fit");
    if (pixels > 0) {
      const { width, height } = await page.$eval(".stage canvas", (canvas) => canvas.getBoundingClientRect().toJSON());
      const fitted = (0.94 * Math.min(width, height - 64)) ** 2 / triangles;
      const wheels = Math.max(0, Math.round(Math.log(Math.sqrt(pixels / fitted)) / (0.0018 * 100)));
      await page.evaluate((wheels) => {
        const canvas = document.querySelector(".stage canvas");
        const { left, top, width, height } = canvas.getBoundingClientRect();
        for (let i = 0; i < wheels; ++i)
          canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: -100, clientX: left + width / 2, clientY: top + height / 2, cancelable: true }));
      }, wheels);
    }
    await rest(page);
    const [rate, longest] = await pan(page, seconds);
    console.log(`| ${triangles.toLocaleString("en-US")} | ${name} | ${rate.toFixed(1)} | ${longest.toFixed(0)} |`);
  }
}
await browser.close();
await server.stop();
