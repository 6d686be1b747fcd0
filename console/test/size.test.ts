// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { domainOf } from "../src/domain/examples";
import { segmentEnds, type Point } from "../src/domain/outline";
import { RegionSchema } from "../src/gen/weft/v1/mesh_service_pb";
import { emptyForm } from "../src/request/form";
import { boundAt } from "../src/size/bound-at";
import { compile } from "../src/size/expression";
import { Nearest } from "../src/size/nearest";

const square = () => domainOf([{ rings: [[[0, 0], [4, 0], [4, 4], [0, 4]] as Point[]] }]);

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
  const nearest = new Nearest(segmentEnds(square()));
  expect(nearest.distance(1, 2)).toBe(1);
  expect(nearest.distance(7, 8)).toBe(5);
});

test("of many segments none is nearer than the distance says, and one is as near", () => {
  const random = (i: number) => Math.abs((Math.sin(i) * 43758.5453) % 1); // the same at any time
  const lines = Float64Array.from({ length: 800 }, (_, i) => 100 * random(i));
  const nearest = new Nearest(lines);
  for (let i = 0; i < 200; ++i) {
    const [x, y] = [130 * random(1000 + i) - 15, 130 * random(2000 + i) - 15];
    const alone = Array.from({ length: 200 }, (_, s) => new Nearest(lines.slice(4 * s, 4 * s + 4)).distance(x, y));
    expect(nearest.distance(x, y)).toBe(Math.min(...alone));
  }
  expect(new Nearest(new Float64Array()).distance(0, 0)).toBe(Infinity);
});

test("the bound of a triangle is that of its centroid", () => {
  const domain = square();
  const lines = segmentEnds(domain);
  const at = (form: Partial<typeof emptyForm>) => boundAt({ ...emptyForm, ...form }, domain, lines, [1, 2], 0);
  expect(at({ sizeKind: "area", size: "x + 2*y" })).toEqual({ area: 5, isExact: true });
  expect(at({ sizeKind: "area", size: "distance" })?.area).toBe(1);
  expect(at({ sizeKind: "edge", size: "2" })?.area).toBeCloseTo(Math.sqrt(3), 12);
  expect(at({ sizeKind: "area", size: "1", gradation: "0.2" })).toEqual({ area: 1, isExact: false });
  for (const size of ["width", "x - 1", "sqrt(-x)", "2 +"]) expect(at({ sizeKind: "area", size }), size).toBeUndefined();
  expect(at({ sizeKind: "none" })).toBeUndefined();
  domain.regions.push(create(RegionSchema, { x: 1, y: 1, id: 0, maxArea: 0.5 }));
  expect(at({ sizeKind: "area", size: "x" })?.area).toBe(0.5);
});
