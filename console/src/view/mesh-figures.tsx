// SPDX-License-Identifier: Apache-2.0
// What the page counts of a run while it comes: histograms, the worst triangles, the picked one.
import { useEffect, useState } from "preact/hooks";
import { count, figure } from "../text";
import type { Names } from "../domain/names";
import { css, scaleColour } from "./colours";
import { regionText } from "./legend";
import { useRunState, type MeshRun } from "./mesh-run";
import type { PickedTriangle } from "./store";

interface Bin {
  count: number;
  label: string;
  fill: string;
}

function Histogram({ title, bins, ends }: { title: string; bins: Bin[]; ends: string[] }) {
  const most = Math.max(...bins.map((bin) => bin.count), 1);
  const all = bins.reduce((sum, bin) => sum + bin.count, 0) || 1;
  const width = 240 / bins.length;
  return (
    <figure class="bars">
      <figcaption>{title}</figcaption>
      <svg viewBox="0 0 240 46" preserveAspectRatio="none" role="img" aria-label={`${title}: most often ${bins.find((bin) => bin.count === most)?.label ?? "none"}`}>
        {bins.map((bin, i) => {
          // A bin that is not empty is seen.
          const height = bin.count > 0 ? Math.max(1.5, (45 * bin.count) / most) : 0;
          return (
            <>
              <rect x={i * width + 0.5} width={Math.max(0.5, width - 1)} y={46 - height} height={height} fill={bin.fill} />
              <rect x={i * width} width={width} height="46" fill="transparent">
                <title>{`${bin.label}: ${count(bin.count)}, ${((100 * bin.count) / all).toFixed(2)} %`}</title>
              </rect>
            </>
          );
        })}
      </svg>
      <div class="bar-ends">
        {ends.map((end) => (
          <span>{end}</span>
        ))}
      </div>
    </figure>
  );
}

// The bound on the area of a triangle at a centroid; undefined if there is none, or it is not known.
export type BoundAt = (centroid: [number, number]) => Promise<number | undefined>;

interface PickedProps {
  picked: PickedTriangle;
  boundAt: BoundAt | undefined;
  names: Names; // of regions
  run: MeshRun;
}

function Picked({ picked, boundAt, names, run }: PickedProps) {
  const [[ax, ay], [bx, by], [cx, cy]] = picked.corners;
  const [bound, setBound] = useState<number>();
  useEffect(() => {
    let late = false;
    setBound(undefined);
    void boundAt?.([(ax + bx + cx) / 3, (ay + by + cy) / 3]).then((area) => late || setBound(area));
    return () => {
      late = true;
    };
  }, [picked, boundAt]);
  return (
    <section class="picked" aria-live="polite" aria-label="Picked triangle">
      <header>
        <h2>Triangle {count(picked.triangle)}</h2>
        <button type="button" class="quiet" aria-label="Close" onClick={() => run.unpick()}>
          ✕
        </button>
      </header>
      <dl class="figures">
        <dt>Angles</dt>
        <dd>{picked.angles.map((angle) => `${angle.toFixed(1)}°`).join(" ")}</dd>
        <dt>Area</dt>
        <dd>{figure(picked.area)}</dd>
        {bound && (
          <>
            <dt>Bound</dt>
            <dd>
              {figure(bound)} ({((100 * picked.area) / bound).toFixed(1)} %)
            </dd>
          </>
        )}
        <dt>Region</dt>
        <dd>{regionText(picked.region, names)}</dd>
        <dt>Chunk</dt>
        <dd>{picked.chunk}</dd>
        <dt>Neighbours</dt>
        <dd class="neighbours">
          {picked.neighbours.map((neighbour) =>
            neighbour === undefined ? (
              <span class="faint">border</span>
            ) : (
              <button type="button" class="link" onClick={() => run.find(neighbour)}>
                {neighbour}
              </button>
            ),
          )}
        </dd>
      </dl>
    </section>
  );
}

interface FiguresProps {
  run: MeshRun;
  regionNames: Names;
  boundAt?: BoundAt | undefined;
}

export function MeshFigures({ run, regionNames, boundAt }: FiguresProps) {
  const { census, picked, triangles, summary } = useRunState(run);
  if (!census || triangles === 0) return null;
  const { angles, areas, firstArea, worst } = census;
  return (
    <div class="mesh-figures">
      {picked && <Picked picked={picked} boundAt={boundAt} names={regionNames} run={run} />}
      <Histogram
        title="Smallest angles"
        bins={angles.map((n, i) => ({
          count: n,
          label: `${2 * i}° to ${2 * i + 2}°`,
          fill: css(scaleColour("angle", (i + 0.5) / angles.length)),
        }))}
        ends={["0°", "20°", "40°", "60°"]}
      />
      <Histogram
        title="Areas"
        bins={areas.map((n, i) => ({
          count: n,
          label: `${figure(2 ** (firstArea + i / 2))} to ${figure(2 ** (firstArea + (i + 1) / 2))}`,
          fill: css(scaleColour("area", (i + 0.5) / areas.length)),
        }))}
        ends={[figure(2 ** firstArea), figure(2 ** (firstArea + areas.length / 2))]}
      />
      {summary && summary.sizeHistogram.some((n) => n > 0n) && (
        <Histogram
          title="Area over its bound"
          bins={summary.sizeHistogram.map((n, i, all) => ({
            count: Number(n),
            label: i + 1 < all.length ? `${i / 10} to ${(i + 1) / 10}` : `${i / 10} and more`,
            fill: css(scaleColour("ratio", (i + 0.5) / all.length)),
          }))}
          ends={["0", "0.5", "1"]}
        />
      )}
      <section>
        <h2>Worst triangles</h2>
        <ol class="worst">
          {worst.map(({ triangle, minAngle, area }) => (
            <li key={triangle}>
              <button
                type="button"
                aria-pressed={picked?.triangle === triangle}
                title={`Go to triangle ${count(triangle)}, of area ${figure(area)}`}
                onClick={() => run.find(triangle)}
              >
                {minAngle.toFixed(2)}°
              </button>
            </li>
          ))}
        </ol>
      </section>
    </div>
  );
}
