// SPDX-License-Identifier: Apache-2.0
// The page that makes meshes, in a real browser against a real weftd.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFile, writeFile } from "node:fs/promises";
import { basename, join } from "node:path";
import { after, before, test } from "node:test";
import { areDrawn, colourAt, downloaded, isBack, middleOf, openBrowser, openPage, press, settled, textMatches } from "./browser.js";
import { looksLike } from "./pictures.js";
import { atEnd, folderFor, models, until, weft, Weftd } from "./weftd.js";

let browser;
before(async () => (browser = await openBrowser()));
after(() => browser.close());

async function meshPage(t, { args = [], ...options } = {}) {
  const server = await Weftd.start({ args });
  atEnd(t, () => server.stop());
  const page = await openPage(t, browser, server.url, options);
  await page.waitForSelector(".mesh-view canvas");
  return { server, page };
}

// Drops a file onto the page, as a file manager does.
const drop = (page, name, text) =>
  page.evaluate(
    (name, text) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([text], name));
      const onto = document.querySelector(".mesh-view");
      for (const type of ["dragenter", "dragover", "drop"])
        onto.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
    },
    name, text,
  );

// Replaces what a field says.
async function fill(page, selector, text) {
  await page.focus(selector);
  await page.$eval(selector, (field) => field.select());
  if (text === "") await page.keyboard.press("Backspace");
  else await page.keyboard.type(text);
}

const phase = (page, wanted) =>
  page.waitForSelector(`.mesh-view[data-phase="${wanted}"]`, { timeout: 300_000 });

// What the page's view says of the run from now on: phase, chunks and triangles, at every change.
const recordRun = (page) =>
  page.$eval(".mesh-view", (view) => {
    window.seen = [];
    const look = () =>
      window.seen.push({ phase: view.dataset.phase, chunks: +view.dataset.chunks, triangles: +view.dataset.triangles });
    new MutationObserver(look).observe(view, { attributes: true });
  });

// Waits until the run that is recorded is there, however short it is.
const recorded = (page, wanted) =>
  page.waitForFunction((phase) => window.seen.at(-1)?.phase === phase, { timeout: 300_000 }, wanted);

const byArea = async (page, area) => {
  await page.evaluate(() =>
    [...document.querySelectorAll(".segmented label")].find((label) => label.innerText === "Area").click());
  await fill(page, "#size", area);
};

async function toggleEdges(page, on) {
  await press(page, "Edges");
  await page.waitForFunction((wanted) =>
    [...document.querySelectorAll(".view-tools button")].some((button) =>
      button.innerText === "Edges" && button.ariaPressed === wanted), {}, String(on));
}

test("all of a domain is shown, however late the page knows its size", async (t) => {
  const { page } = await meshPage(t);
  const first = async () => (await settled(page))[0];
  const shown = await first();
  await page.evaluateOnNewDocument(() => {
    const { observe } = ResizeObserver.prototype;
    ResizeObserver.prototype.observe = function (...what) {
      setTimeout(() => observe.apply(this, what), 300);
    };
  });
  await page.reload();
  assert.ok((await first()).equals(shown));
});

test("a dropped file is meshed, and its chunks come before its summary", async (t) => {
  const { page } = await meshPage(t);
  await drop(page, "key.poly", await readFile(join(models, "key.poly"), "utf8"));
  await textMatches(page, ".domain-facts", /key\.poly[^]*122 points, 122 segments/);
  await byArea(page, "0.0004");
  await recordRun(page);
  await press(page, "Mesh");
  await phase(page, "done");
  const seen = await page.evaluate(() => window.seen);
  const running = seen.filter(({ phase }) => phase === "running");
  const counts = new Set(running.map(({ chunks }) => chunks));
  assert.ok(counts.size > 1, `chunks seen before the summary: ${[...counts]}`); // a frame may show many
  for (let i = 1; i < running.length; ++i) assert.ok(running[i].chunks >= running[i - 1].chunks);
  const [, triangles] = await textMatches(page, ".run-status", /([\d,]+) triangles\s+Done/);
  assert.equal(Number(triangles.replaceAll(",", "")), seen.at(-1).triangles);
  assert.ok(seen.at(-1).triangles > 2_015_000); // the key's area, in triangles of at most 0.0004
  await until("the mesh is drawn", () => areDrawn(page, 1, 2));
});

