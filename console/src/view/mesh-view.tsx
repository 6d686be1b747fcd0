// SPDX-License-Identifier: Apache-2.0
// A mesh to look at, with its tools and its legend.
//
//   <MeshView run={run} regionNames={regionNamesOf(request)} />
import type { ComponentChildren } from "preact";
import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Names } from "../domain/names";
import { useTheme } from "../theme";
import type { Census } from "./census";
import type { ColourBy } from "./colours";
import { Legend } from "./legend";
import type { Backdrop } from "./marks";
import { useRunState, type MeshRun } from "./mesh-run";
import type { Box } from "./picture";
import type { Sketch } from "./sketch";
import { Viewport } from "./viewport";
import "./view.css";

export interface MeshViewProps {
  run: MeshRun;
  regionNames: Names;
  outline?: { ends: Float64Array; box: Box | undefined } | undefined; // x, y of both ends of each segment
  isAsked?: boolean; // whether the page has made the request, so that the server tells its bounds on areas
  sketch?: Sketch | undefined; // takes clicks and keys while there is one
  backdrop?: Backdrop | undefined; // until the first chunks come
  children?: ComponentChildren; // above the canvas
}

const colourings: [ColourBy, string][] = [
  ["angle", "smallest angle"],
  ["area", "area"],
  ["ratio", "area over bound"],
  ["region", "region"],
  ["chunk", "chunk"],
  ["none", "nothing"],
];

const none = new Float64Array();

// Without the smallest hundredth of the triangles, so that a few do not take the scale; the largest
// are few, too, but they are what is seen.
function areaRange({ areas, firstArea }: Census): [number, number] {
  const all = areas.reduce((sum, count) => sum + count, 0);
  let sum = 0;
  const first = areas.findIndex((count) => (sum += count) > 0.01 * all);
  return [firstArea + first / 2, firstArea + areas.length / 2];
}

export function MeshView({ run, regionNames, outline, isAsked, sketch, backdrop, children }: MeshViewProps) {
  const state = useRunState(run);
  const theme = useTheme();
  const canvas = useRef<HTMLCanvasElement>(null);
  const marks = useRef<HTMLCanvasElement>(null);
  const [viewport, setViewport] = useState<Viewport | null>();
  const [lost, setLost] = useState(false);
  const [wanted, setBy] = useState<ColourBy>("angle");
  const [edges, setEdges] = useState(true);
  const [quadtree, setQuadtree] = useState(false);
  const [worst, setWorst] = useState(false);
  const hasBounds = isAsked && state.phase !== "running";
  const by = wanted === "ratio" && !hasBounds ? "angle" : wanted;
  const range = useMemo<[number, number]>(
    () => (by === "angle" ? [0, 60] : by === "area" && state.census?.areas.length ? areaRange(state.census) : [0, 1]),
    [by, state.census],
  );

  useEffect(() => {
    const made = Viewport.on(canvas.current!, marks.current!, run, setLost) ?? null;
    setViewport(made);
    return () => made?.close();
  }, [run]);
  // At once: a mesh that is asked for next is not cleared away.
  useLayoutEffect(() => viewport?.outline(outline?.ends ?? none, outline?.box), [viewport, outline]);
  useEffect(
    () => viewport?.set({ by, range, edges, quadtree, worst, dark: theme === "dark", sketch, backdrop }),
    [viewport, by, range, edges, quadtree, worst, theme, sketch, backdrop],
  );
  useEffect(() => {
    if (state.found > 0) viewport?.showPicked();
  }, [viewport, state.found]);

  const keys = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey || sketch) return;
    const toggles: Record<string, () => void> = {
      e: () => setEdges(!edges),
      q: () => setQuadtree(!quadtree),
      w: () => setWorst(!worst),
      c: () => {
        const usable = colourings.map(([name]) => name).filter((name) => name !== "ratio" || hasBounds);
        setBy(usable[(usable.indexOf(by) + 1) % usable.length]);
      },
    };
    toggles[event.key]?.();
  };
  const toggle = (name: string, key: string, on: boolean, set: (on: boolean) => void, ready = true) => (
    <button type="button" aria-pressed={on} disabled={!ready} title={`${name} (${key})`} onClick={() => set(!on)}>
      {name}
    </button>
  );
  return (
    <div class="mesh-view" data-phase={state.phase} data-chunks={state.chunks} data-triangles={state.triangles}>
      <div class="view-tools" role="toolbar" aria-label="Picture">
        <label>
          Colour by{" "}
          <select value={by} onChange={(event) => setBy(event.currentTarget.value as ColourBy)}>
            {colourings.map(([name, text]) => (
              <option value={name} disabled={name === "ratio" && !hasBounds}>
                {text}
              </option>
            ))}
          </select>
        </label>
        {toggle("Edges", "e", edges, setEdges)}
        {toggle("Quadtree", "q", quadtree, setQuadtree, (state.summary?.leafBoxes.length ?? 0) > 0)}
        {toggle("Worst", "w", worst, setWorst, (state.census?.worst.length ?? 0) > 0)}
        <span class="view-zoom">
          <button type="button" aria-label="Zoom out" title="Zoom out (-)" onClick={() => viewport?.zoom(1 / 1.5)}>
            −
          </button>
          <button type="button" title="Show all (0)" onClick={() => viewport?.fit()}>
            Fit
          </button>
          <button type="button" aria-label="Zoom in" title="Zoom in (+)" onClick={() => viewport?.zoom(1.5)}>
            +
          </button>
        </span>
      </div>
      <div class="stage">
        <canvas
          ref={canvas}
          tabIndex={0}
          role="application"
          aria-label={
            sketch
              ? "Drawing: arrows move, Enter sets a corner, C closes the ring, Backspace takes a corner back"
              : "Picture of the mesh: arrows move, plus and minus zoom, 0 shows all, Enter picks the triangle in the middle"
          }
          class={sketch ? "sketching" : undefined}
          onKeyDown={keys}
        />
        <canvas ref={marks} class="marks" aria-hidden="true" />
        {viewport === null && (
          <p class="problem view-problem">This browser has no WebGL2, which the picture needs. Figures and downloads work without.</p>
        )}
        {lost && (
          <p class="problem view-problem" role="alert">
            The browser has taken the graphics card away from this page. The picture comes back with it; if it does
            not, load the page again. Figures and downloads work without.
          </p>
        )}
        {state.triangles > 0 && <Legend by={by} range={range} regions={state.regions} names={regionNames} />}
        {children}
      </div>
    </div>
  );
}
