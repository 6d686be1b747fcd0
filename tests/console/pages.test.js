// SPDX-License-Identifier: Apache-2.0
// The pages of jobs, meshes and the server, in a real browser against a real weftd.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { basename, join } from "node:path";
import { after, before, test } from "node:test";
import { areDrawn, downloaded, openBrowser, openPage, press, textMatches } from "./browser.js";
import { looksLike } from "./pictures.js";
import { atEnd, folderFor, models, until, Weftd } from "./weftd.js";

const key = join(models, "key.poly");
const cylinder = join(models, "cylinder.poly");
const keySize = ["--size", "0.02*abs(y-46)+0.1"]; // 5,324 triangles
const longSize = ["--size", "1e-5"]; // minutes

let browser;
before(async () => (browser = await openBrowser()));
after(() => browser.close());

// What a browser logs of a server that is away.
const away = [/Failed to load resource: net::/];

async function serverWithJobs(t, args = []) {
  const server = await Weftd.start({ args: ["--data", await folderFor(t), ...args] });
  atEnd(t, () => server.stop());
  return server;
}

// A job that has ended, as `weft get --json` shows it.
async function ended(server, ...args) {
  const id = await server.weft("submit", ...args);
  await server.weft("watch", id).catch(() => {}); // it fails if the job does
  return JSON.parse(await server.weft("get", id, "--json"));
}

test("jobs are listed with what became of them, and filtered by it", async (t) => {
  const server = await serverWithJobs(t);
  const made = await ended(server, key, ...keySize, "--request-id", "key, fine");
  await ended(server, key, "--size", "1", "--request-id", "key, coarse");
  const failed = await ended(server, key, "--size", "x-1000", "--request-id", "key, wrong");
  assert.equal(failed.state, "failed");
  const page = await openPage(t, browser, `${server.url}/jobs`);
  await textMatches(page, "tbody tr", new RegExp(`succeeded\\s+${made.id}[^]*5,324`));
  await textMatches(page, "tbody tr", new RegExp(`failed\\s+${failed.id}[^]*${failed.error.reason}`));
  const long = await server.weft("submit", cylinder, ...longSize, "--request-id", "flow around a cylinder");
  await textMatches(page, "tbody tr", new RegExp(`running\\s+${long}[^]*refining, .* left`));
  await looksLike(page, "jobs", { varies: ["progress"] });
  await server.weft("cancel", long);

  await press(page, "Failed");
  await page.waitForFunction(() => document.querySelectorAll("tbody tr").length === 1);
  await textMatches(page, "tbody tr", new RegExp(failed.id));
});

test("a job at work shows its progress, and is cancelled and deleted by keyboard alone", async (t) => {
  const server = await serverWithJobs(t);
  const id = await server.weft("submit", cylinder, ...longSize);
  const page = await openPage(t, browser, `${server.url}/jobs`);
  await textMatches(page, "tbody tr", /running[^]*\d %/, { timeout: 60_000 });
  const values = new Set();
  await until("the bar moves", async () => {
    values.add(await page.$eval("progress", (bar) => bar.value).catch(() => 0));
    return values.size > 2;
  });

  // From the top of the page to the button, by Tab alone.
  const focused = () => page.evaluate(() => document.activeElement.innerText ?? "");
  for (let i = 0; (await focused()) !== "Cancel"; ++i) {
    assert.ok(i < 40, "Tab never reached Cancel");
    await page.keyboard.press("Tab");
  }
  await page.keyboard.press("Enter");
  assert.equal(await focused(), "Cancel?");
  await page.keyboard.press("Enter");
  await textMatches(page, "tbody tr", new RegExp(`cancelled\\s+${id}`));

  for (let i = 0; (await focused()) !== "Delete"; ++i) {
    assert.ok(i < 40, "Tab never reached Delete");
    await page.keyboard.press("Tab");
  }
  await page.keyboard.press("Enter");
  await page.keyboard.press("Enter");
  await textMatches(page, "main", /No jobs yet/);
});

test("many jobs have pages", async (t) => {
  const server = await serverWithJobs(t);
  const ids = [];
  for (let i = 0; i < 27; ++i) ids.push(await server.weft("submit", key, "--size", "1"));
  const page = await openPage(t, browser, `${server.url}/jobs`);
  await textMatches(page, "tbody", new RegExp(ids.at(-1)));
  assert.equal((await page.$$("tbody tr")).length, 25);
  await press(page, "Older");
  await textMatches(page, "tbody", new RegExp(ids[0]));
  assert.equal((await page.$$("tbody tr")).length, 2);
  await press(page, "Younger");
  await textMatches(page, "tbody", new RegExp(ids.at(-1)));
});

