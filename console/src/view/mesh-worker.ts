// SPDX-License-Identifier: Apache-2.0
// Reads one mesh from the server, turns its chunks into pictures, and answers questions about it. It
// reads ahead of the page by a few chunks at most: if the page is slow, so is the stream, and then
// the engine.
import { fromBinary, toBinary, type DescMessage, type DescMethodServerStreaming } from "@bufbuild/protobuf";
import { Code, ConnectError, createClient } from "@connectrpc/connect";
import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { PackedResponseSchema, type PackedChunk } from "../gen/console/packed_pb";
import { JobService } from "../gen/weft/v1/job_service_pb";
import { GenerateMeshRequestSchema, MeshService, SummarySchema } from "../gen/weft/v1/mesh_service_pb";
import { Counter } from "./census";
import type { FromWorker, ToWorker } from "./messages";
import { unpackChunk, type MeshChunk } from "./packed";
import { linesOf, pictureOf, RegionSlots, type ChunkPicture } from "./picture";
import { mostPoints, sampleSize } from "./sampled-size";
import { MeshStore } from "./store";

const mostUndrawn = 8;
const censusEvery = 300; // milliseconds

const store = new MeshStore();
const slots = new RegionSlots();
const counter = new Counter();
const stop = new AbortController();
let undrawn = 0;
const untilDrawn: (() => void)[] = [];
let chunks = 0;
let lastCensus = 0;
let wish = 0; // what pictures are for
let started: { request: Uint8Array | string; token: string } | undefined;
const bounds = new Map<number, ArrayLike<number>>(); // on areas, of chunks that were asked for, by their numbers

const say = (message: FromWorker, transfer: Transferable[] = []) => postMessage(message, { transfer });

function sayCensus(): void {
  lastCensus = performance.now();
  say({ type: "census", census: counter.census(), chunks, vertices: store.vertices, triangles: store.triangles });
}

function sayPicture(message: FromWorker & { picture: ChunkPicture }): void {
  ++undrawn;
  const { positions, values, indices, grid, thumbnail } = message.picture;
  say(message, [positions, values, indices, grid, thumbnail].map(({ buffer }) => buffer));
}

async function room(): Promise<void> {
  while (undrawn >= mostUndrawn) await new Promise<void>((resolve) => untilDrawn.push(resolve));
}

const callOptions = (token: string) => ({ headers: token ? { authorization: `Bearer ${token}` } : undefined });
const transport = createGrpcWebTransport({ baseUrl: self.location.origin });

// Has the bounds of as many of these chunks as a request may ask for. Returns whether the server tells.
async function ask(chunks: MeshChunk[]): Promise<boolean> {
  const { request, token } = started!;
  const { coordinates } = store;
  const points: number[] = [];
  const asked: MeshChunk[] = [];
  for (const chunk of chunks) {
    if (asked.length > 0 && points.length / 2 + chunk.triangles.length / 3 > mostPoints) break;
    asked.push(chunk);
    for (let t = 0; t < chunk.triangles.length; t += 3)
      for (const d of [0, 1])
        points.push([0, 1, 2].reduce((sum, i) => sum + coordinates[2 * chunk.triangles[t + i] + d], 0) / 3);
  }
  const own = fromBinary(GenerateMeshRequestSchema, request as Uint8Array);
  const told = await sampleSize(createClient(MeshService, transport), own, points, callOptions(token)).catch(() => undefined);
  if (!told) return false;
  let first = 0;
  for (const { index, triangles } of asked) {
    const count = triangles.length / 3;
    bounds.set(index, told.bounds.slice(first, first + count));
    first += count;
  }
  return true;
}

// NaN where they are not known.
const boundsOf = ({ index, triangles }: MeshChunk) =>
  bounds.get(index) ?? new Float32Array(triangles.length / 3).fill(NaN);

async function sayPicturesAgain(over: boolean): Promise<void> {
  const own = wish;
  const chunks = [...store.chunks()];
  let told = over;
  for (const [i, chunk] of chunks.entries()) {
    await room();
    if (told && !bounds.has(chunk.index)) told = await ask(chunks.slice(i));
    if (own !== wish) return; // they are wanted otherwise now
    const picture = pictureOf(chunk, store.coordinates, slots, () => {}, over ? boundsOf(chunk) : undefined);
    if (picture) sayPicture({ type: "again", wish, picture });
  }
}

