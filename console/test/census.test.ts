// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { Counter } from "../src/view/census";

function count(angles: number[], area = 1) {
  const counter = new Counter();
  angles.forEach((angle, i) => counter.add(area, angle, () => ({ triangle: i, chunk: 0, x: i, y: 0 })));
  return counter.census();
}

test("angles are counted by two degrees, sixty among the last", () => {
  const { angles } = count([0, 1.99, 2, 59.9, 60]);
  expect(angles.slice(0, 3)).toEqual([2, 1, 0]);
  expect(angles[29]).toBe(2);
});

test("areas are counted by half octaves, without the empty ones at the ends", () => {
  const counter = new Counter();
  for (const area of [1, 1.3, 1.5, 4]) counter.add(area, 30, () => ({ triangle: 0, chunk: 0, x: 0, y: 0 }));
  expect(counter.census()).toMatchObject({ areas: [2, 1, 0, 0, 1], firstArea: 0 });
});

test("the ten worst are kept with the smallest angle first, whatever their order", () => {
  const { worst } = count([40, 3, 50, 12, 9, 33, 1, 20, 27, 8, 44, 2, 31]);
  expect(worst.map(({ minAngle }) => minAngle)).toEqual([1, 2, 3, 8, 9, 12, 20, 27, 31, 33]);
  expect(worst[0]).toMatchObject({ triangle: 6, x: 6 });
});

test("of equal angles the first stay", () => {
  expect(count(new Array(20).fill(30)).worst.map(({ triangle }) => triangle)).toEqual([0, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
});

test("no triangles, no areas", () => {
  expect(count([])).toMatchObject({ areas: [], worst: [] });
});
