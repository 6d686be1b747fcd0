// SPDX-License-Identifier: Apache-2.0
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { GenerateMeshRequestSchema, Measure, Placement } from "../src/gen/weft/v1/mesh_service_pb";
import { pythonProgram, shellCommand } from "../src/jobs/commands";

const make = (init: MessageInitShape<typeof GenerateMeshRequestSchema>) => create(GenerateMeshRequestSchema, init);

const coast = make({
  size: {
    field: { case: "expression", value: "min(500 + 0.15*coast, 'x')" },
    measure: Measure.EDGE,
    gradation: 0.15,
    gradationWithin: true,
    fields: [{ name: "coast", kind: { case: "distance", value: {} } }],
  },
  quality: { minAngleDeg: 0, placement: Placement.CIRCUMCENTRE, optimise: 0 },
  budget: { maxTriangles: 5000n },
  allowUnrefined: true,
});

test("a request is a command with what was set, zero included, and nothing else", () => {
  expect(shellCommand(make({ size: { field: { case: "constant", value: 0.5 } } }))).toBe(
    "weft mesh DOMAIN.poly -o mesh.vtu \\\n  --size 0.5",
  );
  expect(shellCommand(coast).split(" \\\n  ")).toEqual([
    "weft mesh DOMAIN.poly -o mesh.vtu",
    "--edge 'min(500 + 0.15*coast, '\\''x'\\'')'",
    "--field coast=distance:marker=MARKERS",
    "--gradation 0.15",
    "--gradation-within",
    "--min-angle 0",
    "--placement circumcentre",
    "--optimise 0",
    "--max-triangles 5000",
    "--allow-unrefined",
  ]);
});

test("markers to keep are a list, or all", () => {
  const kept = (markers: number[]) => make({ quality: { keep: { markers } } });
  expect(shellCommand(kept([2, 5]))).toContain("--keep 2,5");
  expect(shellCommand(kept([]))).toContain("--keep all");
  expect(pythonProgram(kept([2, 5]))).toContain("keep=[2,5],");
  expect(pythonProgram(kept([]))).toContain('keep="all",');
});

test("periodic sides are pairs of markers", () => {
  const sides = make({ quality: { periodic: [{ from: 4, to: 2 }, { from: -1, to: 3 }] } });
  expect(shellCommand(sides)).toContain("--periodic 4:2,-1:3");
  expect(pythonProgram(sides)).toContain("periodic=[(4,2),(-1,3)],");
  expect(shellCommand(make({ quality: {} }))).not.toContain("periodic");
});

test("layers are rows of a marker", () => {
  const layers = make({ quality: { layers: [{ marker: 4, first: 0.01, ratio: 1.2, rows: 5 }, { marker: -1, first: 1, rows: 2, region: 3 }] } });
  expect(shellCommand(layers)).toContain("--layers 4:first=0.01,rows=5,ratio=1.2 \\\n  --layers -1:first=1,rows=2,region=3");
  expect(pythonProgram(layers)).toContain(
    "layers={4: weft.Layers(first=0.01, rows=5, ratio=1.2), -1: weft.Layers(first=1, rows=2, region=3)},",
  );
});

test("a request is a program in Python", () => {
  expect(pythonProgram(make({}))).toBe(
    'import weft\n\nwith weft.Client() as client:\n    mesh = client.mesh(\n        "DOMAIN.poly",\n    )\nmesh.write("mesh.vtu")\n',
  );
  for (const line of [
    'edge="min(500 + 0.15*coast, \'x\')",',
    'fields={"coast": weft.distance(marker=MARKERS)},',
    "min_angle=0,",
    "allow_unrefined=True,",
  ])
    expect(pythonProgram(coast)).toContain(`\n        ${line}\n`);
});

test("a domain that was projected is projected again", () => {
  const file = { name: "coast.geojson", inMetres: true };
  expect(shellCommand(make({}), file)).toBe("weft mesh coast.geojson -o mesh.vtu \\\n  --to-metres");
  expect(pythonProgram(make({}), file)).toContain("to_metres=True");
});