function take(packed: PackedChunk): void {
  const chunk = unpackChunk(packed, store.vertices);
  store.add(chunk);
  ++chunks;
  const picture = pictureOf(chunk, store.coordinates, slots, (triangle, area, minAngle) =>
    counter.add(area, minAngle, () => {
      let x = 0, y = 0;
      for (let i = 0; i < 3; ++i) {
        x += store.coordinates[2 * chunk.triangles[3 * triangle + i]] / 3;
        y += store.coordinates[2 * chunk.triangles[3 * triangle + i] + 1] / 3;
      }
      return { triangle: chunk.firstTriangle + triangle, chunk: chunk.index, x, y };
    }),
  );
  if (picture) {
    store.keep(chunk, picture.box);
    const { vertices, triangles } = store;
    sayPicture({ type: "chunk", wish, picture, vertices, triangles, regions: [...slots.ids] });
  }
  if (performance.now() - lastCensus > censusEvery) sayCensus();
}

// The method of a service, with its answers read as PackedResponse.
function packed<I extends DescMessage, O extends DescMessage>(method: DescMethodServerStreaming<I, O>) {
  return { ...method, output: PackedResponseSchema };
}

async function read(request: Uint8Array | string, token: string): Promise<void> {
  const method = {
    generateMesh: packed(MeshService.method.generateMesh),
    fetchMesh: packed(JobService.method.fetchMesh),
  };
  const service = { ...MeshService, method, methods: Object.values(method) };
  const client = createClient(service, transport);
  const options = { signal: stop.signal, ...callOptions(token) };
  const stream =
    typeof request === "string"
      ? client.fetchMesh({ id: request }, options)
      : client.generateMesh(fromBinary(GenerateMeshRequestSchema, request), options);
  let summary: Uint8Array | undefined;
  for await (const { message } of stream) {
    switch (message.case) {
      case "accepted": {
        const { jobId, engineVersion, threads } = message.value;
        say({ type: "accepted", jobId, engineVersion, threads });
        break;
      }
      case "progress": {
        const { stage, triangles, expectedTriangles, elapsedSeconds, fraction } = message.value;
        say({
          type: "progress",
          stage,
          triangles: Number(triangles),
          expected: Number(expectedTriangles),
          seconds: elapsedSeconds,
          fraction,
        });
        break;
      }
      case "chunk":
        take(message.value);
        await room();
        break;
      case "summary":
        summary = toBinary(SummarySchema, message.value);
    }
  }
  if (!summary) throw new ConnectError("The stream ended before its summary: this is not a mesh.", Code.DataLoss);
  sayCensus();
  say({ type: "summary", summary });
}

onmessage = ({ data }: MessageEvent<ToWorker>) => {
  switch (data.type) {
    case "start":
      started = data;
      read(data.request, data.token).catch((error: unknown) => {
        sayCensus();
        const { code, rawMessage, details } = ConnectError.from(error);
        const typed = details.flatMap((detail) => ("value" in detail && "type" in detail ? [detail] : []));
        say({
          type: "failed",
          code,
          message: rawMessage,
          details: typed.map(({ type, value }) => ({ type: String(type), value: value as Uint8Array })),
        });
      });
      break;
    case "cancel":
      stop.abort();
      break;
    case "drawn":
      --undrawn;
      untilDrawn.shift()?.();
      break;
    case "lines": {
      const chunk = store.chunk(data.chunk);
      if (!chunk) break;
      const { lines, inside } = linesOf(chunk);
      say({ type: "lines", chunk: data.chunk, lines, inside }, [lines.buffer]);
      break;
    }
    case "pictures":
      wish = data.wish;
      void sayPicturesAgain(data.over);
      break;
    case "pick":
      say({ type: "picked", picked: store.pick(data.x, data.y) });
      break;
    case "find":
      say({ type: "found", picked: store.find(data.triangle) });
  }
};
