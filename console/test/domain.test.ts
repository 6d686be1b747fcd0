// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";
import { fromJson, toBinary, type JsonValue } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { examples } from "../src/domain/examples";
import { FileError } from "../src/domain/file-error";
import { boxOf, segmentEnds, toMessage } from "../src/domain/planar-domain";
import { readDomain } from "../src/domain/read-domain";
import { decodeText, numberOf } from "../src/domain/text";
import { DomainSchema } from "../src/gen/weft/v1/mesh_service_pb";

const model = (name: string) => readDomain(name, readFileSync(`../tests/models/${name}`, "utf8"));

test("Triangle's .poly: points, segments with markers, holes, comments", () => {
  const domain = readDomain(
    "a.POLY",
    `# a square
4 2 0 0
1 0 0   # the first
2 1 0
3 1 1
4 0 1

4 1
1 1 2 7
2 2 3 -1
3 3 4 0
4 4 1 0
1
1 0.5 0.25
`,
  );
  expect([...domain.points]).toEqual([0, 0, 1, 0, 1, 1, 0, 1]);
  expect([...domain.segments]).toEqual([0, 1, 1, 2, 2, 3, 3, 0]);
  expect([...domain.markers]).toEqual([7, -1, 0, 0]);
  expect([...domain.holes]).toEqual([0.5, 0.25]);
  expect(domain.areas).toEqual([]);
});

test("regions of a .poly: a lone value is id and area, others than integers get free ids", () => {
  const regions = ["1 0 0 2", "2 1 1 0.35 -1", "3 2 2 0.1 0.5", "4 3 3 1 -1"];
  const text = `1 2 0 0\n0 0 0\n0 1\n0\n4\n${regions.join("\n")}\n`;
  expect(readDomain("r.poly", text).regions).toEqual([
    { x: 0, y: 0, id: 2, maxArea: 2 },
    { x: 1, y: 1, id: 4, maxArea: undefined },
    { x: 2, y: 2, id: 3, maxArea: 0.5 },
    { x: 3, y: 3, id: 1, maxArea: undefined },
  ]);
});

test("a fault in a .poly is named by its line", () => {
  const faults: [string, string][] = [
    ["3 2 0 0\n1 0 0\n2 x 0\n", "line 3: the x coordinate is “x”, not a number"],
    ["1 2 0 0\n1 0 0\n1 0\n1 1 9\n0\n", "line 4: there is no point 9"],
    ["1 3 0 0\n", "line 1: the dimension is 3"],
    ["9999999999 2 0 0\n", "line 1: the point count is 9999999999"],
    ["2 2 0 0\n1 0 0\n1 0 0\n", "line 3: the point number is 1, as that of another one before it"],
    ["1 2 0 0\n1 4.0Dx 0\n", "line 2: the x coordinate is “4.0Dx”, not a number"],
    ["1 2 0 0\n1 0x10 0\n", "line 2: the x coordinate is “0x10”, not a number"],
    ["1 2 0 0\n1 0 0\n", "the file ends before the segment count"],
    ["0 2 0 0\n", "put them into the .poly file"],
    ["1 2 0 0\n1 0 0\n0 0\n0\n0\n5\n", "line 6: the file goes on"],
  ];
  for (const [text, message] of faults) expect(() => readDomain("f.poly", text)).toThrow(message);
});

const ring = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]];
const inner = [[1, 1], [2, 1], [2, 2], [1, 1]];

test("GeoJSON: rings are closed chains, properties reach segments and regions", () => {
  const domain = readDomain(
    "a.geojson",
    JSON.stringify({
      type: "FeatureCollection",
      features: [
        {
          type: "Feature",
          properties: { marker: 3, region: 8, max_area: 0.5 },
          geometry: { type: "Polygon", coordinates: [ring, inner] },
        },
        { type: "Feature", geometry: null },
      ],
    }),
  );
  expect(domain.points.length).toBe(2 * 7);
  expect([...domain.segments]).toEqual([0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 4]);
  expect(new Set(domain.markers)).toEqual(new Set([3]));
  expect(domain).toMatchObject({ areas: [{ region: 8, maxArea: 0.5 }], regions: [] });
  expect([...domain.borders]).toEqual(Array(7).fill(1));
});