test("names of a dropped file are asked for, and stand in the legend", async (t) => {
  const { page } = await meshPage(t);
  const rectangle = (x) => [[[x, 0], [x + 4, 0], [x + 4, 4], [x, 4], [x, 0]]];
  const feature = (x, properties) =>
    ({ type: "Feature", properties, geometry: { type: "Polygon", coordinates: rectangle(x) } });
  const features = [
    feature(0, { region: "fluid", marker: "wall" }),
    feature(4, { region: 7, region_name: "solid" }),
    feature(8, { region: 7, region_name: "stone" }),
  ];
  await drop(page, "two.geojson", JSON.stringify({ type: "FeatureCollection", features }));
  await textMatches(page, "section [role=status]", /a name of region 7 is left out: the first is 'solid'/);
  await press(page, "Mesh");
  await phase(page, "done");
  await page.select(".view-tools select", "region");
  await textMatches(page, ".legend", /1 fluid\s+7 solid/);
  await page.focus(".mesh-view canvas");
  await page.keyboard.press("Enter");
  await textMatches(page, ".picked", /Region\s+7 solid/);
});

test("a drawing of arcs is meshed, and its mesh is saved as the command line writes it", async (t) => {
  const { page } = await meshPage(t);
  const circle = [0, "SECTION", 2, "ENTITIES", 0, "CIRCLE", 8, 0, 10, 3, 20, 2, 40, 1.5, 0, "ENDSEC", 0, "EOF"].join("\n");
  await drop(page, "disc.dxf", circle);
  await textMatches(page, ".domain-facts", /disc\.dxf[^]*3 × 3/);
  await fill(page, "#size", "0.1");
  await press(page, "Mesh");
  await phase(page, "done");
  const file = await downloaded(t, page, "msh");
  assert.equal(basename(file), "disc.msh");
  const drawing = join(await folderFor(t), "disc.dxf");
  await writeFile(drawing, circle);
  await weft(["mesh", drawing, "--edge", "0.1", "--min-angle", "28", "-q", "-o", `${drawing}.msh`]);
  assert.deepEqual(await readFile(file), await readFile(`${drawing}.msh`));
});

test("a table is meshed, and what is odd in a file is said with what to do", async (t) => {
  const { page } = await meshPage(t);
  await drop(page, "yard.csv", "0,0\n4,0\n4,4\n0,4\n");
  await textMatches(page, ".domain-facts", /yard\.csv[^]*4 points, 4 segments/);
  assert.equal(await page.$(".findings"), null);
  await press(page, "Mesh");
  await phase(page, "done");
  const gap = "5 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 0 0.001\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 5\n0\n";
  await drop(page, "gap.poly", gap);
  await textMatches(page, ".findings", /a gap of 0\.001 [^]*line 8[^]*line 11; snap=/);
});

test("a shapefile in an archive is meshed", async (t) => {
  const { page } = await meshPage(t);
  const archive = join(await folderFor(t), "island.zip");
  execFileSync("/usr/bin/python3", ["-c", `
import struct, sys, zipfile
ring = [(0, 0), (0, 4), (4, 4), (4, 0), (0, 0)]
box = struct.pack("<4d", 0, 0, 4, 4)
shape = struct.pack("<i", 5) + box + struct.pack("<3i", 1, 5, 0) + b"".join(struct.pack("<2d", *p) for p in ring)
record = struct.pack(">2i", 1, len(shape) // 2) + shape
head = struct.pack(">7i", 9994, 0, 0, 0, 0, 0, (100 + len(record)) // 2) + struct.pack("<2i", 1000, 5) + box + bytes(32)
with zipfile.ZipFile(sys.argv[1], "w", zipfile.ZIP_DEFLATED) as out:
    out.writestr("data/island.shp", head + record)
`, archive]);
  const input = await page.$("input[type=file]");
  await input.uploadFile(archive);
  await textMatches(page, ".domain-facts", /island\.zip[^]*4 points, 4 segments, 4 × 4/);
  await press(page, "Mesh");
  await phase(page, "done");
});

