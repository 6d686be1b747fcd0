// SPDX-License-Identifier: Apache-2.0
// Figures of one triangle.

export interface TriangleFigures {
  area: number; // positive if counter-clockwise
  minAngle: number; // degrees
}

// Angles at a, b and c in degrees.
export function angles(
  ax: number, ay: number, bx: number, by: number, cx: number, cy: number,
): [number, number, number] {
  const at = (px: number, py: number, qx: number, qy: number, rx: number, ry: number) =>
    (Math.atan2(
      Math.abs((qx - px) * (ry - py) - (qy - py) * (rx - px)),
      (qx - px) * (rx - px) + (qy - py) * (ry - py),
    ) * 180) / Math.PI;
  return [at(ax, ay, bx, by, cx, cy), at(bx, by, cx, cy, ax, ay), at(cx, cy, ax, ay, bx, by)];
}

export function figures(
  ax: number, ay: number, bx: number, by: number, cx: number, cy: number,
): TriangleFigures {
  const ux = bx - ax, uy = by - ay, vx = cx - ax, vy = cy - ay, wx = cx - bx, wy = cy - by;
  const twice = ux * vy - uy * vx;
  const u = ux * ux + uy * uy, v = vx * vx + vy * vy, w = wx * wx + wy * wy;
  // The smallest angle lies opposite the shortest edge, and is below 90 degrees.
  const longer = u <= v && u <= w ? v * w : v <= w ? u * w : u * v;
  const sine = longer > 0 ? Math.min(1, Math.abs(twice) / Math.sqrt(longer)) : 0;
  return { area: twice / 2, minAngle: (Math.asin(sine) * 180) / Math.PI };
}

export function contains(
  x: number, y: number, ax: number, ay: number, bx: number, by: number, cx: number, cy: number,
): boolean {
  return (
    (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0 &&
    (cx - bx) * (y - by) - (cy - by) * (x - bx) >= 0 &&
    (ax - cx) * (y - cy) - (ay - cy) * (x - cx) >= 0
  );
}