test("a property that is no marker, no region and no name is left out with a warning", () => {
  const rows = [
    { marker: true, region: ["bay"] },
    { marker_name: 5, region_name: {} },
    { marker: "a", marker_name: "b" },
    { marker: "a", marker_name: "a" },
    { marker: false },
    { region: [0] },
  ];
  const features = rows.map((properties) => ({
    type: "Feature",
    properties,
    geometry: { type: "Polygon", coordinates: [ring] },
  }));
  const domain = readDomain("a.geojson", JSON.stringify({ type: "FeatureCollection", features }));
  expect(domain.warnings).toEqual([
    "features[0].properties.marker is left out: it is true, neither a number nor a text",
    'features[0].properties.region is left out: it is ["bay"], neither a number nor a text',
    "features[1].properties.marker_name is left out: it is 5, not a text",
    "features[1].properties.region_name is left out: it is {}, not a text",
    "features[2].properties.marker_name is left out: it is “b” beside the name “a”",
    "2 more properties are left out",
  ]);
  expect([...domain.markerNames]).toEqual([[1, "a"]]);
});

test("rings that parity does not take for holes are a warning, as on the command line", () => {
  const warnings = (...holes: number[][][]) =>
    readDomain("a.json", JSON.stringify({ type: "Polygon", coordinates: [ring, ...holes] })).warnings;
  const apart = "is a hole that is outside of its polygon or in another hole, at";
  const end = "; what an odd number of the rings encloses is meshed";
  expect(warnings([[9, 1], [8, 1], [8, 2], [9, 1]])).toEqual([`coordinates[1] ${apart} (8, 1)${end}`]);
  expect(warnings(inner, [...inner].reverse())).toEqual([`coordinates[2] ${apart} (1, 1)${end}`]);
  expect(warnings(inner, [[1.5, 1.1], [1.6, 1.1], [1.6, 1.2], [1.5, 1.1]])).toEqual([`coordinates[2] ${apart} (1.5, 1.1)${end}`]);
  expect(warnings([[3, 1], [5, 1], [5, 2], [3, 1]])).toEqual([
    `coordinates[1] is a ring that crosses another of its polygon: coordinates[0], near (3, 1)${end}`,
  ]);
  expect(warnings(inner, [[2, 1], [3, 1], [3, 2], [2, 2], [2, 1]], [[0, 3], [1, 3], [1, 4], [0, 4], [0, 3]])).toEqual([]);
});

test("a ring that crosses itself is a warning, as on the command line", () => {
  const warnings = (coordinates: number[][][][]) =>
    readDomain("a.json", JSON.stringify({ type: "MultiPolygon", coordinates })).warnings;
  const bow = (x: number) => [[[x, 0], [x + 4, 4], [x + 4, 4], [x + 4, 0], [x, 4], [x, 0]]];
  expect(warnings([bow(0)])).toEqual([
    "coordinates[0][0] is a ring that crosses itself: edge 0 from (0, 0) to (4, 4) crosses edge 3 from (4, 0) to (0, 4)",
  ]);
  expect(warnings([...Array(7).keys()].map((i) => bow(9 * i))).at(-1)).toBe("2 more rings cross themselves");
  expect(warnings([[[[1, 1], [3, 1], [3, 2], [2, 1], [2, 3], [1, 1]]]])).toEqual([]); // touches itself
  const wave = Array.from({ length: 20_000 }, (_, i) => {
    const [angle, radius] = [(Math.PI * i) / 10_000, 1 + 0.1 * Math.cos((Math.PI * i) / 250)];
    return [radius * Math.cos(angle), radius * Math.sin(angle)];
  });
  expect(warnings([[[...wave, wave[0]]]])).toEqual([]);
  [wave[7000], wave[7001]] = [wave[7001], wave[7000]];
  expect(warnings([[[...wave, wave[0]]]])[0]).toMatch(/itself: edge 6999 from .* crosses edge 7001 from/);
});

