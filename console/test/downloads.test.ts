// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import type { MeshNames } from "../src/domain/names";
import { formats, type Format } from "../src/download/formats";
import { gmshName, objGroup, spelled } from "../src/download/spelling";

const piece = {
  coordinates: [0, 0, 1, 0, 0, 1, 1, 1],
  triangles: [0, 1, 2, 1, 3, 2],
  regions: [7, 0],
  edges: [0, 1, 2, 0],
  edgeMarkers: [2, -1],
};
const names: MeshNames = {
  markers: new Map([[5, "unused"], [2, 'the "in" & <let>'], [-1, "wänd 🌊"]]),
  regions: new Map([[7, "region 3"], [1, "also unused"]]),
};

async function written(format: Format): Promise<string> {
  const writer = formats[format].begin(names);
  writer.add(piece);
  return (await writer.finish()).text();
}

test("names that become the same get numbers, as weft gives them", () => {
  const names = new Map([[3, "a,b"], [1, "a b"], [2, "a_b"], [4, "a_b_2"]]);
  expect([...spelled(names, objGroup)]).toEqual([[1, "a_b_3"], [2, "a_b"], [3, "a_b_4"], [4, "a_b_2"]]);
  expect(["default", "marker_7", "region_x", "#1"].map(objGroup)).toEqual(["_default", "_marker_7", "region_x", "_1"]);
  expect(["marker -7", "marker_7", '"'].map(gmshName)).toEqual(["_marker -7", "marker_7", "'"]);
});

test("files have the names of markers and regions", async () => {
  expect(await written("vtu")).toContain(
    '<FieldData>\n<DataArray type="Int32" Name="wänd 🌊" NumberOfTuples="2" format="ascii">-1 1</DataArray>\n' +
    '<DataArray type="Int32" Name="the &quot;in&quot; &amp; &lt;let&gt;" NumberOfTuples="2" format="ascii">2 1</DataArray>\n' +
    '<DataArray type="Int32" Name="unused" NumberOfTuples="2" format="ascii">5 1</DataArray>\n' +
    '<DataArray type="Int32" Name="also unused" NumberOfTuples="2" format="ascii">1 2</DataArray>\n',
  );
  expect(await written("msh")).toContain(
    '$PhysicalNames\n6\n1 1 "wänd 🌊"\n1 2 "the \'in\' & <let>"\n1 5 "unused"\n' +
    '2 2 "region 0"\n2 7 "_region 3"\n2 1 "also unused"\n$EndPhysicalNames\n',
  );
  expect(await written("obj")).toMatch(/g _region_3\nf 1 2 3\ng region_0\nf 2 4 3\ng the_"in"_&_<let>\nl 1 2\ng wänd_🌊\nl 3 1\n$/);
  const npz = await written("npz");
  for (const array of ["marker_ids", "marker_names", "region_ids", "region_names"]) expect(npz).toContain(`${array}.npy`);
  expect(npz).toContain("'descr': '<U16', 'fortran_order': False, 'shape': (3,), }");
});
