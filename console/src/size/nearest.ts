// SPDX-License-Identifier: Apache-2.0
// Distances to the nearest segment of a domain, by a tree of boxes around its segments.
//
//   const distance = nearestOf(domain).distance(x, y);

export interface Lines {
  points: Float64Array; // x0, y0, x1, y1, ...
  segments: Uint32Array; // a0, b0, a1, b1, ...
}

const leaf = 8; // segments, at most

interface Node {
  box: [number, number, number, number];
  from: number; // of its segments in `order`
  to: number;
  halves: [Node, Node] | undefined;
}

export class Nearest {
  private readonly order: Uint32Array; // segments, so that those of a node follow each other
  private readonly root: Node | undefined;

  constructor(private readonly lines: Lines) {
    this.order = Uint32Array.from({ length: lines.segments.length / 2 }, (_, i) => i);
    this.root = this.order.length > 0 ? this.node(0, this.order.length) : undefined;
  }

  // Infinity if there are no segments.
  distance(x: number, y: number): number {
    return this.root ? Math.sqrt(this.below(this.root, x, y, Infinity)) : Infinity;
  }

  private node(from: number, to: number): Node {
    const { points } = this.lines;
    const box: Node["box"] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = from; i < to; ++i)
      for (const vertex of this.ends(this.order[i]))
        for (const d of [0, 1]) {
          box[d] = Math.min(box[d], points[2 * vertex + d]);
          box[d + 2] = Math.max(box[d + 2], points[2 * vertex + d]);
        }
    if (to - from <= leaf) return { box, from, to, halves: undefined };
    const along = box[2] - box[0] >= box[3] - box[1] ? 0 : 1;
    const middle = (segment: number) => {
      const [a, b] = this.ends(segment);
      return points[2 * a + along] + points[2 * b + along];
    };
    this.order.subarray(from, to).sort((a, b) => middle(a) - middle(b));
    const half = (from + to) >> 1;
    return { box, from, to, halves: [this.node(from, half), this.node(half, to)] };
  }

  // The least square of a distance to a node's segments, or `least`.
  private below({ from, to, halves }: Node, x: number, y: number, least: number): number {
    if (halves) {
      const away = halves.map(({ box }) => squareTo(box, x, y));
      const first = away[0] <= away[1] ? 0 : 1;
      for (const i of [first, 1 - first]) if (away[i] < least) least = this.below(halves[i], x, y, least);
      return least;
    }
    for (let i = from; i < to; ++i) least = Math.min(least, this.squareTo(this.order[i], x, y));
    return least;
  }

  private squareTo(segment: number, x: number, y: number): number {
    const { points } = this.lines;
    const [a, b] = this.ends(segment);
    const [dx, dy] = [points[2 * b] - points[2 * a], points[2 * b + 1] - points[2 * a + 1]];
    const length = dx * dx + dy * dy;
    const along = length > 0 ? ((x - points[2 * a]) * dx + (y - points[2 * a + 1]) * dy) / length : 0;
    const t = Math.min(1, Math.max(0, along));
    const [ex, ey] = [points[2 * a] + t * dx - x, points[2 * a + 1] + t * dy - y];
    return ex * ex + ey * ey;
  }

  private ends(segment: number): [number, number] {
    return [this.lines.segments[2 * segment], this.lines.segments[2 * segment + 1]];
  }
}

function squareTo(box: Node["box"], x: number, y: number): number {
  const dx = Math.max(box[0] - x, 0, x - box[2]);
  const dy = Math.max(box[1] - y, 0, y - box[3]);
  return dx * dx + dy * dy;
}

const known = new WeakMap<Lines, Nearest>();

// Made once for each domain.
export function nearestOf(lines: Lines): Nearest {
  const made = known.get(lines) ?? new Nearest(lines);
  known.set(lines, made);
  return made;
}
