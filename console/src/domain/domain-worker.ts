// SPDX-License-Identifier: Apache-2.0
// Reads one file, beside the page.
import { FileError } from "./file-error";
import type { PlanarDomain } from "./planar-domain";
import { readDomain } from "./read-domain";
import { decodeText } from "./text";

export type FileAnswer = { domain: PlanarDomain } | { problem: string };

async function answer(file: File): Promise<FileAnswer> {
  try {
    return { domain: readDomain(file.name, decodeText(await file.arrayBuffer())) };
  } catch (error) {
    const why = error instanceof FileError ? error.message : `it cannot be read: ${String(error)}`;
    return { problem: `${file.name}: ${why}` };
  }
}

onmessage = async ({ data }: MessageEvent<File>) => postMessage(await answer(data));
