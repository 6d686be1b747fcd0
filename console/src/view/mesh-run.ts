// SPDX-License-Identifier: Apache-2.0
// A mesh that comes from the server, from any stream of chunks, with what the page knows of it so far.
//
//   const run = useMeshRun();                   // closed when the component goes
//   run.start({ kind: "job", id });             // or { kind: "mesh", request }
//   const state = useRunState(run);
//   <MeshView run={run} /> <MeshFigures run={run} />
//   run.cancel();
import { create, fromBinary, toBinary, type MessageInitShape } from "@bufbuild/protobuf";
import { Code, ConnectError } from "@connectrpc/connect";
import { useEffect, useState } from "preact/hooks";
import { noteFailure } from "../client";
import { GenerateMeshRequestSchema, SummarySchema, type Summary } from "../gen/weft/v1/mesh_service_pb";
import { currentSession } from "../session";
import type { Census } from "./census";
import type { FromWorker, ToWorker } from "./messages";
import type { Box, ChunkPicture } from "./picture";
import type { PickedTriangle } from "./store";

export type MeshRequestInit = MessageInitShape<typeof GenerateMeshRequestSchema>;
export type MeshSource = { kind: "mesh"; request: MeshRequestInit } | { kind: "job"; id: string };

export interface RunState {
  phase: "idle" | "running" | "done" | "failed" | "cancelled";
  started: number; // performance.now()
  ended: number | undefined;
  jobId: string; // names the call in the server's log
  chunks: number;
  vertices: number; // that have come
  triangles: number;
  progress: { stage: number; triangles: number; expected: number; seconds: number; fraction: number } | undefined;
  regions: number[]; // ids, by slot
  box: Box | undefined; // of the triangles so far
  census: Census | undefined;
  summary: Summary | undefined;
  error: ConnectError | undefined;
  picked: PickedTriangle | undefined;
  found: number; // times that find() had an answer: the view moves to it
  firstTriangles: number | undefined; // milliseconds from the start until some were drawn
}

// Draws what comes; the view.
export interface RunPainter {
  reset(): void;
  // Takes the arrays.
  chunk(picture: ChunkPicture): void;
  // A chunk that came before, for wantPictures().
  again(picture: ChunkPicture): void;
  lines(chunk: number, lines: Uint32Array, inside: number): void;
}

const idle: RunState = {
  phase: "idle", started: 0, ended: undefined, jobId: "", chunks: 0, vertices: 0, triangles: 0,
  progress: undefined, regions: [0], box: undefined, census: undefined, summary: undefined,
  error: undefined, picked: undefined, found: 0, firstTriangles: undefined,
};

export class MeshRun {
  state = idle;
  private painter: RunPainter | undefined;
  private worker: Worker | undefined;
  private readonly listeners = new Set<() => void>();
  private telling = false;
  private wish = 0; // that pictures are for; others are late

  // Forgets the mesh before.
  start(source: MeshSource): void {
    this.close();
    this.state = { ...idle, phase: "running", started: performance.now() };
    const worker = new Worker(new URL("./mesh-worker.ts", import.meta.url), { type: "module" });
    this.worker = worker;
    this.wish = 0;
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.hear(data);
    // Without a message the worker's file did not come.
    worker.onerror = ({ message }) =>
      this.fail(message ? new ConnectError(message, Code.Internal) : new ConnectError("failed to fetch", Code.Unavailable));
    const request =
      source.kind === "job"
        ? source.id
        : toBinary(GenerateMeshRequestSchema, create(GenerateMeshRequestSchema, source.request));
    this.say({ type: "start", request, token: currentSession().token });
    this.painter?.reset();
    this.tell();
  }

  // Ends the stream, and with it the server's work; what has come stays.
  cancel(): void {
    if (this.state.phase !== "running") return;
    this.say({ type: "cancel" });
    this.change({ phase: "cancelled", ended: performance.now() });
  }

