// SPDX-License-Identifier: Apache-2.0
// The size that the form asks for, on a grid over the domain, before there is a mesh: without
// gradation and edges across, which only lower it, and without the bounds of regions.
import type { Domain } from "../gen/weft/v1/mesh_service_pb";
import type { FormText } from "../request/form";
import { scaleColour } from "../view/colours";
import type { Box } from "../view/picture";
import { compile } from "./expression";
import { nearestOf, type Lines } from "./nearest";

export interface HeatMap {
  box: Box;
  pixels: ImageData; // the top row first
  low: number; // what the ends of the scale mean, logarithmically between them
  high: number;
}

const longest = 160; // cells along the longer side, at most

// Undefined if the size is a number or none, or if the page cannot compute it.
export function heatMapOf(form: FormText, domain: Domain, lines: Lines, box: Box | undefined): HeatMap | undefined {
  if (form.sizeKind === "none" || !box || Number.isFinite(Number(form.size))) return undefined;
  const value = compile(form.size, ["distance"]);
  if (!value) return undefined;
  const [width, height] = [box[2] - box[0], box[3] - box[1]];
  const nearest = /\bdistance\b/.test(form.size) ? nearestOf(lines) : undefined;
  const cell = Math.max(width, height) / longest;
  if (!(cell > 0) || !(width > 0) || !(height > 0)) return undefined;
  const columns = Math.max(1, Math.ceil(width / cell));
  const rows = Math.max(1, Math.ceil(height / cell));

  const values = new Float64Array(columns * rows);
  const field = [0];
  let low = Infinity; // in the domain
  let high = 0;
  for (let row = 0; row < rows; ++row) {
    const y = box[3] - ((row + 0.5) * height) / rows;
    const inside = stretches(domain, y);
    for (let column = 0; column < columns; ++column) {
      const x = box[0] + ((column + 0.5) * width) / columns;
      if (nearest) field[0] = nearest.distance(x, y);
      const size = value(x, y, field);
      values[row * columns + column] = size;
      if (!(size > 0 && size < Infinity) || !inside.some(([from, to]) => x >= from && x <= to)) continue;
      low = Math.min(low, size);
      high = Math.max(high, size);
    }
  }
  if (high === 0) return undefined;
  const pixels = new ImageData(columns, rows);
  values.forEach((size, i) => {
    if (!(size > 0) || size === Infinity) return;
    const t = high > low ? Math.log(size / low) / Math.log(high / low) : 0.5;
    pixels.data.set([...scaleColour("area", t), 255], 4 * i);
  });
  return { box, pixels, low, high };
}

// Of a horizontal line, what is in the domain: of each area, as parity tells; without areas, all between
// the first and the last crossing.
function stretches({ points, segments, areas, segmentAreas }: Domain, y: number): [number, number][] {
  const found: number[][] = Array.from({ length: areas.length + 1 }, () => []); // of lines, then of areas
  for (let i = 0; i < segments.length; i += 2) {
    const [a, b] = [2 * segments[i], 2 * segments[i + 1]];
    if (points[a + 1] <= y === points[b + 1] <= y) continue;
    const x = points[a] + ((y - points[a + 1]) / (points[b + 1] - points[a + 1])) * (points[b] - points[a]);
    found[segmentAreas[i / 2] ?? 0].push(x);
  }
  for (const xs of found) xs.sort((a, b) => a - b);
  const lines = found[0];
  if (areas.length === 0) return lines.length < 2 ? [] : [[lines[0], lines[lines.length - 1]]];
  return found.slice(1).flatMap((xs) =>
    Array.from({ length: xs.length >> 1 }, (_, i): [number, number] => [xs[2 * i], xs[2 * i + 1]]),
  );
}
