// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { domainOf, examples, geoJsonOf } from "../src/domain/examples";
import { boxOf, segmentEnds, type Point } from "../src/domain/outline";
import { DomainSchema, Fill } from "../src/gen/weft/v1/mesh_service_pb";

const square: Point[] = [[0, 0], [4, 0], [4, 4], [0, 4]];
const hole: Point[] = [[1, 1], [2, 1], [2, 2]];

test("polygons are areas, whose rings are closed", () => {
  const domain = domainOf([{ rings: [square, hole] }, { rings: [hole], region: 2 }]);
  expect(domain.points).toEqual([0, 0, 4, 0, 4, 4, 0, 4, 1, 1, 2, 1, 2, 2, 1, 1, 2, 1, 2, 2]);
  expect(domain.segments).toEqual([0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 4, 7, 8, 8, 9, 9, 7]);
  expect(domain.segmentAreas).toEqual([1, 1, 1, 1, 1, 1, 1, 2, 2, 2]);
  expect(domain.areas.map(({ region }) => region)).toEqual([undefined, 2]);
  expect(domain.fill).toBe(Fill.UNION);
});

test("an example is saved as the polygons that it is", () => {
  for (const { polygons } of examples) {
    const { features } = JSON.parse(geoJsonOf(polygons)) as { features: { geometry: { coordinates: Point[][] } }[] };
    expect(features.map(({ geometry }) => geometry.coordinates.map((ring) => ring.slice(0, -1)))).toEqual(JSON.parse(JSON.stringify(polygons.map(({ rings }) => rings))));
    for (const { geometry } of features) for (const ring of geometry.coordinates) expect(ring.at(-1)).toEqual(ring[0]);
  }
});

test("the box of a domain is that of its points and arcs", () => {
  expect(boxOf(domainOf([{ rings: [square] }]))).toEqual([0, 0, 4, 4]);
  expect(boxOf(create(DomainSchema))).toBeUndefined();
  const disc = { points: [1, 0, -1, 0, 9, 9], segments: [0, 1, 1, 0], arcSegments: [0, 1], arcBulges: [1, 1] };
  boxOf(create(DomainSchema, disc))!.forEach((value, i) => expect(value).toBeCloseTo([-1, -1, 9, 9][i], 3));
});

test("arcs are chords of 2 degrees or less, which end where the arcs do", () => {
  const half = { points: [1, 0, -1, 0], segments: [0, 1, 1, 0] };
  expect([...segmentEnds(create(DomainSchema, half))]).toEqual([1, 0, -1, 0, -1, 0, 1, 0]);
  for (const [bulge, turn, side] of [[1, 180, 1], [-1, 180, -1], [Math.tan(Math.PI / 8), 90, 1], [1e-9, 0, 0]]) {
    const ends = segmentEnds(create(DomainSchema, { ...half, arcSegments: [0], arcBulges: [bulge] }));
    const chords = Array.from({ length: ends.length / 4 }, (_, i) => [...ends.slice(4 * i, 4 * i + 4)]);
    expect(chords.length).toBe(1 + Math.max(1, turn / 2));
    expect(chords[1]).toEqual([-1, 0, 1, 0]); // the straight one
    const arc = [chords[0], ...chords.slice(2)];
    arc.forEach((each, i) => i > 0 && expect(each.slice(0, 2)).toEqual(arc[i - 1].slice(2)));
    expect([...arc[0].slice(0, 2), ...arc.at(-1)!.slice(2)]).toEqual([1, 0, -1, 0]);
    // Left of the way from (1, 0) to (-1, 0) is below: an arc that turns left is to its right, above.
    for (const [, , x, y] of arc.slice(0, -1)) {
      expect(Math.sign(y)).toBe(side);
      if (turn === 180) expect(Math.hypot(x, y)).toBeCloseTo(1, 12);
    }
  }
});
