// SPDX-License-Identifier: Apache-2.0
// What the pages of jobs share: a job's state, its progress, its numbers.
import type { Timestamp } from "@bufbuild/protobuf/wkt";
import { JobState, type Job } from "../gen/weft/v1/job_service_pb";
import { Stage } from "../gen/weft/v1/mesh_service_pb";
import { durationText, secondsLeft } from "../live/times";

export const isOpen = (job: Job) => job.state === JobState.QUEUED || job.state === JobState.RUNNING;

const stateNames: Record<number, string> = {
  [JobState.QUEUED]: "queued",
  [JobState.RUNNING]: "running",
  [JobState.SUCCEEDED]: "succeeded",
  [JobState.FAILED]: "failed",
  [JobState.CANCELLED]: "cancelled",
};

export const stateName = (state: JobState) => stateNames[state] ?? "unknown";

const stageNames: Record<number, string> = {
  [Stage.QUEUED]: "waiting",
  [Stage.TRIANGULATE]: "triangulating",
  [Stage.SIZE]: "sizing",
  [Stage.REFINE]: "refining",
  [Stage.EMIT]: "storing",
};

export function StateBadge({ state }: { state: JobState }) {
  return <span class={`badge badge-${stateName(state)}`}>{stateName(state)}</span>;
}

// In seconds since 1970; undefined if it is not set.
export const secondsOf = (time: Timestamp | undefined) =>
  time && Number(time.seconds) + time.nanos / 1e9;

export const countText = (count: number | bigint) => count.toLocaleString("en-US");

// Of the mesh so far.
export const trianglesOf = (job: Job) => job.summary?.triangles ?? job.progress?.triangles;

// Since the work began, of a job that has ended.
export function workedText(job: Job): string {
  const start = secondsOf(job.startTime);
  const end = secondsOf(job.endTime);
  return start !== undefined && end !== undefined ? durationText(end - start) : "";
}

export function leftText(job: Job): string {
  const { fraction = 0, elapsedSeconds = 0 } = job.progress ?? {};
  const left = secondsLeft(fraction, elapsedSeconds);
  return left === undefined ? "" : `${durationText(left)} left`;
}

// A bar, and in words what is being done.
export function JobProgress({ job }: { job: Job }) {
  const { fraction = 0, stage = Stage.QUEUED } = job.progress ?? {};
  const percent = Math.floor(100 * Math.min(fraction, 1));
  const what = job.state === JobState.QUEUED ? "waiting" : (stageNames[stage] ?? "working");
  return (
    <div class="job-progress">
      <progress max={1} value={job.state === JobState.QUEUED ? 0 : fraction} aria-label={`${what}, ${percent} %`} />
      <span class="faint" data-varies>
        {job.state === JobState.QUEUED ? "waiting" : `${percent} %, ${what}`}
        {leftText(job) && `, ${leftText(job)}`}
      </span>
    </div>
  );
}

export function Age({ time }: { time: Timestamp | undefined }) {
  const at = secondsOf(time);
  if (at === undefined) return null;
  return (
    <time dateTime={new Date(1000 * at).toISOString()} title={new Date(1000 * at).toLocaleString()} data-varies>
      {durationText(Math.max(0, Date.now() / 1000 - at), 1)}
    </time>
  );
}