test("markers that the header of a .poly denies are a warning", () => {
  const text = (count: number) => `3 2 0 0\n1 0 0\n2 1 0\n3 1 1\n3 ${count}\n1 1 2 7\n2 2 3 8\n3 3 1 9\n0\n`;
  expect(readDomain("a.poly", text(1)).warnings).toEqual([]);
  expect(readDomain("a.poly", text(0)).warnings[0]).toMatch(/^line 6: what follows the points of segments is ignored/);
});

test("lines beside a polygon border no area", () => {
  const line = { type: "LineString", coordinates: [[1, 3], [3, 3], [3, 3], [3, 3.5]] };
  const both = { type: "GeometryCollection", geometries: [line, { type: "Polygon", coordinates: [ring] }] };
  const domain = readDomain("a.json", JSON.stringify(both));
  expect(domain.segments.length).toBe(2 * (2 + 4));
  expect([...domain.borders]).toEqual([0, 0, 1, 1, 1, 1]);
  expect(readDomain("b.json", JSON.stringify(line)).areas).toEqual([]);
});

test("rings are closed, a warning tells of the first five", () => {
  const polygons = { type: "MultiPolygon", coordinates: Array(7).fill([ring.slice(0, 4)]) };
  const { segments, warnings } = readDomain("f.json", JSON.stringify(polygons));
  expect([...segments.slice(0, 8)]).toEqual([0, 1, 1, 2, 2, 3, 3, 0]);
  expect(warnings.slice(4)).toEqual([
    "coordinates[4][0] is a ring that is not closed: it starts at (0, 0) and ends at (0, 4); a segment closes it",
    "2 more rings are not closed",
  ]);
});

test("a fault in GeoJSON is named by its path", () => {
  const at = (geometry: unknown) => () => readDomain("f.json", JSON.stringify({ type: "Feature", geometry }));
  expect(at({ type: "Polygon", coordinates: [[[0, 0], [1, 1], [0, 0]]] })).toThrow(
    "the file holds no geometry: 1 ring without an area is left out: geometry.coordinates[0]",
  );
  expect(at({ type: "LineString", coordinates: [[0, 0], [1, "a"]] })).toThrow("geometry.coordinates[1]: is not a position");
  expect(at({ type: "Curve", coordinates: [] })).toThrow("“Curve”");
  expect(at({ type: "toString", coordinates: [] })).toThrow("“toString”");
  expect(at({ type: "GeometryCollection" })).toThrow('geometry: has no array "geometries"');
  expect(() => readDomain("f.json", "{")).toThrow("this is not JSON");
  expect(() => readDomain("f.json", "[]")).toThrow("is not a GeoJSON object");
  expect(() => readDomain("f.json", '{"type":"MultiPoint","coordinates":[]}')).toThrow("holds no geometry");
  let deep: unknown = { type: "Point", coordinates: [0, 0] };
  for (let i = 0; i < 100; ++i) deep = { type: "GeometryCollection", geometries: [deep] };
  expect(at(deep)).toThrow("nested deeper than 64 levels");
});

test("well-known text: several geometries, heights, SRID, EMPTY", () => {
  const domain = readDomain(
    "a.wkt",
    `SRID=4326;POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 1));
     MultiPoint Z ((9 9 1), (8 8 1)) POINT EMPTY
     GEOMETRYCOLLECTION(LINESTRING(1 3, 3 3), MULTILINESTRING((5 5,6 6)))`,
  );
  expect(domain.areas.length).toBe(1);
  expect(domain.points.length).toBe(2 * (7 + 2 + 4));
  expect(domain.markers.length).toBe(7 + 2);
});

