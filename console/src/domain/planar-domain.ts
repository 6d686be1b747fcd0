// SPDX-License-Identifier: Apache-2.0
// A domain in the browser: a planar straight-line graph, as weft.v1.Domain explains.
import { create } from "@bufbuild/protobuf";
import { DomainSchema, Fill, type Domain } from "../gen/weft/v1/mesh_service_pb";
import type { Box } from "../view/picture";
import type { Names } from "./names";

export interface RegionSeed {
  x: number;
  y: number;
  id: number;
  maxArea: number | undefined;
}

// A polygon: what an odd number of its rings encloses.
export interface Area {
  region: number | undefined;
  maxArea: number | undefined;
}

export interface PlanarDomain {
  name: string; // of the file that it could be in, such as "coast.geojson"
  points: Float64Array; // x0, y0, x1, y1, ...
  segments: Uint32Array; // a0, b0, a1, b1, ...
  markers: Int32Array; // one for each segment
  holes: Float64Array; // x0, y0, x1, y1, ...
  regions: RegionSeed[];
  areas: Area[]; // if there are any, what they cover is meshed; otherwise every bounded face
  borders: Uint32Array; // for each segment 0, or 1 + the area whose border it is part of
  markerNames: Names;
  regionNames: Names;
  warnings: string[]; // what of the file was left out
}

export type Point = [x: number, y: number];

// Undefined if there are no points.
export function boxOf({ points }: PlanarDomain): Box | undefined {
  if (points.length === 0) return undefined;
  const box: Box = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 2) {
    box[0] = Math.min(box[0], points[i]);
    box[1] = Math.min(box[1], points[i + 1]);
    box[2] = Math.max(box[2], points[i]);
    box[3] = Math.max(box[3], points[i + 1]);
  }
  return box;
}

// x, y of both ends of each segment.
export function segmentEnds({ points, segments }: PlanarDomain): Float64Array {
  const ends = new Float64Array(2 * segments.length);
  segments.forEach((vertex, i) => {
    ends[2 * i] = points[2 * vertex];
    ends[2 * i + 1] = points[2 * vertex + 1];
  });
  return ends;
}

const named = (names: Names) => [...names].sort(([a], [b]) => a - b).map(([id, name]) => ({ id, name }));

// `snap` as in weft.v1.Domain.
export function toMessage(domain: PlanarDomain, snap: number): Domain {
  return create(DomainSchema, {
    points: Array.from(domain.points),
    segments: Array.from(domain.segments),
    segmentMarkers: domain.markers.some((marker) => marker !== 0) ? Array.from(domain.markers) : [],
    holes: Array.from(domain.holes),
    regions: domain.regions.map(({ x, y, id, maxArea }) => ({ x, y, id, maxArea })),
    fill: domain.areas.length > 0 ? Fill.UNION : Fill.SEEDS,
    areas: domain.areas.map(({ region, maxArea }) => ({ region, maxArea })),
    segmentAreas: domain.areas.length > 0 ? Array.from(domain.borders) : [],
    snap,
    markerNames: named(domain.markerNames),
    regionNames: named(domain.regionNames),
  });
}
