// SPDX-License-Identifier: Apache-2.0
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { expect, test, vi } from "vitest";
import {
  GenerateMeshRequestSchema,
  GenerateMeshResponseSchema,
  Measure,
  type GenerateMeshRequest,
} from "../src/gen/weft/v1/mesh_service_pb";
import { gridOver, heatMapOf, middlesOf, sampleSize } from "../src/view/sampled-size";

// A server that answers with these messages, and what it was asked.
function serverOf(messages: MessageInitShape<typeof GenerateMeshResponseSchema>[]) {
  const asked: GenerateMeshRequest[] = [];
  const generateMesh = async function* (request: GenerateMeshRequest) {
    asked.push(request);
    for (const message of messages) yield create(GenerateMeshResponseSchema, message);
  };
  return { asked, client: { generateMesh } as unknown as Parameters<typeof sampleSize>[0] };
}

test("a request is asked for its size alone, and stays as it is", async () => {
  const request = create(GenerateMeshRequestSchema, { domain: { points: [0, 0] }, wantQuadtree: true });
  const { asked, client } = serverOf([
    { message: { case: "accepted", value: {} } },
    { message: { case: "summary", value: { sampledBounds: [0.5, NaN], expectedTriangles: 12n } } },
  ]);
  expect(await sampleSize(client, request, [1, 2, 3, 4], {})).toEqual({ bounds: [0.5, NaN], triangles: 12 });
  expect(asked[0]).toMatchObject({ samplePoints: [1, 2, 3, 4], wantQuadtree: false, domain: { points: [0, 0] } });
  expect(request).toMatchObject({ samplePoints: [], wantQuadtree: true });
});

test("a server that makes a mesh instead samples no sizes", async () => {
  const { client } = serverOf([{ message: { case: "summary", value: { triangles: 3n } } }]);
  expect(await sampleSize(client, create(GenerateMeshRequestSchema), [1, 2], {})).toBeUndefined();
});

test("the middles of cells lie in the box, the top row first", () => {
  expect(middlesOf({ box: [0, 0, 4, 2], columns: 2, rows: 2 })).toEqual([1, 1.5, 3, 1.5, 1, 0.5, 3, 0.5]);
  expect(gridOver([0, 0, 4, 2])).toMatchObject({ columns: 160, rows: 80 });
  expect(gridOver([0, 0, 0, 2])).toMatchObject({ columns: 1, rows: 160 });
  expect(gridOver([3, 3, 3, 3])).toMatchObject({ columns: 1, rows: 1 });
});

test("a heat map has the lengths of edges in the domain, and what is beside it at its rim", () => {
  vi.stubGlobal("ImageData", class {
    readonly data: Uint8ClampedArray;
    constructor(readonly width: number, readonly height: number) {
      this.data = new Uint8ClampedArray(4 * width * height);
    }
  });
  const grid = { box: [0, 0, 4, 1] as [number, number, number, number], columns: 4, rows: 1 };
  const area = (edge: number) => (Math.sqrt(3) / 4) * edge ** 2;
  const map = heatMapOf(grid, [area(1), area(3), NaN, NaN], Measure.EDGE)!;
  expect(map.low).toBeCloseTo(1, 12);
  expect(map.high).toBeCloseTo(3, 12);
  const pixel = (i: number) => [...map.pixels.data.slice(4 * i, 4 * i + 4)];
  expect(pixel(0)[3]).toBe(255);
  expect(pixel(1)).not.toEqual(pixel(0));
  expect(pixel(2)).toEqual(pixel(1)); // its middle is outside, but not all of it
  expect(pixel(3)).toEqual([0, 0, 0, 0]);
  expect(heatMapOf(grid, [2, 4, Infinity, NaN], Measure.AREA)).toMatchObject({ low: 2, high: 4 });
  const fallen = heatMapOf(grid, [0, 2, 4, 2], Measure.AREA)!; // the size alone is none at a place
  expect(fallen).toMatchObject({ low: 2, high: 4 });
  expect([...fallen.pixels.data.slice(0, 4)]).toEqual([...fallen.pixels.data.slice(4, 8)]);
  for (const even of [[2, 2, NaN, NaN], [Infinity, Infinity, NaN, NaN], [NaN, NaN, NaN, NaN]])
    expect(heatMapOf(grid, even, Measure.AREA)).toBeUndefined();
});