test("a fault in well-known text is named by line and column", () => {
  const faults: [string, string][] = [
    ["POLYGON ((0 0, 1 0,\n 1))", "line 2, column 3: a position is expected"],
    ["CIRCLE (0 0)", "“CIRCLE” is not a geometry"],
    ["POINT 1 2", "line 1, column 7: “(” is expected"],
    ["LINESTRING (0 0, 1 1", "“)” is expected"],
    ["", "holds no geometry"],
    ["7", "line 1, column 1: a geometry is expected"],
    ["GEOMETRYCOLLECTION(".repeat(100), "nested deeper than 64 levels"],
  ];
  for (const [text, message] of faults) expect(() => readDomain("f.wkt", text)).toThrow(message);
});

const feature = (type: string, coordinates: unknown, properties: object) =>
  ({ type: "Feature", properties, geometry: { type, coordinates } });
const square = (x: number) => [[[x, 0], [x + 4, 0], [x + 4, 4], [x, 4], [x, 0]]];

test("names of GeoJSON are texts, or stand beside numbers", () => {
  const domain = readDomain("a.geojson", JSON.stringify({
    type: "FeatureCollection",
    features: [
      feature("Polygon", square(0), { marker: "wall", region: "fluid", max_area: 1, max_edge: 1 }),
      feature("LineString", [[1, 1], [2, 2]], { marker: 1, marker_name: "gauge" }),
      feature("LineString", [[1, 2], [2, 3]], { marker: "wall" }),
      feature("Polygon", square(5), { region: 4, region_name: "solid", marker: "" }),
      feature("LineString", [[1, 2], [2, 2]], { marker: 1, marker_name: "other" }),
    ],
  }));
  expect([...domain.markerNames]).toEqual([[1, "gauge"], [2, "wall"]]);
  expect([...domain.regionNames]).toEqual([[4, "solid"], [1, "fluid"]]);
  expect([...domain.markers]).toEqual([2, 2, 2, 2, 1, 2, 0, 0, 0, 0, 1]);
  expect(domain.areas.map(({ region }) => region)).toEqual([1, 4]);
  expect(domain.areas[0]!.maxArea).toBeCloseTo(0.433);
  expect(domain.warnings).toEqual(["a name of marker 1 is left out: the first is “gauge”"]);
  const message = toMessage(domain, 0);
  expect(message.markerNames.map(({ id, name }) => [id, name])).toEqual([[1, "gauge"], [2, "wall"]]);
  expect(message.regionNames.length).toBe(2);
});

test("names of a .poly are comments, and values of regions that are no integers", () => {
  const domain = readDomain("a.poly",
    "# marker=2:inlet \n3 2 0 0\n1 0 0\n2 1 0\n3 1 1 # marker=5:no\n3 1\n1 1 2 2\n2 2 3 3\n3 3 1 3\n0\n1\n" +
    "1 0.7 0.2 0.5 -1\n# marker=3:in # out: all\r\n # marker=7:no\n# marker=x:no\n# region=4:fluid\n" +
    "# region=99999999999:no\n# marker=9:a\tb\n# marker=8:inlet ");
  expect([...domain.markerNames]).toEqual([[2, "inlet "], [3, "in # out: all"]]);
  expect([...domain.regionNames]).toEqual([[1, "0.5"], [4, "fluid"]]);
  expect(domain.warnings).toEqual([
    "a name of marker 9 is left out: it has a control character",
    "a name of marker 8 is left out: “inlet ” is another one's, too",
  ]);
});

test("other files are refused with what is read", () => {
  expect(() => readDomain("a.dxf", "")).toThrow(".poly, .geojson, .json, .wkt");
  expect(() => readDomain("constructor", "")).toThrow(".poly");
  expect(() => readDomain("a.constructor", "")).toThrow(".poly");
});

