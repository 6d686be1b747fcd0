// SPDX-License-Identifier: Apache-2.0
// Where a domain's segments are in the plane.
import type { Domain } from "../gen/weft/v1/mesh_service_pb";
import type { Box } from "../view/picture";

export type Point = [x: number, y: number];

// With its arcs. Undefined if there are no points.
export function boxOf(domain: Domain): Box | undefined {
  if (domain.points.length === 0) return undefined;
  const box: Box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const values of [domain.points, segmentEnds(domain)])
    for (let i = 0; i < values.length; ++i) {
      box[i % 2] = Math.min(box[i % 2], values[i]);
      box[2 + (i % 2)] = Math.max(box[2 + (i % 2)], values[i]);
    }
  return box;
}

const chord = Math.PI / 90; // by which one turns, at most

// The corners of the chords that stand for an arc: `bulge` as in weft.v1.Domain.
function cornersOf([ax, ay]: Point, [bx, by]: Point, bulge: number): Point[] {
  const turn = 4 * Math.atan(bulge);
  const count = Math.ceil(Math.abs(turn) / chord);
  const away = (1 - bulge * bulge) / (4 * bulge); // of the centre from the middle, to the left, in lengths of the chord
  const [cx, cy] = [(ax + bx) / 2 - away * (by - ay), (ay + by) / 2 + away * (bx - ax)];
  return Array.from({ length: count - 1 }, (_, i): Point => {
    const angle = (turn * (i + 1)) / count;
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    return [cx + cos * (ax - cx) - sin * (ay - cy), cy + sin * (ax - cx) + cos * (ay - cy)];
  });
}

// x, y of both ends of each segment, in their order. Arcs are chords, whose further ones come last.
export function segmentEnds({ points, segments, arcSegments, arcBulges }: Domain): Float64Array {
  const at = (vertex: number): Point => [points[2 * vertex], points[2 * vertex + 1]];
  const ends = segments.flatMap(at);
  arcSegments.forEach((segment, i) => {
    const [a, b] = [at(segments[2 * segment]), at(segments[2 * segment + 1])];
    let from = a;
    const corners = cornersOf(a, b, arcBulges[i]);
    if (corners.length === 0) return;
    ends.splice(4 * segment + 2, 2, ...corners[0]);
    from = corners[0];
    for (const to of [...corners.slice(1), b]) {
      ends.push(...from, ...to);
      from = to;
    }
  });
  return Float64Array.from(ends);
}
