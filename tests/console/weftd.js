// SPDX-License-Identifier: Apache-2.0
// A weftd with a console, for a test.
//
//   const server = await Weftd.start({ args: ["--data", folder] });
//   await fetch(server.url);
//   await server.stop();
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as pause } from "node:timers/promises";

export const programs = process.env.WEFT_PROGRAMS ?? new URL("../../build/release", import.meta.url).pathname;

export const models = new URL("../models", import.meta.url).pathname;

const ends = new WeakMap();

// Calls `end` after the test; the last given first, so that a page closes before its server.
export function atEnd(test, end) {
  const known = ends.get(test);
  if (known) return void known.push(end);
  const list = [end];
  ends.set(test, list);
  test.after(async () => {
    const problems = [];
    for (const each of list.reverse()) await Promise.resolve(each()).catch((error) => problems.push(error));
    if (problems.length > 0) throw problems[0];
  });
}

// A folder that is gone when the test is over.
export async function folderFor(test) {
  const folder = await mkdtemp(join(tmpdir(), "weft-console-"));
  atEnd(test, () => rm(folder, { recursive: true, force: true }));
  return folder;
}

// Throws with the last that `look` returned if it is not true in time.
export async function until(what, look, seconds = 180) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const seen = await look();
    if (seen) return seen;
    if (Date.now() > end) throw new Error(`not within ${seconds} s: ${what}`);
    await pause(50);
  }
}

export class Weftd {
  // `console` is HOST:PORT of the console. The server is ready when this returns.
  static async start({ args = [], console: address = "127.0.0.1:0", env = {} } = {}) {
    const folder = await mkdtemp(join(tmpdir(), "weftd-"));
    const addresses = join(folder, "addresses");
    const child = spawn(
      join(programs, "weftd"),
      ["--listen", "127.0.0.1:0", "--console", address, "--port-file", addresses, ...args],
      { stdio: ["ignore", "ignore", "pipe"], env: { ...process.env, ...env } },
    );
    const server = new Weftd(child, folder);
    child.stderr.on("data", (bytes) => (server.log += bytes));
    await until("weftd listens", async () => {
      if (child.exitCode !== null) throw new Error(`weftd ended: ${server.log}`);
      const lines = await readFile(addresses, "utf8").catch(() => "");
      server.console = /^console=(.+)$/m.exec(lines)?.[1];
      server.grpc = /^[^=\n]+$/m.exec(lines)?.[0];
      return server.console;
    });
    return server;
  }

  constructor(child, folder) {
    this.child = child;
    this.folder = folder;
    this.log = "";
    this.ended = new Promise((resolve) => child.once("exit", (code, signal) => resolve(code ?? signal)));
  }

  get url() {
    return `http://${this.console}`;
  }

  // SIGKILL by default: what a console must survive.
  async kill(signal = "SIGKILL") {
    this.child.kill(signal);
    const outcome = await this.ended;
    await rm(this.folder, { recursive: true, force: true });
    return outcome;
  }

  // Fails if the server does not end by itself, without an error.
  async stop() {
    const outcome = await this.kill("SIGTERM");
    if (outcome !== 0) throw new Error(`weftd ended with ${outcome}: ${this.log}`);
  }

  // Runs `weft` against this server.
  weft(...args) {
    return weft(args, { WEFT_SERVER: this.grpc });
  }
}

// Runs `weft`, and returns what it printed; fails if it does.
export async function weft(args, env = {}) {
  const child = spawn(join(programs, "weft"), args, {
    stdio: ["ignore", "pipe", "pipe"],
    env: { ...process.env, ...env },
  });
  let out = "";
  let problems = "";
  child.stdout.on("data", (bytes) => (out += bytes));
  child.stderr.on("data", (bytes) => (problems += bytes));
  const code = await new Promise((resolve) => child.once("close", resolve));
  if (code !== 0) throw new Error(`weft ${args.join(" ")} ended with ${code}: ${problems}`);
  return out.trim();
}
