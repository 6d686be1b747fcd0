// SPDX-License-Identifier: Apache-2.0
// A point inside a polygon, far from its border: the middle of the longest stretch inside on one of a
// few horizontal lines. Undefined if the polygon has no area.
import type { Point } from "./planar-domain";

const heights = [0.5, 0.37, 0.63, 0.23, 0.77, 0.11, 0.89, 0.03, 0.97];

export function interiorPoint(rings: readonly (readonly Point[])[]): Point | undefined {
  let low = Infinity, high = -Infinity, left = Infinity, right = -Infinity;
  for (const ring of rings)
    for (const [x, y] of ring) {
      left = Math.min(left, x);
      right = Math.max(right, x);
      low = Math.min(low, y);
      high = Math.max(high, y);
    }
  let best: Point | undefined;
  let longest = 1e-12 * (right - left); // below that it is rounding
  for (const share of heights) {
    const y = low + share * (high - low);
    const crossings = crossingsAt(y, rings);
    for (let i = 0; i + 1 < crossings.length; i += 2) {
      const length = crossings[i + 1] - crossings[i];
      if (length <= longest) continue;
      longest = length;
      best = [(crossings[i] + crossings[i + 1]) / 2, y];
    }
  }
  return best;
}

// x of where the rings cross a height, in ascending order.
function crossingsAt(y: number, rings: readonly (readonly Point[])[]): number[] {
  const found: number[] = [];
  for (const ring of rings)
    ring.forEach(([ax, ay], i) => {
      const [bx, by] = ring[(i + 1) % ring.length];
      if (ay <= y !== by <= y) found.push(ax + ((y - ay) / (by - ay)) * (bx - ax));
    });
  return found.sort((a, b) => a - b);
}