  // Cancels, and frees the memory.
  close(): void {
    this.cancel();
    this.worker?.terminate();
    this.worker = undefined;
    this.state = idle;
    this.tell();
  }

  // Makes the triangle at a point state.picked; undefined if there is none.
  pick(x: number, y: number): void {
    this.say({ type: "pick", x, y });
  }

  unpick(): void {
    this.change({ picked: undefined });
  }

  // Makes the triangle of a number state.picked; the view moves to it.
  find(triangle: number): void {
    this.say({ type: "find", triangle });
  }

  // The painter is told of them later.
  wantLines(chunk: number): void {
    this.say({ type: "lines", chunk });
  }

  // The painter is given all chunks again, one after the other, with areas over their bounds or with areas
  // alone. It has forgotten those from before. REQUIRES with `over`: the run has ended, and no job began it.
  wantPictures(over: boolean): void {
    this.say({ type: "pictures", wish: ++this.wish, over });
  }

  // The painter calls it after each frame with triangles.
  painted(): void {
    if (this.state.phase === "idle" || this.state.firstTriangles !== undefined) return;
    this.change({ firstTriangles: performance.now() - this.state.started });
  }

  // One painter, before the first chunk: pictures are not kept.
  attach(painter: RunPainter): () => void {
    this.painter = painter;
    return () => {
      if (this.painter === painter) this.painter = undefined;
    };
  }

  listen(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => void this.listeners.delete(listener);
  }

  private say(message: ToWorker): void {
    this.worker?.postMessage(message);
  }

  private hear(message: FromWorker): void {
    switch (message.type) {
      case "accepted":
        this.change({ jobId: message.jobId });
        break;
      case "progress":
        this.change({ progress: message });
        break;
      case "chunk": {
        const { picture, vertices, triangles, regions } = message;
        const { box } = this.state;
        const more = picture.box;
        this.change({
          vertices,
          triangles,
          regions,
          chunks: this.state.chunks + 1,
          box: box
            ? [
                Math.min(box[0], more[0]), Math.min(box[1], more[1]),
                Math.max(box[2], more[2]), Math.max(box[3], more[3]),
              ]
            : more,
        });
        if (message.wish === this.wish) this.painter?.chunk(picture);
        this.say({ type: "drawn" });
        break;
      }
      case "again":
        if (message.wish === this.wish) this.painter?.again(message.picture);
        this.say({ type: "drawn" });
        break;
      case "census": {
        const { census, chunks, vertices, triangles } = message;
        this.change({ census, chunks, vertices, triangles });
        break;
      }
      case "summary":
        this.change({
          phase: "done",
          ended: performance.now(),
          summary: fromBinary(SummarySchema, message.summary),
        });
        break;
      case "failed": {
        if (this.state.phase === "cancelled") break;
        const error = new ConnectError(message.message, message.code);
        error.details = message.details;
        this.fail(error);
        break;
      }
      case "lines":
        this.painter?.lines(message.chunk, message.lines, message.inside);
        break;
      case "picked":
        this.change({ picked: message.picked });
        break;
      case "found":
        this.change({ picked: message.picked, found: this.state.found + 1 });
    }
  }

  private fail(error: ConnectError): void {
    noteFailure(error);
    this.change({ phase: "failed", ended: performance.now(), error });
  }

  private change(change: Partial<RunState>): void {
    this.state = { ...this.state, ...change };
    this.tell();
  }

  // Once a frame at most.
  private tell(): void {
    if (this.telling) return;
    this.telling = true;
    requestAnimationFrame(() => {
      this.telling = false;
      for (const listener of this.listeners) listener();
    });
  }
}

export function useMeshRun(): MeshRun {
  const [run] = useState(() => new MeshRun());
  useEffect(() => () => run.close(), [run]);
  return run;
}

export function useRunState(run: MeshRun): RunState {
  const [state, setState] = useState(run.state);
  useEffect(() => {
    setState(run.state);
    return run.listen(() => setState(run.state));
  }, [run]);
  return state;
}
