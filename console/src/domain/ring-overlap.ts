// SPDX-License-Identifier: Apache-2.0
// Where a ring crosses itself, and where the rings of a polygon overlap, as files/formats/domains/ring_crossing.h
// finds it: for warnings alone, so without exact predicates, and not to the end in polygons of very many edges near
// each other.
import type { Point } from "./planar-domain";

const mostWork = 50_000_000; // edges that are looked at

type Edge = readonly [Point, Point];

export interface RingOverlap {
  ring: number; // a hole that is in part outside of the first ring or in another hole
  crossed: number | undefined; // the ring whose edges it crosses
  at: Point;
}

// Its edges by their lower ordinates, so that those at a height are found.
class Ring {
  readonly edges: Edge[];
  readonly low: Point;
  readonly high: Point;
  private readonly tallest: number;

  constructor(readonly points: readonly Point[]) {
    this.edges = points.map((point, i): Edge => [point, points[(i + 1) % points.length]!]);
    this.edges.sort((a, b) => bottom(a) - bottom(b));
    this.tallest = this.edges.reduce((most, [a, b]) => Math.max(most, Math.abs(a[1] - b[1])), 0) * (1 + 1e-9);
    const bound = (of: (...values: number[]) => number, axis: 0 | 1) =>
      points.reduce((value, point) => of(value, point[axis]), points[0]![axis]);
    this.low = [bound(Math.min, 0), bound(Math.min, 1)];
    this.high = [bound(Math.max, 0), bound(Math.max, 1)];
  }

  // All edges between two heights, and others.
  *at(from: number, to: number): Generator<Edge> {
    let [first, end] = [0, this.edges.length];
    while (first < end) {
      const middle = (first + end) >> 1;
      if (bottom(this.edges[middle]!) < from - this.tallest) first = middle + 1;
      else end = middle;
    }
    for (; first < this.edges.length && bottom(this.edges[first]!) <= to; ++first) yield this.edges[first]!;
  }

  meets(other: Ring): boolean {
    return [0, 1].every((axis) => this.low[axis]! <= other.high[axis]! && other.low[axis]! <= this.high[axis]!);
  }
}

const bottom = ([a, b]: Edge) => Math.min(a[1], b[1]);

// Of p to the line of the edge: positive on its left.
const side = ([a, b]: Edge, p: Point) => (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);

// Whether the insides of two edges cross.
const cross = (e: Edge, f: Edge) => side(e, f[0]) * side(e, f[1]) < 0 && side(f, e[0]) * side(f, e[1]) < 0;

// Two edges of a ring whose insides cross, by their first corners, the lower first.
export function findSelfCrossing(points: readonly Point[]): [number, number] | undefined {
  const edges = points.map((point, i) => ({ i, edge: [point, points[(i + 1) % points.length]!] as Edge }));
  edges.sort((a, b) => bottom(a.edge) - bottom(b.edge));
  let left = mostWork;
  for (const [k, { i, edge }] of edges.entries()) {
    const top = Math.max(edge[0][1], edge[1][1]);
    for (let n = k + 1; n < edges.length && bottom(edges[n]!.edge) <= top; ++n) {
      if (--left < 0) return undefined;
      const { i: j, edge: other } = edges[n]!;
      if (cross(edge, other)) return [Math.min(i, j), Math.max(i, j)];
    }
  }
  return undefined;
}

export function findOverlap(rings: readonly (readonly Point[])[]): RingOverlap | undefined {
  const all = rings.map((ring) => new Ring(ring));
  const work = { left: mostWork };
  for (const [i, ring] of all.entries()) {
    for (let j = 0; j < i; ++j) {
      const other = all[j]!;
      --work.left;
      if (j > 0 && !ring.meets(other)) continue;
      const crossing = findCrossing(ring, other, work);
      if (work.left < 0) return undefined;
      if (crossing) return { ring: i, crossed: j, at: crossing };
      const equal = isSame(ring, other);
      const overlaps =
        j === 0 ? !equal && isInside(ring, other) === false : equal || isInside(ring, other) || isInside(other, ring);
      if (overlaps) return { ring: i, crossed: undefined, at: leftmost(ring.points) };
    }
  }
  return undefined;
}

// The start of an edge of `ring` whose inside crosses that of an edge of `other`.
function findCrossing(ring: Ring, other: Ring, work: { left: number }): Point | undefined {
  for (const edge of other.at(ring.low[1], ring.high[1])) {
    --work.left;
    const [c, d] = edge;
    if (Math.max(c[0], d[0]) < ring.low[0] || Math.min(c[0], d[0]) > ring.high[0]) continue;
    for (const own of ring.at(bottom(edge), Math.max(c[1], d[1]))) {
      if (--work.left < 0) return undefined;
      if (cross(own, edge)) return own[0];
    }
  }
  return undefined;
}

function isSame(a: Ring, b: Ring): boolean {
  if (a.points.length !== b.points.length) return false;
  const known = new Set(a.points.map(String));
  return b.points.every((point) => known.has(String(point)));
}

// Whether a ring that does not cross another one lies in it; undefined if all its corners and the middles of its
// edges are on it.
function isInside(ring: Ring, other: Ring): boolean | undefined {
  const middles = ring.edges.map(([a, b]): Point => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]);
  for (const p of [...ring.points, ...middles]) {
    let inside: boolean | undefined = false;
    for (const edge of other.at(p[1], p[1])) {
      const [a, b] = edge;
      const at = side(edge, p);
      const rounding = 1e-12 * Math.hypot(b[0] - a[0], b[1] - a[1]) * Math.hypot(p[0] - a[0], p[1] - a[1]);
      if (Math.abs(at) <= rounding && (a[0] - p[0]) * (b[0] - p[0]) + (a[1] - p[1]) * (b[1] - p[1]) <= 0) {
        inside = undefined;
        break;
      }
      const crosses = a[1] <= p[1] ? b[1] > p[1] && at > 0 : b[1] <= p[1] && at < 0;
      if (crosses) inside = !inside;
    }
    if (inside !== undefined) return inside;
  }
  return undefined;
}

const leftmost = (points: readonly Point[]) =>
  points.reduce((least, p) => (p[0] < least[0] || (p[0] === least[0] && p[1] < least[1]) ? p : least));
