// SPDX-License-Identifier: Apache-2.0
// How far a run is, and what it made.
import type { ConnectError } from "@connectrpc/connect";
import { explain } from "../client";
import { Stage } from "../gen/weft/v1/mesh_service_pb";
import { warningsOf } from "../jobs/summary-warnings";
import { count, figure, seconds, short } from "../text";
import { ProblemText } from "./problem-text";
import { useRunState, type MeshRun, type RunState } from "../view/mesh-run";

const stages: Partial<Record<Stage, string>> = {
  [Stage.QUEUED]: "Waiting for its turn",
  [Stage.TRIANGULATE]: "Triangulating the domain",
  [Stage.SIZE]: "Bounding the size",
  [Stage.REFINE]: "Refining",
  [Stage.EMIT]: "Sending",
};

// Triangles per second of the engine.
function rate({ progress, summary }: RunState): number {
  const time = summary?.timings?.engineSeconds ?? progress?.seconds ?? 0;
  const triangles = summary ? Number(summary.triangles) : (progress?.triangles ?? 0);
  return time > 0 ? triangles / time : 0;
}

function Figures({ state }: { state: RunState }) {
  const { summary } = state;
  if (!summary) return null;
  const missed = summary.unrefined;
  const misses = missed
    ? missed.smallInputAngle + missed.edgeFloor + missed.kept + missed.budget + missed.precision + missed.streaming
    : 0n;
  return (
    <dl class="figures">
      <dt>Vertices</dt>
      <dd>{count(summary.vertices)}</dd>
      <dt>Angles</dt>
      <dd>
        {summary.minAngleDeg.toFixed(1)}° to {summary.maxAngleDeg.toFixed(1)}°
      </dd>
      <dt>Mean quality</dt>
      <dd>{summary.meanQuality.toFixed(3)}</dd>
      <dt>Area</dt>
      <dd>{figure(summary.area)}</dd>
      {misses > 0n && (
        <>
          <dt>Miss a bound</dt>
          <dd>{count(misses)}</dd>
        </>
      )}
      <dt>Engine</dt>
      <dd>
        {seconds(summary.timings?.engineSeconds ?? 0)}, {summary.threads} {summary.threads === 1 ? "thread" : "threads"}
      </dd>
    </dl>
  );
}

function explained(error: ConnectError): string {
  const { sentence, message } = explain(error);
  return message.includes("\n") ? message : sentence;
}

// `told`: whether the failure is shown beside a field of the form.
export function RunStatus({ run, told }: { run: MeshRun; told: boolean }) {
  const state = useRunState(run);
  const { phase, progress, triangles, chunks, summary, error } = state;
  if (phase === "idle") return null;
  const fraction = progress?.fraction ?? 0;
  const perSecond = rate(state);
  const stage = {
    running: (progress && stages[progress.stage as Stage]) ?? "Asking the server",
    done: summary?.cached ? "Done, from the server's memory" : "Done",
    failed: told ? "The server refuses the request: see the field in red" : "Failed",
    cancelled: "Cancelled; this is not a whole mesh",
  }[phase];
  return (
    <section class="run-status" aria-label="Mesh" data-phase={phase}>
      {(phase !== "failed" || triangles > 0) && (
        <p class="big">
          <strong data-varies>{count(summary?.triangles ?? Math.max(triangles, progress?.triangles ?? 0))}</strong> triangles
        </p>
      )}
      {phase === "running" && (
        <>
          <progress max="1" value={fraction} aria-label="Finished work" />
          <p class="row">
            <span class="faint number grow">
              {(100 * fraction).toFixed(0)} %{progress && progress.expected > 0 && ` of about ${short(progress.expected)}`}
            </span>
            <button type="button" onClick={() => run.cancel()}>
              Cancel
            </button>
          </p>
        </>
      )}
      <p class="faint" role="status">
        {stage}
      </p>
      {chunks > 0 && (
        <p class="faint number" data-varies>
          {count(chunks)} {chunks === 1 ? "chunk" : "chunks"}
          {perSecond > 0 && `, ${short(perSecond)} triangles/s`}
        </p>
      )}
      {error && !told && (
        <div class="problem" role="alert">
          <ProblemText text={explained(error)} />
        </div>
      )}
      <Figures state={state} />
      {summary && warningsOf(summary).map((text) => <p key={text} class="problem">{text}</p>)}
    </section>
  );
}
