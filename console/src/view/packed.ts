// SPDX-License-Identifier: Apache-2.0
// A chunk's arrays, from the bytes that they are on the wire.
import type { PackedChunk } from "../gen/console/packed_pb";

// A piece of a mesh; vertices are numbered across the mesh.
export interface MeshChunk {
  index: number;
  firstVertex: number;
  firstTriangle: number;
  coordinates: Float64Array; // x, y of the vertices from firstVertex
  triangles: Uint32Array; // three vertices each
  regions: Int32Array; // one for each triangle, or empty if all are 0
  edges: Uint32Array; // two vertices each, on input segments
}

// The bytes are copied: in their message they lie at odd places. Throws if they end within a number.
function copy(bytes: Uint8Array, size: number, what: string): ArrayBuffer {
  if (bytes.length % size !== 0) throw new Error(`${what} end within a number`);
  return bytes.slice().buffer as ArrayBuffer;
}

// Throws unless every array is whole and every vertex is below `vertices` plus the chunk's own.
export function unpackChunk(packed: PackedChunk, vertices: number): MeshChunk {
  const chunk = {
    index: packed.index,
    firstVertex: packed.firstVertex,
    firstTriangle: packed.firstTriangle,
    coordinates: new Float64Array(copy(packed.coordinates, 16, "coordinates")),
    triangles: new Uint32Array(copy(packed.triangles, 12, "triangles")),
    regions: new Int32Array(copy(packed.regions, 4, "regions")),
    edges: new Uint32Array(copy(packed.edges, 8, "edges")),
  };
  if (chunk.firstVertex !== vertices)
    throw new Error(`chunk ${chunk.index} begins at vertex ${chunk.firstVertex} instead of ${vertices}`);
  const end = vertices + chunk.coordinates.length / 2;
  for (const array of [chunk.triangles, chunk.edges])
    for (let i = 0; i < array.length; ++i)
      if (array[i] >= end) throw new Error(`chunk ${chunk.index} refers to vertex ${array[i]} of ${end}`);
  if (chunk.regions.length !== 0 && chunk.regions.length !== chunk.triangles.length / 3)
    throw new Error(`chunk ${chunk.index} has ${chunk.regions.length} regions`);
  return chunk;
}
