// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import type { MeshChunk } from "../src/view/packed";
import { Grid, linesOf, pictureOf, RegionSlots } from "../src/view/picture";
import { MeshStore } from "../src/view/store";
import { thumbnailOf } from "../src/view/thumbnail";

// A unit square of two triangles with the same third vertex, of which the second has region 9.
const square: MeshChunk = {
  index: 0,
  firstVertex: 0,
  firstTriangle: 0,
  coordinates: Float64Array.from([0, 0, 1, 0, 1, 1, 0, 1]),
  triangles: Uint32Array.from([0, 1, 2, 3, 0, 2]),
  regions: Int32Array.from([0, 9]),
  edges: Uint32Array.from([0, 1, 1, 2, 2, 3, 3, 0]),
};

test("each triangle has a third vertex of its own, with its values", () => {
  const slots = new RegionSlots();
  const picture = pictureOf(square, square.coordinates, slots, () => undefined)!;
  const thirds = [2, 5].map((i) => picture.indices[i]);
  expect(new Set(thirds).size).toBe(2);
  expect(thirds.map((third) => slots.ids[picture.values[4 * third + 2]])).toEqual([0, 9]);
  // Positions are relative to the middle of the box, and turn as they did.
  for (let t = 0; t < 2; ++t) {
    const [a, b, c] = [0, 1, 2].map((i) => picture.indices[3 * t + i]).map((v) => [...picture.positions.slice(2 * v, 2 * v + 2)]);
    expect((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).toBe(1);
  }
  expect(picture).toMatchObject({ triangles: 2, typicalArea: 0.5, box: [0, 0, 1, 1] });
});

test("a picture shows areas, or areas over the bounds at the centroids", () => {
  const areas = pictureOf(square, square.coordinates, new RegionSlots(), () => undefined)!;
  expect([areas.shownLow, areas.shownHigh]).toEqual([-1, -1]);
  const over = [...square.regions].map((region) => (region === 9 ? 4 : 2 / 3));
  const ratios = pictureOf(square, square.coordinates, new RegionSlots(), () => undefined, over)!;
  expect(ratios.shownLow).toBe(-3); // half a unit over 4, in the region
  expect(ratios.shownHigh).toBeCloseTo(Math.log2(3 / 4)); // over 2/3, in the other
  expect([ratios.logAreaLow, ratios.logAreaHigh]).toEqual([-1, -1]);
  const shown = [2, 5].map((i) => ratios.values[4 * ratios.indices[i] + 1]);
  expect(shown).toEqual([255, 0]);
  for (const none of [Infinity, NaN, -1])
    expect(pictureOf(square, square.coordinates, new RegionSlots(), () => undefined, [none, none])!.shownHigh).toBe(-8);
});

test("an edge inside is drawn once, those on segments after it", () => {
  const { lines, inside } = linesOf(square);
  expect(lines.length).toBe(2 * (1 + 3 + 4)); // of the border three go upwards, and come with those inside
  expect(inside).toBe(lines.length - 8);
});

test("a chunk of vertices alone has no picture", () => {
  const chunk = { ...square, triangles: new Uint32Array(), regions: new Int32Array(), edges: new Uint32Array() };
  expect(pictureOf(chunk, square.coordinates, new RegionSlots(), () => undefined)).toBeUndefined();
});

test("every cell of the image that a mesh covers is full", () => {
  const grid = new Grid(8, 8);
  grid.add(0, 0, 8, 0, 8, 8, 100, 10, 1);
  grid.add(0, 0, 8, 8, 0, 8, 100, 10, 1);
  const pixels = grid.pixels();
  for (let i = 0; i < 64; ++i) expect([...pixels.slice(4 * i, 4 * i + 4)]).toEqual([100, 10, 1, 255]);
});

test("a thumbnail keeps the values of an image that is the same everywhere, on all levels", () => {
  const even = Uint8Array.from({ length: 4 * 50 * 7 }, (_, i) => [80, 40, 3, 255][i % 4]);
  const levels = thumbnailOf(even, 50, 7);
  expect(levels.length).toBe(4 * (32 ** 2 + 16 ** 2 + 8 ** 2 + 4 ** 2 + 2 ** 2 + 1));
  for (let i = 0; i < levels.length; i += 4) expect([...levels.slice(i, i + 4)]).toEqual([80, 40, 3, 255]);
});

test("a pixel of a thumbnail that is covered by a quarter is full, with the values of that quarter", () => {
  const pixels = new Uint8Array(4 * 64 * 64);
  pixels.set([80, 40, 3, 255]);
  expect([...thumbnailOf(pixels, 64, 64).slice(0, 8)]).toEqual([80, 40, 3, 255, 0, 0, 0, 0]);
});

test("a triangle is found by a point and by its number, with its neighbours across chunks", () => {
  const store = new MeshStore();
  store.add(square);
  store.keep(square, [0, 0, 1, 1]);
  const next: MeshChunk = {
    ...square,
    index: 1,
    firstVertex: 4,
    firstTriangle: 2,
    coordinates: Float64Array.from([2, 0.5]),
    triangles: Uint32Array.from([1, 4, 2]),
    regions: new Int32Array(),
  };
  store.add(next);
  store.keep(next, [1, 0, 2, 1]);
  expect(store.pick(0.9, 0.5)).toMatchObject({ triangle: 0, region: 0, area: 0.5, neighbours: [undefined, 2, 1] });
  expect(store.find(2)).toMatchObject({ triangle: 2, chunk: 1, vertices: [1, 4, 2], neighbours: [undefined, undefined, 0] });
  expect(store.find(1)).toMatchObject({ region: 9 });
  expect(store.find(1)!.angles.map(Math.round)).toEqual([90, 45, 45]);
  expect(store.pick(5, 5)).toBeUndefined();
  expect(store.find(3)).toBeUndefined();
});
