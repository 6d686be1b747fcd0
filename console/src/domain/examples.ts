// SPDX-License-Identifier: Apache-2.0
// Domains that come with the console, each with a size that suits it.
import { create } from "@bufbuild/protobuf";
import { AreaSchema, DomainSchema, Fill, type Domain } from "../gen/weft/v1/mesh_service_pb";
import type { FormText } from "../request/form";
import type { Point } from "./outline";

export interface Example {
  name: string;
  file: string; // its name, if it is saved
  polygons: Polygon[];
  form: Partial<FormText>;
}

export interface Polygon {
  rings: readonly (readonly Point[])[]; // without their last points
  region?: number; // not 0
}

export function domainOf(polygons: Polygon[]): Domain {
  const domain = create(DomainSchema, { fill: Fill.UNION });
  polygons.forEach(({ rings, region }, i) => {
    for (const ring of rings) {
      const first = domain.points.length / 2;
      domain.points.push(...ring.flat());
      domain.segments.push(...ring.flatMap((_, k) => [first + k, first + ((k + 1) % ring.length)]));
      domain.segmentAreas.push(...ring.map(() => i + 1));
    }
    domain.areas.push(create(AreaSchema, { region }));
  });
  return domain;
}

// The same as a file.
export function geoJsonOf(polygons: Polygon[]): string {
  const features = polygons.map(({ rings, region }) => ({
    type: "Feature",
    properties: region ? { region } : {},
    geometry: { type: "Polygon", coordinates: rings.map((ring) => [...ring, ring[0]]) },
  }));
  return JSON.stringify({ type: "FeatureCollection", features });
}

const rounded = (value: number) => Number(value.toFixed(6));

function ring(count: number, at: (share: number) => Point): Point[] {
  return Array.from({ length: count }, (_, i) => at(i / count).map(rounded) as Point);
}

const circle = (x: number, y: number, radius: number, count = 64) =>
  ring(count, (t) => [x + radius * Math.cos(2 * Math.PI * t), y + radius * Math.sin(2 * Math.PI * t)]);

// A wavy closed line around a point, of a few harmonics: an island, or a shore.
function coast(x: number, y: number, width: number, height: number, seed: number, count: number): Point[] {
  return ring(count, (t) => {
    let radius = 1;
    for (let k = 2; k < 24; ++k) radius += (0.32 / k) * Math.sin(2 * Math.PI * (k * t + Math.sin(seed * 12.9898 * k) * 43.7));
    return [x + width * radius * Math.cos(2 * Math.PI * t), y + height * radius * Math.sin(2 * Math.PI * t)];
  });
}

const plate = () => [
  {
    rings: [
      [[0, 0], [8, 0], [8, 5], [0, 5]],
      circle(2, 2.5, 1.1),
      circle(6.6, 3.7, 0.5, 40),
      circle(6.6, 1.3, 0.5, 40),
      [[3.8, 2.1], [5.4, 2.1], [5.4, 2.9], [3.8, 2.9]],
    ] as Point[][],
  },
];

// NACA 0012 at 6 degrees, with a closed trailing edge.
function airfoil() {
  const side = (t: number) => 0.6 * (0.2969 * Math.sqrt(t) - 0.126 * t - 0.3516 * t ** 2 + 0.2843 * t ** 3 - 0.1036 * t ** 4);
  const tilt = (-6 * Math.PI) / 180;
  const wing = ring(160, (s) => {
    const x = (1 + Math.cos(2 * Math.PI * s)) / 2;
    const y = s < 0.5 ? side(x) : -side(x);
    return [(x - 0.5) * Math.cos(tilt) - y * Math.sin(tilt), (x - 0.5) * Math.sin(tilt) + y * Math.cos(tilt)];
  });
  return [{ rings: [[[-2, -1.6], [4, -1.6], [4, 1.6], [-2, 1.6]] as Point[], wing] }];
}

const lake = () => [
  {
    rings: [
      coast(0, 0, 9, 5.4, 1, 700),
      coast(-3.6, 0.6, 1.5, 0.9, 4, 200),
      coast(1.1, -1.2, 0.9, 0.8, 7, 160),
      coast(3.6, 1.2, 1.1, 0.7, 2, 180),
      coast(0.4, 2.1, 0.4, 0.3, 9, 90),
    ],
  },
];

function gear() {
  const teeth = 18;
  const outer = ring(teeth * 8, (t) => {
    const phase = (t * teeth) % 1;
    const radius = phase < 0.32 || phase > 0.98 ? 5 : phase > 0.4 && phase < 0.9 ? 4.2 : 4.6;
    return [radius * Math.cos(2 * Math.PI * t), radius * Math.sin(2 * Math.PI * t)];
  });
  const openings = Array.from({ length: 6 }, (_, i) =>
    circle(2.9 * Math.cos((i * Math.PI) / 3), 2.9 * Math.sin((i * Math.PI) / 3), 0.72, 48),
  );
  const hub = circle(0, 0, 1.7, 72);
  return [{ rings: [outer, hub, ...openings], region: 1 }, { rings: [hub, circle(0, 0, 0.9, 48)], region: 2 }];
}

const square = () => [{ rings: [[[0, 0], [1, 0], [1, 1], [0, 1]] as Point[]] }];

const make = (name: string, file: string, polygons: Polygon[], form: Partial<FormText>): Example => ({ name, file, polygons, form });

export const examples: readonly Example[] = [
  make("Plate", "plate.geojson", plate(), { sizeKind: "edge", size: "0.12", minAngle: "28" }),
  make("Airfoil", "airfoil.geojson", airfoil(), { sizeKind: "edge", size: "0.008 + 0.15*max(0, hypot(x, 2*y) - 0.52)", minAngle: "28" }),
  make("Lake", "lake.geojson", lake(), { sizeKind: "edge", size: "0.02 + 0.2*distance", gradation: "0.25", minAngle: "25" }),
  make("Gear", "gear.geojson", gear(), { sizeKind: "edge", size: "0.1", minAngle: "28" }),
  make("A million", "million.geojson", square(), { sizeKind: "edge", size: "0.00155", minAngle: "20" }),
];
