// SPDX-License-Identifier: Apache-2.0
// The bound on the area of a single triangle, also if the size is an expression.
import type { Domain } from "../gen/weft/v1/mesh_service_pb";
import type { FormText } from "../request/form";
import { compile } from "./expression";
import { nearestOf, type Lines } from "./nearest";

// The bound at a centroid, in squared units. It may be lower still if `isExact` is false: gradation and
// edges across are the server's to compute.
export interface PlaceBound {
  area: number;
  isExact: boolean;
}

// `lines`: of the domain. Undefined if there is no bound, or if the page cannot compute it.
export function boundAt(form: FormText, domain: Domain, lines: Lines, [x, y]: [number, number], region: number): PlaceBound | undefined {
  const bounds = domain.regions.filter(({ id }) => id === region).map(({ maxArea }) => maxArea ?? Infinity);
  if (form.sizeKind !== "none") {
    const value = compile(form.size, ["distance"]);
    if (!value) return undefined;
    const size = value(x, y, [nearestOf(lines).distance(x, y)]);
    bounds.push(form.sizeKind === "edge" ? (Math.sqrt(3) / 4) * size ** 2 : size);
  }
  const area = Math.min(...bounds);
  const isExact = form.gradation.trim() === "" && form.cellsAcross.trim() === "";
  return area > 0 && area < Infinity ? { area, isExact } : undefined;
}
