// SPDX-License-Identifier: Apache-2.0
import type { FileAnswer } from "./domain-worker";

// Reads a dropped or picked file in a worker of its own.
export function readFile(file: File): Promise<FileAnswer> {
  const worker = new Worker(new URL("./domain-worker.ts", import.meta.url), { type: "module" });
  return new Promise<FileAnswer>((resolve) => {
    worker.onmessage = ({ data }: MessageEvent<FileAnswer>) => resolve(data);
    worker.onerror = (event) => resolve({ problem: `${file.name}: ${event.message || "the server does not answer, and so its reader does not come"}` });
    worker.postMessage(file);
  }).finally(() => worker.terminate());
}
