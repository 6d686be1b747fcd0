// SPDX-License-Identifier: Apache-2.0
// Bounds on areas that the page knows without the server: a number, or an expression that it can
// evaluate, and those of regions.
import { Measure, type GenerateMeshRequest } from "../gen/weft/v1/mesh_service_pb";
import { compile } from "../size/expression";
import { nearestOf, type Lines } from "../size/nearest";

export interface Bounds {
  everywhere: number | Expression | undefined; // a number in squared units
  regions: ReadonlyMap<number, number>; // by id
}

interface Expression {
  text: string;
  isEdge: boolean; // whether its values are lengths of edges instead of areas
  lines: Lines; // of the domain, for `distance`
}

// In squared units; what is not above 0 is no bound.
export type BoundOf = (x: number, y: number, region: number) => number;

const areaOfEdge = (edge: number) => (Math.sqrt(3) / 4) * edge ** 2;

// Undefined if there is no bound, or if the server alone can compute it: from gradation, edges across,
// rasters and the local width.
export function boundsOf(request: GenerateMeshRequest | undefined, lines: Lines): Bounds | undefined {
  const { size, domain } = request ?? {};
  if ((size?.cellsAcross ?? 0) > 0 || (size?.gradation ?? 0) > 0) return undefined;
  const isEdge = size?.measure === Measure.EDGE;
  let everywhere: Bounds["everywhere"];
  switch (size?.field.case) {
    case "constant":
      everywhere = isEdge ? areaOfEdge(size.field.value) : size.field.value;
      break;
    case "expression":
      if (!compile(size.field.value, ["distance"])) return undefined;
      everywhere = { text: size.field.value, isEdge, lines };
      break;
    case "raster":
      return undefined;
  }
  const regions = new Map<number, number>();
  for (const { id, maxArea } of domain?.regions ?? []) if (maxArea !== undefined) regions.set(id, maxArea);
  return everywhere === undefined && regions.size === 0 ? undefined : { everywhere, regions };
}

// Whether triangles of one region have different bounds.
export const varies = (bounds: Bounds | undefined): boolean => typeof bounds?.everywhere === "object";

// At a triangle's centroid, Infinity if there is none. Its expression is compiled once.
export function boundFunction({ everywhere, regions }: Bounds): BoundOf {
  const inRegion = (region: number) => regions.get(region) ?? Infinity;
  if (typeof everywhere !== "object")
    return (_x, _y, region) => Math.min(everywhere ?? Infinity, inRegion(region));
  const { text, isEdge, lines } = everywhere;
  const value = compile(text, ["distance"]);
  if (!value) return (_x, _y, region) => inRegion(region);
  const nearest = /\bdistance\b/.test(text) ? nearestOf(lines) : undefined;
  const fields = [0];
  return (x, y, region) => {
    if (nearest) fields[0] = nearest.distance(x, y);
    const size = value(x, y, fields);
    return Math.min(isEdge ? areaOfEdge(size) : size, inRegion(region));
  };
}

// Logarithms to base 2 for each of the 256 slots of regions, as the renderer wants them. Triangles
// without a bound are far below it. If bounds vary, pictures hold areas over them, and these are 0.
export function boundLogarithms(bounds: Bounds | undefined, regions: readonly number[]): Float32Array {
  const logarithms = new Float32Array(256);
  if (varies(bounds)) return logarithms;
  const bound = bounds && boundFunction(bounds);
  return logarithms.map((_, slot) => {
    const most = bound && slot < regions.length ? bound(0, 0, regions[slot]) : Infinity;
    return most === Infinity ? 100 : Math.log2(most);
  });
}
