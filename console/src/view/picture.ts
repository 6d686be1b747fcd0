// SPDX-License-Identifier: Apache-2.0
// What the graphics card needs of a chunk: its triangles as they are, and an image of it for when
// they are smaller than pixels.
import type { MeshChunk } from "./packed";
import { thumbnailOf } from "./thumbnail";
import { figures } from "./triangle";

export type Box = [minX: number, minY: number, maxX: number, maxY: number];

export interface ChunkPicture {
  index: number;
  triangles: number;
  typicalArea: number; // of the triangle at a random point of the chunk, in squared units
  box: Box;
  // Relative to the middle of the box, so that 32 bits are enough at any zoom.
  positions: Float32Array;
  // Four for each vertex: of the triangle whose third vertex it is, the smallest angle over 60
  // degrees, what is shown of the area from shownLow to shownHigh, the region's slot, the logarithm of
  // the area from logAreaLow to logAreaHigh. If it is the third vertex of none, of one of its triangles.
  values: Uint8Array;
  indices: Uint16Array | Uint32Array;
  logAreaLow: number; // to base 2
  logAreaHigh: number;
  shownLow: number; // logarithms to base 2 of the area, or of the area over its bound
  shownHigh: number;
  // The first three values for each cell of a grid over the box, rows from below, times the covered share
  // of the cell, which comes fourth; the slot is that of one of the triangles.
  grid: Uint8Array;
  gridWidth: number;
  gridHeight: number;
  thumbnail: Uint8Array; // of the grid, see thumbnailOf
}

export const anglePart = (degrees: number) => Math.round((255 * Math.min(degrees, 60)) / 60);

// Slots of regions, which a byte can hold: 0 for region 0, then in the order in which they come.
export class RegionSlots {
  readonly ids: number[] = [0];
  private readonly slots = new Map<number, number>([[0, 0]]);

  slot(id: number): number {
    let slot = this.slots.get(id);
    if (slot === undefined) {
      slot = this.ids.length < 256 ? this.ids.push(id) - 1 : 1 + (Math.abs(id) % 255);
      this.slots.set(id, slot);
    }
    return slot;
  }
}

// A chunk's vertices on the graphics card: its own and those of earlier chunks, each once.
export class LocalVertices {
  readonly globals: number[] = [];
  private readonly own: Int32Array;
  private readonly others = new Map<number, number>();

  constructor(private readonly chunk: MeshChunk) {
    this.own = new Int32Array(chunk.coordinates.length / 2).fill(-1);
    for (const vertex of chunk.triangles) this.add(vertex);
  }

  of(vertex: number): number {
    const at = vertex - this.chunk.firstVertex;
    return at >= 0 ? this.own[at] : (this.others.get(vertex) ?? -1);
  }

  private add(vertex: number): void {
    if (this.of(vertex) >= 0) return;
    const at = vertex - this.chunk.firstVertex;
    const local = this.globals.push(vertex) - 1;
    if (at >= 0) this.own[at] = local;
    else this.others.set(vertex, local);
  }
}

// Of the area over its bound: a byte tells what lies between well enough.
const leastRatio = -8;
const mostRatio = 3;

// From the least to the greatest of some values, as a byte has them.
class Scale {
  readonly low: number;
  readonly high: number;
  private readonly spread: number;

  constructor(values: Float32Array) {
    this.low = values.reduce((least, value) => Math.min(least, value), Infinity);
    this.high = values.reduce((most, value) => Math.max(most, value), -Infinity);
    this.spread = this.high > this.low ? 255 / (this.high - this.low) : 0;
  }

  at(value: number): number {
    return (value - this.low) * this.spread;
  }
}

const gridCells = 256; // at most, along the longer side of the box
// Coverage from which a cell counts as full.
const fullFrom = 0.35;
const beside = [[-1, 0], [1, 0], [0, -1], [0, 1], [-1, -1], [1, -1], [-1, 1], [1, 1]];