test("the models of the tests are read, the same from both formats", () => {
  for (const name of ["key.poly", "pipe.poly", "cylinder.poly"]) expect(model(name).points.length).toBeGreaterThan(100);
  const [a, b] = [model("us-east-coast.geojson"), model("us-east-coast.poly")];
  expect(boxOf(a)).toEqual(boxOf(b));
  expect(a.markers.length).toBe(b.markers.length);
});

test("each example is a domain with a size", () => {
  for (const { file, text, form } of examples) {
    const domain = readDomain(file, text);
    expect(segmentEnds(domain).every(Number.isFinite)).toBe(true);
    expect(form.size).toBeTruthy();
  }
});

test("a file is the same whatever program saved it", () => {
  const samples: [string, string][] = [
    ["a.poly", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 1\n1 1 2 5\n2 2 3 5\n3 3 1 5\n0\n# marker=5:inlet\n"],
    ["a.geojson", '{"type": "Polygon",\n "coordinates": [[[0, 0], [1, 0], [0, 1], [0, 0]]]}\n'],
    ["a.wkt", "POLYGON ((0 0, 1 0,\n 0 1, 0 0))\n"],
  ];
  const utf16 = (text: string, big: boolean) => {
    const bytes = new DataView(new ArrayBuffer(2 * text.length));
    [...text].forEach((character, i) => bytes.setUint16(2 * i, character.charCodeAt(0), !big));
    return bytes.buffer;
  };
  const utf8 = (text: string) => new TextEncoder().encode(text).buffer;
  for (const [name, text] of samples) {
    const expected = readDomain(name, text);
    const files = [
      utf8(`\ufeff${text}`),
      utf8(text.replaceAll("\n", "\r\n")),
      utf8(text.replaceAll("\n", "\r")),
      utf8(text.replaceAll("\n", "\t\n")),
      utf16(`\ufeff${text}`, false),
      utf16(`\ufeff${text}`, true),
    ];
    for (const bytes of files) expect(readDomain(name, decodeText(bytes))).toEqual(expected);
  }
  for (const bytes of [[0xff, 0xfe, 0x20], [0xff, 0xfe, 0x00, 0xd8], [0xfe, 0xff, 0xdc, 0x00]])
    expect(() => decodeText(new Uint8Array(bytes).buffer)).toThrow("begins as UTF-16");
  expect(() => readDomain("a.poly", decodeText(utf8("\ufeff")))).toThrow("the file ends before the point count");
});

test("a number is one as a whole, with exponents of Fortran's too", () => {
  expect([" 4.0D+03 ", "-1.d3", "+.5", "4.", "1.0+103", "2e-1"].map(numberOf)).toEqual([4000, -1000, 0.5, 4, 1e103, 0.2]);
  for (const text of ["", "4x", "4.0D", "1-2", "1.0+3", "0x10", "1,5", "Infinity", "1e999"]) expect(numberOf(text)).toBeUndefined();
  const poly = readDomain("a.poly", "2 2 0 0\n1 0.0D+00 4.0D+03\n2 1.0+103 0\n0 0\n0\n");
  expect([...poly.points]).toEqual([0, 4000, 1e103, 0]);
  expect([...readDomain("a.wkt", "POINT (1.5D1 2)").points]).toEqual([15, 2]);
});

test("the points of a .poly have any numbers, and its headers may end early", () => {
  const domain = readDomain("a.poly", "3\n70 0 0\n-3 1 0\n12 0 1\n3\n1 70 -3 5\n2 -3 12\n3 12 70 6\n0\n");
  expect([...domain.segments]).toEqual([0, 1, 1, 2, 2, 0]);
  expect([...domain.markers]).toEqual([5, 0, 6]);
});

test("a property that is a text may be a number", () => {
  const at = (properties: unknown) =>
    readDomain("a.json", JSON.stringify({ type: "Feature", properties, geometry: { type: "Polygon", coordinates: [ring] } }));
  expect(at({ marker: "3", region: " 7 ", max_area: "1D-1" })).toMatchObject({ areas: [{ region: 7, maxArea: 0.1 }], markerNames: new Map() });
  expect(at({ marker: "3" }).markers[0]).toBe(3);
  expect(at({ MARKER: 4, marker: 3, Region: "inlet", MAX_AREA: "0.5", Max_Area: 9 })).toMatchObject({
    markers: Int32Array.of(3, 3, 3, 3), areas: [{ region: 1, maxArea: 0.5 }], regionNames: new Map([[1, "inlet"]]),
  });
  expect(at({ max_edge: "2" }).areas[0]!.maxArea).toBeCloseTo(Math.sqrt(3), 12);
  expect(at({ max_edge: 2, max_area: 1 }).areas[0]!.maxArea).toBe(1);
  expect(at({ marker: " ", region: "", max_area: "" })).toMatchObject({ areas: [{ region: undefined, maxArea: undefined }], markerNames: new Map() });
  expect(() => at({ max_area: "small" })).toThrow('properties.max_area: is "small", not a number');
  expect(() => at({ max_area: true })).toThrow("properties.max_area: is true, not a number");
});

test("what has no area and no length is left out, counted in one warning", () => {
  const flat = [[1, 1], [2, 2], [2, 2], [1, 1]];
  const domain = readDomain("a.json", JSON.stringify({
    type: "GeometryCollection",
    geometries: [
      { type: "Polygon", coordinates: [ring, flat, []] },
      null,
      { type: "Polygon", coordinates: [] },
      { type: "MultiPolygon", coordinates: [[], [[[9, 9], [9, 9]], inner]] },
      { type: "LineString", coordinates: [[1, 1], [1, 1]] },
    ],
  }));
  expect(domain.segments.length).toBe(2 * 4);
  expect(domain.warnings).toEqual([
    "3 rings without an area, 1 line without a length and 3 empty geometries are left out, the first is geometries[0].coordinates[1]",
  ]);
  expect(readDomain("a.wkt", "POLYGON ((0 0, 4 0, 4 4, 0 0), EMPTY) POINT EMPTY").warnings).toEqual([
    "1 ring without an area and 1 empty geometry are left out, the first is geometry 0, ring [1]",
  ]);
});

const files = "../tests/domain_files";
const expected = JSON.parse(readFileSync(`${files}/expect.json`, "utf8")) as Record<string, JsonValue>;

test.each(Object.keys(expected))("%s is read as by the command line and Python", (name) => {
  const bytes = readFileSync(`${files}/${name}`);
  const read = () => readDomain(name, decodeText(Uint8Array.from(bytes).buffer));
  if (expected[name] === null) return expect(read).toThrow(FileError);
  const wanted = fromJson(DomainSchema, expected[name]);
  expect([...toBinary(DomainSchema, toMessage(read(), 0))]).toEqual([...toBinary(DomainSchema, wanted)]);
});

type Ring = { ring: number[][]; crs?: string; degrees: boolean; is_told?: boolean };

test.each(JSON.parse(readFileSync(`${files}/degrees.json`, "utf8")) as Ring[])(
  "degrees are a warning as on the command line and in Python: %o",
  ({ ring, crs, degrees, is_told }) => {
    const polygon = {
      type: "Polygon",
      coordinates: [[...ring, ring[0]]],
      ...(crs && { crs: { type: "name", properties: { name: crs } } }),
    };
    expect(readDomain("a.json", JSON.stringify(polygon)).warnings).toEqual([
      ...(degrees ? [expect.stringMatching(/^the coordinates are longitudes and latitudes: .*--lonlat/)] : []),
      ...(is_told
        ? [`its crs is “${crs}”, not WGS 84 as GeoJSON's is; coordinates are taken as they are`]
        : []),
    ]);
  },
);