test("a job's page outlives a killed server, and is the same after a reload", async (t) => {
  const folder = await folderFor(t);
  const first = await Weftd.start({ args: ["--data", folder] });
  const { id, summary } = await ended(first, key, ...keySize);
  const page = await openPage(t, browser, `${first.url}/job/${id}`, { expected: away });
  await textMatches(page, "main", /succeeded/);
  await page.goto(`${first.url}/jobs`);
  await textMatches(page, "tbody", new RegExp(id));

  await first.kill();
  await textMatches(page, ".banner", /does not answer/);
  await textMatches(page, "tbody", new RegExp(id)); // what it said last is still there
  const second = await Weftd.start({ args: ["--data", folder], console: first.console });
  atEnd(t, () => second.stop());
  await page.waitForFunction(() => document.querySelector(".banner") === null);
  await second.weft("submit", key, "--size", "1", "--request-id", "after the restart");
  await textMatches(page, "tbody", /after the restart/);

  await page.goto(`${second.url}/job/${id}`);
  await page.reload();
  await textMatches(page, "main", /succeeded[^]*5,324/);
  await textMatches(page, "main", /0\.02\*abs\(y-46\)\+0\.1/); // the request is kept, too
  const link = await page.$eval('main a[href^="/mesh/"]', (a) => a.getAttribute("href"));
  assert.equal(link, `/mesh/${summary.digest}`);
  await looksLike(page, "job");
});

test("a job that failed says why, and which field is at fault", async (t) => {
  const server = await serverWithJobs(t);
  const { id, error } = await ended(server, key, "--size", "x-1000");
  const page = await openPage(t, browser, `${server.url}/job/${id}`);
  await textMatches(page, "main [role=alert]", new RegExp(error.reason));
  await textMatches(page, "main [role=alert]", /size/);
});

test("a job that never was is not found", async (t) => {
  const server = await serverWithJobs(t);
  const page = await openPage(t, browser, `${server.url}/job/01ARZ3NDEKTSV4RRFFQ69G5FAV`);
  await textMatches(page, "main", /no job/i);
});

test("a mesh's page draws it, tells its figures and its request", async (t) => {
  const server = await serverWithJobs(t);
  const { summary } = await ended(server, key, ...keySize, "--min-angle", "25");
  const page = await openPage(t, browser, `${server.url}/mesh/${summary.digest}`);
  await textMatches(page, "aside", new RegExp(summary.triangles.toLocaleString("en-US")));
  await textMatches(page, "aside", /0\.02\*abs\(y-46\)\+0\.1[^]*min_angle_deg\s+25/);
  await until("the mesh is drawn", () => areDrawn(page, 1));
  await looksLike(page, "mesh");
});

test("a digest that nobody keeps is said to be so", async (t) => {
  const server = await serverWithJobs(t);
  const page = await openPage(t, browser, `${server.url}/mesh/${"0".repeat(64)}`);
  await textMatches(page, "main", /No job of yours keeps this mesh/);
});

const names = ['marker=2:the "bow" & <hole>', "marker=3:marker 7", "region=0:brass, old"];

for (const format of ["vtu", "msh", "npz", "inp", "stl"])
  test(`a mesh is downloaded as .${format}, as weft fetch writes it`, async (t) => {
    const server = await serverWithJobs(t);
    const { id, summary } = await ended(server, key, ...keySize, ...names.flatMap((name) => ["--names", name]));
    const page = await openPage(t, browser, `${server.url}/mesh/${summary.digest}`);
    const file = await downloaded(t, page, format);
    assert.equal(basename(file), `${summary.digest.slice(0, 12)}.${format}`);
    const fetched = join(await folderFor(t), `fetched.${format}`);
    await server.weft("fetch", id, "-o", fetched);
    assert.deepEqual(await readFile(file), await readFile(fetched));
    await textMatches(page, ".downloads", /[\d,]+ triangles written/);
    if (format === "stl") await textMatches(page, ".downloads", /names/); // which it does not carry
  });

