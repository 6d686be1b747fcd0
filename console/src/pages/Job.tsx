// SPDX-License-Identifier: Apache-2.0
// One job: what it does, why it failed, or what it made.
import { useEffect, useState } from "preact/hooks";
import { jobs as service } from "../client";
import { CallbackState, JobState, type Job as JobMessage } from "../gen/weft/v1/job_service_pb";
import { ErrorText } from "../jobs/error-text";
import { JobActions } from "../jobs/job-actions";
import { countText, isOpen, JobProgress, secondsOf, StateBadge, workedText } from "../jobs/job-parts";
import { RequestFacts } from "../jobs/request-facts";
import { fetchSummary } from "../jobs/stored-mesh";
import { hex, Histograms, SummaryFacts } from "../jobs/summary-facts";
import "./pages.css";
import { Problem } from "../live/problem";
import { usePoll } from "../live/poll";

const whileRunning = 400; // ms between two questions
const whileQueued = 1000;

const callbackNames: Record<CallbackState, string> = {
  [CallbackState.UNSPECIFIED]: "Unknown",
  [CallbackState.PENDING]: "Pending",
  [CallbackState.DELIVERED]: "Delivered",
  [CallbackState.FAILED]: "Failed",
};

function Times({ job }: { job: JobMessage }) {
  const rows: [string, string | undefined][] = [
    ["Created", timeText(secondsOf(job.createTime))],
    ["Started", timeText(secondsOf(job.startTime))],
    ["Ended", timeText(secondsOf(job.endTime))],
    ["Worked", workedText(job)],
  ];
  return (
    <section aria-labelledby="course" class="card">
      <h2 id="course">Course</h2>
      <dl class="facts">
        {rows.map(([name, text]) =>
          text ? (
            <div key={name}>
              <dt>{name}</dt>
              <dd data-varies>{text}</dd>
            </div>
          ) : null,
        )}
        {job.requestId && (
          <div>
            <dt>Request id</dt>
            <dd class="mono cut">{job.requestId}</dd>
          </div>
        )}
        {job.client && (
          <div>
            <dt>Client</dt>
            <dd class="cut">{job.client}</dd>
          </div>
        )}
        {job.attempts > 0 && (
          <div>
            <dt>Attempts</dt>
            <dd>{job.attempts}</dd>
          </div>
        )}
        {job.worker && (
          <div>
            <dt>Server</dt>
            <dd class="mono cut" data-varies>{job.worker}</dd>
          </div>
        )}
        {job.callback && (
          <div>
            <dt>Callback</dt>
            <dd class="cut">
              {callbackNames[job.callback.state]}: {job.callback.url}
              {job.callback.error && ` (${job.callback.error})`}
            </dd>
          </div>
        )}
        {job.fromStore && (
          <div>
            <dt>Mesh</dt>
            <dd>was kept already</dd>
          </div>
        )}
      </dl>
    </section>
  );
}

const timeText = (seconds: number | undefined) =>
  seconds === undefined ? undefined : new Date(1000 * seconds).toLocaleString("en-GB");

// The figures of its mesh and what it was asked for.
function Made({ job }: { job: JobMessage }) {
  const whole = usePoll(`summary of ${job.id}`, (signal) => fetchSummary(job, signal), () => undefined);
  if (!job.summary)
    return <p class="empty">The server no longer keeps the mesh of this job. Submit the request again to make it anew.</p>;
  return (
    <>
      <section aria-labelledby="figures" class="card">
        <h2 id="figures">Mesh</h2>
        <SummaryFacts summary={job.summary} />
      </section>
      <section aria-labelledby="request" class="card">
        <h2 id="request">Request</h2>
        <RequestFacts summary={whole.value} />
        <Histograms summary={job.summary} />
      </section>
    </>
  );
}

function Working({ job }: { job: JobMessage }) {
  const { triangles = 0n, expectedTriangles = 0n } = job.progress ?? {};
  return (
    <section aria-label="Progress" class="working">
      <JobProgress job={job} />
      {triangles > 0n && (
        <p class="faint" data-varies>
          {countText(triangles)} triangles
          {expectedTriangles > 0n && ` of about ${countText(expectedTriangles)}`}
        </p>
      )}
    </section>
  );
}

export function JobPage({ id }: { id: string }) {
  const polled = usePoll(
    `job ${id}`,
    async (signal) => (await service.getJob({ id }, { signal })).job,
    (job) => (!job || !isOpen(job) ? undefined : job.state === JobState.RUNNING ? whileRunning : whileQueued),
  );
  const [deleted, setDeleted] = useState(false);
  useEffect(() => setDeleted(false), [id]);
  const job = polled.value;
  if (deleted)
    return (
      <section class="page">
        <h1>Job deleted</h1>
        <p><a href="/jobs">All jobs</a></p>
      </section>
    );
  return (
    <section aria-labelledby="title" class="page">
      <header class="page-head">
        <h1 id="title">
          Job <span class="mono" data-varies>{id}</span>
        </h1>
        {job && <StateBadge state={job.state} />}
        <span class="gap" />
        {job?.summary && (
          <a class="button" href={`/mesh/${hex(job.summary.sha256)}`}>
            See the mesh of {countText(job.summary.triangles)} triangles
          </a>
        )}
        {job && <JobActions job={job} changed={() => (isOpen(job) ? polled.again() : setDeleted(true))} />}
      </header>
      <Problem of={polled.problem} />
      {job && isOpen(job) && <Working job={job} />}
      {job?.error && <ErrorText error={job.error} />}
      {job && (
        <div class="columns columns-job">
          <Times job={job} />
          {job.state === JobState.SUCCEEDED && <Made job={job} />}
        </div>
      )}
    </section>
  );
}
