// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { domainOf } from "../src/domain/examples";
import { Fill, Measure, Placement } from "../src/gen/weft/v1/mesh_service_pb";
import { pythonProgram, shellCommand } from "../src/jobs/commands";
import { emptyForm, fieldOf, isRequest, requestOf, type FormText } from "../src/request/form";

const domain = domainOf([{ rings: [[[0, 0], [1, 0], [1, 1]]] }]);
const file = { name: "a b.wkt", inMetres: false };

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
    domain: { snap: 1e-6, fill: Fill.UNION, segments: [0, 1, 1, 2, 2, 0], segmentMarkers: [] },
    wantQuadtree: true,
  });
  const sparse = request({ size: "1", minAngle: "" });
  expect(sparse.quality?.minAngleDeg).toBeUndefined();
  expect(sparse.budget).toBeUndefined();
});

test("a domain that was projected keeps its distance of merging unless another one is asked for", () => {
  const snap = (text: string) => {
    const made = requestOf({ ...emptyForm, size: "1", snap: text }, { ...domain, snap: 0.5 });
    return isRequest(made) && made.domain?.snap;
  };
  expect(snap("")).toBe(0.5);
  expect(snap("0.25")).toBe(0.25);
});

test("a gradation within the domain is asked for and shown beside a gradation alone", () => {
  const within = (gradation: string) => request({ size: "1", gradation, gradationWithin: true });
  expect(within("0.2").size).toMatchObject({ gradation: 0.2, gradationWithin: true });
  expect(shellCommand(within("0.2"), file)).toContain("--gradation 0.2 \\\n  --gradation-within");
  expect(pythonProgram(within("0.2"), file)).toContain("gradation_within=True");
  for (const none of ["", "0"]) {
    expect(within(none).size?.gradationWithin).toBe(false);
    expect(shellCommand(within(none), file)).not.toContain("gradation");
  }
  expect(request({ size: "1", gradation: "0.2" }).size?.gradationWithin).toBe(false);
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
  expect(shellCommand(made, file)).toContain("weft mesh 'a b.wkt' -o mesh.vtu");
  expect(shellCommand(made, file)).toContain("--edge '0.1*distance' \\\n  --field distance=distance \\\n");
  expect(pythonProgram(made, file)).toContain('fields={"distance": weft.distance()},');
  expect(pythonProgram(made, file)).toContain('"a b.wkt",');
});
