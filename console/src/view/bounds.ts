// SPDX-License-Identifier: Apache-2.0
// Bounds on areas that the page knows without the server: numbers, not expressions.
import { Measure, type GenerateMeshRequest } from "../gen/weft/v1/mesh_service_pb";

export interface Bounds {
  everywhere: number | undefined; // in squared units
  regions: ReadonlyMap<number, number>; // by id
}

// Undefined if a bound varies within a region, or if there is none.
export function boundsOf(request: GenerateMeshRequest | undefined): Bounds | undefined {
  const { size, domain } = request ?? {};
  const varies = size?.field.case === "expression" || size?.field.case === "raster";
  if (varies || (size?.cellsAcross ?? 0) > 0 || (size?.gradation ?? 0) > 0) return undefined;
  const constant = size?.field.case === "constant" ? size.field.value : undefined;
  const everywhere =
    constant !== undefined && size?.measure === Measure.EDGE ? (Math.sqrt(3) / 4) * constant ** 2 : constant;
  const regions = new Map<number, number>();
  for (const { id, maxArea } of domain?.regions ?? []) if (maxArea !== undefined) regions.set(id, maxArea);
  return everywhere === undefined && regions.size === 0 ? undefined : { everywhere, regions };
}

// Of a region's triangles; undefined if there is none.
export function boundOf(bounds: Bounds, region: number): number | undefined {
  const both = [bounds.everywhere, bounds.regions.get(region)].filter((bound) => bound !== undefined);
  return both.length > 0 ? Math.min(...both) : undefined;
}

// Logarithms to base 2 for each of the 256 slots of regions, as the renderer wants them. Triangles
// without a bound are far below it.
export function boundLogarithms(bounds: Bounds | undefined, regions: readonly number[]): Float32Array {
  return Float32Array.from({ length: 256 }, (_, slot) => {
    const bound = bounds && slot < regions.length ? boundOf(bounds, regions[slot]) : undefined;
    return bound === undefined ? 100 : Math.log2(bound);
  });
}
