// SPDX-License-Identifier: Apache-2.0
// Makes a domain of points, lines and polygons, as GeoJSON and WKT have them, as `weft mesh` does:
//   - With polygons, what any of them covers is meshed. Each is an area of its own: the points inside an
//     odd number of its rings. So rings of holes are holes, and polygons may overlap.
//   - Lines beside polygons become edges inside.
//   - With lines alone every bounded face is meshed.
import { FileError } from "./file-error";
import { LeftOut } from "./left-out";
import { Labels } from "./names";
import type { Area, PlanarDomain, Point } from "./planar-domain";
import { findOverlap, findSelfCrossing } from "./ring-overlap";

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

const mostTold = 5; // of each kind

const same = (a: Point, b: Point) => a[0] === b[0] && a[1] === b[1];

// Whether there are fewer than 3 distinct positions.
const isCollapsed = (ring: readonly Point[]) => new Set(ring.map(([x, y]) => `${x} ${y}`)).size < 3;

export class GeometryBuilder {
  private readonly points: number[] = [];
  private readonly segments: number[] = [];
  private readonly markers: number[] = []; // labels
  private readonly markerLabels = new Labels("marker");
  private readonly regionLabels = new Labels("region");
  private readonly borders: number[] = []; // of segments
  private readonly areas: Area[] = []; // their regions are labels
  readonly leftOut = new LeftOut();
  private readonly oddProperties: string[] = []; // sentences
  private readonly open: string[] = []; // sentences
  private readonly crossings: string[] = []; // sentences
  private readonly overlaps: string[] = []; // sentences

  // A property that counts for nothing, with what it is.
  leaveOutProperty(path: string, what: string): void {
    this.oddProperties.push(`${path} is left out: it is ${what}`);
  }

  point(at: Point): void {
    this.points.push(...at);
  }

  line(positions: readonly Point[], place: string, properties: Properties): void {
    if (positions.every((position) => same(position, positions[0]))) {
      this.markerLabels.of(properties.marker, properties.markerName); // as the command line numbers names
      return this.leftOut.add("line", place);
    }
    this.chain(positions, 0, properties);
  }

  // Each ring ends in its first position, or is closed with a warning. The holes of a ring that is left out are
  // left out, too.
  polygon(rings: readonly (readonly Point[])[], place: string, properties: Properties): void {
    const kept: { path: string; ring: Point[] }[] = [];
    const crossings = this.crossings.length;
    for (const [i, ring] of rings.entries()) {
      if (isCollapsed(ring)) {
        this.markerLabels.of(properties.marker, properties.markerName);
        this.leftOut.add("ring", `${place}[${i}]`);
        if (i === 0) return;
        continue;
      }
      const closed = this.close(ring, `${place}[${i}]`);
      this.chain(closed.slice(0, -1), this.areas.length + 1, properties);
      kept.push({ path: `${place}[${i}]`, ring: closed.slice(0, -1) });
      this.checkCrossing(closed, `${place}[${i}]`);
    }
    if (kept.length === 0) return;
    if (this.crossings.length === crossings) this.checkOverlap(kept);
    const { region, regionName, maxArea } = properties;
    const asks = region !== undefined || regionName !== "";
    this.areas.push({ region: asks ? this.regionLabels.of(region ?? 0, regionName) : undefined, maxArea });
  }

  // Tells of a ring that does not end where it starts.
  private close(ring: readonly Point[], path: string): readonly Point[] {
    const [first, last] = [ring[0], ring[ring.length - 1]];
    if (same(first, last)) return ring;
    const ends = `it starts at (${first.join(", ")}) and ends at (${last.join(", ")})`;
    this.open.push(`${path} is a ring that is not closed: ${ends}; a segment closes it`);
    return [...ring, first];
  }

  private checkCrossing(ring: readonly Point[], path: string): void {
    const found = findSelfCrossing(ring.slice(0, -1));
    if (!found) return;
    const edges = found.map((i) => `edge ${i} from (${ring[i].join(", ")}) to (${ring[i + 1].join(", ")})`);
    this.crossings.push(`${path} is a ring that crosses itself: ${edges.join(" crosses ")}`);
  }

  // Tells of rings that parity does not treat as holes of the first.
  private checkOverlap(kept: readonly { path: string; ring: Point[] }[]): void {
    const found = findOverlap(kept.map(({ ring }) => ring));
    if (!found) return;
    const at = `(${found.at.join(", ")})`;
    const fault =
      found.crossed === undefined
        ? `is a hole that is outside of its polygon or in another hole, at ${at}`
        : `is a ring that crosses another of its polygon: ${kept[found.crossed].path}, near ${at}`;
    this.overlaps.push(`${kept[found.ring].path} ${fault}; what an odd number of the rings encloses is meshed`);
  }

  finish(name: string): PlanarDomain {
    const leftOut = this.leftOut.sentence();
    if (this.points.length === 0) throw new FileError("", `the file holds no geometry${leftOut && `: ${leftOut}`}`);
    const markers = this.markerLabels.numbers();
    const regions = this.regionLabels.numbers();
    const told = (sentences: string[], others: string) => {
      const more = sentences.length - mostTold;
      return more > 0 ? [...sentences.slice(0, mostTold), `${more} ${others}`] : sentences;
    };
    const odd = told(this.oddProperties, "more properties are left out");
    const open = told(this.open, "more rings are not closed");
    const crossings = told(this.crossings, "more rings cross themselves");
    const overlaps = told(this.overlaps, "more polygons have rings that overlap");
    const [ofMarkers, ofRegions] = [this.markerLabels.reader, this.regionLabels.reader];
    return {
      name,
      points: Float64Array.from(this.points),
      segments: Uint32Array.from(this.segments),
      markers: Int32Array.from(this.markers, (label) => markers[label]!),
      holes: new Float64Array(),
      regions: [],
      areas: this.areas.map(({ region, maxArea }) => ({ region: region === undefined ? region : regions[region]!, maxArea })),
      borders: Uint32Array.from(this.borders),
      markerNames: ofMarkers.names,
      regionNames: ofRegions.names,
      warnings: [...(leftOut ? [leftOut] : []), ...open, ...crossings, ...overlaps, ...odd, ...ofMarkers.warnings, ...ofRegions.warnings],
    };
  }

  // A ring of the polygon that 1 less than `area` numbers, or a line if it is 0. Positions that repeat the
  // one before are dropped.
  private chain(positions: readonly Point[], area: number, properties: Properties): void {
    const marker = this.markerLabels.of(properties.marker, properties.markerName);
    const first = this.points.length / 2;
    positions.forEach(([x, y], i) => {
      if (i > 0 && x === positions[i - 1][0] && y === positions[i - 1][1]) return;
      const index = this.points.push(x, y) / 2 - 1;
      if (index > first) this.segment(index - 1, index, marker, area);
    });
    const last = this.points.length / 2 - 1;
    if (area > 0 && last > first) this.segment(last, first, marker, area);
  }

  private segment(a: number, b: number, marker: number, area: number): void {
    this.segments.push(a, b);
    this.markers.push(marker);
    this.borders.push(area);
  }
}