test("a domain in degrees is projected to metres if that is asked for", async (t) => {
  const { page } = await meshPage(t);
  await drop(page, "coast.geojson", await readFile(join(models, "us-east-coast.geojson"), "utf8"));
  await textMatches(page, ".findings", /longitudes and latitudes/);
  await press(page, "Project it to metres");
  await textMatches(page, ".domain-facts", /coast\.geojson[^]*[\d.e,]{4,} × /);
  await page.waitForFunction(() => !document.body.innerText.includes("Project it to metres"));
});

for (const [name, text, complaint] of [
  ["broken.poly", "3 2 0 0\n1 0 0\n2 1 zero\n3 0 1\n", /broken\.poly:3:5: expected the y coordinate/],
  ["picture.png", "\x89PNG", /picture\.png/],
])
  test(`a file that is no domain is refused with its fault: ${name}`, async (t) => {
    const { page } = await meshPage(t, { expected: [/status of 400/] });
    await drop(page, name, text);
    await textMatches(page, "section [role=alert]", complaint);
    await textMatches(page, ".domain-facts", /plate\.geojson/); // what was there stays
  });

// Has an empty sheet for a drawing come, by `act`.
async function emptySheet(page, act) {
  const before = await middleOf(page, await page.$(".mesh-view"));
  await act();
  await page.waitForSelector("canvas.sketching");
  await settled(page, before);
}

test("a polygon with a hole is drawn by hand and meshed", async (t) => {
  const { page } = await meshPage(t);
  await emptySheet(page, () => press(page, "Draw"));
  const { x, y, width, height } = await (await page.$(".mesh-view canvas")).boundingBox();
  const middle = [x + width / 2, y + height / 2];
  const click = ([dx, dy]) => page.mouse.click(middle[0] + dx, middle[1] + dy);
  for (const corner of [[-200, -120], [200, -120], [200, 120], [-200, 120]]) await click(corner);
  await textMatches(page, ".sketch-bar", /4 corners/);
  await click([-200, -120]); // the first one closes the ring
  for (const corner of [[-60, -50], [60, -50], [0, 60]]) await click(corner);
  await textMatches(page, ".sketch-bar", /3 corners/);
  await press(page, "Close ring");
  await press(page, "Use");
  await textMatches(page, ".domain-facts", /drawing\.geojson[^]*7 points, 7 segments/);
  await press(page, "Mesh");
  await phase(page, "done");
  await until("the mesh is drawn", () => areDrawn(page, 1));
  // The drawing fills the picture now: its hole is in the middle, triangles are beside it.
  await until("the hole is empty", async () => {
    const [hole, beside, outside] = await Promise.all([
      colourAt(page, ...middle),
      colourAt(page, middle[0] - width / 4, middle[1]),
      colourAt(page, middle[0], y + height - 4),
    ]);
    return hole === outside && beside !== outside;
  });
});

test("a fault in an expression is shown with its caret under it, and goes with it", async (t) => {
  const { page } = await meshPage(t);
  await fill(page, "#size", "0.1 + 2*(x +* y)");
  await press(page, "Mesh");
  const [pre] = await textMatches(page, "#size-problem", /[^]*\^/);
  const lines = pre.split("\n");
  const column = lines.at(-1).indexOf("^");
  const expression = lines.findLast((line) => line.includes("2*(x +* y)"));
  assert.equal(expression.slice(column, column + 1), "*");
  assert.equal(expression[column - 1], "+");
  assert.equal(await page.$eval("#size", (field) => field.getAttribute("aria-invalid")), "true");

  await fill(page, "#size", "0.2");
  await page.waitForSelector("#size-problem", { hidden: true });
  await page.keyboard.press("Enter");
  await phase(page, "done");
});