// Undefined if the chunk has no triangles. `coordinates` are those of the whole mesh so far;
// `visit` is told of each triangle. With `over`, areas over these bounds, one for
// each triangle, are shown instead of areas.
export function pictureOf(
  chunk: MeshChunk,
  coordinates: Float64Array,
  slots: RegionSlots,
  visit: (triangle: number, area: number, minAngle: number) => void,
  over?: ArrayLike<number>,
): ChunkPicture | undefined {
  const count = chunk.triangles.length / 3;
  if (count === 0) return undefined;
  const local = new LocalVertices(chunk);
  const box = boxOf(local.globals, coordinates);
  const middleX = (box[0] + box[2]) / 2;
  const middleY = (box[1] + box[3]) / 2;

  const angle = new Float32Array(count);
  const logArea = new Float32Array(count);
  const shown = over ? new Float32Array(count) : logArea;
  let area = 0;
  let squares = 0;
  for (let t = 0; t < count; ++t) {
    const a = 2 * chunk.triangles[3 * t], b = 2 * chunk.triangles[3 * t + 1], c = 2 * chunk.triangles[3 * t + 2];
    const f = figures(
      coordinates[a], coordinates[a + 1], coordinates[b], coordinates[b + 1], coordinates[c], coordinates[c + 1],
    );
    visit(t, f.area, f.minAngle);
    area += f.area;
    squares += f.area * f.area;
    angle[t] = f.minAngle;
    logArea[t] = Math.log2(Math.max(f.area, 1e-300));
    if (!over) continue;
    const ratio = Math.log2(f.area / over[t]);
    shown[t] = Math.min(Math.max(Number.isNaN(ratio) ? -Infinity : ratio, leastRatio), mostRatio);
  }
  const areas = new Scale(logArea);
  const shades = over ? new Scale(shown) : areas;

  // A triangle's values are those of its third vertex, so each needs one of its own: one of its
  // corners that no other has taken, or a copy.
  const indices = new Uint32Array(3 * count);
  const claimed = new Uint8Array(local.globals.length);
  const copies: number[] = [];
  const owner = new Int32Array(local.globals.length + count); // the triangle of a claimed vertex, plus 1
  const touching = new Int32Array(local.globals.length); // any triangle of a vertex
  for (let t = 0; t < count; ++t) {
    const corners = [0, 1, 2].map((i) => local.of(chunk.triangles[3 * t + i]));
    for (const corner of corners) touching[corner] = t;
    const free = corners.findIndex((corner) => !claimed[corner]);
    const turn = free < 0 ? 0 : (free + 1) % 3;
    let last = corners[(turn + 2) % 3];
    if (free < 0) last = local.globals.length + copies.push(last) - 1;
    else claimed[last] = 1;
    owner[last] = t + 1;
    indices[3 * t] = corners[turn];
    indices[3 * t + 1] = corners[(turn + 1) % 3];
    indices[3 * t + 2] = last;
  }
  const vertices = local.globals.length + copies.length;
  const positions = new Float32Array(2 * vertices);
  const values = new Uint8Array(4 * vertices);
  const slotOf = (t: number) => (chunk.regions.length > 0 ? slots.slot(chunk.regions[t]) : 0);
  for (let v = 0; v < vertices; ++v) {
    const global = local.globals[v < local.globals.length ? v : copies[v - local.globals.length]];
    positions[2 * v] = coordinates[2 * global] - middleX;
    positions[2 * v + 1] = coordinates[2 * global + 1] - middleY;
    const t = owner[v] > 0 ? owner[v] - 1 : touching[v];
    values[4 * v] = anglePart(angle[t]);
    values[4 * v + 1] = Math.round(shades.at(shown[t]));
    values[4 * v + 2] = slotOf(t);
    values[4 * v + 3] = Math.round(areas.at(logArea[t]));
  }

  const width = box[2] - box[0];
  const height = box[3] - box[1];
  const most = Math.min(gridCells, Math.max(8, Math.ceil(1.2 * Math.sqrt(count))));
  const cell = Math.max(width, height) / most || 1;
  const grid = new Grid(Math.max(1, Math.ceil(width / cell)), Math.max(1, Math.ceil(height / cell)));
  const fx = grid.width / (width || 1);
  const fy = grid.height / (height || 1);
  for (let t = 0; t < count; ++t) {
    const at = (i: number, d: number) => coordinates[2 * chunk.triangles[3 * t + i] + d] - box[d];
    grid.add(
      at(0, 0) * fx, at(0, 1) * fy, at(1, 0) * fx, at(1, 1) * fy, at(2, 0) * fx, at(2, 1) * fy,
      anglePart(angle[t]), shades.at(shown[t]), slotOf(t),
    );
  }
  const pixels = grid.pixels();
  return {
    index: chunk.index,
    triangles: count,
    typicalArea: area > 0 ? squares / area : 0,
    box,
    positions,
    values,
    indices: vertices <= 65536 ? Uint16Array.from(indices) : indices,
    logAreaLow: areas.low,
    logAreaHigh: areas.high,
    shownLow: shades.low,
    shownHigh: shades.high,
    grid: pixels,
    gridWidth: grid.width,
    gridHeight: grid.height,
    thumbnail: thumbnailOf(pixels, grid.width, grid.height),
  };
}

