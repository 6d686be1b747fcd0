// SPDX-License-Identifier: Apache-2.0
// Generates src/gen from ../proto and proto, with the machine's protoc.
import { spawnSync } from "node:child_process";
import { mkdirSync, rmSync } from "node:fs";
import { fileURLToPath } from "node:url";

const here = fileURLToPath(new URL(".", import.meta.url));
const out = `${here}src/gen`;
rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
const files = ["weft/v1/mesh_service", "weft/v1/job_service", "google/rpc/status", "google/rpc/error_details", "console/packed"];
const { status, error } = spawnSync(
  "protoc",
  [
    `--plugin=protoc-gen-es=${here}node_modules/.bin/protoc-gen-es`,
    "-I",
    `${here}../proto`,
    "-I",
    `${here}proto`,
    `--es_out=${out}`,
    "--es_opt=target=ts",
    ...files.map((file) => `${file}.proto`),
  ],
  { stdio: "inherit" },
);
if (error) console.error(`protoc: ${error.message}`);
process.exit(status ?? 1);