test("a gradation is measured within the domain if its box is ticked, which shows beside a gradation alone", async (t) => {
  const { page } = await meshPage(t);
  // A channel behind a thin wall, fine at its end.
  const bend = [[[0, 0], [8, 0], [8, 8], [1.1, 8], [1.1, 0.5], [1, 0.5], [1, 8], [0, 8], [0, 0]]];
  await drop(page, "bend.geojson", JSON.stringify({ type: "Polygon", coordinates: bend }));
  await textMatches(page, ".domain-facts", /bend\.geojson/);
  await fill(page, "#size", "x < 1 && y > 7.5 ? 0.05 : 20");
  assert.equal(await page.$("#gradationWithin"), null);
  const triangles = async () => {
    await recordRun(page);
    await press(page, "Mesh");
    await recorded(page, "done");
    return page.evaluate(() => window.seen.at(-1).triangles);
  };
  await fill(page, "#size", "50 + x");
  await triangles();
  await textMatches(page, ".run-status", /the size bounds nothing: it asks for edges of 5/);
  await fill(page, "#size", "x < 1 && y > 7.5 ? 0.05 : 20");

  await fill(page, "#gradation", "0.15");
  await page.waitForSelector("#gradationWithin");
  const across = await triangles();
  await page.click("#gradationWithin");
  const within = await triangles();
  assert.ok(within < 0.85 * across, `${within} triangles within the domain, ${across} across land`);
  const [command, program] = await page.evaluate(async () => {
    const copied = [];
    navigator.clipboard.writeText = async (text) => void copied.push(text);
    for (const button of document.querySelectorAll(".copies button")) button.click();
    while (copied.length < 2) await new Promise((done) => setTimeout(done));
    return copied;
  });
  assert.match(command, /--gradation 0\.15 \\\n {2}--gradation-within/);
  assert.match(program, /gradation_within=True/);

  await fill(page, "#gradation", "");
  await page.waitForSelector("#gradationWithin", { hidden: true });
  await drop(page, "again.geojson", JSON.stringify({ type: "Polygon", coordinates: bend }));
  await textMatches(page, ".domain-facts", /again\.geojson/);
  await fill(page, "#gradation", "0.15");
  await page.waitForSelector("#gradationWithin");
  assert.equal(await page.$eval("#gradationWithin", (box) => box.checked), false);
});

test("a run is cancelled, and with it the server's work; what has come stays", async (t) => {
  const { server, page } = await meshPage(t);
  const running = async () =>
    /^weft_running_jobs(?:\{[^}]*\})? (\d+)/m.exec(await (await fetch(`${server.url}/metrics`)).text())?.[1];
  await press(page, "A million");
  await fill(page, "#size", "0.0001"); // minutes
  await press(page, "Mesh");
  await page.waitForFunction(() => Number(document.querySelector(".mesh-view").dataset.chunks) > 3);
  // A run gives its place back while the browser is slow to read.
  await until("the server works", async () => (await running()) === "1");
  await press(page, "Cancel");
  await textMatches(page, ".run-status", /Cancelled/);
  await until("the server rests", async () => (await running()) === "0");
  assert.ok(await page.$eval(".mesh-view", (view) => Number(view.dataset.triangles) > 0));
  await press(page, "Mesh"); // the page goes on
  await phase(page, "running");
  await page.keyboard.press("Escape");
  await phase(page, "cancelled");
});

