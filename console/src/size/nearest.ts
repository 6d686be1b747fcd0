// SPDX-License-Identifier: Apache-2.0
// Distances to the nearest segment of a domain, by a tree of boxes around its segments.
//
//   const distance = nearestOf(segmentEnds(domain)).distance(x, y);

export type Lines = Float64Array; // x, y of both ends of each segment

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
    this.order = Uint32Array.from({ length: lines.length / 4 }, (_, i) => i);
    this.root = this.order.length > 0 ? this.node(0, this.order.length) : undefined;
  }

  // Infinity if there are no segments.
  distance(x: number, y: number): number {
    return this.root ? Math.sqrt(this.below(this.root, x, y, Infinity)) : Infinity;
  }

  private node(from: number, to: number): Node {
    const { lines } = this;
    const box: Node["box"] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = from; i < to; ++i)
      for (const d of [0, 1, 2, 3]) {
        const value = lines[4 * this.order[i] + d];
        box[d % 2] = Math.min(box[d % 2], value);
        box[2 + (d % 2)] = Math.max(box[2 + (d % 2)], value);
      }
    if (to - from <= leaf) return { box, from, to, halves: undefined };
    const along = box[2] - box[0] >= box[3] - box[1] ? 0 : 1;
    const middle = (segment: number) => lines[4 * segment + along] + lines[4 * segment + 2 + along];
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
    const [ax, ay, bx, by] = this.lines.subarray(4 * segment, 4 * segment + 4);
    const [dx, dy] = [bx - ax, by - ay];
    const length = dx * dx + dy * dy;
    const along = length > 0 ? ((x - ax) * dx + (y - ay) * dy) / length : 0;
    const t = Math.min(1, Math.max(0, along));
    const [ex, ey] = [ax + t * dx - x, ay + t * dy - y];
    return ex * ex + ey * ey;
  }
}

function squareTo(box: Node["box"], x: number, y: number): number {
  const dx = Math.max(box[0] - x, 0, x - box[2]);
  const dy = Math.max(box[1] - y, 0, y - box[3]);
  return dx * dx + dy * dy;
}

const known = new WeakMap<Lines, Nearest>();

// Made once for the same ones.
export function nearestOf(lines: Lines): Nearest {
  const made = known.get(lines) ?? new Nearest(lines);
  known.set(lines, made);
  return made;
}
