// SPDX-License-Identifier: Apache-2.0
// The figures of a mesh, in words.
import type { Summary } from "../gen/weft/v1/mesh_service_pb";
import { durationText } from "../live/times";
import { countText } from "./job-parts";
import { warningsOf } from "./summary-warnings";

export const hex = (bytes: Uint8Array) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");

// At most six digits, as a person writes them.
export function numberText(value: number): string {
  if (value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e7)) return value.toExponential(3);
  return Number(value.toPrecision(6)).toLocaleString("en-US", { maximumFractionDigits: 6 });
}

export function bytesText(bytes: number | bigint): string {
  const units = ["B", "KiB", "MiB", "GiB", "TiB"];
  let value = Number(bytes);
  let unit = 0;
  while (value >= 999.5 && unit < units.length - 1) {
    value /= 1024;
    ++unit;
  }
  return `${unit > 0 && value < 99.5 ? value.toFixed(1) : Math.round(value)} ${units[unit]}`;
}

export interface Fact {
  name: string;
  text: string;
  // Differs between two makings of one mesh.
  varies?: boolean;
}

export function factsOf(summary: Summary): Fact[] {
  const facts: Fact[] = [
    { name: "Triangles", text: countText(summary.triangles) },
    { name: "Vertices", text: countText(summary.vertices) },
    { name: "Edges on segments", text: countText(summary.edges) },
    { name: "Chunks", text: countText(summary.chunks) },
    { name: "Area", text: numberText(summary.area) },
    { name: "Angles", text: `${summary.minAngleDeg.toFixed(2)}° to ${summary.maxAngleDeg.toFixed(2)}°` },
    { name: "99 % have angles above", text: `${summary.minAngleP1Deg.toFixed(1)}°` },
    { name: "Mean quality", text: summary.meanQuality.toFixed(4) },
  ];
  if (summary.idealRatio > 0)
    facts.push({ name: "Triangles over the least", text: `${summary.idealRatio.toFixed(3)} times` });
  const missed = summary.unrefined;
  const misses = missed
    ? missed.smallInputAngle + missed.edgeFloor + missed.kept + missed.budget + missed.precision + missed.streaming
    : 0n;
  facts.push({ name: "Miss a bound", text: misses === 0n ? "none" : countText(misses) });
  facts.push(
    { name: "Engine", text: durationText(summary.timings?.engineSeconds ?? 0), varies: true },
    { name: "Threads", text: String(summary.threads), varies: true },
    { name: "Peak of memory", text: bytesText(summary.peakEngineBytes), varies: true },
    { name: "Engine version", text: summary.engineVersion },
  );
  for (const text of warningsOf(summary)) facts.push({ name: "Warning", text });
  return facts;
}

export function SummaryFacts({ summary }: { summary: Summary }) {
  return (
    <dl class="facts">
      {factsOf(summary).map(({ name, text, varies }) => (
        <div key={name + text}>
          <dt>{name}</dt>
          <dd data-varies={varies || undefined}>{text}</dd>
        </div>
      ))}
    </dl>
  );
}

// Bars of a histogram; `labels` are of its bins.
export function Histogram({ title, bins, labels }: { title: string; bins: bigint[]; labels: string[] }) {
  const counts = bins.map(Number);
  const most = Math.max(...counts, 1);
  const width = 100 / counts.length;
  const all = counts.reduce((a, b) => a + b, 0);
  if (all === 0) return null;
  return (
    <figure class="histogram">
      <figcaption>{title}</figcaption>
      <svg viewBox="0 0 100 30" preserveAspectRatio="none" role="img" aria-label={
        `${title}: ${counts.map((count, i) => `${labels[i]}: ${count}`).join(", ")}`}>
        {counts.map((count, i) => (
          <rect x={i * width + 0.4} width={width - 0.8} y={30 - (30 * count) / most} height={(30 * count) / most}>
            <title>{`${labels[i]}: ${countText(count)}, ${((100 * count) / all).toFixed(1)} %`}</title>
          </rect>
        ))}
      </svg>
      <div class="histogram-ends faint">
        <span>{labels[0]}</span>
        <span>{labels.at(-1)}</span>
      </div>
    </figure>
  );
}

export function Histograms({ summary }: { summary: Summary }) {
  const aspects = ["1.1", "1.25", "1.5", "2", "3", "5", "10", "100", "more"];
  return (
    <div class="histograms">
      <Histogram
        title="Angles"
        bins={summary.angleHistogram}
        labels={summary.angleHistogram.map((_, i) => `${10 * i}° to ${10 * (i + 1)}°`)}
      />
      <Histogram title="Aspect" bins={summary.aspectHistogram} labels={aspects.map((most) => `to ${most}`)} />
      <Histogram
        title="Area over its bound"
        bins={summary.sizeHistogram}
        labels={summary.sizeHistogram.map((_, i) => `${(i / 10).toFixed(1)} to ${((i + 1) / 10).toFixed(1)}`)}
      />
    </div>
  );
}
