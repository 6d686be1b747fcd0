// SPDX-License-Identifier: Apache-2.0
// Two meshes side by side: what differs in what was asked for, and in what was made.
import type { Job } from "../gen/weft/v1/job_service_pb";
import type { Summary } from "../gen/weft/v1/mesh_service_pb";
import { differences } from "../compare/differences";
import { requestJson } from "../jobs/request-facts";
import { fetchSummary, findJob } from "../jobs/stored-mesh";
import { StoredMeshView } from "../jobs/stored-mesh-view";
import { factsOf, hex } from "../jobs/summary-facts";
import "./pages.css";
import { Problem } from "../live/problem";
import { usePoll } from "../live/poll";

interface Side {
  job?: Job | undefined;
  summary?: Summary | undefined;
}

function useSide(name: string) {
  return usePoll<Side>(
    `side ${name}`,
    async (signal) => {
      const job = await findJob(name, signal);
      return { job, summary: job && (await fetchSummary(job, signal)) };
    },
    () => undefined,
  );
}

// A change of a number in percent, where there is one.
function changeText(a: string, b: string): string {
  const [from, to] = [a, b].map((text) => Number(text.replaceAll(",", "")));
  if (from === undefined || to === undefined || !(from > 0) || !(to > 0) || a === b) return "";
  const change = 100 * (to / from - 1);
  return `${change > 0 ? "+" : "−"}${Math.abs(change).toFixed(Math.abs(change) < 10 ? 1 : 0)} %`;
}

function Requests({ a, b }: { a: Summary; b: Summary }) {
  if (!a.request || !b.request)
    return <p class="faint">An earlier version of the server made one of them, and did not keep its request.</p>;
  const rows = differences(requestJson(a.request), requestJson(b.request));
  if (rows.length === 0) return <p>Both were asked for with the same options. Domains are not compared.</p>;
  return (
    <table class="compare">
      <thead class="hidden">
        <tr><th scope="col">Option</th><th scope="col">Left</th><th scope="col">Right</th></tr>
      </thead>
      <tbody>
        {rows.map(({ path, a, b }) => (
          <tr key={path}>
            <th scope="row" class="mono">{path}</th>
            <td class="mono wrap">{a || <span class="faint">default</span>}</td>
            <td class="mono wrap">{b || <span class="faint">default</span>}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Figures({ a, b }: { a: Summary; b: Summary }) {
  const ofB = new Map(factsOf(b).map((fact) => [fact.name, fact.text]));
  return (
    <table class="compare">
      <thead class="hidden">
        <tr><th scope="col">Figure</th><th scope="col">Left</th><th scope="col">Right</th><th scope="col">Change</th></tr>
      </thead>
      <tbody>
        {factsOf(a).map(({ name, text, varies }) => {
          const other = ofB.get(name) ?? "";
          return (
            <tr key={name} class={text === other ? "same" : undefined}>
              <th scope="row">{name}</th>
              <td class="number" data-varies={varies || undefined}>{text}</td>
              <td class="number" data-varies={varies || undefined}>{other}</td>
              <td class="number" data-varies={varies || undefined}>{changeText(text, other)}</td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}

function Picture({ name, side }: { name: string; side: Side }) {
  if (!side.job?.summary) return <p class="empty">No job of yours keeps {name}.</p>;
  const digest = hex(side.job.summary.sha256);
  return (
    <div class="compare-picture">
      <a class="mono" href={`/mesh/${digest}`} title={digest}>{digest.slice(0, 12)}</a>
      <StoredMeshView job={side.job} label={`Mesh ${digest.slice(0, 12)}`} />
    </div>
  );
}

export function ComparePage({ a, b }: { a: string; b: string }) {
  const left = useSide(a);
  const right = useSide(b);
  const sides = [left.value, right.value];
  const [ofA, ofB] = sides.map((side) => side?.summary);
  return (
    <section aria-labelledby="title" class="page">
      <header class="page-head">
        <h1 id="title">Compare</h1>
        {ofA && ofB && (
          <span class="faint">{hex(ofA.sha256) === hex(ofB.sha256) ? "the same mesh, byte for byte" : "different meshes"}</span>
        )}
      </header>
      <Problem of={left.problem ?? right.problem} />
      <div class="compare-pictures">
        {sides.map((side, i) => side && <Picture key={i} name={i === 0 ? a : b} side={side} />)}
      </div>
      {ofA && ofB && (
        <div class="columns">
          <section aria-labelledby="figures" class="card">
            <h2 id="figures">Figures</h2>
            <Figures a={ofA} b={ofB} />
          </section>
          <section aria-labelledby="request" class="card">
            <h2 id="request">What differs in the request</h2>
            <Requests a={ofA} b={ofB} />
          </section>
        </div>
      )}
    </section>
  );
}
