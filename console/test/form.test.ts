// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { readWkt } from "../src/domain/wkt";
import { Fill, Measure, Placement } from "../src/gen/weft/v1/mesh_service_pb";
import { pythonProgram, shellCommand } from "../src/jobs/commands";
import { emptyForm, fieldOf, isRequest, requestOf, type FormText } from "../src/request/form";
import { boundLogarithms, boundsOf } from "../src/view/bounds";

const domain = readWkt("a b.wkt", "POLYGON ((0 0, 1 0, 1 1, 0 0))");

function request(change: Partial<FormText>) {
  const made = requestOf({ ...emptyForm, ...change }, domain);
  if (!isRequest(made)) throw new Error(JSON.stringify(made));
  return made;
}

test("a number is a constant, anything else an expression", () => {
  expect(request({ sizeKind: "area", size: " 1e-2 " }).size).toMatchObject({
    field: { case: "constant", value: 0.01 },
    measure: Measure.AREA,
  });
  expect(request({ sizeKind: "edge", size: "0.1 + x" }).size).toMatchObject({
    field: { case: "expression", value: "0.1 + x" },
    measure: Measure.EDGE,
    fields: [],
  });
  expect(request({ sizeKind: "none", size: "" }).size?.field.case).toBeUndefined();
});

test("fields that an expression names go with it", () => {
  const names = (size: string) => request({ size }).size?.fields.map(({ name }) => name);
  expect(names("0.1 + 0.2*distance")).toEqual(["distance"]);
  expect(names("min(width, distance)")).toEqual(["distance", "width"]);
  expect(names("distances + my_width")).toEqual([]);
});

test("the rest of the form reaches the request; what is empty is not set", () => {
  const full = request({
    size: "1", gradation: "0.2", cellsAcross: "3", minAngle: "0", maxTriangles: "5000", snap: "1e-6", placement: "circumcentre",
  });
  expect(full).toMatchObject({
    size: { gradation: 0.2, cellsAcross: 3 },
    quality: { minAngleDeg: 0, placement: Placement.CIRCUMCENTRE },
    budget: { maxTriangles: 5000n },
    domain: { snap: 1e-6, fill: Fill.EVEN_ODD, segments: [0, 1, 1, 2, 2, 0], segmentMarkers: [] },
    wantQuadtree: true,
  });
  const sparse = request({ size: "1", minAngle: "" });
  expect(sparse.quality?.minAngleDeg).toBeUndefined();
  expect(sparse.budget).toBeUndefined();
});

test("what is not a number is named by its field, all at once", () => {
  expect(requestOf({ ...emptyForm, size: "", gradation: "much", maxTriangles: "1.5" }, domain)).toEqual({
    size: "a number or an expression is missing",
    gradation: "“much” is not a number",
    maxTriangles: "a whole number is expected",
  });
});

test("the server's paths lead to the fields of the page", () => {
  expect(fieldOf("size.expression")).toBe("size");
  expect(fieldOf("size.gradation")).toBe("gradation");
  expect(fieldOf("quality.min_angle_deg")).toBe("minAngle");
  expect(fieldOf("domain.points[3].x")).toBeUndefined();
});

test("the command of a whole request names its file and its fields", () => {
  const made = request({ size: "0.1*distance" });
  expect(shellCommand(made, domain.name)).toContain("weft mesh 'a b.wkt' -o mesh.vtu");
  expect(shellCommand(made, domain.name)).toContain("--edge '0.1*distance' \\\n  --field distance=distance \\\n");
  expect(pythonProgram(made, domain.name)).toContain('fields={"distance": weft.distance()},');
  expect(pythonProgram(made, domain.name)).toContain('"a b.wkt",');
});

test("bounds on areas are known if they are numbers", () => {
  expect(boundsOf(request({ sizeKind: "edge", size: "2" }))?.everywhere).toBeCloseTo(Math.sqrt(3));
  expect(boundsOf(request({ size: "x" }))).toBeUndefined();
  expect(boundsOf(request({ size: "2", gradation: "0.1" }))).toBeUndefined();
  expect(boundsOf(request({ sizeKind: "none" }))).toBeUndefined();
  const bounds = { everywhere: 4, regions: new Map([[7, 1], [8, 16]]) };
  expect([...boundLogarithms(bounds, [0, 7, 8]).slice(0, 4)]).toEqual([2, 0, 2, 100]);
});
