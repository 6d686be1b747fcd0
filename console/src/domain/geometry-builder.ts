// SPDX-License-Identifier: Apache-2.0
// Makes a domain of points, lines and polygons, as GeoJSON and WKT have them, as `weft mesh` does:
//   - With polygons, the points inside an odd number of rings are meshed, so rings of holes are holes.
//   - Lines beside polygons become edges inside. Each is sent twice, because two segments in one
//     place do not change the parity.
//   - With lines alone every bounded face is meshed.
import { FileError } from "./file-error";
import { interiorPoint } from "./interior-point";
import { LeftOut } from "./left-out";
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

const same = (a: Point, b: Point) => a[0] === b[0] && a[1] === b[1];

// Whether there are fewer than 3 distinct positions.
const isCollapsed = (ring: readonly Point[]) => new Set(ring.map(([x, y]) => `${x} ${y}`)).size < 3;

export class GeometryBuilder {
  private readonly points: number[] = [];
  private readonly segments: number[] = [];
  private readonly markers: number[] = []; // labels
  private readonly markerLabels = new Labels("marker");
  private readonly regionLabels = new Labels("region");
  private readonly lines: { from: number; to: number }[] = []; // of segments
  private readonly regions: RegionSeed[] = []; // their ids are labels
  private filled = false;
  readonly leftOut = new LeftOut();

  point(at: Point): void {
    this.points.push(...at);
  }

  line(positions: readonly Point[], place: string, properties: Properties): void {
    if (positions.every((position) => same(position, positions[0]))) {
      this.markerLabels.of(properties.marker, properties.markerName); // as the command line numbers names
      return this.leftOut.add("line", place);
    }
    const from = this.markers.length;
    this.chain(positions, false, properties);
    this.lines.push({ from, to: this.markers.length });
  }

  // Each ring ends in its first position. The holes of a ring that is left out are left out, too.
  polygon(rings: readonly (readonly Point[])[], place: string, properties: Properties): void {
    const kept: (readonly Point[])[] = [];
    for (const [i, ring] of rings.entries()) {
      if (isCollapsed(ring)) {
        this.markerLabels.of(properties.marker, properties.markerName);
        this.leftOut.add("ring", `${place}[${i}]`);
        if (i === 0) return;
        continue;
      }
      if (!same(ring[0], ring[ring.length - 1])) throw new FileError(`${place}[${i}]`, "is a ring that is not closed");
      this.chain(ring.slice(0, -1), true, properties);
      kept.push(ring);
    }
    if (kept.length > 0) this.filled = true;
    const { region, regionName, maxArea } = properties;
    if (kept.length === 0 || (region === undefined && !regionName && maxArea === undefined)) return;
    const seed = interiorPoint(kept);
    if (!seed) return this.leftOut.add("region", place);
    this.regions.push({ x: seed[0], y: seed[1], id: this.regionLabels.of(region ?? 0, regionName), maxArea });
  }

  finish(name: string): PlanarDomain {
    const leftOut = this.leftOut.sentence();
    if (this.points.length === 0) throw new FileError("", `the file holds no geometry${leftOut && `: ${leftOut}`}`);
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
      warnings: [...(leftOut ? [leftOut] : []), ...ofMarkers.warnings, ...ofRegions.warnings],
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
