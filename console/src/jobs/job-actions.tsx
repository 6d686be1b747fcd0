// SPDX-License-Identifier: Apache-2.0
// Cancels a job that is open; deletes one that has ended.
import { useState } from "preact/hooks";
import { jobs as service } from "../client";
import type { Job } from "../gen/weft/v1/job_service_pb";
import { messageOf } from "../live/problem";
import { isOpen } from "./job-parts";

// Does what it says when it is pressed a second time.
function SureButton({ label, act }: { label: string; act: () => Promise<void> }) {
  const [asked, setAsked] = useState(false);
  const [problem, setProblem] = useState("");
  const press = async () => {
    if (!asked) return setAsked(true);
    setAsked(false);
    try {
      await act();
      setProblem("");
    } catch (error) {
      setProblem(messageOf(error));
    }
  };
  return (
    <>
      {problem && <span role="alert" class="problem">{problem}</span>}
      <button type="button" class={asked ? "sure" : "quiet"} onClick={press} onBlur={() => setAsked(false)}>
        {asked ? `${label}?` : label}
      </button>
    </>
  );
}

export function JobActions({ job, changed }: { job: Job; changed: () => void }) {
  return isOpen(job) ? (
    <SureButton
      key="cancel"
      label="Cancel"
      act={async () => {
        await service.cancelJob({ id: job.id });
        changed();
      }}
    />
  ) : (
    <SureButton
      key="delete"
      label="Delete"
      act={async () => {
        await service.deleteJob({ id: job.id });
        changed();
      }}
    />
  );
}