// Vertices of lines, in the picture's numbering: first the edges inside, then those on segments.
export function linesOf(chunk: MeshChunk): { lines: Uint32Array; inside: number } {
  const local = new LocalVertices(chunk);
  const lines: number[] = [];
  for (let i = 0; i < chunk.triangles.length; ++i) {
    const a = chunk.triangles[i];
    const b = chunk.triangles[i % 3 === 2 ? i - 2 : i + 1];
    // An edge inside has a triangle on either side, and comes in both directions.
    if (a < b) lines.push(local.of(a), local.of(b));
  }
  const inside = lines.length;
  for (let i = 0; i < chunk.edges.length; i += 2) {
    const a = local.of(chunk.edges[i]);
    const b = local.of(chunk.edges[i + 1]);
    if (a >= 0 && b >= 0) lines.push(a, b);
  }
  return { lines: Uint32Array.from(lines), inside };
}

function boxOf(vertices: number[], coordinates: Float64Array): Box {
  const box: Box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const vertex of vertices) {
    const x = coordinates[2 * vertex];
    const y = coordinates[2 * vertex + 1];
    if (x < box[0]) box[0] = x;
    if (y < box[1]) box[1] = y;
    if (x > box[2]) box[2] = x;
    if (y > box[3]) box[3] = y;
  }
  return box;
}

// Sums over cells of 1 x 1, weighted by area. A triangle smaller than a cell counts where its centroid
// lies, a larger one in each cell whose middle it covers.
export class Grid {
  private readonly sums: Float32Array; // angle, area, weight of each cell
  private readonly slots: Uint8Array;

  constructor(
    readonly width: number,
    readonly height: number,
  ) {
    this.sums = new Float32Array(3 * width * height);
    this.slots = new Uint8Array(width * height);
  }

  add(
    ax: number, ay: number, bx: number, by: number, cx: number, cy: number,
    angle: number, area: number, slot: number,
  ): void {
    const weight = Math.abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2;
    const left = Math.min(ax, bx, cx), right = Math.max(ax, bx, cx);
    const low = Math.min(ay, by, cy), high = Math.max(ay, by, cy);
    if (right - left < 0.75 && high - low < 0.75) {
      this.put((ax + bx + cx) / 3, (ay + by + cy) / 3, weight, angle, area, slot);
      return;
    }
    for (let y = Math.ceil(low - 0.5) + 0.5; y < high; ++y) {
      // The stretch of this row inside: between the crossings of the edges with it.
      let from = Infinity, to = -Infinity;
      const cross = (px: number, py: number, qx: number, qy: number) => {
        if (py < y === qy < y) return;
        const x = px + ((y - py) / (qy - py)) * (qx - px);
        from = Math.min(from, x);
        to = Math.max(to, x);
      };
      cross(ax, ay, bx, by);
      cross(bx, by, cx, cy);
      cross(cx, cy, ax, ay);
      for (let x = Math.ceil(from - 0.5) + 0.5; x < to; ++x) this.put(x, y, 1, angle, area, slot);
    }
  }

  private put(x: number, y: number, weight: number, angle: number, area: number, slot: number): void {
    const column = Math.min(this.width - 1, Math.max(0, Math.floor(x)));
    const row = Math.min(this.height - 1, Math.max(0, Math.floor(y)));
    const at = row * this.width + column;
    this.sums[3 * at] += weight * angle;
    this.sums[3 * at + 1] += weight * area;
    this.sums[3 * at + 2] += weight;
    this.slots[at] = slot;
  }

  pixels(): Uint8Array {
    const pixels = new Uint8Array(4 * this.slots.length);
    for (let at = 0; at < this.slots.length; ++at) {
      const weight = this.sums[3 * at + 2];
      if (weight === 0) continue;
      const covered = Math.min(1, weight / fullFrom);
      pixels[4 * at] = Math.round((this.sums[3 * at] / weight) * covered);
      pixels[4 * at + 1] = Math.round((this.sums[3 * at + 1] / weight) * covered);
      pixels[4 * at + 2] = this.slots[at];
      pixels[4 * at + 3] = Math.max(1, Math.round(255 * covered));
    }
    return this.widened(pixels);
  }

  // Cells beside covered ones take their values, so that neighbouring chunks leave no seam.
  private widened(pixels: Uint8Array): Uint8Array {
    const wide = pixels.slice();
    for (let y = 0; y < this.height; ++y)
      for (let x = 0; x < this.width; ++x) {
        const at = y * this.width + x;
        if (pixels[4 * at + 3] === 255) continue;
        for (const [dx, dy] of beside) {
          const from = at + dy * this.width + dx;
          const inside = x + dx >= 0 && x + dx < this.width && y + dy >= 0 && y + dy < this.height;
          if (!inside || pixels[4 * from + 3] !== 255) continue;
          wide.set(pixels.subarray(4 * from, 4 * from + 4), 4 * at);
          break;
        }
      }
    return wide;
  }
}