test("the size is shown before there is a mesh, with about how many triangles it asks for", async (t) => {
  const { page } = await meshPage(t);
  const about = async () => Number((await textMatches(page, ".desk-foot", /about ([\d,]+) triangles/))[1].replaceAll(",", ""));
  await fill(page, "#size", "0.1");
  await page.waitForSelector(".legend", { hidden: true }); // the same everywhere
  const even = await until("the size is known", async () => (await about()) > 6000 && about());
  assert.ok(even < 10_000, `${even}`);
  await fill(page, "#size", "0.1 + 0.1*x");
  await textMatches(page, ".legend", /Length of edges, as asked for/);
  await until("a larger size is known", async () => (await about()) < even / 4);
  await fill(page, "#gradation", "0.01");
  await until("the limit is shown", async () => (await about()) > even / 2);
  await fill(page, "#size", "0.1 +");
  const place = () => page.$eval(".desk-foot .primary", (button) => button.getBoundingClientRect().top);
  const before = await place();
  await page.waitForFunction(() => !/about/.test(document.querySelector(".desk-foot").innerText));
  assert.equal(await place(), before); // no button moves under the mouse
  await page.waitForSelector(".legend", { hidden: true });
});

for (const [measure, size, gradation] of [["edge", "0.25 + 0.1*distance + 0.05*x", ""], ["area", "0.02 + 0.01*x", ""], ["edge", "0.25 + 0.1*distance + 0.05*x", "0.08"]])
  test(`triangles have the colour of their area over the bound that the server tells: ${measure} ${gradation}`, async (t) => {
    const { page } = await meshPage(t);
    if (measure === "area") await byArea(page, size);
    else await fill(page, "#size", size);
    await fill(page, "#gradation", gradation);
    await press(page, "Mesh");
    await phase(page, "done");
    await until("the mesh is drawn", () => areDrawn(page, 1));
    const [before] = await settled(page);
    await page.select(".view-tools select", "ratio");
    await textMatches(page, ".legend", /Area over its bound[^]*0\.00[^]*1\.00/);
    await toggleEdges(page, false);
    await settled(page, before);
    const scale = await page.$$eval(".legend rect", (rects) =>
      rects.map((rect) => getComputedStyle(rect).fill.match(/\d+/g).map(Number)));
    const { x, y, width, height } = await (await page.$(".mesh-view canvas")).boundingBox();
    const ratios = new Set();
    await page.focus(".mesh-view canvas");
    const unit = 0.85 * Math.min(width / 8, height / 5); // of the plate, in pixels, about
    for (const [dx, dy] of [[-3.5, 0], [-0.6, 1.2], [0.5, -1.2], [1.8, 0], [3.6, 0]]) {
      const at = [x + width / 2 + unit * dx, y + height / 2 + unit * dy];
      await page.keyboard.press("Escape"); // picks none, so that none is marked
      await page.waitForSelector("aside .picked", { hidden: true });
      let colour = await colourAt(page, ...at);
      while ((await colourAt(page, ...at, 5)) !== colour) { // on an edge
        at[1] += 3;
        colour = await colourAt(page, ...at);
      }
      await page.mouse.click(...at);
      const [, percent] = await textMatches(page, "aside", /Bound\s+[\d.,e-]+ \(([\d.]+) %\)/);
      const wanted = scale[Math.round((Number(percent) / 100) * (scale.length - 1))];
      const seen = [colour >> 16, (colour >> 8) & 255, colour & 255];
      assert.ok(seen.every((value, i) => Math.abs(value - wanted[i]) < 14), `${percent} % is ${seen} instead of ${wanted}`);
      ratios.add(percent);
    }
    assert.ok(ratios.size > 2, `different triangles: ${[...ratios]}`);
    await page.select(".view-tools select", "angle");
    await textMatches(page, ".legend", /Smallest angle/);
    await page.focus(".mesh-view canvas");
    await page.keyboard.press("Escape"); // picks none
    await page.waitForSelector("aside .picked", { hidden: true });
    await toggleEdges(page, true);
    await isBack(page, await page.$(".mesh-view"), before);
  });

