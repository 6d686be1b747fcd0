// SPDX-License-Identifier: Apache-2.0
// What the page and its mesh worker say to each other.
import type { Census } from "./census";
import type { ChunkPicture } from "./picture";
import type { PickedTriangle } from "./store";

export type ToWorker =
  // `request`: a GenerateMeshRequest in bytes, or the id of a job. Once per worker, first.
  | { type: "start"; request: Uint8Array | string; token: string }
  | { type: "cancel" }
  // The page has taken a chunk in, and wants another.
  | { type: "drawn" }
  | { type: "lines"; chunk: number }
  // The page wants all chunks again, because it has lost them, or because they are to show areas over
  // their bounds, or areas alone. Pictures carry the number of the wish that they are for; the first is 0.
  | { type: "pictures"; wish: number; over: boolean }
  | { type: "pick"; x: number; y: number }
  | { type: "find"; triangle: number };

export type FromWorker =
  | { type: "accepted"; jobId: string; engineVersion: string; threads: number }
  | { type: "progress"; stage: number; triangles: number; expected: number; seconds: number; fraction: number }
  | { type: "chunk"; wish: number; picture: ChunkPicture; vertices: number; triangles: number; regions: number[] }
  | { type: "again"; wish: number; picture: ChunkPicture }
  | { type: "census"; census: Census; chunks: number; vertices: number; triangles: number }
  | { type: "summary"; summary: Uint8Array } // a weft.v1.Summary
  | { type: "failed"; code: number; message: string; details: { type: string; value: Uint8Array }[] }
  | { type: "lines"; chunk: number; lines: Uint32Array; inside: number }
  | { type: "picked"; picked: PickedTriangle | undefined }
  | { type: "found"; picked: PickedTriangle | undefined };
