// SPDX-License-Identifier: Apache-2.0
// The meshes that the server keeps, found by what a link may name: a job's id or a mesh's digest.
import { jobs as service } from "../client";
import { JobState, type Job } from "../gen/weft/v1/job_service_pb";
import type { Summary } from "../gen/weft/v1/mesh_service_pb";
import { hex } from "./summary-facts";

const isJobId = (name: string) => /^[0-9A-Z]{26}$/.test(name);
export const isDigest = (name: string) => /^[0-9a-f]{64}$/.test(name);

// The caller's youngest job whose mesh this is, or undefined if none keeps it. Digests are looked for
// in the list of jobs that succeeded, because the protocol has no call for them.
export async function findJob(name: string, signal: AbortSignal): Promise<Job | undefined> {
  if (isJobId(name)) return (await service.getJob({ id: name }, { signal })).job;
  if (!isDigest(name)) return undefined;
  for (let pageToken = ""; ; ) {
    const page = await service.listJobs({ states: [JobState.SUCCEEDED], pageSize: 1000, pageToken }, { signal });
    const found = page.jobs.find(({ summary }) => summary && hex(summary.sha256) === name);
    if (found || !page.nextPageToken) return found;
    pageToken = page.nextPageToken;
  }
}

// The whole summary of a job's mesh, with its request; the chunks are not sent.
export async function fetchSummary(job: Job, signal: AbortSignal): Promise<Summary | undefined> {
  if (!job.summary) return undefined;
  let summary: Summary | undefined;
  for await (const { message } of service.fetchMesh({ id: job.id, firstChunk: job.summary.chunks }, { signal }))
    if (message.case === "summary") summary = message.value;
  return summary;
}