test("five million triangles are drawn, and panned by the mouse", async (t) => {
  const { page } = await meshPage(t);
  await press(page, "A million");
  await fill(page, "#size", "0.00068");
  await press(page, "Mesh");
  await phase(page, "done");
  await textMatches(page, ".run-status", /5,\d{3},\d{3} triangles/);
  await page.select(".view-tools select", "chunk"); // many colours
  await until("the mesh is drawn", () => areDrawn(page, 1));
  const canvas = await (await page.$(".mesh-view canvas")).boundingBox();
  const middle = [canvas.x + canvas.width / 2, canvas.y + canvas.height / 2];
  const corner = [canvas.x + canvas.width / 2 - 120, canvas.y + canvas.height / 2 - 80];
  const step = [120, 80];
  const beforeMove = await colourAt(page, ...corner, 9);
  await page.mouse.move(...middle);
  await page.mouse.down();
  await page.mouse.move(middle[0] + step[0], middle[1] + step[1], { steps: 8 });
  await page.mouse.up();
  // What was there has moved with the mouse.
  await until("the picture has moved", async () => (await colourAt(page, corner[0] + step[0], corner[1] + step[1], 9)) === beforeMove);
  await press(page, "Fit");
  await until("the picture is back", async () => (await colourAt(page, ...corner, 9)) === beforeMove);
});

test("a picture that has moved far is the one that is drawn anew", async (t) => {
  const { page } = await meshPage(t);
  await press(page, "Airfoil");
  await press(page, "Mesh");
  await phase(page, "done");
  await page.select(".view-tools select", "chunk");
  await until("the mesh is drawn", () => areDrawn(page, 1));
  await page.focus(".mesh-view canvas");
  for (let i = 0; i < 4; ++i) await page.keyboard.press("+");
  for (const [way, times] of [["ArrowLeft", 11], ["ArrowUp", 5], ["ArrowRight", 7]])
    for (let i = 0; i < times; ++i) await page.keyboard.press(way);
  const [moved] = await settled(page);
  await toggleEdges(page, false);
  await settled(page, moved);
  await toggleEdges(page, true);
  await isBack(page, await page.$(".mesh-view"), moved);
});

test("a picture whose graphics card is taken away says so, and comes back with it", async (t) => {
  const { page } = await meshPage(t, { expected: [/CONTEXT_LOST_WEBGL/] });
  const view = await page.$(".mesh-view");
  await press(page, "A million");
  await page.select(".view-tools select", "chunk");
  await press(page, "Mesh");
  await page.waitForFunction(() => Number(document.querySelector(".mesh-view").dataset.chunks) > 3);
  await page.$eval(".stage canvas", (canvas) => {
    window.card = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
    window.card.loseContext();
  });
  await textMatches(page, ".view-problem", /taken the graphics card away/);
  await phase(page, "done"); // chunks come meanwhile, too
  await page.evaluate(() => window.card.restoreContext());
  await page.waitForSelector(".view-problem", { hidden: true });
  await until("the mesh is drawn", () => areDrawn(page, 1));
  const [restored] = await settled(page);

  await recordRun(page);
  await press(page, "Mesh"); // the same once more, undisturbed
  await recorded(page, "done");
  await isBack(page, view, restored);
});

