// SPDX-License-Identifier: Apache-2.0
// The files of a mesh that the server keeps, written by a worker as its chunks come.
import { useEffect, useRef, useState } from "preact/hooks";
import { namesOf } from "../domain/names";
import type { Job } from "../gen/weft/v1/job_service_pb";
import type { Summary } from "../gen/weft/v1/mesh_service_pb";
import { countText } from "../jobs/job-parts";
import { currentSession } from "../session";
import { formats, type Format } from "./formats";
import type { News, Order } from "./worker";

// Lets the browser keep a file.
function keep(file: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

// `summary`: with the request, which has the names.
export function Downloads({ job, summary, digest }: { job: Job; summary: Summary | undefined; digest: string }) {
  const [said, setSaid] = useState("");
  const worker = useRef<Worker>();
  const [busy, setBusy] = useState(false);
  const stop = () => {
    worker.current?.terminate();
    worker.current = undefined;
    setBusy(false);
  };
  useEffect(() => stop, [job.id]);

  const download = (format: Format) => {
    stop();
    const all = Number(job.summary?.triangles ?? 0n);
    const started = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
    worker.current = started;
    setBusy(true);
    setSaid("0 %");
    started.onmessage = ({ data }: MessageEvent<News>) => {
      if ("triangles" in data) return setSaid(`${Math.floor((100 * data.triangles) / Math.max(all, 1))} %`);
      stop();
      if ("problem" in data) return setSaid(data.problem);
      keep(data.file, `${digest.slice(0, 12)}.${format}`);
      setSaid(`${countText(all)} triangles written`);
    };
    started.onerror = () => {
      stop();
      setSaid("the file could not be written");
    };
    const order: Order = { job: job.id, format, names: namesOf(summary?.request), token: currentSession().token };
    started.postMessage(order);
  };

  return (
    <div class="downloads" role="group" aria-label="Download">
      <span class="faint" role="status">{said || "Download"}</span>
      {busy && <button type="button" class="quiet" onClick={() => { stop(); setSaid("stopped"); }}>Stop</button>}
      {(Object.keys(formats) as Format[]).map((format) => (
        <button type="button" title={formats[format].for} disabled={busy} onClick={() => download(format)}>
          .{format}
        </button>
      ))}
    </div>
  );
}
