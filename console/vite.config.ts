// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vitest/config";

// `npm run dev` asks a weftd for everything but the page itself.
const server = process.env.WEFT_CONSOLE_URL ?? "http://127.0.0.1:8080";
const proxied = Object.fromEntries(
  ["/weft.v1.", "/metrics"].map((path) => [path, { target: server, changeOrigin: true }]),
);

export default defineConfig({
  esbuild: { jsx: "automatic", jsxImportSource: "preact" },
  build: { target: "es2022", assetsInlineLimit: 0, emptyOutDir: true, modulePreload: { polyfill: false } },
  worker: { format: "es" },
  server: { proxy: proxied },
  test: { include: ["test/**/*.test.ts"], testTimeout: 60_000 }, // for machines under load
});
