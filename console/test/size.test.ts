// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { readWkt } from "../src/domain/wkt";
import { compile } from "../src/size/expression";
import { distanceTo } from "../src/size/heat-map";

const at = (text: string, x = 2, y = 3, distance = 5) => compile(text, ["distance"])?.(x, y, [distance]);

test("expressions have the values that docs/size.md says", () => {
  const values: [string, number][] = [
    ["-x^2", -4],
    ["2^-1", 0.5],
    ["2^3^2", 512],
    ["10 - 4 - 3", 3],
    ["x < 0 ? 1 : y < 0 ? 2 : 3", 3],
    ["1 || 0 && 0", 1],
    ["!x + 1", 1],
    ["x <= 2 && y != 3", 0],
    [" .5e1*distance\n", 25],
    ["min(4, 3, x) + max(1, y)", 5],
    ["clamp(distance, 0, 1) + hypot(3, 4)", 6],
    ["coalesce(sqrt(-1), 7) + defined(log(-1))", 7],
    ["atan2(0, 1) + floor(2.5) + ceil(2.5)", 5],
    ["sin(pi/2) + log(e)", 2],
  ];
  for (const [text, value] of values) expect(at(text), text).toBeCloseTo(value, 12);
});

test("what is not an expression has no values", () => {
  for (const text of ["", "2x", "1 +", "abz(x)", "toString(x)", "min(x)", "sqrt(x, y)", "(x", "x)", "x $ y", "depth", "(".repeat(9999), "-".repeat(9999) + "1"])
    expect(compile(text, ["distance"]), text.slice(0, 20)).toBeUndefined();
});

test("the distance is to the nearest point of a segment", () => {
  const square = readWkt("a.wkt", "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))");
  expect(distanceTo(square, 1, 2)).toBe(1);
  expect(distanceTo(square, 7, 8)).toBe(5);
});