test("by the keyboard alone a mesh is asked for, drawn, zoomed and coloured", async (t) => {
  const { page } = await meshPage(t);
  const focused = () => page.evaluate(() => document.activeElement.id || document.activeElement.ariaLabel ||
    document.activeElement.innerText || document.activeElement.tagName);
  const tabTo = async (pattern) => {
    const passed = [];
    for (let i = 0; i < 60; ++i) {
      await page.keyboard.press("Tab");
      passed.push(await focused());
      if (pattern.test(passed.at(-1))) return;
    }
    assert.fail(`Tab never reached ${pattern}, but ${passed.join(", ")}`);
  };
  await tabTo(/^Gear$/);
  await page.keyboard.press("Space");
  await textMatches(page, ".domain-facts", /gear\.geojson/);
  await tabTo(/^size$/);
  await page.keyboard.down("Control");
  await page.keyboard.press("a");
  await page.keyboard.up("Control");
  await page.keyboard.type("0.2");
  await page.keyboard.press("Enter");
  await phase(page, "done");
  await tabTo(/^Picture of the mesh/);
  await page.keyboard.press("Enter"); // the triangle in the middle: there is a hole
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  await textMatches(page, "aside", /neighbours/i);
  await page.keyboard.press("c");
  await textMatches(page, ".legend", /^(?!Smallest angle)/);
  await page.keyboard.press("+");

  // A triangle, drawn.
  await page.keyboard.down("Shift");
  for (let i = 0; i < 60 && (await focused()) !== "Draw"; ++i) await page.keyboard.press("Tab");
  await page.keyboard.up("Shift");
  await emptySheet(page, () => page.keyboard.press("Space"));
  await tabTo(/^Drawing/);
  await page.keyboard.press("Enter");
  for (const [way, times] of [["ArrowRight", 20], ["ArrowUp", 12]]) {
    for (let i = 0; i < times; ++i) await page.keyboard.press(way);
    await page.keyboard.press("Enter");
  }
  await textMatches(page, ".sketch-bar", /3 corners/);
  await page.keyboard.press("c");
  await tabTo(/^Use$/);
  await page.keyboard.press("Enter");
  await textMatches(page, ".domain-facts", /3 points, 3 segments/);
  await page.keyboard.down("Control");
  await page.keyboard.press("Enter");
  await page.keyboard.up("Control");
  await phase(page, "done");
});

test("Ctrl+Enter meshes a drawing at once, before the page is painted without its tools", async (t) => {
  const { page } = await meshPage(t);
  await emptySheet(page, () => press(page, "Draw"));
  const { x, y, width, height } = await (await page.$(".mesh-view canvas")).boundingBox();
  for (const [dx, dy] of [[-90, -60], [90, -60], [0, 90]])
    await page.mouse.click(x + width / 2 + dx, y + height / 2 + dy);
  await textMatches(page, ".sketch-bar", /3 corners/);
  await page.$eval(".sketch-bar .primary", async (use) => {
    use.click();
    for (let i = 0; i < 10; ++i) await Promise.resolve(); // the page is rendered, not painted
    document.activeElement.dispatchEvent(
      new KeyboardEvent("keydown", { key: "Enter", ctrlKey: true, bubbles: true, cancelable: true }),
    );
  });
  await phase(page, "done");
});

test("a request becomes a job, whose page shows its mesh", async (t) => {
  const { page } = await meshPage(t, { args: ["--data", await folderFor(t)] });
  await press(page, "As a job");
  await textMatches(page, "main", /Job [0-9A-Z]{26}[^]*succeeded/);
  await page.click("a.button");
  await until("the mesh is drawn", () => areDrawn(page, 1));
  assert.match(new URL(page.url()).pathname, /^\/mesh\/[0-9a-f]{64}$/);
});

test("a server that goes away while it makes a mesh is said to be away", async (t) => {
  const server = await Weftd.start();
  const page = await openPage(t, browser, server.url, { expected: [/net::/] });
  await press(page, "A million");
  await fill(page, "#size", "0.0001");
  await press(page, "Mesh");
  await page.waitForFunction(() => Number(document.querySelector(".mesh-view").dataset.chunks) > 0);
  await server.kill();
  await phase(page, "failed");
  await textMatches(page, ".banner", /does not answer/);
});

test("what the documents show of the page is what it looks like", async (t) => {
  const { page } = await meshPage(t, { dark: true });
  await press(page, "Lake");
  await fill(page, "#size", "0.12 + 0.25*distance");
  await press(page, "Mesh");
  await phase(page, "done");
  await until("the mesh is drawn", () => areDrawn(page, 1));
  await looksLike(page, "new-mesh", { varies: [".figures dd:last-child"] });

  await press(page, "Airfoil");
  await recordRun(page);
  await press(page, "Mesh");
  await recorded(page, "done");
  await press(page, "Worst");
  await page.click(".worst button, .mesh-figures button");
  await textMatches(page, "aside", /neighbours/i);
  await until("the mesh is drawn", () => areDrawn(page, 1, 2));
  await looksLike(page, "worst", { varies: [".figures dd:last-child"] });
});