test("two meshes stand side by side with what differs", async (t) => {
  const server = await serverWithJobs(t);
  const a = await ended(server, key, ...keySize);
  const b = await ended(server, key, ...keySize, "--min-angle", "30");
  const page = await openPage(t, browser, `${server.url}/jobs`);
  await textMatches(page, "tbody", new RegExp(a.id));
  for (const { id } of [a, b]) await page.click(`aria/Compare the mesh of ${id}`);
  await page.locator("a ::-p-text(Compare two meshes)").click();
  await textMatches(page, "main table", /min_angle_deg\s+default\s+30/);
  await textMatches(
    page,
    "main table",
    new RegExp(`Triangles\\s+5,324\\s+${b.summary.triangles.toLocaleString("en-US")}`),
  );
  await until("both are drawn", () => areDrawn(page, 2));
  await looksLike(page, "compare");
});

test("the server's page shows what it works on", async (t) => {
  const server = await serverWithJobs(t);
  const page = await openPage(t, browser, `${server.url}/server`, { dark: true });
  for (const size of ["3e-3", "1e-3", "6e-4", "2e-3", "8e-4"]) await ended(server, cylinder, "--size", size);
  const id = await server.weft("submit", cylinder, ...longSize);
  await textMatches(page, "main dl", /Meshes at work\s+1 of/);
  await textMatches(page, "main dl", /Triangles made\s+[1-9][\d,]+/);
  await textMatches(page, "main figure", /Triangles a second\s+now [1-9][\d,]+/);
  await page.waitForFunction(() => document.querySelector("main svg polyline")?.points.numberOfItems >= 5);
  await looksLike(page, "server", { varies: [".facts dd", ".page-head"] });
  await server.weft("cancel", id);
  await textMatches(page, "main dl", /Meshes at work\s+0 of/);
});

test("a token is asked for, refused if it is wrong, and kept over a reload", async (t) => {
  const folder = await folderFor(t);
  const tokens = join(folder, "tokens");
  await writeFile(tokens, "ada 4f8a1c9d2b7e6f30\n", { mode: 0o600 });
  const server = await serverWithJobs(t, ["--tokens", tokens]);
  const page = await openPage(t, browser, `${server.url}/jobs`, { expected: [/status of 401/] });
  const enter = async (token) => {
    await page.waitForSelector("#token");
    await page.type("#token", token);
    await page.keyboard.press("Enter");
  };
  await textMatches(page, ".token", /The server needs a token/);
  await enter("wrong");
  await textMatches(page, ".token", /Token refused/);
  await enter("4f8a1c9d2b7e6f30");
  await textMatches(page, "main", /No jobs yet/);
  await page.waitForSelector("#token", { hidden: true });
  await page.goto(`${server.url}/server`);
  await page.waitForSelector(".tiles");
  assert.equal(await page.$("#token"), null);
});

test("a mesh's link is for those with a token of its client's name, and for nobody else", async (t) => {
  const tokens = join(await folderFor(t), "tokens");
  const of = { first: "ada-4f8a1c9d2b7e6f30", second: "ada-77c01be9a3d45f21", other: "bob-0a5be81f66d3c942" };
  await writeFile(tokens, `ada ${of.first}\nada ${of.second}\nbob ${of.other}\n`, { mode: 0o600 });
  const server = await serverWithJobs(t, ["--tokens", tokens]);
  const folder = await folderFor(t);
  const token = join(folder, "token");
  await writeFile(token, of.first, { mode: 0o600 });
  const asAda = (...args) => server.weft(...args, "--token-file", token);
  const id = await asAda("submit", key, ...keySize);
  await asAda("watch", id);
  const { summary } = JSON.parse(await asAda("get", id, "--json"));
  const open = (path, token) => openPage(t, browser, server.url + path, { token });

  const colleague = await open(`/mesh/${summary.digest}`, of.second);
  await until("the mesh is drawn", () => areDrawn(colleague, 1));
  const stranger = await open(`/mesh/${summary.digest}`, of.other);
  await textMatches(stranger, "main", /No job of yours keeps this mesh/);
  const list = await open("/jobs", of.second);
  await textMatches(list, "thead", /Triangles\s+Client\s+Attempts/);
  await textMatches(list, "tbody tr", new RegExp(`${id}[^]*\\sada\\s+1\\s`));
  await textMatches(await open(`/job/${id}`, of.second), "dl", /Client\s+ada/);
  await textMatches(await open("/jobs", of.other), "main", /No jobs yet/);
});

test("without --data the pages of jobs say so", async (t) => {
  const server = await Weftd.start();
  atEnd(t, () => server.stop());
  const page = await openPage(t, browser, `${server.url}/jobs`);
  await textMatches(page, "main", /keeps no jobs/);
});
