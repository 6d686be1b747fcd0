// SPDX-License-Identifier: Apache-2.0
// Makes a domain of points, lines and polygons, as GeoJSON and WKT have them, as `weft mesh` does:
//   - With polygons, the points inside an odd number of rings are meshed, so rings of holes are holes.
//   - Lines beside polygons become edges inside. Each is sent twice, because two segments in one
//     place do not change the parity.
//   - With lines alone every bounded face is meshed.
import { FileError } from "./file-error";
import { interiorPoint } from "./interior-point";
import { Labels } from "./names";
import type { PlanarDomain, Point, RegionSeed } from "./planar-domain";

export interface Properties {
  marker: number; // of segments
  region: number | undefined;
  maxArea: number | undefined;
  markerName: string; // empty: none
  regionName: string;
}

export const noProperties: Properties = {
  marker: 0, region: undefined, maxArea: undefined, markerName: "", regionName: "",
};

export class GeometryBuilder {
  private readonly points: number[] = [];
  private readonly segments: number[] = [];
  private readonly markers: number[] = []; // labels
  private readonly markerLabels = new Labels("marker");
  private readonly regionLabels = new Labels("region");
  private readonly lines: { from: number; to: number }[] = []; // of segments
  private readonly regions: RegionSeed[] = []; // their ids are labels
  private filled = false;

  point(at: Point): void {
    this.points.push(...at);
  }

  line(positions: readonly Point[], properties: Properties): void {
    const from = this.markers.length;
    this.chain(positions, false, properties);
    this.lines.push({ from, to: this.markers.length });
  }

  // Each ring ends in its first position.
  polygon(rings: readonly (readonly Point[])[], place: string, properties: Properties): void {
    rings.forEach((ring, i) => {
      const last = ring.at(-1);
      if (!last || last[0] !== ring[0][0] || last[1] !== ring[0][1])
        throw new FileError(`${place}[${i}]`, "is a ring that is not closed");
      if (new Set(ring.map(([x, y]) => `${x} ${y}`)).size < 3)
        throw new FileError(`${place}[${i}]`, "is a ring of fewer than 3 points");
      this.chain(ring.slice(0, -1), true, properties);
    });
    if (rings.length > 0) this.filled = true;
    const { region, regionName, maxArea } = properties;
    if (rings.length === 0 || (region === undefined && !regionName && maxArea === undefined)) return;
    const seed = interiorPoint(rings);
    if (!seed) throw new FileError(place, "is a polygon with a region but without area");
    this.regions.push({ x: seed[0], y: seed[1], id: this.regionLabels.of(region ?? 0, regionName), maxArea });
  }

  finish(name: string): PlanarDomain {
    if (this.points.length === 0) throw new FileError("", "the file holds no geometry");
    if (this.filled)
      for (const { from, to } of this.lines)
        for (let i = from; i < to; ++i) this.segment(this.segments[2 * i], this.segments[2 * i + 1], this.markers[i]);
    const markers = this.markerLabels.numbers();
    const regions = this.regionLabels.numbers();
    const [ofMarkers, ofRegions] = [this.markerLabels.reader, this.regionLabels.reader];
    return {
      name,
      points: Float64Array.from(this.points),
      segments: Uint32Array.from(this.segments),
      markers: Int32Array.from(this.markers, (label) => markers[label]!),
      holes: new Float64Array(),
      regions: this.regions.map((seed) => ({ ...seed, id: regions[seed.id]! })),
      evenOdd: this.filled,
      markerNames: ofMarkers.names,
      regionNames: ofRegions.names,
      warnings: [...ofMarkers.warnings, ...ofRegions.warnings],
    };
  }

  // Positions that repeat the one before are dropped.
  private chain(positions: readonly Point[], closed: boolean, properties: Properties): void {
    const marker = this.markerLabels.of(properties.marker, properties.markerName);
    const first = this.points.length / 2;
    positions.forEach(([x, y], i) => {
      if (i > 0 && x === positions[i - 1][0] && y === positions[i - 1][1]) return;
      const index = this.points.push(x, y) / 2 - 1;
      if (index > first) this.segment(index - 1, index, marker);
    });
    const last = this.points.length / 2 - 1;
    if (closed && last > first) this.segment(last, first, marker);
  }

  private segment(a: number, b: number, marker: number): void {
    this.segments.push(a, b);
    this.markers.push(marker);
  }
}
