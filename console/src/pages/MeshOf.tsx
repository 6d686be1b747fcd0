// SPDX-License-Identifier: Apache-2.0
// A mesh that the server keeps, for whoever gets the link: its picture, its figures, what it was asked
// for, and its files.
import { Copy } from "../jobs/copy";
import { pythonProgram, shellCommand } from "../jobs/commands";
import { Downloads } from "../download/downloads";
import type { Summary } from "../gen/weft/v1/mesh_service_pb";
import { RequestFacts } from "../jobs/request-facts";
import { fetchSummary, findJob, isDigest } from "../jobs/stored-mesh";
import { StoredMeshView } from "../jobs/stored-mesh-view";
import { Histograms, SummaryFacts } from "../jobs/summary-facts";
import "./pages.css";
import { Problem } from "../live/problem";
import { usePoll } from "../live/poll";

function Missing({ digest }: { digest: string }) {
  return (
    <div class="empty">
      <p>No job of yours keeps this mesh.</p>
      <ul>
        <li>The server keeps meshes for a while only; <a href="/server">how long</a> is among its limits.</li>
        <li>If the server wants tokens, a mesh is shown to those with a token of the same name only.</li>
        <li>A mesh from the page Mesh is kept once it is submitted as a job.</li>
      </ul>
      {!isDigest(digest) && <p>A mesh's name has 64 digits from 0 to f; this is none.</p>}
    </div>
  );
}

// To ask for the mesh again, or for this very one in any other format.
function Again({ id, summary }: { id: string; summary: Summary }) {
  return (
    <div class="again" role="group" aria-label="Copy">
      <span class="faint">Copy as</span>
      {summary.request && <Copy label="weft mesh" text={shellCommand(summary.request)} />}
      {summary.request && <Copy label="Python" text={pythonProgram(summary.request)} />}
      <Copy label="weft fetch" text={`weft fetch ${id} -o mesh.vtu`} />
    </div>
  );
}

export function MeshOfPage({ digest }: { digest: string }) {
  const found = usePoll(
    `mesh ${digest}`,
    async (signal) => {
      const job = await findJob(digest, signal);
      return { job, summary: job && (await fetchSummary(job, signal)) };
    },
    () => undefined,
  );
  const { job, summary } = found.value ?? {};
  return (
    <section aria-labelledby="title" class="page page-full">
      <header class="page-head">
        <h1 id="title">
          Mesh <span class="mono" title={digest}>{digest.slice(0, 12)}</span>
        </h1>
        <Copy label="Copy the link" text={location.href} />
        <span class="gap" />
        {job && <Downloads of={job} stem={digest.slice(0, 12)} />}
      </header>
      <Problem of={found.problem} />
      {found.value && !job && <Missing digest={digest} />}
      {job?.summary && (
        <div class="mesh-page">
          <StoredMeshView job={job} label={`Mesh ${digest.slice(0, 12)}`} />
          <aside aria-label="Figures and request" tabIndex={0} class="card">
            <SummaryFacts summary={job.summary} />
            <h2>Request</h2>
            <RequestFacts summary={summary} />
            {summary && <Again id={job.id} summary={summary} />}
            <Histograms summary={job.summary} />
            <p>
              <a href={`/job/${job.id}`}>Its job</a>
            </p>
          </aside>
        </div>
      )}
    </section>
  );
}
