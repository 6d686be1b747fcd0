// SPDX-License-Identifier: Apache-2.0
// The caller's jobs, live.
import { useState } from "preact/hooks";
import { jobs as service } from "../client";
import { JobState, type Job } from "../gen/weft/v1/job_service_pb";
import { Age, countText, isOpen, JobProgress, StateBadge, trianglesOf, workedText } from "../jobs/job-parts";
import { reasonOf } from "../jobs/error-text";
import { JobActions } from "../jobs/job-actions";
import { hex } from "../jobs/summary-facts";
import "./pages.css";
import { Problem } from "../live/problem";
import { usePoll } from "../live/poll";

const pageSize = 25;
const whileOpen = 1000; // ms between two questions
const whileQuiet = 3000;

const filters: { label: string; states: JobState[] }[] = [
  { label: "All", states: [] },
  { label: "Open", states: [JobState.QUEUED, JobState.RUNNING] },
  { label: "Succeeded", states: [JobState.SUCCEEDED] },
  { label: "Failed", states: [JobState.FAILED] },
  { label: "Cancelled", states: [JobState.CANCELLED] },
];

interface RowProps {
  job: Job;
  named: boolean; // with its client
  changed: () => void;
  picked: boolean;
  pick: () => void;
}

function Row({ job, named, changed, picked, pick }: RowProps) {
  const triangles = trianglesOf(job);
  return (
    <tr>
      <td>
        {job.summary && (
          <input type="checkbox" checked={picked} onChange={pick} aria-label={`Compare the mesh of ${job.id}`} />
        )}
      </td>
      <td>
        <StateBadge state={job.state} />
      </td>
      <td>
        <a class="mono" href={`/job/${job.id}`} data-varies>{job.id}</a>
        {job.requestId && <div class="faint cut" title={job.requestId}>{job.requestId}</div>}
      </td>
      <td class="wide">
        {isOpen(job) && <JobProgress job={job} />}
        {job.state === JobState.SUCCEEDED && (
          <span class="faint" data-varies>{job.fromStore ? "was kept already" : `in ${workedText(job)}`}</span>
        )}
        {job.error && <span class="cut" title={job.error.message}>{reasonOf(job.error)}</span>}
      </td>
      <td class="number">
        {triangles !== undefined &&
          (job.summary ? (
            <a href={`/mesh/${hex(job.summary.sha256)}`} title="See the mesh">{countText(triangles)}</a>
          ) : (
            countText(triangles)
          ))}
      </td>
      {named && <td class="cut" title={job.client}>{job.client}</td>}
      <td class="number">{job.attempts || ""}</td>
      <td class="number"><Age time={job.createTime} /></td>
      <td class="actions"><JobActions job={job} changed={changed} /></td>
    </tr>
  );
}

export function JobsPage() {
  const [filter, setFilter] = useState(filters[0]!);
  const [tokens, setTokens] = useState([""]); // of the pages up to this one
  const pageToken = tokens.at(-1)!;
  const list = usePoll(
    `${filter.label} ${pageToken}`,
    (signal) => service.listJobs({ states: filter.states, pageSize, pageToken }, { signal }),
    ({ jobs }) => (jobs.some(isOpen) ? whileOpen : whileQuiet),
  );
  const [picked, setPicked] = useState<string[]>([]); // jobs whose meshes to compare, two at most
  const pick = (id: string) =>
    setPicked(picked.includes(id) ? picked.filter((each) => each !== id) : [...picked, id].slice(-2));
  const jobs = list.value?.jobs ?? [];
  const named = jobs.some(({ client }) => client !== ""); // the server tells clients apart
  const next = list.value?.nextPageToken;
  return (
    <section aria-labelledby="title" class="page">
      <header class="page-head">
        <h1 id="title">Jobs</h1>
        <div class="segments" role="group" aria-label="State">
          {filters.map((each) => (
            <button
              type="button"
              aria-pressed={each === filter}
              onClick={() => {
                setFilter(each);
                setTokens([""]);
              }}
            >
              {each.label}
            </button>
          ))}
        </div>
        <span class="gap" />
        {picked.length === 2 ? (
          <a class="button" href={`/compare/${picked[0]}/${picked[1]}`}>Compare two meshes</a>
        ) : (
          picked.length === 1 && <span class="faint">Tick another one to compare the two</span>
        )}
      </header>
      <Problem of={list.problem} />
      {list.value && jobs.length === 0 && (
        <p class="empty">
          {filter.states.length === 0 ? "No jobs yet. " : `No job is ${filter.label.toLowerCase()}. `}
          <a href="/">Mesh</a> something and keep it, or use <code>weft submit</code>.
        </p>
      )}
      {jobs.length > 0 && (
        <div class="card table-card">
          <table class="jobs" aria-busy={list.value === undefined}>
            <thead>
              <tr>
                <th scope="col"><span class="hidden">Compare</span></th>
                <th scope="col">State</th>
                <th scope="col">Job</th>
                <th scope="col">Progress</th>
                <th scope="col" class="number">Triangles</th>
                {named && <th scope="col" class="client">Client</th>}
                <th scope="col" class="number">Attempts</th>
                <th scope="col" class="number">Age</th>
                <th scope="col"><span class="hidden">Actions</span></th>
              </tr>
            </thead>
            <tbody>
              {jobs.map((job) => (
                <Row
                  key={job.id}
                  job={job}
                  named={named}
                  changed={list.again}
                  picked={picked.includes(job.id)}
                  pick={() => pick(job.id)}
                />
              ))}
            </tbody>
          </table>
        </div>
      )}
      {(tokens.length > 1 || next) && (
        <nav class="pager" aria-label="Pages">
          <button type="button" disabled={tokens.length === 1} onClick={() => setTokens(tokens.slice(0, -1))}>
            Younger
          </button>
          <span class="faint">page {tokens.length}</span>
          <button type="button" disabled={!next} onClick={() => next && setTokens([...tokens, next])}>
            Older
          </button>
        </nav>
      )}
    </section>
  );
}
