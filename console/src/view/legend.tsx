// SPDX-License-Identifier: Apache-2.0
// What the colours mean.
import type { Names } from "../domain/names";
import { css, regionColour, scaleColour, type ColourBy } from "./colours";
import { figure } from "../text";

const steps = 64;
const mostRegions = 12;

const titles = { angle: "Smallest angle", area: "Area", ratio: "Area over its bound" };

export function Scale({ title, by, ends }: { title: string; by: "angle" | "area" | "ratio"; ends: string[] }) {
  return (
    <div class="legend">
      <span>{title}</span>
      <svg width="190" height="12" viewBox={`0 0 ${steps} 4`} preserveAspectRatio="none" shape-rendering="crispEdges" aria-hidden="true">
        {Array.from({ length: steps }, (_, i) => (
          <rect x={i} width="1" height="4" fill={css(scaleColour(by, i / (steps - 1)))} />
        ))}
      </svg>
      <div class="legend-ends">
        {ends.map((end) => (
          <span>{end}</span>
        ))}
      </div>
    </div>
  );
}

interface LegendProps {
  by: ColourBy;
  range: [number, number];
  regions: number[];
  names: Names; // of regions
}

// "none", "7", or "7 fluid".
export const regionText = (id: number, names: Names) =>
  id === 0 && !names.has(id) ? "none" : names.has(id) ? `${id} ${names.get(id)}` : String(id);

export function Legend({ by, range, regions, names }: LegendProps) {
  if (by === "none") return null;
  if (by === "chunk") return <p class="legend">A colour for each chunk, and so for each leaf of the quadtree</p>;
  if (by === "region")
    return (
      <div class="legend">
        <span>Region</span>
        <ul>
          {regions.slice(0, mostRegions).map((id, slot) => (
            <li key={id}>
              <svg width="12" height="12" aria-hidden="true">
                <rect width="12" height="12" rx="2" fill={css(regionColour(slot))} />
              </svg>
              {regionText(id, names)}
            </li>
          ))}
          {regions.length > mostRegions && <li>and {regions.length - mostRegions} more</li>}
        </ul>
      </div>
    );
  const text = {
    angle: (t: number) => `${Math.round(range[0] + t * (range[1] - range[0]))}°`,
    area: (t: number) => figure(2 ** (range[0] + t * (range[1] - range[0]))),
    ratio: (t: number) => (range[0] + t * (range[1] - range[0])).toFixed(2),
  }[by];
  return <Scale title={titles[by]} by={by} ends={[0, 0.5, 1].map(text)} />;
}
