// SPDX-License-Identifier: Apache-2.0
import type { GenerateMeshRequest } from "../gen/weft/v1/mesh_service_pb";

export type Names = Map<number, string>; // by the number of the region

// What the request of a mesh calls its regions.
export const regionNamesOf = (request: GenerateMeshRequest | undefined): Names =>
  new Map(request?.domain?.regionNames.map(({ id, name }) => [id, name]));
