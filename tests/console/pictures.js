// SPDX-License-Identifier: Apache-2.0
// Screenshots, held against docs/pictures/console-NAME.png, which the documents show. With
// WEFT_ANEW=1 these become what the pages show now, for a person to look at.
//
// Compared are the means of squares of 16 x 16 pixels: what is missing, or has another place, size or
// colour, changes them, another font does not. What varies from run to run, such as ages, is left
// out: every element with data-varies, and what a test names.
import { execFileSync } from "node:child_process";
import { mkdir, readFile, stat, writeFile } from "node:fs/promises";
import { PNG } from "pngjs";
import { settled } from "./browser.js";

const folder = new URL("../../docs/pictures/", import.meta.url).pathname;
const out = new URL("../../out/console/", import.meta.url).pathname;
const anew = process.env.WEFT_ANEW === "1";
const side = 16; // of a square, in pixels
const mostApart = 20; // of 255, that the means of a square may be
const mostShare = 0.02; // of the squares, that may be farther apart
const mostBytes = 200_000;

// Rectangles on the page, in its pixels.
function placesOf(page, selectors) {
  return page.evaluate(
    (css) =>
      [...document.querySelectorAll(css)].map((node) => {
        const { left, top, right, bottom } = node.getBoundingClientRect();
        return { left: Math.floor(left), top: Math.floor(top), right: Math.ceil(right), bottom: Math.ceil(bottom) };
      }),
    selectors.join(","),
  );
}

// Whether the square at column i, row j is none of the places.
const isJudged = (places, i, j) =>
  !places.some(({ left, top, right, bottom }) =>
    left < (i + 1) * side && i * side < right && top < (j + 1) * side && j * side < bottom);

function meanOf({ data, width }, i, j, channel) {
  let sum = 0;
  for (let y = j * side; y < (j + 1) * side; ++y)
    for (let x = i * side; x < (i + 1) * side; ++x) sum += data[4 * (y * width + x) + channel];
  return sum / (side * side);
}

// The squares that differ, by their columns and rows.
function differentSquares(seen, stored, places) {
  const found = [];
  for (let j = 0; (j + 1) * side <= seen.height; ++j)
    for (let i = 0; (i + 1) * side <= seen.width; ++i)
      if (isJudged(places, i, j) &&
          [0, 1, 2].some((c) => Math.abs(meanOf(seen, i, j, c) - meanOf(stored, i, j, c)) > mostApart))
        found.push([i, j]);
  return found;
}

// The picture with these squares in red.
function marked(image, squares) {
  const { width, data } = image;
  for (const [i, j] of squares)
    for (let y = j * side; y < (j + 1) * side; ++y)
      for (let x = i * side; x < (i + 1) * side; ++x) data[4 * (y * width + x)] = 255;
  return PNG.sync.write(image);
}

// 256 colours are enough for a document, and halve the file.
async function shrink(file) {
  const program = "import sys; from PIL import Image; f = sys.argv[1]; " +
    "Image.open(f).convert('RGB').quantize(256, Image.Quantize.MAXCOVERAGE).save(f, optimize=True)";
  execFileSync("/usr/bin/python3", ["-c", program, file]);
  const { size } = await stat(file);
  if (size > mostBytes) throw new Error(`${file} has ${size} bytes, more than ${mostBytes}`);
}

// Fails if the page does not look like the picture of this name. On a failure out/console has what
// was seen, with what differs in red.
export async function looksLike(page, name, { varies = [] } = {}) {
  await page.mouse.move(0, 0);
  await page.evaluate(() => document.fonts.ready);
  await settled(page);
  const places = await placesOf(page, ["[data-varies]", ...varies]);
  const bytes = Buffer.from(await page.screenshot());
  const file = `${folder}console-${name}.png`;
  if (anew) {
    await writeFile(file, bytes);
    return shrink(file);
  }
  const stored = PNG.sync.read(await readFile(file).catch(() => {
    throw new Error(`there is no ${file}; WEFT_ANEW=1 makes it`);
  }));
  const seen = PNG.sync.read(bytes);
  if (seen.width !== stored.width || seen.height !== stored.height)
    throw new Error(`${file} has ${stored.width} x ${stored.height} pixels, the page ${seen.width} x ${seen.height}`);
  const squares = differentSquares(seen, stored, places);
  const share = squares.length / ((seen.width * seen.height) / side ** 2);
  if (share <= mostShare) return;
  await mkdir(out, { recursive: true });
  await writeFile(`${out}${name}.png`, marked(seen, squares));
  throw new Error(`the page does not look like ${file}: ${(100 * share).toFixed(1)} % of it differ, ` +
    `in red in out/console/${name}.png; WEFT_ANEW=1 makes the picture anew`);
}
