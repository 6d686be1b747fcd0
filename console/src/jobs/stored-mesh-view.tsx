// SPDX-License-Identifier: Apache-2.0
// The picture of a mesh that the server keeps, drawn as its chunks come.
import { useEffect } from "preact/hooks";
import { explain } from "../client";
import { regionNamesOf } from "../domain/names";
import type { Job } from "../gen/weft/v1/job_service_pb";
import { useMeshRun, useRunState } from "../view/mesh-run";
import { MeshView } from "../view/mesh-view";

export function StoredMeshView({ job, label }: { job: Job; label: string }) {
  const run = useMeshRun();
  const { phase, triangles, summary, error } = useRunState(run);
  const start = () => run.start({ kind: "job", id: job.id });
  useEffect(start, [run, job.id]);
  return (
    <div class="stored-mesh" role="group" aria-label={label}>
      <MeshView run={run} regionNames={regionNamesOf(summary?.request)} />
      {phase === "running" && (
        <progress max={Number(job.summary?.triangles ?? 1n)} value={triangles} aria-label="Received" />
      )}
      {error && (
        <p class="problem" role="alert">
          {explain(error).sentence}{" "}
          <button type="button" onClick={start}>
            Again
          </button>
        </p>
      )}
    </div>
  );
}
