// SPDX-License-Identifier: Apache-2.0
// The chunks of a mesh as they came, for questions about single triangles.
import type { MeshChunk } from "./packed";
import { angles, contains, figures } from "./triangle";

export interface PickedTriangle {
  triangle: number; // its number in the mesh
  chunk: number;
  region: number;
  corners: [number, number][];
  vertices: [number, number, number];
  angles: [number, number, number]; // degrees, at the corners
  area: number;
  // Across the edge from each corner to the next; undefined on the border, and while it has not come.
  neighbours: (number | undefined)[];
}

interface Kept {
  chunk: MeshChunk;
  box: [number, number, number, number];
}

export class MeshStore {
  vertices = 0;
  triangles = 0;
  coordinates = new Float64Array(1 << 16);
  private readonly kept = new Map<number, Kept>();

  // Takes the vertices in; keep() takes the triangles, once their box is known.
  add(chunk: MeshChunk): void {
    const end = 2 * this.vertices + chunk.coordinates.length;
    if (end > this.coordinates.length) {
      const larger = new Float64Array(Math.max(end, 2 * this.coordinates.length));
      larger.set(this.coordinates.subarray(0, 2 * this.vertices));
      this.coordinates = larger;
    }
    this.coordinates.set(chunk.coordinates, 2 * this.vertices);
    this.vertices += chunk.coordinates.length / 2;
    this.triangles += chunk.triangles.length / 3;
  }

  keep(chunk: MeshChunk, box: [number, number, number, number]): void {
    this.kept.set(chunk.index, { chunk, box });
  }

  chunk(index: number): MeshChunk | undefined {
    return this.kept.get(index)?.chunk;
  }

  // In the order in which they came; those that come meanwhile, too.
  *chunks(): Generator<MeshChunk> {
    for (const { chunk } of this.kept.values()) yield chunk;
  }

  // The triangle at a point; undefined if there is none.
  pick(x: number, y: number): PickedTriangle | undefined {
    for (const { chunk, box } of this.kept.values()) {
      if (x < box[0] || y < box[1] || x > box[2] || y > box[3]) continue;
      for (let t = 0; t < chunk.triangles.length / 3; ++t) {
        const [a, b, c] = this.corners(chunk, t);
        if (contains(x, y, a[0], a[1], b[0], b[1], c[0], c[1])) return this.describe(chunk, t);
      }
    }
    return undefined;
  }

  // By its number in the mesh.
  find(triangle: number): PickedTriangle | undefined {
    for (const { chunk } of this.kept.values()) {
      const t = triangle - chunk.firstTriangle;
      if (t >= 0 && t < chunk.triangles.length / 3) return this.describe(chunk, t);
    }
    return undefined;
  }

  private corners(chunk: MeshChunk, t: number): [number, number][] {
    return [0, 1, 2].map((i) => {
      const vertex = chunk.triangles[3 * t + i];
      return [this.coordinates[2 * vertex], this.coordinates[2 * vertex + 1]];
    });
  }

  private describe(chunk: MeshChunk, t: number): PickedTriangle {
    const corners = this.corners(chunk, t);
    const [[ax, ay], [bx, by], [cx, cy]] = corners;
    const vertices = [0, 1, 2].map((i) => chunk.triangles[3 * t + i]) as [number, number, number];
    return {
      triangle: chunk.firstTriangle + t,
      chunk: chunk.index,
      region: chunk.regions.length > 0 ? chunk.regions[t] : 0,
      corners,
      vertices,
      angles: angles(ax, ay, bx, by, cx, cy),
      area: figures(ax, ay, bx, by, cx, cy).area,
      neighbours: vertices.map((from, i) => this.withEdge(vertices[(i + 1) % 3], from)),
    };
  }

  // The triangle that has the edge in this direction.
  private withEdge(from: number, to: number): number | undefined {
    const x = (this.coordinates[2 * from] + this.coordinates[2 * to]) / 2;
    const y = (this.coordinates[2 * from + 1] + this.coordinates[2 * to + 1]) / 2;
    for (const { chunk, box } of this.kept.values()) {
      if (x < box[0] || y < box[1] || x > box[2] || y > box[3]) continue;
      const { triangles } = chunk;
      for (let i = 0; i < triangles.length; ++i)
        if (triangles[i] === from && triangles[i % 3 === 2 ? i - 2 : i + 1] === to)
          return chunk.firstTriangle + Math.floor(i / 3);
    }
    return undefined;
  }
}
