// SPDX-License-Identifier: Apache-2.0
import { create, fromBinary, toBinary } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { PackedResponseSchema, type PackedChunk } from "../src/gen/console/packed_pb";
import { GenerateMeshResponseSchema, type Chunk } from "../src/gen/weft/v1/mesh_service_pb";
import { unpackChunk } from "../src/view/packed";

// The chunk as the console reads it from the bytes that a server sends.
function packed(chunk: Partial<Omit<Chunk, "$typeName" | "$unknown">>): PackedChunk {
  const sent = create(GenerateMeshResponseSchema, { message: { case: "chunk", value: chunk } });
  const { message } = fromBinary(PackedResponseSchema, toBinary(GenerateMeshResponseSchema, sent));
  if (message.case !== "chunk") throw new Error(`a ${message.case} instead of a chunk`);
  return message.value;
}

const square = {
  index: 3,
  firstVertex: 2,
  firstTriangle: 7,
  coordinates: [0, 0.1, 1e-300, -1e50],
  triangles: [0, 1, 2, 3, 2, 1],
  regions: [-5, 2 ** 31 - 1],
  edges: [1, 2],
};

test("the arrays of a chunk are those that were sent, bit by bit", () => {
  const chunk = unpackChunk(packed(square), 2);
  expect(chunk).toMatchObject({ index: 3, firstVertex: 2, firstTriangle: 7 });
  expect([...chunk.coordinates]).toEqual(square.coordinates);
  expect([...chunk.triangles]).toEqual(square.triangles);
  expect([...chunk.regions]).toEqual(square.regions);
  expect([...chunk.edges]).toEqual(square.edges);
});

test("a chunk that is out of turn, or refers to vertices that have not come, is refused", () => {
  expect(() => unpackChunk(packed(square), 5)).toThrow("begins at vertex 2 instead of 5");
  expect(() => unpackChunk(packed(square), 1)).toThrow("begins at vertex 2 instead of 1");
  expect(() => unpackChunk(packed({ ...square, triangles: [0, 1, 4] }), 2)).toThrow("refers to vertex 4 of 4");
  expect(() => unpackChunk(packed({ ...square, edges: [9, 0] }), 2)).toThrow("refers to vertex 9 of 4");
});

test("arrays that are not whole are refused", () => {
  expect(() => unpackChunk(packed({ ...square, coordinates: [1, 2, 3] }), 2)).toThrow("coordinates end within a number");
  expect(() => unpackChunk(packed({ ...square, regions: [1] }), 2)).toThrow("has 1 regions");
});
