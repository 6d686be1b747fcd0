// SPDX-License-Identifier: Apache-2.0
// What the page counts of a mesh while it comes: histograms, and the worst triangles.

export interface WorstTriangle {
  triangle: number; // its number in the mesh
  chunk: number;
  minAngle: number; // degrees
  area: number;
  x: number; // of its centroid
  y: number;
}

export interface Census {
  angles: number[]; // triangles for each 2 degrees of their smallest angle, 30 bins
  // Triangles for each half octave of area; areas[0] begins at 2 ** firstArea.
  areas: number[];
  firstArea: number;
  worst: WorstTriangle[]; // the smallest angle first
}

const worstCount = 10;

export class Counter {
  private readonly angles = new Array<number>(30).fill(0);
  private readonly areas = new Map<number, number>();
  private readonly worst: WorstTriangle[] = [];

  // `place` gives the rest of the triangle, if it is among the worst so far.
  add(area: number, minAngle: number, place: () => Omit<WorstTriangle, "area" | "minAngle">): void {
    ++this.angles[Math.min(29, Math.floor(minAngle / 2))];
    const bin = Math.floor(2 * Math.log2(Math.max(area, 1e-300)));
    this.areas.set(bin, (this.areas.get(bin) ?? 0) + 1);
    if (this.worst.length === worstCount && minAngle >= this.worst[worstCount - 1].minAngle) return;
    const at = this.worst.findIndex((other) => minAngle < other.minAngle);
    this.worst.splice(at < 0 ? this.worst.length : at, 0, { ...place(), area, minAngle });
    this.worst.length = Math.min(this.worst.length, worstCount);
  }

  census(): Census {
    const bins = [...this.areas.keys()];
    const first = bins.length > 0 ? Math.min(...bins) : 0;
    const length = bins.length > 0 ? Math.max(...bins) - first + 1 : 0;
    return {
      angles: [...this.angles],
      areas: Array.from({ length }, (_, i) => this.areas.get(first + i) ?? 0),
      firstArea: first / 2,
      worst: [...this.worst],
    };
  }
}
