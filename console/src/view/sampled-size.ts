// SPDX-License-Identifier: Apache-2.0
// What the size of a request asks for at places, as the server tells it before there is a mesh: on a grid
// for the picture behind the domain, and at the centroids of triangles.
import { clone } from "@bufbuild/protobuf";
import type { CallOptions, Client } from "@connectrpc/connect";
import { GenerateMeshRequestSchema, Measure, type GenerateMeshRequest, type MeshService } from "../gen/weft/v1/mesh_service_pb";
import { scaleColour } from "./colours";
import type { Box } from "./picture";

// Points that a request may have.
export const mostPoints = 262_144;

export interface SampledSize {
  // On areas, in squared units; Infinity for none, NaN outside of the domain, 0 where the size alone is none.
  bounds: number[];
  triangles: number; // that the mesh will have, about
}

// `points`: x, y of each; mostPoints at most. Undefined if the server samples no sizes.
export async function sampleSize(
  client: Pick<Client<typeof MeshService>, "generateMesh">,
  request: GenerateMeshRequest,
  points: number[],
  options: CallOptions,
): Promise<SampledSize | undefined> {
  const asked = clone(GenerateMeshRequestSchema, request);
  asked.samplePoints = points;
  asked.wantQuadtree = false;
  asked.noCache = true; // nobody asks for the same again
  for await (const { message } of client.generateMesh(asked, options))
    if (message.case === "summary") {
      const { sampledBounds: bounds, expectedTriangles } = message.value;
      return bounds.length > 0 ? { bounds, triangles: Number(expectedTriangles) } : undefined;
    }
  return undefined;
}

export interface Grid {
  box: Box;
  columns: number;
  rows: number;
}

const longest = 160; // cells along the longer side, at most

export function gridOver(box: Box): Grid {
  const [width, height] = [box[2] - box[0], box[3] - box[1]];
  const cell = Math.max(width, height) / longest;
  const cells = (length: number) => Math.max(1, Math.ceil(length / cell) || 1);
  return { box, columns: cells(width), rows: cells(height) };
}

// The middles of the cells, the top row first.
export function middlesOf({ box, columns, rows }: Grid): number[] {
  const points: number[] = [];
  for (let row = 0; row < rows; ++row)
    for (let column = 0; column < columns; ++column)
      points.push(
        box[0] + ((column + 0.5) * (box[2] - box[0])) / columns,
        box[3] - ((row + 0.5) * (box[3] - box[1])) / rows,
      );
  return points;
}

export interface HeatMap {
  box: Box;
  pixels: ImageData; // the top row first
  low: number; // what the ends of the scale mean, logarithmically between them
  high: number;
}

// The lengths of edges or the areas at the middles of the cells. Undefined if they are the same everywhere.
export function heatMapOf(grid: Grid, bounds: number[], measure: Measure): HeatMap | undefined {
  const values = measure === Measure.EDGE ? bounds.map((area) => Math.sqrt((4 / Math.sqrt(3)) * area)) : bounds;
  const known = values.filter((value) => value > 0 && value < Infinity);
  const low = known.reduce((least, value) => Math.min(least, value), Infinity);
  const high = known.reduce((most, value) => Math.max(most, value), 0);
  if (!(high > low * (1 + 1e-9))) return undefined;
  const pixels = new ImageData(grid.columns, grid.rows);
  values.forEach((_, i) => {
    const value = near(values, grid, i);
    if (!(value < Infinity)) return;
    pixels.data.set([...scaleColour("area", Math.log(Math.max(value, low) / low) / Math.log(high / low)), 255], 4 * i);
  });
  return { box: grid.box, pixels, low, high };
}

// The value of a cell; if its middle is outside of the domain, that of one beside it, which may be inside.
function near(values: number[], { columns, rows }: Grid, i: number): number {
  if (!Number.isNaN(values[i])) return values[i];
  const [row, column] = [Math.floor(i / columns), i % columns];
  for (const [down, right] of [[0, 1], [0, -1], [1, 0], [-1, 0], [1, 1], [1, -1], [-1, 1], [-1, -1]]) {
    const inside = row + down >= 0 && row + down < rows && column + right >= 0 && column + right < columns;
    const value = inside ? values[i + down * columns + right] : NaN;
    if (!Number.isNaN(value)) return value;
  }
  return NaN;
}
